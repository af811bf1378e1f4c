#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# `hr2d field --pfm`: the map has the numbers of the CSV file at the centres of its pixels, for one band
# and for three; other numbers of bands are refused.  Skipped without python3, which reads it.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
if ! command -v python3 >/dev/null 2>&1; then
  echo "no python3: not tested" >&2
  [ -z "${CI-}" ] || exit 1
  exit 77
fi

# room FILE EMISSION: a room with an obstacle that shines
room() {
  cat >"$1" <<END
{"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"reflectance": 0.5},
   "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]]}},
  {"type": "Feature", "properties": {"faces": "out", "emission": $2},
   "geometry": {"type": "Polygon", "coordinates": [[[1, 0.5], [2, 0.5], [2, 1.5], [1, 1.5], [1, 0.5]]]}}]}
END
}
room "$work/grey.geojson" 1
room "$work/two.geojson" '[1, 2]'
room "$work/rgb.geojson" '[1, 2, 0.5]'

same() { python3 "$HR2D_SRCDIR/tests/program/pfm.py" "$@"; }
others() { ! same "$@" 2>/dev/null; }
# reads_like SCENE NAME X0 Y0 X1 Y1 OPTION...
reads_like() {
  scene=$1 name=$2 x0=$3 y0=$4 x1=$5 y1=$6
  shift 6
  succeeds field "$work/$scene.geojson" --pfm "$work/$name.pfm" --csv "$work/$name.csv" --eps 1 "$@"
  check "$name: the numbers of the table, at centres of pixels" \
    same "$work/$name.pfm" "$work/$name.csv" "$x0" "$y0" "$x1" "$y1"
}
reads_like grey grey 0 0 4 3 --grid 11x8
reads_like rgb rgb -1 -1 5 4 --grid 23x17 --box=-1,-1,5,4
reads_like grey pixel 2.5 0 3.5 1 --grid 1x1 --box 2.5,0,3.5,1
reads_like grey row 0 0 4 3 --grid 5x1
reads_like rgb coarse 0 0 4 3 --grid 61x41 --tolerance 0.01
check "the head of one band" [ "$(head -c 14 "$work/grey.pfm" | tr '\n' ,)" = 'Pf,11 8,-1.0,'"$(
  head -c 14 "$work/grey.pfm" | tail -c 1)" ]
check "pixels outside are among them" grep -q ',,,,' "$work/rgb.csv"

# Without it the first node is at the corner of the box, and JSON tells which it is.
succeeds field "$work/grey.geojson" --grid 11x8 --eps 1 --csv "$work/nodes.csv" --json "$work/nodes.json"
check "nodes at the border are other points" others "$work/grey.pfm" "$work/nodes.csv" 0 0 4 3
check "JSON without pixels" sh -c '! grep -q nodes "$1"' - "$work/nodes.json"
succeeds field "$work/grey.geojson" --grid 2x1 --eps 1 --pfm "$work/x.pfm" --json "$work/pixels.json"
check "JSON with pixels" grep -q '^  "nodes": "pixel centres",$' "$work/pixels.json"
check "and with their centres" grep -q '"x": 1[,.]' "$work/pixels.json"

# Negative control: another number, a lost one, rows from the top, bytes in the other order.
awk -F, -v OFS=, 'NR == 9 { $4 *= 1.000001 } { print }' "$work/grey.csv" >"$work/other.csv"
awk 'NR != 9' "$work/grey.csv" >"$work/short.csv"
for table in other short; do
  check "$table.csv is not the same" others "$work/grey.pfm" "$work/$table.csv" 0 0 4 3
done
python3 - "$work/grey.pfm" "$work" <<'PY'
import sys
head, data = (lambda text: (b"\n".join(text[:3]) + b"\n", text[3]))(open(sys.argv[1], "rb").read().split(b"\n", 3))
rows = [data[k:k + 44] for k in range(0, len(data), 44)]
open(sys.argv[2] + "/top.pfm", "wb").write(head + b"".join(reversed(rows)))
open(sys.argv[2] + "/big.pfm", "wb").write(head + b"".join(data[k:k + 4][::-1] for k in range(0, len(data), 4)))
PY
for map in top big; do
  check "$map.pfm is not the same" others "$work/$map.pfm" "$work/grey.csv" 0 0 4 3
done

# ---- misuse
usage "--pfm: a float map has one band or three, and this scene has 2" field "$work/two.geojson" \
  --pfm "$work/two.pfm"
check "no file of two bands" [ ! -e "$work/two.pfm" ]
printf '1 1\n' >"$work/points"
usage "--points excludes --grid, --box, --tolerance, --vtk and --pfm" field "$work/grey.geojson" \
  --points "$work/points" --pfm "$work/x.pfm"
expect 1 "^hr2d: $work/no/x.pfm: cannot be written" field "$work/grey.geojson" --pfm "$work/no/x.pfm"
usage "'solve' has no option --pfm" solve "$work/grey.geojson" --pfm "$work/x.pfm"
if [ -e /dev/full ]; then
  expect 1 "^hr2d: /dev/full: " field "$work/grey.geojson" --quiet --eps 1 --grid 99x99 --pfm /dev/full
fi
run field "$work/grey.geojson" --eps 1 --grid 11x8 --pfm -
check "- is standard output, without a table" cmp -s "$work/out" "$work/grey.pfm"
summary check-pfm
