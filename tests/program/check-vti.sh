#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# `hr2d field --vtk` and `hr2d solve --vtk`: the file has the numbers of the CSV file, as its format
# says, and as VTK reads it (Debian: python3-vtk9, 240 MB with what it needs).  Without python3 this is skipped, without
# VTK the second half, which says so; where CI is set, a missing VTK is a failure.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
if ! command -v python3 >/dev/null 2>&1; then
  echo "no python3: not tested" >&2
  exit 77
fi
# Another python3 may come first in PATH.
python=
for one in ${PYTHON-} python3 /usr/bin/python3; do
  ! "$one" -c 'import vtkmodules.vtkIOXML' 2>/dev/null || python=$one
done
if [ -z "$python" ]; then
  echo "no VTK for python3 (python3-vtk9): .vti files are read by their format alone" >&2
  check "CI has python3-vtk9" [ -z "${CI-}" ]
fi

# A room with an obstacle and a lamp; two bands.
cat >"$work/room.geojson" <<'END'
{"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"reflectance": [0.5, 0.2], "emission": [0, 0]},
   "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]]}},
  {"type": "Feature", "properties": {"faces": "out", "emission": [1, 3]},
   "geometry": {"type": "Polygon", "coordinates": [[[1, 1], [2, 1], [2, 2], [1, 2], [1, 1]]]}}]}
END

# reads_like NAME OPTION...: makes both files, and compares them
reads_like() {
  name=$1
  shift
  succeeds field "$work/room.geojson" --vtk "$work/$name.vti" --csv "$work/$name.csv" "$@"
  check "$name: the format" python3 "$HR2D_SRCDIR/tests/program/vti.py" format \
    "$work/$name.vti" "$work/$name.csv"
  [ -z "$python" ] || check "$name: VTK's reader" \
    "$python" "$HR2D_SRCDIR/tests/program/vti.py" vtk "$work/$name.vti" "$work/$name.csv"
}
reads_like room --grid 23x17 --box=-1,-1,5,4
reads_like row --grid 5x1
reads_like point --grid 1x1 --box 3,1,3,1
reads_like coarse --grid 81x61 --tolerance 0.01
check "points outside are among them" grep -q ',,,,' "$work/room.csv"

# Negative control: another number, and a lost one.
awk -F, -v OFS=, 'NR == 9 { $4 += 1e-9 } { print }' "$work/room.csv" >"$work/other.csv"
awk 'NR != 9' "$work/room.csv" >"$work/short.csv"
for table in other short; do
  check "$table.csv is not the same" sh -c '! python3 "$@" 2>/dev/null' - \
    "$HR2D_SRCDIR/tests/program/vti.py" format "$work/room.vti" "$work/$table.csv"
done

# The walls: leaves as lines.
cat >"$work/hot.geojson" <<'END'
{"type": "FeatureCollection", "hr2d": {"background_temperature": 280}, "features": [
  {"type": "Feature", "properties": {"temperature": 300, "emissivity": 0.5},
   "geometry": {"type": "LineString", "coordinates": [[0, 0], [4, 0]]}},
  {"type": "Feature", "properties": {"flux": 0, "emissivity": 0.8},
   "geometry": {"type": "LineString", "coordinates": [[4, 1], [2, 1.5], [0, 1]]}}]}
END
walls_like() { # walls_like SCENE OPTION...
  name=$1
  shift
  succeeds solve "$work/$name.geojson" --vtk "$work/$name.vtp" --csv "$work/$name.csv" \
    --json "$work/$name.json" "$@"
  set -- "$work/$name.vtp" "$work/$name.csv" "$work/$name.json"
  check "walls of $name: the format" python3 "$HR2D_SRCDIR/tests/program/vtp.py" format "$@"
  [ -z "$python" ] || check "walls of $name: VTK's reader" \
    "$python" "$HR2D_SRCDIR/tests/program/vtp.py" vtk "$@"
}
walls_like room --eps 1 --no-error
walls_like room --target-error 1e-3
walls_like hot --eps 0.5
awk -F, -v OFS=, 'NR == 3 { $9 += 1e-9 } { print }' "$work/hot.csv" >"$work/other.csv"
sed '$d' "$work/hot.csv" >"$work/short.csv"
for table in other short; do
  check "$table.csv is not the same" sh -c '! python3 "$@" 2>/dev/null' - \
    "$HR2D_SRCDIR/tests/program/vtp.py" format "$work/hot.vtp" "$work/$table.csv" "$work/hot.json"
done
expect 1 "^hr2d: $work/no/x.vtp: cannot be written" solve "$work/hot.geojson" --vtk "$work/no/x.vtp"

summary check-vti
