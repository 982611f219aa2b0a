#!/bin/sh
# Installs what is missing, builds, and runs the whole test suite.
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh test python web

echo "== web pages"
scripts/build_web.sh

echo "== other readers, from npm"
(cd tests/clients && ../../scripts/npm.sh ci --no-audit --no-fund --silent) ||
  echo "not installed: their tests are skipped, which fails in the end"

echo "== Snakemake"
scripts/unpack_snakemake.sh || echo "not unpacked: its test is skipped, which fails in the end"

echo "== release build"
cmake --preset release -DPCEDNET_TESTS=ON -DPCEDNET_PYTHON_MODULE=ON
cmake --build --preset release

echo "== tests"
failed=0
jobs=$((2 * $(nproc)))  # many wait for browsers and daemons
ctest --preset release -j "$jobs" --output-log build/release/tests.log || failed=1
echo "== tests that were skipped"
scripts/check_skips.sh build/release/tests.log build/release/Testing/Temporary/LastTest.log || failed=1
[ "$failed" = 0 ] || scripts/show_failures.sh build/release/tests.log
exit $failed
