#!/bin/sh
# Makes the shipped models from generated shapes alone; the same bytes every time.
set -eu
cd "$(dirname "$0")/.."
pcednet=build/release/bin/pcednet
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

$pcednet generate default "$folder/default" --seed 1
$pcednet train "$folder/default" -o models/scan.safetensors --natural --seed 1 --overwrite
