#!/bin/sh
# Lists the tests that a run of ctest skipped: scripts/check_skips.sh LOG OUTPUTS
#   LOG      of ctest --output-log
#   OUTPUTS  of all tests, as ctest keeps them: Testing/Temporary/LastTest.log
# Exits with 1 if one of them needs nothing but what scripts/test.sh installs, or if a test in Python
# skipped a part of itself.
set -eu
usage="usage: scripts/check_skips.sh LOG OUTPUTS"
log=${1:?$usage} outputs=${2:?$usage}
grep -q '^Total Test time' "$log" || { echo "check_skips.sh: $log is no log of ctest" >&2; exit 2; }

# They need the authors' data beside this folder, or programs that scripts/setup.sh clients installs;
# Slurm's daemons need root.
clients='cloudcompare|meshlab|pcl|gdal|qgis'
[ "$(id -u)" = 0 ] || clients="$clients|slurm"
may_be_skipped="^Cli\.published_scores_test\$|^Clients\.($clients)\$"

skipped=$(
  sed -n 's/^[[:space:]]*[0-9]* - \(.*\) (\(Skipped\|Disabled\))$/\1/p' "$log"
  awk '/^[0-9]+\/[0-9]+ Testing: / { name = $3 } /^OK \(.*skipped=/ { print name " in part" }' "$outputs"
)
[ -n "$skipped" ] || { echo "No test was skipped."; exit 0; }
echo "$(echo "$skipped" | wc -l) tests were skipped:"
echo "$skipped" | sed 's/^/  /'
if unexpected=$(echo "$skipped" | grep -Ev "$may_be_skipped"); then
  echo "of which these should have run:"
  echo "$unexpected" | sed 's/^/  /'
  exit 1
fi
