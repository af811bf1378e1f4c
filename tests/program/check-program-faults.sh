#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Files that fail, in every way that one can: the program says so in one line that names the
# file and ends with 1, and no output is ever cut short under its name.
#
# Environment: HR2D_PROGRAM, the program; HR2D_BUILDDIR, where it was built, if it is
# libtool's wrapper; HR2D_SCENES, the example scenes; HR2D_SRCDIR, the top of the sources;
# HR2D_TEST_MULTIPLIER, how much of the work to do; HR2D_TEST_SEED.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
scenes=${HR2D_SCENES:-$HR2D_SRCDIR/examples/scenes}
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"

seed=${HR2D_TEST_SEED:-$(date +%s)}
echo "HR2D_TEST_SEED=$seed"
share() { # share N: N by the multiplier, at least 1
  awk -v n="$1" -v m="${HR2D_TEST_MULTIPLIER:-1}" \
    'BEGIN { n = int(n * m); print n < 1 ? 1 : n }'
}

scene=$work/scene.geojson
cp "$scenes/square-room.geojson" "$scene"
# What a run may write; each file is old before it.
new=$work/new
good=$work/good
mkdir "$new" "$good"
make_old() {
  rm -rf "$new"
  mkdir "$new"
  for name in csv json mtx dat i vtp svg png pdf; do echo old >"$new/x.$name"; done
}
# Timing decides how many rows a study or a cost has, but no file of any kind is cut short.
ends_well() {
  case $1 in
  *.csv) awk -F, 'NR == 1 { n = NF } NF != n { bad = 1 } END { exit bad || NR < 1 }' "$1" &&
    [ "$(tail -c 1 "$1" | od -An -tx1 | tr -d ' ')" = 0a ] ;;
  *.mtx) awk '/^%/ { next } !n { n = $3 + 1 } { lines++ } END { exit lines != n }' "$1" &&
    [ "$(tail -c 1 "$1" | od -An -tx1 | tr -d ' ')" = 0a ] ;;
  *.dat) awk 'NF == 1 { if (left) exit bad = 1; left = $1; next } { left-- }
    END { exit bad || left }' "$1" ;;
  *.i) [ "$(tail -n 2 "$1" | tr -d '\n')" = '  [][]' ] ;;
  *.json) [ "$(head -n 1 "$1")$(tail -n 1 "$1")" = '{}' ] ;;
  *.vtp) tail -n 1 "$1" | grep -q '</VTKFile>' ;;
  *.svg) tail -n 2 "$1" | grep -q '</svg>' ;;
  *.pdf) tail -n 1 "$1" | grep -q '%%EOF' ;;
  *.state) cp "$1" "$work/copy.state" && hr2d solve "$scene" --eps 0.25 --max-level 5 --quiet \
    --no-error --state "$work/copy.state" >"$work/taken" 2>&1 ;;
  *.png) tail -c 8 "$1" | grep -q IEND ;;
  *) return 1 ;;
  esac
}
same_shape() { # same_shape FILE FILE: of what has no times in it
  case $1 in
  *x.csv) [ "$(wc -l <"$1")" -eq "$(wc -l <"$2")" ] ;;
  esac
}
is_old() {
  [ "$(head -c 4 "$1" | tr -d '\0')" = old ]
}
whole() { # each file is the old one or a new one, and nothing else is there
  for file in "$new"/* "$new"/.hr2d-*; do
    [ ! -f "$file" ] || is_old "$file" || ends_well "$file" || return 1
    case $command in
    solve | factors) [ ! -f "$file" ] || is_old "$file" || same_shape "$file" "$good/${file##*/}" || return 1 ;;
    esac
  done
}
untouched() {
  for file in "$new"/* "$new"/.hr2d-*; do
    [ ! -f "$file" ] || is_old "$file" || return 1
  done
}
tells() { # tells FILE: exit 1 and one line that names it
  [ "$status" -eq 1 ] && [ "$(wc -l <"$work/err")" -eq 1 ] && grep -q "^hr2d: $1: ." "$work/err"
}
said() {
  echo "was $status, $(head -n 2 "$work/err")"
}

# The commands that write, with everything they can write.
arguments() { # arguments COMMAND
  case $1 in
  solve) echo "solve $scene --eps 0.5 --max-level 5 --no-error --at 0:0.5 --csv $new/x.csv --json $new/x.json --vtk $new/x.vtp --draw $new/x.$format --no-fill --tiles $new/tiles.$format" ;;
  target) echo "solve $scene --target-error 1e-3 --json $new/x.json --csv $new/x.csv" ;;
  stages) echo "solve $scene --multigrid 1:0.5 --eps 0.25 --max-level 5 --no-error --state $new/x.state --csv $new/x.csv" ;;
  study) echo "study $scene --to 0.125 --steps 4 --csv $new/x.csv --json $new/x.json $plot" ;;
  cost) echo "cost $scene --methods size,factors --max-seconds 0.1 --csv $new/x.csv --json $new/x.json $plot" ;;
  factors) echo "factors $scene --csv $new/x.csv --mtx $new/x.mtx --elmer $new/x.dat --moose $new/x.i --json $new/x.json" ;;
  esac
}
undisturbed() { # undisturbed COMMAND: what it should have written
  make_old
  # shellcheck disable=SC2046
  run $(arguments "$1")
  check "$1 works; $(said)" [ "$status" -eq 0 ]
  rm -rf "$good"
  cp -r "$new" "$good"
}
format=svg
plot=
if command -v gnuplot >/dev/null 2>&1; then plot="--plot $new/x.svg"; fi
run solve "$scene" --quiet --draw "$work/probe.svg"
if [ "$status" -ne 0 ]; then
  echo "without pictures: $(cat "$work/err")"
  format=csv
fi

. "$HR2D_SRCDIR/tests/program/cli/faulty-places.sh"
. "$HR2D_SRCDIR/tests/program/cli/faulty-calls.sh"
. "$HR2D_SRCDIR/tests/program/cli/faulty-signals.sh"
summary program-faults
