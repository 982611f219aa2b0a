#!/bin/sh
# From a fresh clone to the edges of a point cloud: installs what is missing, builds the whole
# program with its web pages, classifies the included sample, draws it, and draws its edges as lines.
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh web
scripts/build_web.sh ||
  echo "demo.sh: no web pages, so annotate and report will not work; scripts/build_web.sh says why" >&2

cmake --preset release >/dev/null
cmake --build --preset release

mkdir -p out
build/release/bin/pcednet classify examples/building.ply --overwrite \
  -o out/building_edges.ply --preview out/building_edges.png
build/release/bin/pcednet lines out/building_edges.ply --overwrite \
  -o out/building_lines.dxf --preview out/building_lines.png

cat <<'END'

Look at   out/building_edges.png and out/building_lines.png,
or open   out/building_edges.ply  in CloudCompare, MeshLab or PCL,
          out/building_lines.dxf  in any CAD program.
Your own: build/release/bin/pcednet classify YOUR_FILE.ply
Or paint: build/release/bin/pcednet annotate YOUR_FILE.ply
END
