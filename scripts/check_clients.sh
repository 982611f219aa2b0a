#!/bin/sh
# Checks that CloudCompare, MeshLab and PCL read our files as we mean them, and that we read PCL's.
# Usage: scripts/check_clients.sh [PCEDNET [cloudcompare|meshlab|pcl]]
# (default: build/release/bin/pcednet, all three). `scripts/setup.sh clients` installs the programs;
# one that is not there is skipped, with a message.
# Exits with 1 on a mismatch, with 77 if nothing could be checked.
set -eu
cd "$(dirname "$0")/.."
pcednet=$(realpath "${1:-build/release/bin/pcednet}")
[ -x "$pcednet" ] || { echo "check_clients.sh: no $pcednet; build it or name it" >&2; exit 2; }
client=${2:-all}
case $client in all | cloudcompare | meshlab | pcl) ;; *)
  echo "check_clients.sh: no client $client" >&2
  exit 2
  ;;
esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0
checks=0
points=900

# compare NAME TOLERANCES: rows.txt (what we meant) against got.txt, column by column. A tolerance
# holds for the absolute difference; for one that ends in r, relative to the number.
compare() {
  checks=$((checks + 1))
  if awk -v name="$1" -v tolerances="$2" '
      BEGIN { columns = split(tolerances, t, " ") }
      NR == FNR { want[NR] = $0; rows = NR; next }
      {
        split(want[FNR], w, " ")
        if (NF != columns) { print name ": row " FNR " has " NF " columns, not " columns; bad = 1; exit 1 }
        for (c = 1; c <= columns; ++c) {
          allowed = t[c] ~ /r$/ ? (t[c] + 0) * (w[c] < 0 ? -w[c] : w[c]) : t[c] + 0
          off = $c - w[c]
          if (off < -allowed || off > allowed) {
            print name ": row " FNR " column " c ": " $c ", not " w[c]; bad = 1; exit 1
          }
        }
        seen = FNR
      }
      END { if (!bad && seen + 0 != rows) { print name ": " seen + 0 " rows, not " rows; exit 1 } }
    ' rows.txt got.txt; then
    echo "ok       $1"
  else
    echo "MISMATCH $1"
    failures=$((failures + 1))
  fi
}

# same NAME FILE FILE
same() {
  checks=$((checks + 1))
  if cmp "$2" "$3"; then echo "ok       $1"; else
    echo "MISMATCH $1"
    failures=$((failures + 1))
  fi
}

# have CLIENT PROGRAM...: whether the client is asked for and its programs are there
have() {
  [ "$client" = all ] || [ "$client" = "$1" ] || return 1
  shift
  for program in "$@"; do
    command -v "$program" >/dev/null || { echo "skipped  $program is not installed"; return 1; }
  done
}

# x y z nx ny nz r g b quality class p_sharp p_smooth label, in a national grid
awk -v n=$points 'BEGIN {
  split("255 255 168", red); split("255 196 0", green); split("255 93 0", blue)
  for (i = 0; i < n; ++i) {
    class = i % 3; angle = i * 0.7
    printf "%.3f %.3f %.3f %.6g %.6g 0 %d %d %d %.4f %d %.5f %.5f %d\n",
      512049.781 + i * 0.25, 5403059.52 - i * 0.125, 252.5 + i * 0.01, cos(angle), sin(angle),
      red[class + 1], green[class + 1], blue[class + 1], i / n, class, (i % 17) / 17, (i % 13) / 13,
      i % 4 == 3 ? 255 : i % 4
  }
}' >all.txt
{
  printf 'ply\nformat ascii 1.0\ncomment made by scripts/check_clients.sh\n'
  echo 'comment classes 0 non-edge, 1 smooth-edge, 2 sharp-edge'
  echo "element vertex $points"
  printf 'property double %s\n' x y z
  printf 'property float %s\n' nx ny nz
  printf 'property uchar %s\n' red green blue
  echo 'property float quality'
  echo 'property uchar scalar_edge_class'
  printf 'property float %s\n' scalar_p_sharp scalar_p_smooth
  echo 'property uchar label'
  echo end_header
  cat all.txt
} >given.ply
"$pcednet" convert given.ply -o r.ply 2>/dev/null
"$pcednet" convert r.ply -o whole.ply --ascii 2>/dev/null

if have cloudcompare CloudCompare; then
  # Its scalar fields are our scalar_*; field 0 is edge_class. Positions become
  # floats after a global shift (half a unit in the last place of 256), normals are quantised.
  QT_QPA_PLATFORM=offscreen CloudCompare -SILENT -NO_TIMESTAMP -AUTO_SAVE OFF -C_EXPORT_FMT ASC \
    -PREC 6 -ADD_HEADER -ADD_PTS_COUNT -O -GLOBAL_SHIFT AUTO r.ply -SAVE_CLOUDS FILE cc.asc \
    -SET_ACTIVE_SF 0 -FILTER_SF 2 2 -SAVE_CLOUDS FILE sharp.asc >cc.log 2>&1 || cat cc.log
  touch cc.asc sharp.asc
  tolerances="2e-5 2e-5 2e-5 0 0 0 0 1e-6 1e-6 2e-3 2e-3 2e-3"
  columns='{ print $1, $2, $3, $7, $8, $9, $11, $12, $13, $4, $5, $6 }'
  awk "$columns" all.txt >rows.txt
  tail -n +3 cc.asc >got.txt
  compare "CloudCompare: every point" "$tolerances"
  awk "\$11 == 2 $columns" all.txt >rows.txt
  tail -n +3 sharp.asc >got.txt
  compare "CloudCompare: points whose edge_class is 2" "$tolerances"
  wc -l <rows.txt | awk '{ print $1 }' >rows1.txt
  sed -n 2p sharp.asc >count.txt
  same "CloudCompare: how many these are" rows1.txt count.txt
fi

if have meshlab meshlabserver xvfb-run; then
  # Positions become float and are written with seven digits; an alpha of 255 is added.
  xvfb-run -a meshlabserver -i r.ply -o back.ply -m vq vn vc sa >ml.log 2>&1 || cat ml.log
  touch back.ply
  awk '{ print $1, $2, $3, $4, $5, $6, $7, $8, $9, 255, $10 }' all.txt >rows.txt
  sed '1,/^end_header/d' back.ply >got.txt
  compare "MeshLab: normals, colours and quality" "1e-6r 1e-6r 1e-6r 1e-6 1e-6 1e-6 0 0 0 0 1e-6"
fi

if have pcl pcl_ply2pcd pcl_convert_pcd_ascii_binary; then
  pcl_ply2pcd r.ply r.pcd >pcl.log 2>&1 || cat pcl.log
  for encoding in 0 1 2; do
    pcl_convert_pcd_ascii_binary r.pcd "r$encoding.pcd" $encoding 12 >pcl.log 2>&1 || cat pcl.log
  done
  # rgb is one packed number there. Our normals have six digits before they are made unit.
  tolerances="1e-6 1e-6 1e-6 1e-6 1e-6 1e-6 0 1e-7 0 1e-7 1e-7 0"
  awk '{ print $1, $2, $3, $4, $5, $6, $7 * 65536 + $8 * 256 + $9, $10, $11, $12, $13, $14 }' \
    all.txt >rows.txt
  unpack='{ $7 = $7 % 16777216; print }'
  sed '1,/^DATA/d' r0.pcd | awk "$unpack" >got.txt
  compare "PCL: every field of our PLY" "$tolerances"
  "$pcednet" convert r.ply -o ours.pcd 2>/dev/null
  pcl_convert_pcd_ascii_binary ours.pcd ours0.pcd 0 12 >pcl.log 2>&1 || cat pcl.log
  sed '1,/^DATA/d' ours0.pcd | awk "$unpack" >got.txt
  compare "PCL: every field of our PCD" "$tolerances"
  grep -v '^comment' whole.ply >want.ply
  for encoding in 1 2; do
    "$pcednet" convert "r$encoding.pcd" -o pcl.ply --ascii --overwrite 2>/dev/null
    same "PCL's PCD, encoding $encoding, read by us" want.ply pcl.ply
  done
fi

[ $failures -eq 0 ] || { echo "$failures mismatches"; exit 1; }
[ $checks -gt 0 ] || exit 77
