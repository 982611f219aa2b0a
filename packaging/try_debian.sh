#!/bin/sh
# Installs Debian packages of pcednet in a bare Debian 12 and does the main job there as an ordinary
# user: packaging/try_debian.sh FOLDER_OF_DEBS [CLOUD]. Needs root, debootstrap and the network, and
# some 500 MB in TMPDIR for a while.
set -eu
debs=${1:?usage: packaging/try_debian.sh FOLDER_OF_DEBS [CLOUD]}
cloud=${2:-$(dirname "$0")/../examples/building.ply}
root=$(mktemp -d)
chmod 755 "$root"
trap 'rm -rf "$root"' EXIT

debootstrap --variant=minbase bookworm "$root" >"$root.log" || { cat "$root.log"; exit 1; }
rm -f "$root.log"
cp "$debs"/*.deb "$root/tmp/"
cp "$cloud" "$root/tmp/cloud.ply"
# inside WORDS: runs them in the bare Debian.
inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}
packages=$(cd "$debs" && ls ./*.deb | sed 's|^\./|/tmp/|')
inside apt-get update -qq
# shellcheck disable=SC2086
inside apt-get install -y -qq --no-install-recommends $packages >/dev/null
inside useradd -m user
# user COMMAND: as an ordinary user in the home folder.
user() {
  inside su -l user -c "$1"
}
set -x
user 'pcednet --version'
user 'pcednet classify /tmp/cloud.ply -o edges.ply --preview edges.png'
user 'pcednet lines edges.ply -o edges.dxf && ls -l'
user 'pcednet evaluate /tmp/cloud.ply --positive edge'
if [ -e "$root/usr/lib/python3/dist-packages/pcednet" ]; then
  user 'python3 -c "import pcednet; print(pcednet.classify(pcednet.read(\"/tmp/cloud.ply\")).counts)"'
fi
inside dpkg --audit
# The desktop's side, and the manual.
inside apt-get install -y -qq --no-install-recommends shared-mime-info desktop-file-utils man-db xdg-utils libfile-mimeinfo-perl >/dev/null
user 'cp /tmp/cloud.ply a.ply; printf LASF >b.las; printf LASF >c.laz; printf ASTM-E57 >d.e57; mimetype *.ply *.las *.laz *.e57'
user 'for type in model/x-ply application/vnd.las application/vnd.laszip model/e57; do xdg-mime query default $type; done'
user 'man -w pcednet pcednet-classify'
# Nothing stays behind.
inside apt-get purge -y -qq pcednet libpcednet-dev python3-pcednet >/dev/null
inside sh -c '! find /usr /etc /var -path "*pcednet*" -not -name "__pycache__" -not -name "*.pyc" | grep .'
