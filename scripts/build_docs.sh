#!/bin/sh
# Makes the pages of the documentation in build/docs (or the folder that is named); open index.html
# there. The program must be built; `scripts/setup.sh web` installs what else this needs, and npm
# then fetches the libraries that docs/site/package-lock.json names.
set -eu
cd "$(dirname "$0")/.."
out=${1:-build/docs}
pcednet=${PCEDNET:-build/release/bin/pcednet}
[ -x "$pcednet" ] || { echo "build_docs.sh: no $pcednet; build it, or set PCEDNET" >&2; exit 1; }

# The lock file, copied when its packages are all there, says whether they are those wanted.
if ! cmp -s docs/site/package-lock.json docs/site/node_modules/.installed-lock.json; then
  (cd docs/site && ../../scripts/npm.sh ci --no-audit --no-fund --silent && cp package-lock.json node_modules/.installed-lock.json)
fi
commands=$(mktemp)
trap 'rm -f "$commands"' EXIT
PYTHONDONTWRITEBYTECODE=1 python3 packaging/program_help.py "$pcednet" >"$commands"
node docs/site/build.mjs "$out" "$commands"
