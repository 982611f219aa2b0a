#!/bin/sh
# Prints the end of what each failed test of a run of ctest printed, so that it stands last:
# scripts/show_failures.sh LOG, the log of ctest --output-on-failure --output-log.
set -eu
log=${1:?usage: scripts/show_failures.sh LOG}
awk -v most=60 '
  function finish(  i) {
    if (name != "") print "== failed: " name
    for (i = lines > most ? lines - most : 0; i < lines; ++i) print text[i]
    name = ""
    lines = 0
  }
  /^ *Start +[0-9]+: / || /^ *[0-9]+\/[0-9]+ Test +#[0-9]+: / || /^[0-9]+% tests passed/ { finish() }
  /^ *[0-9]+\/[0-9]+ Test +#[0-9]+: .*\*\*\*/ && !/\*\*\*(Skipped|Not Run)/ { name = $4; next }
  name != "" { text[lines++] = $0 }
  END { finish() }
' "$log"
