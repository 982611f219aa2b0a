#!/bin/sh
# Scores lines on generated clouds with true curves: bench/lines_scores.sh FOLDER SEED [LINES OPTION...]
#   clean, noisy, scanned   parts of 32,768 points without normals
#   roof, survey            roofs of 1,024 points, boundaries included: easy ones, and as surveyed
# Classifies every cloud first: their labels are the truth.
set -eu
folder=$1 seed=$2
shift 2
pcednet=$(dirname "$0")/../build/release/bin/pcednet

[ -d "$folder/curves" ] || "$pcednet" generate lines "$folder" --seed "$seed" >/dev/null 2>&1
for cloud in "$folder"/*.ply; do
  name=$(basename "$cloud" .ply)
  [ -f "$folder/curves/$name.obj" ] || continue  # a part without edges
  case $name in
    roof*) kind=roof boundaries=--boundaries ;;
    survey*) kind=survey boundaries=--boundaries ;;
    *_noisy) kind=noisy boundaries= ;;
    *_scanned) kind=scanned boundaries= ;;
    *) kind=clean boundaries= ;;
  esac
  mkdir -p "$folder/lines/$kind"
  # shellcheck disable=SC2086
  "$pcednet" lines "$cloud" --classify $boundaries "$@" -o "$folder/lines/$kind/$name.obj" \
    --overwrite --progress none >/dev/null 2>&1
done
for kind in clean noisy scanned roof survey; do
  echo "== $kind"
  "$pcednet" evaluate "$folder/lines/$kind" --truth "$folder" --cloud "$folder" | tail -2
done
