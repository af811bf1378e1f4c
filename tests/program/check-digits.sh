#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Orders, target errors, budgets and `hr2d cost`: what is promised against values that
# this project did not compute, tests/data/reference.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SCENES, the example scenes;
# HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
scenes=${HR2D_SCENES:-$HR2D_SRCDIR/examples/scenes}
data=$HR2D_SRCDIR/tests/program/cli
reference=$HR2D_SRCDIR/tests/data/reference/radiosity_fine.csv
. "$data/expect.sh"

narrow=$scenes/par-near.geojson
far=$scenes/par-far.geojson

# ---- what contradicts itself
for option in "--oracle l1" "--eps 0.1" "--variant original" "--multigrid 1:0.5" "--order 2" \
  "--max-level 9" --no-closure; do
  for target in "--target-error 1e-3" "--time-budget 1"; do
    # shellcheck disable=SC2086
    usage "${target% *} and ${option%% *} exclude each other" solve "$far" $option $target
  done
done
usage "--norm needs --target-error or --time-budget" solve "$far" --norm sup
usage "--importance needs --target-error or --time-budget" solve "$far" --importance top
usage "--importance .* excludes --norm sup" solve "$far" --target-error 1e-3 --importance top \
  --norm sup
usage "--error and --no-error exclude each other" solve "$far" --error --no-error
usage "--order: '0' is not a whole number from 1 to 32" solve "$far" --order 0
usage "--order: '33' is not" solve "$far" --order 33
usage "--target-error: '0' is not a number greater than 0" solve "$far" --target-error 0
usage "--target-error: 'nan' is not" solve "$far" --target-error nan
usage "--time-budget: '-1' is not" solve "$far" --time-budget -1
usage "--norm: 'max' is neither average nor sup" solve "$far" --target-error 1e-3 --norm max
usage "--importance: the name is empty" solve "$far" --target-error 1e-3 --importance ''
usage "--importance: the scene has no patch called 'foo'" solve "$far" --target-error 1e-3 \
  --importance foo
usage "--importance: the scene has no patch 2, only 0 to 1" solve "$far" --target-error 1e-3 \
  --importance 2
usage "'study' has no option --order" study "$far" --order 2
usage "'cost' has no option --oracle" cost "$far" --oracle size
usage "'solve' has no option --predict" solve "$far" --predict
usage "'cost' needs a SCENE file" cost
usage "--methods: 'sized' is none of size, size2, .*, factors" cost "$far" --methods auto,sized
usage "--methods: '' is none of" cost "$far" --methods auto,
usage "--against: 'time' does not list some of seconds, links, bytes" cost "$far" --against time
usage "--against: 'links,links' does not list" cost "$far" --against links,links
usage "--against needs --plot" cost "$far" --against links
usage "--max-seconds: '0' is not" cost "$far" --max-seconds 0
for option in "--csv $work/x.csv" "--plot $work/x.svg" "--methods size" "--max-seconds 1" \
  "--max-level 3"; do
  # shellcheck disable=SC2086
  usage "--predict and ${option%% *} exclude each other" cost "$far" --predict $option
done

# ---- errors: true_error SCENE JSON has the largest of the averages, relative
true_error() {
  awk -F, -v scene="$1" '
    NR == FNR { if ($1 == scene) exact[$2] = $3; next }
    index($0, "\"name\": ") { split($0, part, "\""); name = part[4] }
    index($0, "\"average\": [") { getline; d = $1 / exact[name] - 1; if (d < 0) d = -d
                                  if (d > worst) worst = d; n++ }
    END { if (!n) worst = 1; printf "%.12e\n", worst }' "$reference" "$2"
}
value() { # value KEY JSON: the first one
  grep -o "\"$1\": [^,]*" "$2" | head -n 1 | cut -d' ' -f2
}
at_most() { # at_most VALUE BOUND, up to what the reference is trusted for
  awk -v x="$1" -v e="$2" 'BEGIN { exit !(x == x + 0 && e == e + 0 && x <= e + 2e-14) }'
}
between() { # between VALUE LOW HIGH
  awk -v x="$1" -v lo="$2" -v hi="$3" 'BEGIN { exit !(x == x + 0 && x >= lo && x <= hi) }'
}

# Of each solution the bound holds and the estimate is near.
measured() { # measured NAME SCENE ARGUMENTS...
  name=$1
  shift
  succeeds solve "$@" --quiet --json "$work/m.json"
  true=$(true_error "$name" "$work/m.json")
  check "the bound of $*: $true, at most $(value bound "$work/m.json")" \
    at_most "$true" "$(value bound "$work/m.json")"
  check "the estimate of $*: $true, about $(value estimate "$work/m.json")" \
    at_most "$true" "$(awk -v e="$(value estimate "$work/m.json")" 'BEGIN { print 1.5 * e }')"
  check "no more than twice" at_most "$(value estimate "$work/m.json")" \
    "$(awk -v e="$true" 'BEGIN { print 2 * e }')"
}
for pair in "par_d0.1_rho0.5 $narrow" "square_rho0.9 $scenes/square-room.geojson" \
  "occ_square_walls0.5_occ0.5 $scenes/screened-room.geojson"; do
  # shellcheck disable=SC2086
  for oracle in size size2 bf l1; do
    measured $pair --oracle $oracle --eps 0.1
  done
  # shellcheck disable=SC2086
  measured $pair --order 3 --eps 0.5
done
hr2d solve "$narrow" --quiet --eps 0.5 --json "$work/m.json"
check "the paper's algorithm is not that good by chance" \
  between "$(true_error par_d0.1_rho0.5 "$work/m.json")" 1e-5 1
hr2d solve "$narrow" --quiet --eps 0.5 --order 8 --json "$work/m.json"
check "but its links are at order 8" \
  small "$(true_error par_d0.1_rho0.5 "$work/m.json")" 1e-11
check "the order is told" grep -q '^  "order": 8,$' "$work/m.json"
check "coefficients have a time" grep -q '^    "coefficients": [0-9]' "$work/m.json"
check "kernels are counted" between "$(value kernels "$work/m.json")" 1000 1e7

# ---- targets
reaches() { # reaches NAME SCENE TARGET
  succeeds solve "$2" --target-error "$3" --quiet --json "$work/t.json"
  true=$(true_error "$1" "$work/t.json")
  check "target $3 of $1: $true" at_most "$true" "$3"
  check "its bound: $(value bound "$work/t.json")" \
    at_most "$true" "$(value bound "$work/t.json")"
  check "its estimate" at_most "$(value estimate "$work/t.json")" "$3"
}
for target in 1e-1 1e-3 1e-6 1e-9 1e-12; do
  reaches par_d0.1_rho0.5 "$narrow" $target
  reaches par_d1_rho0.5 "$far" $target
  reaches square_rho0.9 "$scenes/square-room.geojson" $target
  reaches orth_touch_rho0.7 "$scenes/corner.geojson" $target
  reaches occ_square_walls0.5_occ0.5 "$scenes/screened-room.geojson" $target
done

succeeds solve "$scenes/furnace-enclosure.geojson" --target-error 1e-12 --quiet --json "$work/t.json"
check "an enclosure, to its bound" awk -v e="$(value bound "$work/t.json")" '
  index($0, "\"average\": [") { getline; d = $1 - 1; if (d < 0) d = -d; if (d > e) bad = 1; n++ }
  END { exit bad || n != 4 || e > 1e-12 }' "$work/t.json"

# ---- errors at points are measured for values at points
succeeds solve "$narrow" --target-error 1e-9 --json "$work/t.json"
for key in sup_estimate sup_bound; do
  check "averages alone: $key" grep -q "^    \"$key\": null" "$work/t.json"
  check "nor of H: $key" grep -q "^      \"$key\": null" "$work/t.json"
done
check "no line about points" lacks 'at points' "$work/out"
check "but the error of averages" grep -q '^error     of averages about [0-9]' "$work/out"
succeeds solve "$narrow" --target-error 1e-9 --csv "$work/t.csv"
check "rows of leaves have errors at points" grep -q '^ *of H at points about [0-9]' "$work/out"
succeeds solve "$narrow" --eps 0.3
check "nor has another solution any" lacks 'at points' "$work/out"

# ---- the JSON of a target
succeeds solve "$narrow" --target-error 1e-9 --at 0:0.5 --json "$work/t.json"
for key in scene patches at elements leaves links limited_links levels order epsilon oracle \
  variant effects work seconds peak_bytes error status target; do
  check "a target has the key $key" grep -q "^  \"$key\": " "$work/t.json"
done
for key in refine coefficients solve error total estimate bound sup_estimate sup_bound kernels \
  oracle_calls visibility_tests exchange_areas sweeps; do
  check "a target has the inner key $key" grep -q "^    \"$key\": [0-9]" "$work/t.json"
done
for key in estimate bound sup_estimate sup_bound; do
  check "the error of H has the key $key" grep -q "^      \"$key\": [0-9]" "$work/t.json"
done
check "no epsilon" grep -q '^  "epsilon": null,$' "$work/t.json"
check "the oracle of a target" grep -q '^  "oracle": "separation",$' "$work/t.json"
check "no variant" grep -q '^  "variant": null,$' "$work/t.json"
check "all patches count" grep -q '^    "importance": null,$' "$work/t.json"
check "status ok" grep -q '^  "status": "ok"$' "$work/t.json"
for line in '^target    error 1e-09 in averages$' '^order     p = [0-9]*$' \
  '^error     of averages about [0-9.e-]*, at most [0-9.e-]*$' \
  '^          at points about [0-9.e-]*, at most [0-9.e-]*$' \
  '^          of averages of H about [0-9.e-]*, at most [0-9.e-]*$' \
  '^          of H at points about [0-9.e-]*, at most [0-9.e-]*$' \
  '^seconds   refine [0-9.]*, coefficients [0-9.]*, solve [0-9.]*, error [0-9.]*, total '; do
  check "the table has a line $line" grep -q -e "$line" "$work/out"
done
if command -v python3 >/dev/null 2>&1; then
  check "JSON is JSON" python3 -m json.tool "$work/t.json" /dev/null
fi

# ---- patches that matter, and the floor
listed() { # listed KEY FILE: the numbers of a list of the target, in one line
  awk -v key="\"$1\": [" 'index($0, key) { on = 1; next } on && /]/ { exit } on { gsub(/[ ,]/, ""); printf "%s ", $0 }' "$2"
}
succeeds solve "$narrow" --target-error 1e-6 --importance top --json "$work/t.json"
check "the patch that matters" [ "$(listed importance "$work/t.json")" = "1 " ]
check "it is told" grep -q '^target    error 1e-06 in averages of top$' "$work/out"
check "the default floor" near "$(value floor "$work/t.json")" 1e-6 1e-20
succeeds solve "$scenes/square-room.geojson" --target-error 1e-6 --importance left --importance 0 \
  --importance=left --floor 0.25 --json "$work/t.json"
check "the patches that matter" [ "$(listed importance "$work/t.json")" = "3 0 3 " ]
check "they are told" grep -q '^target    error 1e-06 in averages of left, 0, left$' "$work/out"
check "the floor" near "$(value floor "$work/t.json")" 0.25 0
for number in 0 -1 1.5 x nan ''; do
  usage "--floor: '$number' is not a number greater than 0 and at most 1" \
    solve "$narrow" --target-error 1e-3 --floor "$number"
done
# With a floor of 1 errors are relative to the brightest average, also those that are measured.
estimate() { # estimate FLOOR: of a solve whose darker patches are worse
  hr2d solve "$scenes/screened-room.geojson" --eps 0.5 --error --floor "$1" --quiet --json "$work/t.json" &&
    value estimate "$work/t.json"
}
check "a floor counts without a target, too" awk -v low="$(estimate 1e-6)" \
  -v high="$(estimate 1)" 'BEGIN { exit !(high > 0 && high < 0.9 * low) }'

# ---- points, in the largest norm
point() { # point PATCH:T VALUE: what the table says
  check "$1 to 1e-9" near \
    "$(grep "^at $1 " "$work/out" | awk '{ print $3 }')" "$2" "$3"
}
succeeds solve "$narrow" --target-error 1e-9 --norm sup --at bottom:0.25 --at top:0.5
point bottom:0.25 1.28925868287759 1e-9
point top:0.5 0.63991996880632773 2e-9
# Relative to the largest B, 1.2.
succeeds solve "$scenes/screened-room.geojson" --target-error 1e-6 --norm sup --at right:0.25 \
  --at occ_top:0.5
point right:0.25 0.30787810845673647 3.9e-6
point occ_top:0.5 0.078004325768524244 1.5e-5
# B = E + ρH with ρ = 1/2
check "H belongs to B" near \
  "$(grep '^at right' "$work/out" | awk '{ print $5 }')" 0.61575621691347294 3.9e-6
succeeds solve "$scenes/square-room.geojson" --order 6 --eps 0.5 --max-level 12 --at left:0.25
point left:0.25 2.2160343782474614 1e-6

# ---- a target that is out of reach is told, and everything is written
expect 1 "^hr2d: $narrow: .*; the error is about [0-9.e-]*, at most [0-9.e-]*\$" \
  solve "$narrow" --target-error 1e-18 --json "$work/t.json" --csv "$work/t.csv"
check "its status" grep -q '^  "status": "inaccurate"$' "$work/t.json"
check "its reason" grep -q '^    "reason": "..*"$' "$work/t.json"
check "its averages" small "$(true_error par_d0.1_rho0.5 "$work/t.json")" 2e-14
check "its leaves" [ "$(wc -l <"$work/t.csv")" -gt 4 ]
expect 1 "^hr2d: $narrow: .*links" solve "$narrow" --target-error 1e-12 --max-links 4

# ---- budgets
succeeds solve "$scenes/square-room.geojson" --time-budget 2 --json "$work/t.json"
check "a budget is worth digits" small "$(true_error square_rho0.9 "$work/t.json")" 1e-9
check "the budget is told" grep -q '^target    best within 2 seconds$' "$work/out"
check "the budget is kept: $(value total "$work/t.json")" small "$(value total "$work/t.json")" 4
awk 'BEGIN {
  print "{\"type\": \"GeometryCollection\", \"geometries\": ["
  for (k = 0; k < 5000; k++)
    printf "%s{\"type\": \"LineString\", \"coordinates\": [[%d, 0], [%d, 1]]}\n", k ? "," : "", k, k
  print "]}"
}' >"$work/many.geojson"
run solve "$work/many.geojson" --time-budget 1e-6
check "a budget of time includes the reading of the scene" \
  matches 1 'the time does not suffice to read the scene$'
# To look for warnings takes several times as long as to check a fan of walls, so that one of the
# doubled budgets ends in between.
awk 'BEGIN {
  print "{\"type\": \"FeatureCollection\", \"hr2d\": {\"background\": 1}, \"features\": ["
  for (k = 0; k < 2000; k++) {
    c = cos(0.00314 * (k + 0.3)); s = sin(0.00314 * (k + 0.3))
    printf "%s{\"type\": \"Feature\", \"properties\": {\"sides\": \"both\"}, \"geometry\":", k ? "," : ""
    printf "{\"type\": \"LineString\", \"coordinates\": [[%.9f, %.9f], [%.9f, %.9f]]}}\n", c, s, 8 * c, 8 * s
  }
  print "]}"
}' >"$work/fan.geojson"
late='the time does not suffice to look for all warnings'
for budget in 0.1 0.2 0.4 0.8 1.6 3.2 6.4 12.8; do
  run solve "$work/fan.geojson" --time-budget $budget --json "$work/t.json"
  grep -q "$late" "$work/err" && break
done
check "warnings that were not looked for are told" grep -q "^hr2d: .*: $late" "$work/err"
check "also in JSON" grep -q '"code": "unfinished"' "$work/t.json"
run solve "$scenes/partition.geojson" --target-error 1e-14 --time-budget 0.5 --json "$work/t.json" --quiet
check "a budget of half a second: $(value total "$work/t.json")" \
  small "$(value total "$work/t.json")" 2

# ---- lower and upper ends
succeeds solve "$scenes/partition.geojson" --target-error 1e-3 --enclose 0.1 --json "$work/t.json"
check "the error for certain" grep -q \
  '^enclosed  error of averages at most [0-9.e-]*, of H [0-9.e-]*, for certain$' "$work/out"
check "the gap" awk -v gap="$(value gap "$work/t.json")" 'BEGIN { exit !(gap > 0 && gap <= 0.1) }'
hr2d solve "$scenes/partition.geojson" --target-error 1e-3 --enclose 1e-9 --max-links 3000 \
  >"$work/out" 2>"$work/err" && status=0 || status=$?
check "a gap that is not reached" [ "$status" -eq 1 ]
check "it is told" grep -q 'enclose: [0-9]* links leave a gap of' "$work/err"
check "what was reached is told" grep -q '^enclosed  error of averages' "$work/out"
echo '{"type": "FeatureCollection", "hr2d": {"background": 1}, "features": [{"type": "Feature",
  "properties": {"reflectance": 0.5}, "geometry": {"type": "LineString",
  "coordinates": [[0, 0], [2, 0], [1, 1], [0, 0]]}}]}' >"$work/shut.geojson"
hr2d solve "$work/shut.geojson" --target-error 1e-2 --enclose 1e-2 --max-links 500 \
  >"$work/out" 2>"$work/err" || true
check "what is not known is no number" grep -q '^enclosed  error of averages unknown' "$work/out"
usage "--enclose: '0' is not a number greater than 0" solve "$narrow" --enclose 0

# ---- errors that are not measured
succeeds solve "$narrow" --no-error --json "$work/t.json"
check "no error is told" grep -q '^error     not measured$' "$work/out"
for key in estimate bound sup_estimate sup_bound; do
  check "no error: $key" grep -q "^    \"$key\": null" "$work/t.json"
  check "nor of H: $key" grep -q "^      \"$key\": null" "$work/t.json"
done
succeeds solve "$scenes/square-room.geojson" --target-error 1e-8 --no-error --json "$work/t.json"
check "no error of a target is told" grep -q '^error     not measured$' "$work/out"
check "and none in the file" grep -q '^    "bound": null' "$work/t.json"
check "but digits" small "$(true_error square_rho0.9 "$work/t.json")" 1e-8
unmeasured=$(value kernels "$work/t.json")
succeeds solve "$scenes/square-room.geojson" --target-error 1e-8 --json "$work/t.json"
check "the error costs more kernels than $unmeasured" [ "$(value kernels "$work/t.json")" -gt \
  "$unmeasured" ]
succeeds solve "$scenes/occluders-200.geojson" --eps 1 --json "$work/t.json"
check "nor of 406 patches" grep -q '^    "bound": null' "$work/t.json"

# ---- threads leave no trace
hr2d solve "$scenes/screened-room.geojson" --target-error 1e-9 --threads 1 --csv "$work/one.csv" --quiet
hr2d solve "$scenes/screened-room.geojson" --target-error 1e-9 --threads 3 --csv "$work/three.csv" --quiet
check "one target, any threads" cmp -s "$work/one.csv" "$work/three.csv"
hr2d solve "$narrow" --order 5 --eps 0.3 --threads 1 --csv "$work/one.csv" --quiet
hr2d solve "$narrow" --order 5 --eps 0.3 --threads 3 --csv "$work/three.csv" --quiet
check "one order, any threads" cmp -s "$work/one.csv" "$work/three.csv"

# ---- coefficients of leaves: a smooth B goes on across them
succeeds solve "$narrow" --order 8 --eps 0.5 --csv -
check "the header has coefficients" [ "$(head -n 1 "$work/out")" = \
  "patch,name,t0,t1,ax,ay,bx,by,B0,H0,B0c1,B0c2,B0c3,B0c4,B0c5,B0c6,B0c7,Q0" ]
goes_on() {
  awk -F, 'NR > 1 { start = end = $9; sign = -1
             for (k = 11; k < NF; k++) { end += $k; start += sign * $k; sign = -sign }
             if (NR > 2 && $1 == patch) { d = start - last; if (d < 0) d = -d
                                          if (d > 1e-6) bad = 1; n++ }
             mean[$1] += ($4 - $3) * $9; last = end; patch = $1 }
           END { d = mean[0] - 1.2652309653332332; exit bad || n < 20 || d > 1e-11 || d < -1e-11 }' "$1"
}
check "polynomials meet at their ends" goes_on "$work/out"
succeeds solve "$scenes/furnace-enclosure.geojson" --order 12 --eps 1 --csv "$work/f.csv"
check "B = 1 in an enclosure, all along" awk -F, 'NR > 1 { for (k = 9; k < NF; k++) {
  d = $k - (k < 11); if (d > 1e-12 || d < -1e-12) bad = 1 } } END { exit bad || NR < 5 }' "$work/f.csv"
succeeds solve "$scenes/lit-room.geojson" --order 2 --eps 1 --csv -
check "coefficients of three bands" [ "$(head -n 1 "$work/out" | cut -d, -f9-)" = \
  "B0,B1,B2,H0,H1,H2,B0c1,B1c1,B2c1,Q0,Q1,Q2" ]
succeeds solve "$narrow" --order 4 --eps 0.3 --multigrid 1:0.5 --csv "$work/many.csv"
succeeds solve "$narrow" --order 4 --eps 0.3 --csv "$work/once.csv"
check "multigridding ends with the same leaves" \
  [ "$(cut -d, -f1-4 "$work/many.csv" | cksum)" = "$(cut -d, -f1-4 "$work/once.csv" | cksum)" ]

# ---- pictures follow the polynomials
run solve "$narrow" --order 6 --eps 1 --quiet --draw "$work/order.svg" --links-of top:0.3
if [ "$status" -eq 0 ]; then
  check "gradients" grep -q 'linearGradient' "$work/order.svg"
  succeeds solve "$scenes/screened-room.geojson" --target-error 1e-6 --quiet \
    --draw "$work/target.svg" --links-of right:0.9 --link-level 1
  check "a picture of a target" grep -q '</svg>' "$work/target.svg"
else
  check "no picture for want of cairo only" grep -q 'without cairo' "$work/err"
fi

# ---- what accuracy costs
succeeds cost "$narrow" --predict --json "$work/p.json"
check "predictions" grep -q '^predicted  1e-03: about .*s, .* 1e-12: about .*s$' "$work/out"
check "their table" [ "$(grep -c '^  1e-[01][0-9] .* to [0-9]' "$work/out")" -eq 4 ]
check "their JSON" [ "$(grep -c '"target": [0-9]' "$work/p.json")" -eq 4 ]
check "and no rows" grep -q '^  "rows": \[\]' "$work/p.json"
succeeds cost "$narrow" --methods size,order-4,auto,factors --max-seconds 6 --csv "$work/c.csv" \
  --json "$work/c.json" --quiet
check "quiet cost" [ ! -s "$work/out" ]
check "CSV of costs" [ "$(head -n 1 "$work/c.csv")" = \
  "method,parameter,order,elements,links,bytes,seconds,error,variant,closure" ]
check "methods with links have a variant and a closure" awk -F, 'NR > 1 && \
  ($9 != "") + ($10 != "") != ($1 ~ /^(auto|factors)$/ ? 0 : 2) { bad = 1 } END { exit bad }' "$work/c.csv"
for key in scene threads predictions reference rows fits status; do
  check "cost has the key $key" grep -q "^  \"$key\": " "$work/c.json"
done
row() { # row METHOD PARAMETER COLUMN
  awk -F, -v m="$1" -v p="$2" -v c="$3" '$1 == m && $2 == p { print $c }' "$work/c.csv"
}
# tests/data/reference/counts_maxAr_pow2.csv
check "N of size" [ "$(row size 0.0625 4)" = 1022 ]
check "L of size" [ "$(row size 0.0625 5)" = 15244 ]
hr2d solve "$narrow" --quiet --eps 0.0625 --json "$work/m.json"
check "the error of size" near "$(row size 0.0625 8)" \
  "$(true_error par_d0.1_rho0.5 "$work/m.json")" 1e-3
check "targets are reached" awk -F, '$1 == "auto" { n++; if ($8 > $2 && $8 > 2e-14) bad = 1 }
  END { exit bad || n < 10 }' "$work/c.csv"
# F of two parallel patches 0.1 apart by crossed strings, √1.01 − 0.1; B = E + ρF(…) of each
check "the first row of equal pieces is two patches" [ "$(row factors 1 4)" = 2 ]
awk 'BEGIN { f = sqrt(1.01) - 0.1; b = 1 / (1 - f * f / 4); t = f / 2 * b
             x = b / 1.2652309653332332 - 1; y = t / 0.57547950195007069 - 1
             if (x < 0) x = -x; if (y < 0) y = -y; printf "%.12e\n", (x > y) ? x : y }' >"$work/two"
check "and has their error" near "$(row factors 1 8)" "$(cat "$work/two")" 1e-4
slope() {
  awk -v m="\"method\": \"$1\"" 'index($0, m) && /,$/ { found = 1 }
    found && /links_slope/ { gsub(/[^-0-9.e]/, "", $2); print $2; exit }' "$work/fits"
}
sed -n '/"fits"/,$p' "$work/c.json" >"$work/fits"
# Constant elements: the error falls like the square of their size, links as its inverse.
check "links of size: $(slope size)" between "$(slope size)" 0.9 1.1
check "factors of equal pieces: $(slope factors)" between "$(slope factors)" 0.9 1.1
check "links of order 4: $(slope order-4)" between "$(slope order-4)" 0.1 0.4
# Exponents, with the interval of Student's t by the textbook's formulas; the normal distribution
# would make it 1.96 standard errors.
succeeds cost "$far" --exponents --max-level 5 --csv "$work/c.csv" --json "$work/c.json"
kinds='(size|size2|bf|l1|bounds) +(original|modified) +[124] +(on|off) '
check "60 variants" [ "$(grep -cE "^$kinds" "$work/out")" = 60 ]
check "size2 is size with the square of epsilon" [ \
  "$(awk -F, '$1 == "size" { print $3, $4, $5, $8, $9, $10 }' "$work/c.csv" | cksum)" = \
  "$(awk -F, '$1 == "size2" { print $3, $4, $5, $8, $9, $10 }' "$work/c.csv" | cksum)" ]
awk -F, '$1 == "size" && $3 == 2 && $9 == "original" && $10 == "on" && $8 < 1 {
    x[n] = -log($8) / log(10); y[n] = log($5) / log(10)
    if (!n || x[n] < min) min = x[n]; if (!n || x[n] > max) max = x[n]; n++ }
  END { split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262 2.228 2.201 2.179", t, " ")
    for (k = 0; k < n; k++) if (x[k] >= (min + max) / 2) { m++; sx += x[k]; sy += y[k] }
    sx /= m; sy /= m
    for (k = 0; k < n; k++) if (x[k] >= (min + max) / 2) {
      xx += (x[k] - sx) ^ 2; xy += (x[k] - sx) * (y[k] - sy); yy += (y[k] - sy) ^ 2 }
    error = sqrt((yy - xy * xy / xx) / (m - 2) / xx)
    printf "slope=%.12e range=%.12e normal=%.12e\n", xy / xx, t[m - 2] * error, 1.96 * error
  }' "$work/c.csv" >"$work/line"
fitted() { # fitted KEY: of size, original, closure on, order 2
  sed -n '/"fits"/,$p' "$work/c.json" | tr -d ' \n' | tr '}' '\n' |
    grep '"method":"size","variant":"original","closure":"on","order":2,' |
    sed "s/.*\"$1\":\([-0-9.e]*\).*/\1/"
}
eval "$(cat "$work/line")"
# shellcheck disable=SC2154 # what the line sets
check "an exponent by the textbook: $(cat "$work/line")" near "$(fitted links_slope)" "$slope" 1e-9
# shellcheck disable=SC2154
check "its interval: $(fitted links_range)" near "$(fitted links_range)" "$range" 1e-3
# shellcheck disable=SC2154
check "which is not the normal one" eval '! near "$(fitted links_range)" "$normal" 1e-3'
check "order 2: the root of the links" between "$(fitted links_slope)" 0.4 0.6
for option in "--plot $work/x.svg" "--methods size" "--max-seconds 1" --no-closure --predict; do
  # shellcheck disable=SC2086
  usage "--exponents and ${option%% *} exclude each other" cost "$far" --exponents $option
done
succeeds cost "$scenes/screened-room.geojson" --methods order-2,auto-solve,multigrid --max-seconds 2
check "a table" [ "$(grep -c '^order-2 \|^auto-solve \|^multigrid ' "$work/out")" -gt 15 ]
check "its reference" grep -q '^reference  error at most [0-9.e-]*: p = ' "$work/out"
# A floor of ρ = 1/2 under a background of 2 has B = 1 at once.
cat >"$work/floor.geojson" <<END
{"type": "FeatureCollection", "hr2d": {"background": 2}, "features": [{"type": "Feature",
 "properties": {"reflectance": 0.5}, "geometry": {"type": "LineString",
 "coordinates": [[0, 0], [1, 0]]}}]}
END
succeeds cost "$work/floor.geojson" --methods factors --max-seconds 1 --csv "$work/c.csv" --quiet
check "a background is a box" awk -F, 'NR > 1 { n++; if ($8 > 1e-13) bad = 1 }
  END { exit bad || n < 5 }' "$work/c.csv"
# The panels reflect nothing, and what the floor receives is exact.
succeeds cost "$scenes/solar-panels.geojson" --methods factors --max-seconds 1 \
  --csv "$work/c.csv" --quiet
check "also past other patches" awk -F, 'NR > 1 { n++; if ($8 > 1e-12) bad = 1 }
  END { exit bad || n < 5 }' "$work/c.csv"
# Mirrors and the ends of a period are no sides of the box: of a quarter, at an oblique mirror, of
# streets, between two mirrors.
line() { # line PROPERTIES COORDINATES
  echo '{"type": "Feature", "properties": {'"$1"'}, "geometry": {"type": "LineString",
    "coordinates": ['"$2"']}}'
}
cell() { # cell "HR2D" FEATURE...: a scene under a background
  echo '{"type": "FeatureCollection", "hr2d": {"background": 1'"$1"'}, "features": ['
  shift
  (IFS=,; echo "$*]}")
}
mirror='"sides": "mirror"'
grey='"reflectance": 0.5'
cell "" "$(line "$mirror" "[0, 0], [0, 3]")" "$(line "$mirror" "[0, 3], [3, 3]")" \
  "$(line "$grey" "[0, 0], [2, 0]")" "$(line "$grey" "[2, 0], [2, 2]")" >"$work/quarter.geojson"
cell "" "$(line "$mirror" "[0, 0], [1, 1]")" "$(line "$grey" "[1, 0], [3, 0]")" \
  "$(line "$grey" "[3, 0.5], [4, 2]")" >"$work/oblique.geojson"
cell ', "period": [20, 0]' "$(line "$grey" "[0, 0], [12, 0]")" \
  "$(line "$grey" "[12, 0], [12, 9], [20, 9], [20, 0]")" >"$work/street.geojson"
cell "" "$(line "$mirror" "[0, 0], [0, 3]")" "$(line "$mirror" "[3, 0], [3, 3]")" \
  "$(line "$grey" "[0, 0], [3, 0]")" "$(line "$grey" "[1, 0.5], [2, 1.5]")" >"$work/between.geojson"
for scene in quarter oblique street between; do
  succeeds cost "$work/$scene.geojson" --methods factors --max-seconds 3 --csv "$work/c.csv" --quiet
  check "the box of $scene: $(cat "$work/c.csv")" awk -F, 'NR > 1 { n++; if ($8 > $2 * $2 / 4) bad = 1 }
    END { exit bad || n < 3 }' "$work/c.csv"
done
sed 's/{"background": 2}/{"background": 2, "sun": {"bearing": 30, "irradiance": 1}}/' \
  "$work/floor.geojson" >"$work/sun.geojson"
expect 1 "^hr2d: .*: factors: equal pieces do not know sun and sky\$" \
  cost "$work/sun.geojson" --methods factors,size --max-seconds 1
check "the other method has its rows" grep -q '^size ' "$work/out"
# Of the two methods one is ready after hundredths of a second, the other after many seconds.
succeeds cost "$scenes/occluders-200.geojson" --methods size,l1-grid --max-seconds 1
check "the method in time has rows" grep -q '^size  *16 ' "$work/out"
check "the method without a row is told" grep -q \
  '^hr2d: .*: l1-grid has no row: its share of the time, 0.5 s, .*--max-seconds$' "$work/err"
if command -v gnuplot >/dev/null 2>&1; then
  for against in seconds links,seconds,bytes; do
    succeeds cost "$far" --methods size,auto,factors --max-seconds 1 --quiet --against $against \
      --plot "$work/cost.svg"
    check "a plot against $against" magic "$work/cost.svg" 3c3f786d
    check "with a slope" grep -q 'factors *[0-9]\.[0-9]' "$work/cost.svg"
  done
fi
"$HR2D_PROGRAM" cost "$narrow" --methods l1-grid --max-seconds 1000 --csv "$work/late.csv" \
  >/dev/null 2>"$work/err" &
child=$!
sleep 4
kill -TERM "$child"
wait "$child"
status=$?
check "an interrupt ends cost with 130; was $status" matches 130 'interrupted$'
check "and keeps its rows" grep -q '^l1-grid,' "$work/late.csv"

summary check-digits
