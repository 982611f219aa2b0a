#!/bin/sh
# Trains the shipped models on generated shapes alone: scripts/train_models.sh [general] [scan] [cad] [worn]
# The same machine gives the same bytes; other processors differ in the last digits (see
# docs/architecture.md, Determinism). Some shapes have points with random normals on purpose, which
# --keep-orientation keeps.
set -eu
cd "$(dirname "$0")/.."
pcednet=build/release/bin/pcednet
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

generate() { # KIND SEED
  [ -d "$folder/$1$2" ] || $pcednet generate "$1" "$folder/$1$2" --seed "$2"
}

for model in ${*:-general scan cad worn}; do
  case $model in
  general)
    clouds=
    for set in default:1 default:2 default:3 default:4 default:6 default:7 \
      scan:1 scan:2 scan:3 scan:4 cad:1 cad:2 cad:3 cad:4 cad:6 cad:7 \
      worn:1 worn:2 worn:3 worn:4 varied:1 varied:2 varied:3 varied:4; do  # seed 5 is for comparing
      generate "${set%:*}" "${set#*:}"
      clouds="$clouds $folder/${set%:*}${set#*:}"
    done
    piece_options="--scales 8 --s-max-ratio 8 --gate 0.4 --second-gate -0.3 --width 40 --seed 1"
    options="$piece_options --context --keep-orientation"
    generate sparse 1
    generate drawn 1
    generate pieces 1
    more_in_noise=''
    for set in worn:6 worn:7 worn:8 worn:9 scan:6 scan:7; do
      generate "${set%:*}" "${set#*:}"
      more_in_noise="$more_in_noise $folder/${set%:*}${set#*:}"
    done
    for seed in 1 2 3; do
      $pcednet generate lines "$folder/lines$seed" --seed "$seed" --only _noisy
      $pcednet generate lines "$folder/lines$seed" --seed "$seed" --only _scanned
    done
    # shellcheck disable=SC2086  # several options, one argument for each folder
    $pcednet train "$folder/sparse1" -o "$folder/sparse.safetensors" $options --distil 4 --octaves --natural --even-validation
    # shellcheck disable=SC2086
    $pcednet train "$folder/drawn1" "$folder/default1" "$folder/default2" "$folder/cad1" "$folder/cad2" \
      -o "$folder/exact.safetensors" $options --distil 2 --octaves --natural --even-validation --epochs 18 --no-normals \
      --only estimated,exact
    # Without octaves in training it finds more of scans from several places.
    # shellcheck disable=SC2086
    $pcednet train "$folder/lines1" "$folder/lines2" "$folder/lines3" $clouds $more_in_noise \
      -o "$folder/noisy.safetensors" $options --distil 2 --natural --epochs 18 --no-normals --only estimated,noisy
    # Whether a cloud of few points is a whole thing or a piece of a scan.
    # shellcheck disable=SC2086
    $pcednet train "$folder/pieces1" -o "$folder/pieces.safetensors" $piece_options --octaves --even-validation
    # shellcheck disable=SC2086
    $pcednet train $clouds -o models/general.safetensors $options --distil 4 --octaves --unrounded-scales --balance 0.07 --overwrite \
      --expert "$folder/sparse.safetensors" below=4000,estimated \
      --expert "$folder/exact.safetensors" estimated,exact \
      --expert "$folder/noisy.safetensors" estimated,noisy \
      --pieces "$folder/pieces.safetensors"
    ;;
  scan)
    generate default 1
    generate default 2
    generate default 3
    generate scan 1
    $pcednet train "$folder/default1" "$folder/default2" "$folder/default3" "$folder/scan1" \
      -o models/scan.safetensors --natural --even-validation --distil 3 --context --keep-orientation \
      --seed 1 --overwrite
    ;;
  cad)
    generate cad 1
    generate cad 2
    $pcednet train "$folder/cad1" "$folder/cad2" -o models/cad.safetensors \
      --classes 2 --natural --even-validation --gate 0.4 --second-gate -0.3 --distil 3 \
      --keep-orientation --seed 1 --overwrite
    ;;
  worn)
    generate worn 1
    generate worn 2
    generate cad 1
    generate cad 2
    $pcednet train "$folder/worn1" "$folder/worn2" "$folder/cad1" "$folder/cad2" \
      -o models/worn.safetensors --classes 2 --balance 0.5 --even-validation --gate -0.5 --distil 3 --context \
      --keep-orientation --seed 1 --overwrite
    ;;
  *)
    echo "train_models.sh: no model $model" >&2
    exit 2
    ;;
  esac
done
