#!/bin/sh
# skips_test.sh CHECK_SKIPS: what it makes of made-up logs of ctest.
set -eu
check=$1
log=$(mktemp)
outputs=$(mktemp)
trap 'rm -f "$log" "$outputs"' EXIT

# expect CODE WORDS: with the log on stdin, CHECK_SKIPS exits with CODE and says WORDS.
expect() {
  cat >"$log"
  code=0
  said=$("$check" "$log" "$outputs" 2>&1) || code=$?
  if [ $code -ne "$1" ] || ! echo "$said" | grep -qF "$2"; then
    echo "exit $code instead of $1, or no \"$2\": $said"
    exit 1
  fi
}

printf 'Total Test time (real) =   0.02 sec\n' | expect 0 'No test was skipped'
printf 'Total Test time (real) =   0.02 sec\n\nThe following tests did not run:\n%s\n%s\n' \
  '	 12 - Clients.pcl (Skipped)' '	613 - Cli.published_scores_test (Skipped)' |
  expect 0 '2 tests were skipped'
printf 'Total Test time (real) =   0.02 sec\n\nThe following tests did not run:\n%s\n%s\n' \
  '	  1 - Clients.pcl (Skipped)' '	  2 - Clients.e57 (Skipped)' | expect 1 'these should have run'
printf 'Total Test time (real) =   0.02 sec\n%s\n' '	  3 - Web.report (Disabled)' |
  expect 1 '1 tests were skipped'
printf 'No tests were found!!!\n' | expect 2 'is no log of ctest'

printf '%s\n' '7/9 Testing: Cli.lines_test' 'Ran 9 tests in 1.2s' 'OK' '8/9 Testing: Package.deb' \
  'Ran 5 tests in 3.4s' 'OK (skipped=1)' >"$outputs"
printf 'Total Test time (real) =   0.02 sec\n' | expect 1 'Package.deb'
