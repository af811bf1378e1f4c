#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# `hr2d solve` and `hr2d field` in scenes with temperatures and heat fluxes: the table, CSV, JSON
# and VTK, and fluxes that cannot be.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
# side PROPERTIES ENDS
side() {
  printf '{"type": "Feature", "properties": {%s},
    "geometry": {"type": "LineString", "coordinates": [%s]}}' "$@"
}
# A square with 1000 K on the left, 600 K on the right and FLUX below; the top is insulated.
square() {
  printf '{"type": "FeatureCollection", "features": ['
  side '"temperature": 1000, "name": "hot"' '[0, 1], [0, 0]' && printf ,
  side "\"flux\": $1, \"emissivity\": 0.5, \"name\": \"floor\"" '[0, 0], [1, 0]' && printf ,
  side '"temperature": 600' '[1, 0], [1, 1]' && printf ,
  side '"flux": 0, "name": "top"' '[1, 1], [0, 1]' && printf ']}'
}
square 0 >"$work/square.geojson"

# ---- by symmetry floor and top have ((1000^4 + 600^4)/2)^(1/4) = 866.9093 K
succeeds solve "$work/square.geojson" --target-error 1e-9 --at floor:0.5 --at hot:0.5 \
  --json "$work/square.json" --csv "$work/square.csv"
check "the table has temperatures" grep -q 'floor .* 866\.90' "$work/out"
check "those that are given" grep -q 'hot .* 1000     given ' "$work/out"
check "a point has one" grep -q '^at floor:0.5 .* T 866\.90' "$work/out"
check "and a black one, too" grep -q '^at hot:0.5 .* T 1000$' "$work/out"
check "CSV ends with T" [ "$(sed -n '1s/.*,//p' "$work/square.csv" | tr -d '\r')" = T ]
check "which is that of the leaf" awk -F, '$2 == "hot" && $NF != 1000 { bad = 1 }
  $2 == "top" { n++; if ($NF < 600 || $NF > 1000) bad = 1 } END { exit bad || !n }' \
  "$work/square.csv"
check "JSON has four temperatures, and two of points" \
  [ "$(grep -c '"temperature":' "$work/square.json")" -eq 6 ]
check "with their errors" [ "$(grep -c '"temperature_error":' "$work/square.json")" -eq 4 ]
check "and the heat" [ "$(grep -c '"heat":' "$work/square.json")" -eq 4 ]
check "and what is known" [ "$(grep -c '"temperature_state": "found"' "$work/square.json")" -eq 2 ]

# ---- points between: in the middle, by symmetry, the same
printf '0.5 0.5\n-3 0.5\n' >"$work/points"
succeeds field "$work/square.geojson" --points "$work/points" --csv "$work/field.csv" \
  --target-error 1e-9 --json "$work/field.json"
check "the range" grep -q '^mean radiant temperature 866\.90' "$work/out"
check "a column" awk -F, 'NR == 1 { ok = $8 == "temperature" }
  NR == 2 { ok = ok && ($8 - 866.9093)^2 < 1e-6 } NR == 3 { ok = ok && $8 == "" }
  END { exit !ok }' "$work/field.csv"
check "JSON has it" [ "$(grep -c '"temperature": 866\.90' "$work/field.json")" -eq 1 ]
succeeds field "$work/square.geojson" --grid 3x3 --vtk "$work/field.vti"
check "VTK has it" grep -q 'Name="temperature"' "$work/field.vti"

# ---- in two bands, of which each has its own emissivity, symmetry is the same
sed 's/"features"/"hr2d": {"wavelengths": [4]}, &/; s/"emissivity": 0.5/"emissivity": [0.5, 0.5]/' \
  "$work/square.geojson" >"$work/bands.geojson"
succeeds solve "$work/bands.geojson" --target-error 1e-9 --at floor:0.2 --json "$work/b.json" \
  --csv "$work/b.csv"
check "temperatures in bands" [ "$(grep -c '^ .* 866\.90' "$work/out")" -eq 2 ]
check "one for the whole patch" grep -q '^at floor:0.2 .* T 866\.90' "$work/out"
check "CSV has them" awk -F, '$2 == "top" && ($NF - 866.9093)^2 > 1e-6 { bad = 1 }
  $2 == "top" { n++ } END { exit bad || !n }' "$work/b.csv"
check "JSON, too" [ "$(grep -c '"temperature": 866\.90' "$work/b.json")" -eq 3 ]
succeeds field "$work/bands.geojson" --points "$work/points" --csv "$work/bfield.csv" \
  --target-error 1e-6
check "and a field" awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "temperature") c = k }
  NR == 2 { ok = ($c - 866.9093)^2 < 1e-2 } END { exit !ok }' "$work/bfield.csv"
succeeds solve "$work/bands.geojson" --eps 0.02 --state "$work/bands.state"
check "on links of eps, too" [ "$(grep -c '^ .* 866\.9.* unknown' "$work/out")" -eq 2 ]
succeeds solve "$work/bands.geojson" --eps 0.02 --state "$work/bands.state"
check "a state has them" [ "$(grep -c '^ .* 866\.9.* unknown' "$work/out")" -eq 2 ]
sed 's/"flux": 0, "emissivity": \[0.5, 0.5\]/"flux": 0, "emissivity": [[300, 0.5, 0.5], [900, 0.5, 0.4]]/' \
  "$work/bands.geojson" >"$work/tables.geojson"
expect 1 'a state cannot keep emissivities' solve "$work/tables.geojson" --eps 0.02 \
  --state "$work/tables.state"
succeeds info "$work/bands.geojson"
sed 's/"flux": 0, "emissivity"/"flux": -20000, "emissivity"/' "$work/bands.geojson" \
  >"$work/coldbands.geojson"
expect 1 'floor.* cannot lose so much heat' solve "$work/coldbands.geojson" \
  --target-error 1e-6

# ---- a table of emissivities: 0.5 at 866.9 K changes nothing in the symmetric room
sed 's/"emissivity": 0.5/"emissivity": [[0, 0.1], [1733.8186, 0.9]]/' "$work/square.geojson" \
  >"$work/table.geojson"
sed 's/"features"/"hr2d": {"wavelengths": [4]}, &/' "$work/table.geojson" >"$work/tables.geojson"
for scene in table tables; do
  succeeds solve "$work/$scene.geojson" --target-error 1e-9 --at floor:0.5 --csv "$work/t.csv"
  check "$scene: temperatures" [ "$(grep -c '^ .* 866\.90' "$work/out")" -eq 2 ]
  check "$scene: at a point" grep -q '^at floor:0.5 .* T 866\.90' "$work/out"
  check "$scene: CSV" awk -F, '$2 == "floor" && ($NF < 600 || $NF > 1000) { bad = 1 }
    $2 == "floor" { n++ } END { exit bad || !n }' "$work/t.csv"
  succeeds info "$work/$scene.geojson"
done

# ---- what cannot be
square -20000 >"$work/cold.geojson"
expect 1 'floor") cannot lose so much heat' solve "$work/cold.geojson" --json "$work/cold.json"
check "the report is there" grep -q '"temperature_state": "impossible"' "$work/cold.json"
square -300000 >"$work/colder.geojson"
expect 1 'would send a negative radiosity' solve "$work/colder.geojson"
sed 's/"temperature": [0-9]*/"flux": 5/' "$work/square.geojson" >"$work/afloat.geojson"
run solve "$work/afloat.geojson"
check "fluxes alone have no solution" [ "$status" -eq 1 ]
check "the patch is named" grep -q '"hot") is in a closed part .* no patch has a given temp' \
  "$work/err"
sed 's/"temperature": [0-9]*/"flux": 0/' "$work/square.geojson" >"$work/dark.geojson"
succeeds solve "$work/dark.geojson"
check "without any heat nothing is known" [ "$(grep -c ' unlit ' "$work/out")" -eq 4 ]

# ---- the control: scenes of E and rho have none of this
succeeds solve "$HR2D_SRCDIR/examples/scenes/square-room.geojson" --json "$work/plain.json" \
  --csv "$work/plain.csv"
check "no second table" [ "$(grep -c 'T in K' "$work/out")" -eq 0 ]
check "no temperatures in JSON" [ "$(grep -c temperature "$work/plain.json")" -eq 0 ]
check "nor in CSV" [ "$(sed -n '1p' "$work/plain.csv" | grep -c T)" -eq 0 ]

summary check-temperatures
