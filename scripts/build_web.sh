#!/bin/sh
# Builds the pages that pcednet carries inside: web/dist/*.html. Configure and build pcednet again
# afterwards. `scripts/setup.sh web` installs what this needs (Node.js 18); npm then fetches the
# libraries that web/package-lock.json names.
set -eu
cd "$(dirname "$0")/../web"
npm() { ../scripts/npm.sh "$@"; }

# The lock file, copied when its packages are all there, says whether they are those wanted.
if ! cmp -s package-lock.json node_modules/.installed-lock.json; then
  npm ci --no-audit --no-fund
  cp package-lock.json node_modules/.installed-lock.json
fi
npm run --silent build
