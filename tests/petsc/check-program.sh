#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# hr2d-mpi solve has the result of hr2d solve, says what is wrong once, keeps its state, and ends
# within 10 seconds when a rank is killed; the run goes on from its last file.
#
# Environment: HR2D_PROGRAM, the program hr2d.
# shellcheck disable=SC2154 # what ranks.sh sets
. "${HR2D_SRCDIR:=.}/tests/petsc/ranks.sh"
: "${HR2D_PROGRAM:=$HR2D_BUILDDIR/tools/hr2d}"
program=$HR2D_BUILDDIR/hr2d-mpi
scenes=$HR2D_SRCDIR/examples/scenes
room=$scenes/lit-room.geojson

rooms="lit-room solar-panels partition furnace-enclosure"
count=0
for scene in $rooms; do
  count=$((count + 1))
  aside $count ranks 3 "$program" solve "$scenes/$scene.geojson" --quiet --eps 0.1 \
    --json "$work/three$count"
done
count=0
for scene in $rooms; do
  count=$((count + 1))
  "$HR2D_PROGRAM" solve "$scenes/$scene.geojson" --no-error --quiet --eps 0.1 \
    --json "$work/one" 2>"$work/errors"
  finish $count
  check "$scene as hr2d solve: $(cat "$work/errors" "$work/$count.errors")" \
    python3 "$HR2D_SRCDIR/tests/petsc/same-averages.py" "$work/one" "$work/three$count"
done
if python3 -c 'import jsonschema; jsonschema.Draft202012Validator' 2>"$work/errors"; then
  "$HR2D_PROGRAM" schema solve-mpi >"$work/schema"
  check "it is what its schema says" python3 -c 'import json, jsonschema, sys
schema, result = (json.load(open(path)) for path in sys.argv[1:])
validator = jsonschema.Draft202012Validator(schema)
validator.validate(result)
del result["ranks"]["count"]
assert not validator.is_valid(result)' "$work/schema" "$work/three1"
fi
"$HR2D_PROGRAM" solve "$scenes/lit-room.geojson" --no-error --quiet --eps 0.2 --json "$work/one"
check "a difference would be found" \
  eval '! python3 "$HR2D_SRCDIR/tests/petsc/same-averages.py" "$work/one" "$work/three1" 2>"$work/out"'

# ---- targets, orders and what needs all elements: the same bits on any number of ranks
but=
whole() { # whole NAME ARGUMENTS...: compares with hr2d solve, without the counts in $but
  what=$1
  shift
  for n in 1 2 3 4; do
    aside $n ranks $n "$program" solve "$@" --quiet --json "$work/whole$n"
  done
  "$HR2D_PROGRAM" solve "$@" --quiet --json "$work/one" 2>"$work/errors"
  for n in 1 2 3 4; do
    finish $n
  done
  for n in 1 2 3 4; do
    # shellcheck disable=SC2086 # no word or two
    check "$what on $n ranks: $(cat "$work/errors" "$work/$n.errors")" python3 \
      "$HR2D_SRCDIR/tests/petsc/same-averages.py" $but "$work/one" "$work/whole$n" "$work/whole1"
  done
}
whole "lit room to 1e-6" "$scenes/lit-room.geojson" --target-error 1e-6
whole "partition to 1e-3" "$scenes/partition.geojson" --target-error 1e-3
whole "panels at points" "$scenes/solar-panels.geojson" --target-error 1e-2 --norm sup
whole "furnace of order 4" "$scenes/furnace-enclosure.geojson" --order 4 --eps 0.3
whole "partition of order 2" "$scenes/partition.geojson" --order 2 --eps 0.4 --no-closure
whole "brightness" "$scenes/lit-room.geojson" --oracle bf --multigrid 0.5:0.5 --eps 0.1
whole "rounds of brightness" "$scenes/lit-room.geojson" --oracle bf --eps 0.02
# Which visibility tests a further refinement makes depends on the ranks.
but="--but visibility_tests"
whole "rounds behind a screen" "$scenes/screened-room.geojson" --oracle bf --eps 0.05 --no-error
but=
for n in 1 3 4; do
  check "there are 3 rounds on $n ranks" grep -q '"rounds": 3' "$work/whole$n"
done
cat >"$work/heated.geojson" <<'END'
{"type": "FeatureCollection", "hr2d": {"wavelengths": [3, 8]}, "features": [
{"type": "Feature", "properties": {"temperature": 1500, "emissivity": [0.3, 0.5, 0.9]},
 "geometry": {"type": "LineString", "coordinates": [[0, 0], [4, 0]]}},
{"type": "Feature", "properties": {"flux": 0, "emissivity": [0.9, 0.5, 0.2]},
 "geometry": {"type": "LineString", "coordinates": [[4, 0], [4.5, 3]]}},
{"type": "Feature", "properties": {"temperature": 500, "emissivity": [0.1, 0.5, 0.7]},
 "geometry": {"type": "LineString", "coordinates": [[4.5, 3], [0, 3]]}},
{"type": "Feature", "properties": {"flux": -2000, "emissivity": [0.4, 0.8, 0.9]},
 "geometry": {"type": "LineString", "coordinates": [[0, 3], [0, 0]]}},
{"type": "Feature", "properties": {"flux": 300, "emissivity": [0.7, 0.2, 0.4]},
 "geometry": {"type": "LineString", "coordinates": [[2, 1], [2, 2]]}}]}
END
whole "temperatures to 1e-4" "$work/heated.geojson" --target-error 1e-4
whole "temperatures of order 1" "$work/heated.geojson" --eps 0.2 --no-error
# Half of a room with a post, and a row of panels over ground.
cat >"$work/half.geojson" <<'END'
{"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {"sides": "mirror"},
 "geometry": {"type": "LineString", "coordinates": [[0, 0], [0, 3]]}},
{"type": "Feature", "properties": {"reflectance": 0.5},
 "geometry": {"type": "LineString", "coordinates": [[0, 0], [2, 0]]}},
{"type": "Feature", "properties": {"emission": 1, "reflectance": 0.1},
 "geometry": {"type": "LineString", "coordinates": [[2, 0], [2, 3]]}},
{"type": "Feature", "properties": {"reflectance": 0.8},
 "geometry": {"type": "LineString", "coordinates": [[2, 3], [0, 3]]}},
{"type": "Feature", "properties": {"reflectance": 0.6, "sides": "both"},
 "geometry": {"type": "LineString", "coordinates": [[0.7, 0.3], [0.9, 2.1]]}}]}
END
cat >"$work/row.geojson" <<'END'
{"type": "FeatureCollection", "hr2d": {"background": 1, "period": [2, 0]}, "features": [
{"type": "Feature", "properties": {"reflectance": 0.2},
 "geometry": {"type": "LineString", "coordinates": [[0, 0], [2, 0]]}},
{"type": "Feature", "properties": {"reflectance": 0.3, "sides": "both"},
 "geometry": {"type": "LineString", "coordinates": [[0.4, 0.7], [1.4, 1.3]]}}]}
END
# Light that depends on its direction.
cat >"$work/daylight.geojson" <<'END'
{"type": "FeatureCollection", "hr2d": {"background": 0.5, "sky": [[-60, 20, 2]],
 "sun": {"direction": [0.3, -1], "irradiance": 3}}, "features": [
{"type": "Feature", "properties": {"reflectance": 0.2},
 "geometry": {"type": "LineString", "coordinates": [[0, 0], [3, 0]]}},
{"type": "Feature", "properties": {"reflectance": 0.3, "sides": "both"},
 "geometry": {"type": "LineString", "coordinates": [[0.5, 0.5], [1.5, 1]]}}]}
END
whole "sun and sky of order 1" "$work/daylight.geojson" --eps 0.2 --no-error
for symmetric in half row; do
  whole "$symmetric to 1e-3" "$work/$symmetric.geojson" --target-error 1e-3
  whole "$symmetric of order 1" "$work/$symmetric.geojson" --eps 0.2 --no-error
  whole "$symmetric at points" "$work/$symmetric.geojson" --eps 0.3 --order 2 --at 0:0.3
done
ranks 2 "$program" solve "$scenes/lit-room.geojson" --eps 0.2 --no-error --quiet --csv "$work/two.csv"
"$HR2D_PROGRAM" solve "$scenes/lit-room.geojson" --eps 0.2 --no-error --quiet --csv "$work/one.csv"
check "leaves as CSV" [ "$(wc -l <"$work/two.csv")" = "$(wc -l <"$work/one.csv")" ]
ranks 2 "$program" solve "$scenes/partition.geojson" --time-budget 0.5 --json "$work/two" \
  >"$work/out" 2>"$work/errors"
check "a budget of time ends: $(cat "$work/errors")" grep -q '"solve"' "$work/two"

# ---- pictures and films: those of hr2d solve, byte by byte but for the name of the program
without_comment() {
  python3 "$HR2D_SRCDIR/tests/petsc/without-comment.py" "$1" >"$1.plain"
}
draws() { # draws FORMAT ARGUMENTS...
  form=$1
  shift
  for n in 1 3; do
    aside $n ranks $n "$program" solve "$@" "$work/ranks$n.$form" --quiet --no-error
  done
  "$HR2D_PROGRAM" solve "$@" "$work/one.$form" --quiet --no-error
  without_comment "$work/one.$form"
  for n in 1 3; do
    finish $n
    without_comment "$work/ranks$n.$form"
    check "$* on $n ranks: $(cat "$work/$n.errors")" \
      cmp "$work/one.$form.plain" "$work/ranks$n.$form.plain"
    check "it names its program" grep -aq 'hr2d-mpi [0-9.]*: hr2d-mpi solve ' "$work/ranks$n.$form"
  done
}
if "$HR2D_PROGRAM" solve "$room" --eps 1 --quiet --no-error --draw "$work/try.svg" 2>"$work/errors"; then
  draws svg "$room" --eps 0.2 --links-of 1:0.3 --no-fill --draw
  draws svg "$scenes/partition.geojson" --eps 0.3 --order 2 --links-of 2:0.6 --beams-of 1:0.5 --draw
  draws svg "$scenes/par-near.geojson" --eps 0.1 --variant modified --links-of 0:0.4 \
    --link-level 3 --link-parents --no-fill --draw
  draws svg "$scenes/solar-panels.geojson" --target-error 1e-2 --links-of 1:0.5 --arrows --draw
  draws png "$room" --eps 0.2 --watch
  draws svg "$room" --eps 0.2 --tiles
  check "a picture without links differs" eval '! cmp -s "$work/one.svg" "$work/try.svg"'
else
  check "built without cairo: $(cat "$work/errors")" [ -z "${HR2D_NEED_PETSC-}" ]
fi

# ---- an enclosure is that of one process
$HR2D_PROGRAM solve "$room" --eps 0.2 --enclose 0.1 2>/dev/null | grep '^enclosed' >"$work/wanted" || true
ranks 2 "$program" solve "$room" --eps 0.2 --enclose 0.1 2>/dev/null | grep '^enclosed' >"$work/named" || true
check "enclosures do not depend on ranks: $(cat "$work/named")" eval \
  '[ -s "$work/wanted" ] && cmp -s "$work/wanted" "$work/named"'

# ---- one radiosity for each patch, likewise
patches_of() { # the first table
  sed -n '/^patch /,/^$/p' | awk '{ $1 = $1 } 1'
}
$HR2D_PROGRAM solve "$room" --enclosure --no-error 2>/dev/null | patches_of >"$work/wanted" || true
ranks 3 "$program" solve "$room" --enclosure >"$work/enclosure" 2>/dev/null || true
patches_of <"$work/enclosure" >"$work/named"
check "one radiosity for each patch does not depend on ranks" eval \
  '[ -s "$work/wanted" ] && cmp -s "$work/wanted" "$work/named"'
check "and is the method" grep -q '^method    enclosure: one radiosity for each patch$' "$work/enclosure"

# ---- no option of hr2d solve is missing
options_of() { # options_of PROGRAM: the names in its help
  "$1" solve --help | grep -oE -e '--[a-z][a-z-]*' | sort -u
}
options_of "$HR2D_PROGRAM" >"$work/wanted"
options_of "$program" >"$work/named"
check "hr2d-mpi has all options: $(comm -23 "$work/wanted" "$work/named" | tr '\n' ' ')" \
  [ -z "$(comm -23 "$work/wanted" "$work/named")" ]
check "there are some" [ "$(wc -l <"$work/wanted")" -gt 20 ]

# ---- what is wrong is said by one rank
said=0
says() { # says STATUS TEXT ARGUMENTS...: begins it; mpirun adds lines of its own
  said=$((said + 1))
  echo "$1 $2" >"$work/wanted$said"
  shift 2
  aside said$said ranks 2 "$program" "$@"
}
hear() { # all that is to be said
  while [ $said -gt 0 ]; do
    finish said$said
    read -r wanted text <"$work/wanted$said"
    heard=$(cat "$work/said$said.errors")
    check "'$text': status $wanted; was $status: $heard" [ $status -eq "$wanted" ]
    check "'$text' is said once: $heard" \
      [ "$(grep -c -e "^hr2d-mpi: .*$text" "$work/said$said.errors")" = 1 ]
    said=$((said - 1))
  done
}
says 2 "unknown option '--epss'" solve "$room" --epss 1
says 2 "the only command is solve" info "$room"
hear
says 1 "cannot open" solve "$work/nothing"
says 1 "more than 100 links are needed" solve "$room" --max-links 100
says 1 "solve without --state" solve "$work/heated.geojson" --state "$work/state"
says 1 "at most" solve "$room" --target-error 1e-30
hear

# ---- a state, and another scene
state=$work/state
ranks 2 "$program" solve "$room" --quiet --multigrid 0.8:0.5 --eps 0.2 --state "$state"
check "a state is kept" [ -s "$state" ]
ranks 3 "$program" solve "$room" --eps 0.1 --state "$state" --json "$work/on" >"$work/out"
check "a run goes on from it" grep -q "from epsilon 0.2" "$work/out"
"$HR2D_PROGRAM" solve "$room" --no-error --quiet --multigrid 0.2:0.5 --eps 0.1 --json "$work/one"
check "to the result of a run without a stop" \
  python3 "$HR2D_SRCDIR/tests/petsc/same-averages.py" "$work/one" "$work/on"
says 1 "the state is of another scene" solve "$scenes/par-near.geojson" --state "$state"
hear

# ---- states of what needs all elements: written by 2 ranks, the same bits from there on any number
resumes() { # resumes WHAT SCENE FROM MIDDLE ALL ARGUMENTS...: ALL makes the stages of hr2d solve
  title=$1 scene=$2 from=$3 middle=$4 all=$5
  shift 5
  rm -f "$work/stage"
  ranks 2 "$program" solve "$scene" "$@" --no-error --quiet --multigrid "$from" \
    --eps "$middle" --state "$work/stage"
  for n in 1 3 4; do
    cp "$work/stage" "$work/stage$n"
    aside $n ranks $n "$program" solve "$scene" "$@" --no-error --multigrid "$from" --eps 0.1 \
      --state "$work/stage$n" --json "$work/from$n"
  done
  "$HR2D_PROGRAM" solve "$scene" "$@" --no-error --quiet --multigrid "$all" --eps 0.1 \
    --json "$work/one"
  for n in 1 3 4; do
    finish $n
    check "$title goes on on $n ranks" grep -q "from epsilon $middle" "$work/$n"
    check "$title on $n ranks: $(cat "$work/$n.errors")" python3 \
      "$HR2D_SRCDIR/tests/petsc/same-averages.py" "$work/one" "$work/from$n" "$work/from1"
    check "$title: the same state on $n ranks" cmp -s "$work/stage1" "$work/stage$n"
  done
}
resumes "order 3" "$scenes/furnace-enclosure.geojson" 0.8:0.5 0.4 0.4:0.5 --order 3
resumes "bands of order 2" "$room" 0.8:0.5 0.4 0.4:0.5 --order 2
# Without the post, for the sake of visibility tests.
grep -v -e '"both"' -e '0.7, 0.3' "$work/half.geojson" | sed 's/\(\[2, 3\], \[0, 3\]\]}}\),/\1]}/' \
  >"$work/bare.geojson"
resumes "half of order 2" "$work/bare.geojson" 0.8:0.5 0.4 0.4:0.5 --order 2
resumes "half of order 1" "$work/bare.geojson" 0.8:0.5 0.4 0.4:0.5
resumes "brightness" "$room" 0.4:0.5 0.2 0.4:0.5 --oracle bf
# Rounds: the calls that made a state of hr2d solve are not in it.
rm -f "$work/state1" "$work/state2"
"$HR2D_PROGRAM" solve "$room" --oracle bf --eps 0.05 --no-error --quiet --state "$work/state1"
"$HR2D_PROGRAM" solve "$room" --oracle bf --eps 0.02 --no-error --quiet --state "$work/state1" \
  --json "$work/one"
ranks 2 "$program" solve "$room" --oracle bf --eps 0.05 --no-error --quiet --state "$work/state2"
ranks 3 "$program" solve "$room" --oracle bf --eps 0.02 --no-error --quiet --state "$work/state2" \
  --json "$work/three" 2>"$work/errors"
check "rounds go on from the light of other rounds: $(cat "$work/errors")" python3 \
  "$HR2D_SRCDIR/tests/petsc/same-averages.py" \
  --but oracle_calls,facing_tests,visibility_tests,exchange_areas "$work/one" "$work/three"
ranks 3 "$program" solve "$room" --eps 0.1 --order 2 --state "$work/stage1" >"$work/out" 2>&1
check "a state of another oracle is refused" grep -q "of another oracle" "$work/out"
ranks 3 "$program" solve "$room" --eps 0.2 --oracle bf --multigrid 0.4:0.5 \
  --state "$work/stage1" >"$work/out" 2>&1
check "so is a finer one" grep -q "which is finer than --eps 0.2" "$work/out"

# ---- a rank that is killed
plates=$scenes/par-near.geojson
"$MPIEXEC" -n 2 "$program" solve "$plates" --quiet --multigrid 1:0.5 --eps 0.001 \
  --state "$work/killed" >"$work/out" 2>"$work/errors" &
job=$!
waited=0
until [ -s "$work/killed" ] || [ $waited -ge 300 ]; do
  sleep 0.1
  waited=$((waited + 1))
done
victim=$(ps -o pid=,comm= --ppid $job | awk '/hr2d-mpi/ { print $1; exit }')
check "the job runs" [ -n "$victim" ]
begin=$(date +%s)
kill -9 "$victim"
wait $job
status=$?
end=$(date +%s)
check "the job ends; was $status" [ $status -ne 0 ]
check "within 10 seconds; took $((end - begin))" [ $((end - begin)) -le 10 ]
check "with a message: $(cat "$work/errors")" grep -q "signal 9" "$work/errors"
ranks 1 "$program" solve "$plates" --eps 0.1 --state "$work/killed" >"$work/out"
check "and the run goes on from its last file" grep -q "from epsilon" "$work/out"
exit $failed
