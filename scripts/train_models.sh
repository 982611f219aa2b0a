#!/bin/sh
# Makes the shipped models from generated shapes alone; the same bytes every time.
# scripts/train_models.sh [scan] [cad] [worn] makes those alone.
set -eu
cd "$(dirname "$0")/.."
pcednet=build/release/bin/pcednet
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

generate() { # KIND SEED
  [ -d "$folder/$1$2" ] || $pcednet generate "$1" "$folder/$1$2" --seed "$2"
}

for model in ${*:-scan cad worn}; do
  case $model in
  scan)
    generate default 1
    generate default 2
    $pcednet train "$folder/default1" "$folder/default2" -o models/scan.safetensors \
      --natural --seed 1 --overwrite
    ;;
  cad)
    generate cad 1
    generate cad 2
    $pcednet train "$folder/cad1" "$folder/cad2" -o models/cad.safetensors \
      --classes 2 --natural --gate 0.1 --seed 1 --overwrite
    ;;
  worn)
    generate worn 1
    generate worn 2
    generate cad 1
    generate cad 2
    $pcednet train "$folder/worn1" "$folder/worn2" "$folder/cad1" "$folder/cad2" \
      -o models/worn.safetensors --classes 2 --balance 0.5 --gate -0.5 --seed 1 --overwrite
    ;;
  *)
    echo "train_models.sh: no model $model" >&2
    exit 2
    ;;
  esac
done
