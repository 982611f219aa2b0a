#!/bin/sh
# Runs pcednet of the tarball where there is nothing else, not even /proc or /dev:
# packaging/try_tarball.sh TARBALL [CLOUD]. Needs no root where users may have namespaces.
set -eu
tarball=${1:?usage: packaging/try_tarball.sh TARBALL [CLOUD]}
cloud=${2:-$(dirname "$0")/../examples/building.ply}
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
tar xzf "$tarball" -C "$root"
mv "$root"/pcednet-* "$root/anywhere"
mkdir "$root/work"
cp "$cloud" "$root/work/cloud.ply"

# alone WORDS: pcednet with the tarball and the cloud as its whole world.
alone() {
  echo "pcednet $*"
  unshare -r chroot "$root" /anywhere/bin/pcednet "$@"
}
alone --version
alone classify /work/cloud.ply -o /work/edges.ply --preview /work/edges.png
alone lines /work/edges.ply -o /work/edges.dxf -o /work/edges.gpkg
alone evaluate /work/cloud.ply --positive edge
alone convert /work/cloud.ply -o /work/thin.ply --subsample 0.1
alone train /work/thin.ply -o /work/my.safetensors --epochs 2
alone tiles plan /work/cloud.ply -o /work/plan.json --max-memory 200M
alone tiles run /work/plan.json
alone tiles join /work/plan.json -o /work/joined.ply
ls -l "$root/work"
