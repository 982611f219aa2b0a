#!/bin/sh
# Packs pcednet into build/packages: scripts/package.sh [deb] [tar], both if none is named.
#   deb  Debian 12 packages, from the release build
#   tar  one program without shared libraries, for any x86-64 Linux, from the build in build/static
# Installs what is missing. The first time takes as long as two builds of the program.
set -eu
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- deb tar
scripts/setup.sh web python package
scripts/build_web.sh
out=$PWD/build/packages
mkdir -p "$out"

pack_deb() {
  cmake --preset release -DPCEDNET_WEB=ON -DPCEDNET_PYTHON_MODULE=ON >/dev/null
  cmake --build --preset release --target pcednet pcednet_manual _core
  rm -f "$out"/*.deb
  (cd build/release && cpack -G DEB -B "$out" >"$out/cpack.log") || { cat "$out/cpack.log"; exit 1; }
  rm -rf "$out/_CPack_Packages" "$out/cpack.log"
  lintian --allow-root --fail-on error,warning "$out"/*.deb
}

# The licences of what is within the program.
write_licences() {
  for package in libeigen3-dev libboost-dev libcli11-dev libnanoflann-dev nlohmann-json3-dev libfmt-dev \
    libpugixml-dev libyaml-cpp-dev libpng-dev zlib1g-dev libsqlite3-dev libssl-dev libproj-dev libc6-dev \
    libstdc++-12-dev; do
    cp -L "/usr/share/doc/$package/copyright" "$1/$package"
  done
  cp packaging/copyright "$1/pcednet"
}

pack_tar() {
  packaging/static_libraries.sh build/static-libraries
  cmake --preset static >/dev/null
  cmake --build --preset static --target pcednet pcednet_manual
  version=$(build/static/bin/pcednet --version | cut -d' ' -f2)
  name=pcednet-$version-linux-x86_64
  rm -rf build/static/tar
  cmake --install build/static --component program --strip --prefix "build/static/tar/$name" >/dev/null
  (cd "build/static/tar/$name" && rm -rf share/doc && mkdir -p share/pcednet/proj share/licences)
  cp /usr/share/proj/proj.db "build/static/tar/$name/share/pcednet/proj/"
  write_licences "build/static/tar/$name/share/licences"
  cp packaging/tarball.md "build/static/tar/$name/README.md"
  cp CHANGELOG.md "build/static/tar/$name/"
  tar -C build/static/tar --owner=0 --group=0 --sort=name -c "$name" | gzip -9n >"$out/$name.tar.gz"
}

for what; do
  case $what in
    deb | tar) "pack_$what" ;;
    *)
      echo "package.sh: makes deb or tar, not $what" >&2
      exit 2
      ;;
  esac
done
ls -l "$out"
