#!/bin/sh
# Unpacks Debian's Snakemake into build/snakemake for its test, without installing it: needs no root.
# Installing it takes 652 MB and minutes, for python3-azure and python3-botocore, which it does without.
set -eu
folder=$(cd "$(dirname "$0")/.." && pwd)/build/snakemake
[ -x "$folder/usr/bin/snakemake" ] && exit 0
command -v snakemake >/dev/null && exit 0
rm -rf "$folder.new"
mkdir -p "$folder.new/packages"
cd "$folder.new/packages"
missing=$(apt-get install --simulate --no-install-recommends snakemake | sed -n 's/^Inst \([^ ]*\).*/\1/p' |
  grep -Ev '^python3-(azure|azure-storage|boto3|botocore)$')
# shellcheck disable=SC2086
apt-get download -qq $missing
for package in *.deb; do dpkg-deb --extract "$package" ..; done
cd ..
rm -rf packages
mv "$folder.new" "$folder"
