#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# One value, and all ways in which the program can be asked for it: the table, --at, JSON, the
# leaves of --csv and the field.  Right values are closed forms and Fourier series.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"

feature() { # feature PROPERTIES COORDINATES
  printf '{"type": "Feature", "properties": {%s},
    "geometry": {"type": "LineString", "coordinates": [%s]}}' "$1" "$2"
}
scene() { # scene FILE MEMBERS FEATURES...
  file=$work/$1
  printf '{"type": "FeatureCollection", "hr2d": {%s}, "features": [' "$2" >"$file"
  shift 2
  printf '%s' "$1" >>"$file"
  shift
  for f in "$@"; do printf ',%s' "$f" >>"$file"; done
  printf ']}' >>"$file"
}
number() { # number EXPRESSION: of the JSON of the last run, as d
  python3 -c 'import json, sys
d = json.load(open(sys.argv[1]))
x = eval(sys.argv[2])
print(*x if isinstance(x, list) else [x], sep="\n")' "$work/json" "$1"
}
# at SCENE PLACE B H RELATIVE ARGUMENTS...: --at in the table and in JSON
at() {
  file=$work/$1 place=$2 b=$3 h=$4 within=$5
  shift 5
  succeeds solve "$file" --at "$place" --json "$work/json" "$@"
  run solve "$file" --at "$place" "$@"
  check "$file: B at $place" near "$(awk '/^at /{print $3}' "$work/out")" "$b" "$within"
  check "$file: H at $place" near "$(awk '/^at /{print $5}' "$work/out")" "$h" "$within"
  if command -v python3 >/dev/null 2>&1; then
    check "$file: B at $place in JSON" near "$(number 'd["at"][0]["value"][0]')" "$b" "$within"
    check "$file: H at $place in JSON" near "$(number 'd["at"][0]["irradiance"][0]')" "$h" "$within"
  fi
}
# leaf SCENE PATCH T COLUMN VALUE RELATIVE ARGUMENTS...: the leaf at T, whose mean it is about
leaf() {
  file=$work/$1 patch=$2 t=$3 column=$4 value=$5 within=$6
  shift 6
  succeeds solve "$file" --csv "$work/csv" "$@"
  is=$(awk -F, -v p="$patch" -v t="$t" -v c="$column" \
    '$2 == p && $3 <= t && t < $4 { print $c }' "$work/csv")
  check "$file: the leaf of $patch at $t: $is for $value" near "$is" "$value" "$within"
}
# means SCENE COLUMN KEY ARGUMENTS...: leaves add up to the averages
means() {
  file=$work/$1 column=$2 key=$3
  shift 3
  succeeds solve "$file" --csv "$work/csv" --json "$work/json" "$@"
  command -v python3 >/dev/null 2>&1 || return 0
  number "[p['$key'][0] for p in d['patches']]" >"$work/averages"
  awk -F, -v c="$column" 'NR > 1 { sum[$1] += ($4 - $3) * $c; last = $1 }
    END { for (k = 0; k <= last; k++) printf "%.17g\n", sum[k] }' "$work/csv" >"$work/means"
  check "$file: means of column $column" sh -c 'paste "$1" "$2" | awk "
    { d = \$1 - \$2; if (d < 0) d = -d; if (d > 1e-12 * (\$1 + 1e-300) + 1e-15) bad = 1 }
    END { exit bad || NR == 0 }"' sh "$work/averages" "$work/means"
}

# ---- solar panels that rise by 30 degrees, 2 long, every 5: ½(1 + cos(30° + ψ)) with the angle
# ψ of the top of the row before, at .15 of the panel
scene panels '"period": [5, 0], "background": 1' \
  "$(feature '"name": "panel", "sides": "both"' '[0, 2], [1.7320508075688774, 3]')" \
  "$(feature '"name": "ground"' '[0, 0], [5, 0]')"
panel() { # panel T
  awk -v t="$1" 'BEGIN {
    b = atan2(1, sqrt(3)); x = t * 2 * cos(b); y = t * 2 * sin(b)
    psi = atan2(1 - y, x + 5 - sqrt(3)); printf "%.15g\n", (1 + cos(b + psi)) / 2 }'
}
right=$(panel 0.15)
check "the closed form" near "$right" 0.862404799 1e-9
for norm in sup average; do
  at panels panel:0.15 0 "$right" 1e-11 --target-error 1e-4 --norm $norm
done
for t in 0.05 0.15 0.185 0.5 0.9; do
  succeeds solve "$work/panels" --csv "$work/csv" --target-error 1e-6 --norm sup
  middle=$(awk -F, -v t=$t '$2 == "panel" && $3 <= t && t < $4 { print ($3 + $4) / 2 }' \
    "$work/csv")
  leaf panels panel "$t" 10 "$(panel "$middle")" 2e-3 --target-error 1e-6 --norm sup
done
# Just off the panel the field has n·Φ = H, for the panel is black.
printf '0.25980762113533157 2.15\n' >"$work/points"
succeeds field "$work/panels" --points "$work/points" --csv - --target-error 1e-4
check "the field on the panel" near \
  "$(awk -F, 'NR == 2 { printf "%.15g", -$5 / 2 + $6 * sqrt(3) / 2 }' "$work/out")" "$right" 1e-11

# ---- a lamp in endless plates, by Fourier series
scene plates '"period": [1, 0]' \
  "$(feature '"name": "lamp", "emission": 1, "reflectance": 0.5' '[0, 0], [0.5, 0]')" \
  "$(feature '"name": "floor", "reflectance": 0.5' '[0.5, 0], [1, 0]')" \
  "$(feature '"name": "ceiling", "reflectance": 0.5' '[1, 0.5], [0, 0.5]')"
at plates ceiling:0.75 0.3673092 0.7346184 2e-6 --target-error 1e-4

# ---- leaves add up to averages, also where polynomials of H are below 0 behind a partition
scene partition '' \
  "$(feature '"name": "floor", "reflectance": 0.5' '[0, 0], [2, 0]')" \
  "$(feature '"name": "lamp", "emission": 1, "reflectance": 0.5' '[2, 0], [2, 1]')" \
  "$(feature '"name": "ceiling"' '[2, 1], [0, 1]')" \
  "$(feature '"name": "left", "reflectance": 0.5' '[0, 1], [0, 0]')" \
  "$(feature '"name": "partition", "reflectance": 0.5, "sides": "both"' '[1, 1], [1, 0.05]')"
means partition 9 average --target-error 1e-5
means partition 10 irradiance --target-error 1e-5
means partition 10 irradiance --eps 0.1

# ---- without a target errors of H are there, and what is not measured is not 0
scene black '' \
  "$(feature '"name": "hot", "emission": 1' '[2, 1], [0, 1]')" \
  "$(feature '"name": "floor"' '[0, 0], [2, 0]')"
succeeds solve "$work/black" --eps 10 --json "$work/json"
run solve "$work/black" --eps 10 --at hot:0.5
check "errors of H" grep -q '^ *of H at points about [1-9]' "$work/out"
run solve "$work/black" --eps 10 --no-error
check "what is not measured" grep -qx 'error     not measured' "$work/out"
check "and no 0 in its place" lacks '0.0e+00, at most' "$work/out"
succeeds field "$work/black" --points "$work/points" --csv -
check "no error of the field without a target" awk -F, 'NR == 2 { exit $8 != "" }' "$work/out"
succeeds field "$work/partition" --grid 5x5 --target-error 1e-3 --csv -
check "an error of the field with one" awk -F, '
  NR == 8 { ok = $4 != "" && $8 > 0 && $8 < 0.1 } END { exit !ok }' "$work/out"
summary "one value"
