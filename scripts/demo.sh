#!/bin/sh
# From a fresh clone to the edges of a point cloud: installs what is missing, builds, classifies the
# included sample and draws it.
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh

cmake --preset release >/dev/null
cmake --build --preset release

mkdir -p out
build/release/bin/pcednet classify examples/building.ply --overwrite \
  -o out/building_edges.ply --preview out/building_edges.png

cat <<'END'

Look at   out/building_edges.png
or open   out/building_edges.ply  in CloudCompare, MeshLab or PCL.
Your own: build/release/bin/pcednet classify YOUR_FILE.ply
END
