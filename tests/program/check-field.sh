#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# `hr2d field`: the light at points of a file and of a grid, as a table, CSV, JSON and VTK.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
furnace=$work/furnace.geojson
# side EMISSION REFLECTANCE ENDS: with E = 1 - reflectance, B is 1
side() {
  printf '{"type": "Feature", "properties": {"emission": %s, "reflectance": %s},
    "geometry": {"type": "LineString", "coordinates": [%s]}}' "$@"
}
{
  printf '{"type": "FeatureCollection", "features": ['
  side 0.5 0.5 '[0, 0], [1, 0]' && printf ,
  side 0.25 0.75 '[1, 0], [1, 1]' && printf ,
  side 1 0 '[1, 1], [0, 1]' && printf ,
  side 0.75 0.25 '[0, 1], [0, 0]' && printf ']}'
} >"$furnace"

# ---- a furnace: M = 1 and no flux, at points of a file; comments are skipped
printf '# places\n0.5 0.5\n\n  0.25\t0.75\n-3 0.5\n' >"$work/points"
succeeds field "$furnace" --points "$work/points" --csv -
check "a row for each point, and a header" [ "$(wc -l <"$work/out")" -eq 4 ]
check "the header" grep -qx 'x,y,band,mean,flux_x,flux_y,sky,error' "$work/out"
check "M is 1 in the order of the points" awk -F, '
  NR == 2 { ok = $1 == 0.5 && ($4 - 1)^2 < 1e-26 && $5^2 + $6^2 < 1e-26 && $7 == 0 }
  NR == 3 { ok = ok && $1 == 0.25 && $2 == 0.75 && ($4 - 1)^2 < 1e-26 }
  NR == 4 { ok = ok && $4 == "" && $5 == "" && $6 == "" && $7 > 0 }
  END { exit !ok }' "$work/out"
printf '0.5 0.5\n' >"$work/one"
hr2d field "$furnace" --points - --csv - <"$work/one" >"$work/out"
check "points of standard input" [ "$(wc -l <"$work/out")" -eq 2 ]
for bad in '1' '1 2 3' '1 x' 'nan 1' '1 2 3 x' '1 2 3 4 5'; do
  echo "$bad" >"$work/bad"
  expect 1 'line 1: not two numbers' field "$furnace" --points "$work/bad"
done
expect 1 'cannot be opened' field "$furnace" --points "$work/none"

# ---- planes: H is 1 in a furnace, and half a plane that sees black walls and a bright one
printf '0.5 0.5 0 2\n0.25 0.75 -1 3\n-3 0.5 1 0\n' >"$work/planes"
succeeds field "$furnace" --points "$work/planes" --csv "$work/planes.csv" --json "$work/planes.json" \
  --target-error 1e-9
check "the header has irradiance" \
  grep -qx 'x,y,band,mean,flux_x,flux_y,sky,error,irradiance,irradiance_error' "$work/planes.csv"
check "H is 1, and nothing outside" awk -F, '
  NR == 2 || NR == 3 { good += ($9 - 1)^2 < 1e-18 && $10 > 0 && $10 < 1e-6 }
  NR == 4 { good += $9 == "" && $10 == "" }
  END { exit good != 3 }' "$work/planes.csv"
check "JSON has it" [ "$(grep -c '"irradiance": \[' "$work/planes.json")" -eq 3 ]
check "and the table" grep -q '^  *irradiance 1 to 1, error at most ' "$work/out"
sed 's/"emission": 0.5/"emission": 0/; s/"reflectance": [0-9.]*/"reflectance": 0/g' "$furnace" >"$work/lamps"
# From the middle each wall is seen under a right angle: the wall straight ahead gives sin 45°.
for tilted in '0,1 1 0.75 0.25' '1,0 0.25 1 0' '0,-3 0 0.25 0.75'; do
  # shellcheck disable=SC2086 # a normal, what is ahead, to the left and to the right
  set -- $tilted
  succeeds field "$work/lamps" --points "$work/one" --csv - --normal "$1"
  check "$1 looks ahead" awk -F, -v ahead="$2" -v left="$3" -v right="$4" '
    { is = $9; c = sqrt(.5) } END { h = ahead * c + (left + right) * (1 - c) / 2
      exit !((is - h)^2 < 1e-24) }' "$work/out"
done
succeeds field "$work/lamps" --grid 3x2 --box .2,.2,.8,.8 --normal 1,1 --vtk "$work/planes.vti"
check "VTK has it" grep -q 'Name="irradiance0"' "$work/planes.vti"
printf '0 0 0 1\n1 1\n' >"$work/bad"
expect 1 'line 2: some points have a normal, and some do not' field "$furnace" --points "$work/bad"
printf '0 0 0 0\n' >"$work/bad"
expect 1 'line 1: the normal is 0' field "$furnace" --points "$work/bad"
usage "--normal is for points that have no normals" field "$furnace" --points "$work/planes" --normal 1,0
usage "--normal and --tolerance exclude each other" field "$furnace" --normal 1,0 --tolerance .1
for bad in 0,0 1 1,2,3 x,1; do
  usage "--normal: not two numbers X,Y that are not both 0" field "$furnace" --normal $bad
done

# ---- a grid
succeeds field "$furnace" --grid 5x3 --box 0.25,0.25,0.75,0.5 --csv "$work/grid.csv" \
  --json "$work/grid.json" --vtk "$work/grid.vti" --target-error 1e-6
check "the table counts the points" grep -q '^points  *15: 15 between' "$work/out"
check "nodes in rows" [ "$(sed -n '7p' "$work/grid.csv" | cut -d, -f1-3)" = 0.25,0.375,0 ]
check "JSON has the grid" grep -q '"columns": 5' "$work/grid.json"
check "and all points" [ "$(grep -c '"place": "between"' "$work/grid.json")" -eq 15 ]
check "VTK has the nodes" grep -q 'WholeExtent="0 4 0 2 0 0"' "$work/grid.vti"
# The length of an array stands alone, then the numbers: 12 and 160 digits.
check "and numbers of 8 bytes" [ "$(grep -A1 'Name="mean0"' "$work/grid.vti" | sed -n 2p |
  tr -d '\n' | wc -c)" -eq 172 ]

# ---- what is outside is marked in each format
printf '0.5 0.5\n2 2\n' >"$work/two"
succeeds field "$furnace" --points "$work/two" --csv "$work/two.csv" --json "$work/two.json"
check "the table counts them" grep -q '^points  *2: 1 between.* 1 outside' "$work/out"
check "CSV has no numbers" grep -q '^2,2,0,,,,' "$work/two.csv"
check "JSON says outside, and null" sh -c 'tr -d " \n" <"$1" |
  grep -q "\"place\":\"outside\",\"mean\":\[null\],\"flux\":\[null,null\]"' - "$work/two.json"

# ---- a tolerance: most nodes are interpolated, all within it
room=$HR2D_SRCDIR/examples/scenes/partition.geojson
succeeds field "$room" --target-error 1e-6 --grid 120x80 --csv "$work/exact.csv"
check "without one none is" lacks '^grid' "$work/out"
succeeds field "$room" --target-error 1e-6 --grid 120x80 --csv "$work/some.csv" --tolerance 0.01
check "many are" awk '/^grid/ { n = $2 } END { exit !(n > 1000) }' "$work/out"
# M is between 0 and 0.6: column 4 of one file and column 12 of the other.
paste -d, "$work/exact.csv" "$work/some.csv" >"$work/both.csv"
check "within it" awk -F, 'NR > 1 && ($4 - $12)^2 > 0.006^2 { bad = 1 }
  NR > 1 && ($4 == "") != ($12 == "") { bad = 1 } END { exit bad }' "$work/both.csv"
check "but not exact" awk -F, 'NR > 1 && ($4 - $12)^2 > 1e-10 { some = 1 } END { exit !some }' \
  "$work/both.csv"
usage "--tolerance: '2' is not a number" field "$furnace" --tolerance 2
usage "--points excludes" field "$furnace" --points "$work/one" --tolerance 0.1
usage "--grid: not WxH" field "$furnace" --grid 5
usage "--grid: not WxH" field "$furnace" --grid 0x4
usage "--box: not four numbers" field "$furnace" --box 1,2,3
usage "--points excludes" field "$furnace" --points "$work/one" --grid 3x3

# ---- view factors of points: with black walls the mean is their sum with E
cat >"$work/black.geojson" <<'END'
{"type": "FeatureCollection", "hr2d": {"background": 3}, "features": [
  {"type": "Feature", "properties": {"name": "a, b", "emission": 1},
   "geometry": {"type": "LineString", "coordinates": [[0, 0], [4, 0]]}},
  {"type": "Feature", "properties": {"name": "screen", "emission": 2},
   "geometry": {"type": "LineString", "coordinates": [[1, 1], [2, 1.5]]}}]}
END
printf '1.5 0.5\n3 1\n1 2\n' >"$work/three"
cat >"$work/factors.py" <<'END'
import csv, sys
points, rows = (list(csv.DictReader(open(path, newline=""))) for path in sys.argv[1:])
light = {"a, b": 1, "screen": 2, "sky": 3, "back": 0}
for k, point in enumerate(points):
    own = [row for row in rows if int(row["point"]) == k]
    assert all(row["x"] == point["x"] and row["y"] == point["y"] for row in own) and own
    assert all((row["patch"] == "") == (row["name"] in ("sky", "back")) for row in own)
    share = {row["name"]: float(row["share"]) for row in own}
    assert abs(sum(share.values()) - 1) < 1e-14
    assert abs(sum(share[name] * light[name] for name in share) - float(point["mean"])) < 1e-12
assert {row["name"] for row in rows} == set(light) and rows[0]["patch"] == "0"
END
succeeds field "$work/black.geojson" --points "$work/three" --csv "$work/three.csv" \
  --factors "$work/factors.csv"
has_python() {
  command -v python3 >/dev/null 2>&1
}
! has_python || check "factors of points make the mean" python3 "$work/factors.py" "$work/three.csv" \
  "$work/factors.csv"
sed 3d "$work/factors.csv" >"$work/less.csv"
! has_python || check "one that is missing would be found" \
  sh -c '! python3 "$@" 2>/dev/null' - "$work/factors.py" "$work/three.csv" "$work/less.csv"
succeeds field "$work/black.geojson" --points "$work/three" --factors - --csv-comment --csv "$work/x.csv"
check "on standard output" [ "$(sed -n 2p "$work/out")" = point,x,y,share,patch,name ]
expect 1 "^hr2d: $work/no/x.csv: cannot be written" field "$work/black.geojson" --factors "$work/no/x.csv"
[ ! -c /dev/full ] || expect 1 '^hr2d: /dev/full: cannot be written' field "$work/black.geojson" --factors /dev/full

summary check-field
