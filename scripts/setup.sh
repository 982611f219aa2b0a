#!/bin/sh
# Installs what pcednet needs from Debian 12: scripts/setup.sh [test] [python] [package] [check] [web] [clients]
# Does nothing (and needs no root) when everything is there already.
set -eu
list="$(dirname "$0")/packages.txt"

missing=""
for section in build "$@"; do
  # Node.js of another source does, and would conflict with that of Debian.
  [ "$section" = web ] && command -v node >/dev/null && continue
  wanted=$(sed -n "/^\[$section\]\$/,/^\[/p" "$list" | grep -v '^\[\|^#\|^$') || {
    echo "setup.sh: no section [$section] in $list" >&2
    exit 2
  }
  for package in $wanted; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' ||
      missing="$missing $package"
  done
done
[ -z "$missing" ] && exit 0

if [ "$(id -u)" = 0 ]; then
  as_root=""
elif command -v sudo >/dev/null; then
  as_root=sudo
else
  echo "setup.sh: run as root, or install sudo; missing:$missing" >&2
  exit 1
fi
echo "Installing:$missing"
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get update -qq
# shellcheck disable=SC2086
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing
