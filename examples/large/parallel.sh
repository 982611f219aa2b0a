#!/bin/sh
# Classifies the tiles of a plan with GNU parallel, on this machine or on others that see its files.
#   parallel.sh PLAN [JOBS] [further options of parallel, such as --sshloginfile hosts]
# A tile that fails, or whose process is killed, is tried again up to three times. After a stop, run
# it again: tiles that are done cost nothing.
set -eu
plan=$(realpath "$1")
jobs=${2:-2}
shift; [ $# -eq 0 ] || shift
pcednet=${PCEDNET:-pcednet}
"$pcednet" tiles status "$plan" --json - |
  python3 -c 'import json, sys; s = json.load(sys.stdin); print(*s["missing"], *s["damaged"], sep="\n")' |
  grep . |
  parallel --jobs "$jobs" --retries 3 --joblog "$plan.joblog" "$@" \
    "$pcednet" tiles run "$plan" --tile {} --threads 1 --progress none || [ $? -eq 1 ]
"$pcednet" tiles status "$plan"
