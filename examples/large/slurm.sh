#!/bin/sh
# Classifies the tiles of a plan as an array of Slurm and joins them into OUT.
#   slurm.sh PLAN OUT [options of sbatch, such as --partition=short --cpus-per-task=2 --mem=3G]
# PLAN, OUT and the program must have the same paths on all nodes; PCEDNET names the program.
# Slurm puts a task back in the queue when its node fails, but not when the task is killed or fails.
# A closing job therefore looks for missing tiles after each array and submits them again, up to
# five times in all. After any stop, run it again: tiles that are done cost nothing.
# What the jobs say is in the folder PLAN.slurm.
set -eu
pcednet=${PCEDNET:-pcednet}

# task PLAN LIST TASKS: the tiles of one task, every TASKS-th of the list
task() {
  tiles=$(awk -v own="$SLURM_ARRAY_TASK_ID" -v tasks="$3" 'NR % tasks == own { print "--tile", $1 }' "$2")
  # shellcheck disable=SC2086
  exec "$pcednet" tiles run "$1" $tiles --threads "${SLURM_CPUS_PER_TASK:-1}" --progress none
}

# submit ROUND PLAN OUT OPTIONS...: joins if all tiles are done, else submits those that are not
submit() {
  round=$1 plan=$2 out=$3
  shift 3
  list=$plan.slurm/tiles-$round
  "$pcednet" tiles status "$plan" --json - >"$list.json"
  python3 -c 'import json, sys; s = json.load(sys.stdin); print(*s["missing"], *s["damaged"], sep="\n")' \
    <"$list.json" | sed '/^$/d' >"$list"
  count=$(wc -l <"$list")
  if [ "$count" -eq 0 ]; then exec "$pcednet" tiles join "$plan" -o "$out" --overwrite; fi
  if [ "$round" -gt 5 ]; then
    echo "slurm.sh: tiles are missing after five rounds: $(paste -sd, "$list")" >&2
    exit 1
  fi
  # Slurm allows 1,001 tasks in an array unless its administrator says otherwise.
  tasks=$((count < 1000 ? count : 1000))
  array=$(sbatch --parsable --job-name=tiles --requeue --open-mode=append \
    --output="$plan.slurm/%A_%a.txt" "$@" --array="0-$((tasks - 1))" "$0" --task "$plan" "$list" "$tasks")
  array=${array%%;*}
  closing=$(sbatch --parsable --job-name=tiles-closing --requeue --open-mode=append \
    --output="$plan.slurm/closing-%j.txt" "$@" --dependency="afterany:$array" \
    "$0" --close "$((round + 1))" "$plan" "$out" "$@")
  echo "round $round: $count tiles in array $array, closing job ${closing%%;*}"
}

case ${1:-} in
  --task | --close)
    part=$1
    shift
    if [ "$part" = --task ]; then task "$@"; else submit "$@"; fi
    ;;
  *)
    plan=$(realpath "${1:?usage: slurm.sh PLAN OUT [options of sbatch]}")
    out=$(realpath "${2:?usage: slurm.sh PLAN OUT [options of sbatch]}")
    shift 2
    [ ! -e "$out" ] || { echo "slurm.sh: $out exists" >&2; exit 2; }
    mkdir -p "$plan.slurm"
    submit 1 "$plan" "$out" "$@"
    ;;
esac
