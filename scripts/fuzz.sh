#!/bin/sh
# Fuzzes every reader for SECONDS each: scripts/fuzz.sh SECONDS [READER...]
# Readers: ply pcd obj off stl ptx xyz las e57 parts npy features model project curves. Inputs found are kept in build/fuzz/corpus, and what
# breaks a reader in build/fuzz/findings. Exits with 1 if something does.
# PCEDNET names the program that makes the first inputs (default: build/release/bin/pcednet).
set -eu
cd "$(dirname "$0")/.."
seconds=${1:?usage: scripts/fuzz.sh SECONDS [READER...]}
shift
all="ply pcd obj off stl ptx xyz las e57 parts npy features model project curves"
# shellcheck disable=SC2086
[ $# -gt 0 ] || set -- $all
command -v clang++ >/dev/null || { echo "fuzz.sh: no clang++; scripts/setup.sh check" >&2; exit 77; }
pcednet=$(realpath "${PCEDNET:-build/release/bin/pcednet}")

cmake --preset fuzz >build/fuzz-configure.log
targets=$(printf 'fuzz_%s ' "$@")
# shellcheck disable=SC2086
cmake --build --preset fuzz -j 2 --target $targets e57_seed >build/fuzz-build.log ||
  { tail -n 40 build/fuzz-build.log; exit 1; }

corpus=build/fuzz/corpus
findings=build/fuzz/findings
for reader in $all; do mkdir -p "$corpus/$reader"; done
mkdir -p "$findings"
printf '%s\n' '# x y z nx ny nz red green blue label' '0 0.5 1 0 0 1 255 0 7 0' \
  '1 0 0.25 0 1 0 1 2 3 1' '0 1 3 1 0 0 9 9 9 2' >"$corpus/xyz/seed.xyz"
convert() { "$pcednet" convert "$corpus/xyz/seed.xyz" --overwrite -o "$@" 2>/dev/null; }
convert "$corpus/ply/binary.ply"
convert "$corpus/ply/ascii.ply" --ascii
convert "$corpus/pcd/binary.pcd"
convert "$corpus/pcd/ascii.pcd" --ascii
convert "$corpus/obj/seed.obj"
printf '%s\n' 'solid a' 'facet normal 0 0 1' 'outer loop' 'vertex 0 0 0' 'vertex 1 0 0' 'vertex 0 1 0' \
  endloop endfacet 'endsolid a' >"$corpus/stl/ascii.stl"
printf '%s\n' CNOFF '3 1 0' '0 0 0 0 0 1 9 8 7' '1 0 0 0 0 1 .5 .5 .5 1' '0 1 0 0 0 1 1 1 1' '3 0 1 2 7 7 7' >"$corpus/off/seed.off"
{ printf '%80s\001\000\000\000' ''; head -c 50 /dev/zero; } >"$corpus/stl/binary.stl"
printf '%s\n' 1 2 '0 0 0' '1 0 0' '0 1 0' '0 0 1' '1 0 0 0' '0 1 0 0' '0 0 1 0' '4 5 6 1' '1 2 3 .5 7 8 9' '0 0 0 .5' \
  >"$corpus/ptx/seed.ptx"
convert "$corpus/las/seed.las"
convert "$corpus/las/seed.laz"
convert "$corpus/las/seed.copc.laz"
for kind in las laz; do  # and with a header that counts no points
  cp "$corpus/las/seed.$kind" "$corpus/las/unfinished.$kind"
  head -c 8 /dev/zero | dd of="$corpus/las/unfinished.$kind" bs=1 seek=247 conv=notrunc 2>/dev/null
done
convert "$corpus/xyz/seed.csv"
convert "$corpus/xyz/seed.pts"
# Ours are too large to begin with: six numbers, whose header has 0166 (118) bytes.
printf '\223NUMPY\001\000\166\000%-117s\n%48s' \
  "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }" '' >"$corpus/npy/seed.npy"
cp "$corpus/ply/binary.ply" "$corpus/las/seed.las" "$corpus/las/seed.laz" \
  "$corpus/las/seed.copc.laz" "$corpus/parts"
cp models/*.safetensors "$corpus/model"
printf '%s\n' 'curves:' '- sharp: true' '  type: Line' '  vert_indices: [0, 1, 2]' \
  >"$corpus/features/seed.yml"
stroke='{"stroke":"a","class":1,"points":[0,1]}'
settings='{"classes":3,"auto":true,"start":"random","seed":1}'
printf '%s' '{"format":"pcednet-annotation-1","input":{"name":"a.ply","digest":"0","points":9},"records":[' \
  "$stroke" ',{"undo":true},{"redo":true},{"settings":' "$settings" '},{"run":1,"records":4,"settings":' \
  "$settings" '},{"restore":1}]}' >"$corpus/project/project.json"
printf '%s' "$stroke" >"$corpus/project/record.json"
printf '%s' '{"id":"a","tool":"brush","class":1,"centres":[[0,0,0]],"radius":1,"protect":true,' \
  '"hidden":[0],"clip":{"min":[0,0,0],"max":[1,1,1]}}' >"$corpus/project/brush.json"
printf '%s' '{"id":"a","tool":"polygon","class":2,"polygon":[[0,0],[1,0],[0,1]],"matrix":' \
  '[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"front_only":true,"point_size":2,"viewport":[9,9],' \
  '"protect":false,"hidden":[],"clip":null}' >"$corpus/project/polygon.json"
printf '%s\n' '# two' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'o boundary' 'l 1 2 -1 1' 'l 3/1 1' \
  >"$corpus/curves/seed.obj"
printf '%s\n' ply 'format ascii 1.0' 'element vertex 3' 'property float x' 'property float y' \
  'property float z' 'element edge 2' 'property int vertex1' 'property int vertex2' \
  'property uchar class' 'property int curve' end_header '0 0 0' '1 0 0' '0 1 0' '0 1 2 0' '1 2 2 0' \
  >"$corpus/curves/seed.ply"
build/fuzz/bin/e57_seed >"$corpus/e57/seed.e57"

fuzz() {  # READER
  log=$findings/$1.log
  if "build/fuzz/bin/fuzz_$1" -max_total_time="$seconds" -max_len=20000 -timeout=10 \
    -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="$findings/$1-" \
    "$corpus/$1" >"$log" 2>&1; then
    awk -v r="$1" '/ cov: / { for (i = 1; i < NF; ++i) if ($i == "cov:") cov = $(i + 1) }
      /number_of_executed_units/ { n = $2 }
      END { print r ": " n " executions, " cov " edges, nothing found" }' "$log"
  else
    echo "$1: FOUND something, see $log"
    return 1
  fi
}

trap 'trap "" TERM; kill 0; exit 130' INT
failed=0
running=
finish() {
  for each in $running; do wait "$each" || failed=1; done
  running=
}
for reader in "$@"; do  # as many at a time as there are cores
  fuzz "$reader" &
  running="$running $!"
  # shellcheck disable=SC2086
  [ "$(printf '%s\n' $running | wc -l)" -lt "$(nproc)" ] || finish
done
finish
exit $failed
