#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Footprints of 1,380 houses with the faults of maps, cli/town.awk: what `hr2d info` says leads to a
# solved town, in the steps that its messages name, and no message is there a hundred times.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
town() { # town SEED ROWS HOUSES [FACES]
  awk -v seed="$1" -v rows="$2" -v houses="$3" -v faces="${4-}" -f "$HR2D_SRCDIR/tests/program/cli/town.awk"
}
lines() { grep -c "$1" "$work/err"; }

# ---- step 1: it is refused, and the message has a tolerance for all
town 7 30 46 >"$work/town.geojson"
run info "$work/town.geojson"
check "walls cross" [ "$status" -eq 1 ]
check "the others are counted" grep -q 'cross at .*; [1-9][0-9][0-9] more pairs cross' "$work/err"
check "there are few lines" [ "$(wc -l <"$work/err")" -le 20 ]
check "the rest has a range" \
  grep -q '[0-9] more of "narrow-gap", in all from 0.001 to 0.[0-9]* wide' "$work/err"
check "whose feature has no name is told by its number" \
  [ "$(sed 's/patch [0-9]* (\(feature [0-9]*\|"[^"]*"\))//g' "$work/err" | grep -c 'patch [0-9]')" -eq 0 ]
feature=$(sed -n 's/.*cross at .*and patch [0-9]* (feature \([0-9]*\)) ends.*/\1/p' "$work/err" | head -n 1)
at=$(sed -n 's/.*cross at (\([0-9.]*\), .*/\1/p' "$work/err" | head -n 1)
check "it is the feature with that number" sh -c "grep '\"Feature\"' '$work/town.geojson' |
  sed -n '${feature:-0}p' | tr -c '0-9.' '\n' | awk -v x='$at' '(\$1 - x)^2 < 1e-3 { n = 1 } END { exit !n }'"
snap=$(sed -n 's/.*--snap \([0-9.]*\) repairs or cuts all.*/\1/p' "$work/err")
check "the tolerance is that of the faults, 20 mm" [ "$snap" = 0.03 ]

# ---- step 2: repaired, backs are seen, in one line that knows why
succeeds info "$work/town.geojson" --snap "${snap:-0}" --json "$work/info.json"
check "one warning is left" [ "$(lines warning:)" -eq 1 ]
check "it tells of polygons" grep -q 'the backs of .* and [0-9]* more stand .*"faces": "out"' "$work/err"

# ---- step 3: seen from outside, nothing is left, and it is solved
town 7 30 46 out >"$work/out.geojson"
succeeds info "$work/out.geojson" --snap "${snap:-0}" --strict
check "no warning is left" [ "$(lines warning:)" -eq 0 ]
succeeds solve "$work/out.geojson" --snap "${snap:-0}" --eps 4 --strict --json "$work/town.json"
check "the sky is received" awk '/"received"/ { v = $2 + 0 } /"relative_error"/ { e = $2 + 0 }
  END { exit !(v > 1000 && e < 1e-12) }' "$work/town.json"

# ---- other seeds: the tolerance that is told is enough for what crosses, and that of all faults for all
for seed in 1 2 3 4 5 6; do
  town $seed 4 12 out >"$work/some.geojson"
  run info "$work/some.geojson"
  check "seed $seed is refused" [ "$status" -eq 1 ]
  tolerance=$(sed -n 's/.*--snap \([0-9.]*\)\( lets\| repairs or cuts all\).*/\1/p' "$work/err" | tail -n 1)
  succeeds info "$work/some.geojson" --snap "${tolerance:-0}"
  succeeds solve "$work/some.geojson" --snap 0.03 --eps 1 --strict
done

# ---- closed plates of 1 to 30 mm are no mistake, and one that is drawn twice, just off, is told
plate() { # plate Y TOP
  printf '{ "type": "Feature", "properties": { "faces": "out", "emission": 1 }, "geometry": { "type": "Polygon",
    "coordinates": [[[0, %s], [2, %s], [2, %s], [0, %s], [0, %s]]] } }' "$1" "$1" "$2" "$2" "$1"
}
{
  echo '{ "type": "FeatureCollection", "hr2d": { "background": 1 }, "features": ['
  plate 0 0.001 && echo , && plate 1 1.01 && echo , && plate 2 2.03 && echo ']}'
} >"$work/plates.geojson"
succeeds solve "$work/plates.geojson" --eps 1 --strict
check "plates have no warning" [ "$(lines warning:)" -eq 0 ]
{
  echo '{ "type": "FeatureCollection", "hr2d": { "background": 1 }, "features": ['
  plate 0 0.001 && echo , && plate 0.0015 0.0025 && echo ']}'
} >"$work/twice.geojson"
run info "$work/twice.geojson" --strict
check "a slit between two is told" [ "$status" -eq 1 ]

summary check-town
