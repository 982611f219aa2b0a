#!/bin/sh
# Classifies the tiles of a plan with GNU parallel, on this machine or on others that see its files.
#   parallel.sh PLAN [JOBS] [further options of parallel, such as --sshloginfile hosts]
# A tile that fails, or whose process is killed, is tried again up to three times. After a stop, run
# it again: tiles that are done cost nothing. Fails unless all are done at the end.
set -eu
plan=$(realpath "$1")
jobs=${2:-2}
shift; [ $# -eq 0 ] || shift
pcednet=${PCEDNET:-pcednet}

# The numbers of the tiles that are not done, one a line.
undone() {
  "$pcednet" tiles status "$plan" --json - |
    python3 -c 'import json, sys; s = json.load(sys.stdin); print(*s["missing"], *s["damaged"], sep="\n")' |
    sed '/^$/d'
}

# parallel counts what fails in its exit code; the tiles themselves say below what is missing.
undone | parallel --quote --no-run-if-empty --jobs "$jobs" --retries 3 --joblog "$plan.joblog" "$@" \
  "$pcednet" tiles run "$plan" --tile {} --threads 1 --progress none || true
"$pcednet" tiles status "$plan"
[ -z "$(undone)" ]
