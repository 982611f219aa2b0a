#!/bin/sh
# Builds the static libraries that Debian does not have, from Debian's sources of the versions that
# are installed: packaging/static_libraries.sh FOLDER leaves libfmt.a and libproj.a there. PROJ goes
# without the network and without grids in TIFF, which pcednet does not use.
set -eu
mkdir -p "${1:?usage: packaging/static_libraries.sh FOLDER}"
cd "$1"
# shellcheck disable=SC2016
wanted=$(dpkg-query -W -f '${source:Package}=${source:Version} ' libfmt-dev libproj-dev)
if [ -f libfmt.a ] && [ -f libproj.a ] && [ "$(cat versions)" = "$wanted" ]; then exit 0; fi

# A list of our own of the sources beside the packages that apt has; apt checks their signatures.
rm -rf lists sources build
mkdir -p lists/partial sources
# shellcheck disable=SC2016
apt-get indextargets --format 'deb-src $(SITE) $(RELEASE) $(COMPONENT) $(ORIGIN)' \
  'Created-By: Packages' | sed -n 's/ Debian$//p' | sort -u >sources.list
here=$PWD
for step in update "source $wanted"; do
  # shellcheck disable=SC2086
  (cd sources && apt-get -qq -o "Dir::Etc::sourcelist=$here/sources.list" -o Dir::Etc::sourceparts=/dev/null \
    -o "Dir::State::lists=$here/lists" -o APT::Get::List-Cleanup=0 $step)
done

mkdir build
(cd build && g++ -O2 -fPIC -I ../sources/fmtlib-*/include -c ../sources/fmtlib-*/src/format.cc \
  ../sources/fmtlib-*/src/os.cc && ar rc ../libfmt.a format.o os.o)
# The database comes with Debian's package: nothing but the library is built, so sqlite3 is not needed.
cmake -S sources/proj-* -B build/proj -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr \
  -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_SHARED_LIBS=OFF -DENABLE_CURL=OFF -DENABLE_TIFF=OFF \
  -DBUILD_APPS=OFF -DBUILD_TESTING=OFF -DEXE_SQLITE3=/bin/true >build/proj.log
cmake --build build/proj --target proj -j "$(nproc)" >>build/proj.log || { tail build/proj.log; exit 1; }
cp build/proj/lib/libproj.a .
rm -rf lists sources build
echo "$wanted" >versions
