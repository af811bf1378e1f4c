#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The program as a user meets it: exit status, messages, files, pictures.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SCENES, the example scenes;
# HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
scenes=${HR2D_SCENES:-$HR2D_SRCDIR/examples/scenes}
data=$HR2D_SRCDIR/tests/program/cli
reference=$HR2D_SRCDIR/tests/data/reference
. "$data/expect.sh"

is_absent() {
  ! [ -e "$1" ]
}
no_leftovers() {
  [ -z "$(find "$work" -name '.hr2d-*')" ]
}

far=$scenes/par-far.geojson
narrow=$scenes/par-near.geojson

# ---- bad usage: exit 2, one line
usage "no command given"
usage "unknown command 'price'" price "$far"
usage "unknown command ''" ""
usage "expected a command before '--eps'" --eps 1
usage "'x' is one argument too many" --help x
usage "'solve' needs a SCENE file" solve
usage "'info' needs a SCENE file" info
usage "'factors' needs a SCENE file" factors
usage "'b' is one argument too many" solve a b
usage "'x' is one argument too many" pair x
usage "unknown option '-x'" solve -x "$far"
usage "unknown option '--max-l' (did you mean --max-level?)" solve "$far" --max-l 3
usage "unknown option '--max-le=3' (did you mean --max-level?)" solve "$far" --max-le=3
usage "unknown option '--target-eror' (did you mean --target-error?)" solve "$far" --target-eror 1
usage "unknown option '--qiuet' (did you mean --quiet?)" info --qiuet "$far"
usage "unknown option '--epsilon=1' (did you mean --eps?)" solve "$far" --epsilon=1
usage "unknown option '--epsilom'" study "$far" --epsilom
usage "unknown command 'slove' (did you mean solve?)" slove "$far"
usage "unknown command 'sol' (did you mean solve?)" help sol
usage "'x' is one argument too many" help solve x
usage "unknown option '--frobnicate'" solve "$far" --frobnicate
check "what is not near is not suggested" lacks 'did you mean' "$work/err"
check "the help of the command is named" grep -q "try 'hr2d solve --help'" "$work/err"
usage "expected a command before '-x'" -x
check "or that of the program" grep -q "try 'hr2d --help'" "$work/err"
usage "'--eps' lacks its argument" solve "$far" --eps
usage "'--quiet=3' takes no argument" solve "$far" --quiet=3
usage "'info' has no option --eps (of solve, field)" info "$far" --eps 1
usage "'solve' has no option --plot" solve "$far" --plot x.svg
usage "'study' has no option --at" study "$far" --at 0:0
usage "'factors' has no option --eps" factors "$far" --eps 1
usage "'info' has no option --csv" info "$far" --csv a
usage "'pair' has no option --force" pair --force occlusion
usage "'pair' has no option --split-crossings" pair --split-crossings
usage "'--split-crossings=1' takes no argument" factors "$far" --split-crossings=1
usage "--force: 'fog' is none of occlusion, .*background.*, corner" solve "$far" --force fog
usage "--force: 'occlusio' is none of" factors "$far" --force occlusio
usage "two outputs go to '-'" factors "$far" --json - --csv -
usage "--eps: 'x' is not a number greater than 0" solve "$far" --eps x
usage "--eps: '0.1x' is not" solve "$far" --eps 0.1x
usage "--eps: '' is not" solve "$far" --eps ''
usage "--eps: ' 1' is not" solve "$far" --eps ' 1'
usage "--eps: 'nan' is not" solve "$far" --eps nan
usage "--eps: 'inf' is not" solve "$far" --eps inf
usage "--eps: '1e999' is not" solve "$far" --eps 1e999
usage "--eps: '-1' is not" solve "$far" --eps -1
usage "--eps: '0' is not" solve "$far" --eps 0
usage "--oracle: 'l2' is none of size, size2, bf" solve "$far" --oracle l2
usage "--variant: 'x' is neither original nor modified" solve "$far" --variant x
usage "--max-level: '1001' is not a whole number from 0 to 1000" solve "$far" --max-level 1001
usage "--max-level: '2.5' is not" solve "$far" --max-level 2.5
usage "--max-links: '0' is not" solve "$far" --max-links 0
usage "--max-links: '-3' is not" solve "$far" --max-links -3
usage "--max-elements: '99999999999999999999' is not" solve "$far" \
  --max-elements 99999999999999999999
usage "--threads: '1025' is not" solve "$far" --threads 1025
usage "--multigrid: '1' is not FROM:RATIO" solve "$far" --multigrid 1
usage "--multigrid: the ratio '2' is not" solve "$far" --multigrid 1:2
usage "--multigrid: 0.01 is not greater than --eps 0.1" solve "$far" --multigrid 0.01:0.5
usage "--at: '1' is not PATCH:T" solve "$far" --at 1
usage "--at: '1:1.5' does not end in a number from 0 to 1" solve "$far" --at 1:1.5
usage "--at: '1:' does not end" solve "$far" --at 1:
usage "--at: the scene has no patch 2, only 0 to 1" solve "$far" --at 2:0
usage "--at: the scene has no patch called 'foo'" solve "$far" --at foo:0
usage "--links-of needs --draw" solve "$far" --links-of 0:0
usage "--beams-of needs --draw" solve "$far" --beams-of 0:0
usage "--beams-of: '1' is not PATCH:T" solve "$far" --draw a.svg --beams-of 1
usage "--beams-of: '1:1.5' does not end in a number from 0 to 1" solve "$far" --draw a.svg \
  --beams-of 1:1.5
usage "--beams-of: the scene has no patch 2, only 0 to 1" solve "$far" --draw "$work/no.svg" \
  --beams-of 0:0 --beams-of 2:0
usage "--beams-of: the scene has no patch called 'foo'" solve "$far" --draw "$work/no.svg" \
  --beams-of foo:0
check "wrong beams leave no picture" is_absent "$work/no.svg"
usage "--draw: 'a.jpg' does not end in .svg, .png or .pdf" solve "$far" --draw a.jpg
usage "--draw: '.png' does not end" solve "$far" --draw .png
usage "--json: the file name is empty" solve "$far" --json ''
usage "two outputs go to '-'" solve "$far" --json - --csv -
usage "two outputs go to 'a'" study "$far" --json a --csv a
usage "--from 1 is not greater than --to 2" study "$far" --from 1 --to 2
usage "--from 1 is not greater than --to 1" study "$far" --to 1
usage "--steps: '1' is not" study "$far" --steps 1
usage "--resume needs --csv with a file" study "$far" --resume
usage "--resume needs --csv with a file" study "$far" --resume --csv -
usage "--plot-log needs --plot" study "$far" --plot-log
usage "--link-level needs --links-of" solve "$far" --link-level 1
usage "--link-parents needs --link-level" solve "$far" --draw a.svg --links-of 0:0 --link-parents
usage "--link-parents needs --link-level with at least 1" solve "$far" --draw a.svg \
  --links-of 0:0 --link-level 0 --link-parents --variant modified
usage "--link-parents needs --variant modified" solve "$far" --draw a.svg --links-of 0:0 \
  --link-level 1 --link-parents

# ---- help and version
fits_screen() {
  awk 'length($0) > 80 { bad = 1 } END { exit bad || NR < 5 || NR > 49 }' "$work/out"
}
for command in "" info solve study cost factors field pair schema; do
  # shellcheck disable=SC2086
  succeeds $command --help
  check "help of '$command' fits a screen" fits_screen
done
same_help() {
  hr2d "$@" | cmp -s - "$work/help"
}
for command in info solve study cost factors field pair schema; do
  hr2d $command --help >"$work/help"
  check "'$command -h'" same_help $command -h
  check "'help $command'" same_help help $command
  check "'$command --help' has an example" grep -q '^For example:' "$work/help"
  sed -n '/^For example:/,$ { /hr2d pair/d; /hr2d schema/d; s/^.*hr2d //p; }' "$work/help" >"$work/examples"
  while read -r example; do
    # shellcheck disable=SC2086
    run $(echo "$example" | sed "s|room.geojson|$work/none|; s|\(--[a-z]*\) \([a-z]*\.[a-z]\)|\1 $work/\2|")
    check "'$example' is well used" [ "$status" -eq 1 ]
  done <"$work/examples"
done
hr2d --help >"$work/help"
check "'-h'" same_help -h
check "'help'" same_help help
check "'help help'" same_help help help
check "helps of commands differ" lacks 'For example' "$work/help"
succeeds --version
check "version is printed" grep -q '^hr2d [0-9][0-9]*\.[0-9][0-9]*\.[0-9]' "$work/out"

# ---- bad input: exit 1, the file is named
expect 1 "^hr2d: $work/none: ." solve "$work/none"
expect 1 "^hr2d: $data/crossing.geojson: .*cross/1.* cross at (0.5, 0.5)" solve "$data/crossing.geojson"
expect 1 "^hr2d: $data/crossing.geojson: .*cross/1.* cross at (0.5, 0.5)" factors "$data/crossing.geojson"
expect 1 "^hr2d: $far: .*10 links" solve "$far" --max-links 10
expect 1 "^hr2d: $far: .*3 elements" solve "$far" --max-elements 3
for file in "$HR2D_SRCDIR"/tests/data/malformed/*.geojson; do
  expect 1 "^hr2d: $file: ." solve "$file"
done

# ---- a scene from standard input
from_stdin() {
  hr2d solve - --eps 0.1 --csv - --quiet <"$far" >"$work/read" &&
    hr2d solve "$far" --eps 0.1 --csv - --quiet | cmp -s - "$work/read"
}
check "- is standard input" from_stdin
expect 1 "^hr2d: /dev/stdin: line 1, column 1: there is no text" info -
usage "SCENE and --points cannot both be standard input" field - --points -

# ---- info
succeeds info "$data/occluded.geojson" --json "$work/info.json"
check "info prints the effects" grep -q '^  occlusion  *on  .*"blocker"' "$work/out"
check "info prints the length" grep -q '^total length  2.8$' "$work/out"
for key in scene cuts patches length bands bounding_box reflectance background effects \
  reasons status; do
  check "info has the key $key" grep -q "^  \"$key\": " "$work/info.json"
done
check "info says occlusion" grep -q '"occlusion": true' "$work/info.json"
check "and no background" grep -q '"background": false' "$work/info.json"
check "nor its light" lacks '^background ' "$work/out"
succeeds info "$data/sky.geojson" --json "$work/info.json"
check "info prints the background" grep -q '^background    0.5 1$' "$work/out"
check "and its effect" grep -q '^  background  *on ' "$work/out"
check "also as JSON" grep -q '"background": true' "$work/info.json"
succeeds info "$far" --force occlusion --force bands
check "info says what is forced" [ "$(grep -c -e '^  occlusion  *on' -e '^  bands  *on' "$work/out")" -eq 2 ]

# ---- solve
succeeds solve "$narrow" --eps 0.015625 --at bottom:0.25 --at 1:0.5 --json "$work/solve.json" \
  --csv "$work/solve.csv"
for key in scene patches at elements leaves links limited_links levels order epsilon oracle \
  variant effects work seconds peak_bytes error power status; do
  check "solve has the key $key" grep -q "^  \"$key\": " "$work/solve.json"
done
for key in index name length average irradiance net_flux patch t value oracle_calls \
  facing_tests visibility_tests exchange_areas partial_links blocked_pairs dark_pairs sweeps \
  iterations row_sums background_rows emitted received absorbed escaped relative_error refine \
  coefficients solve total estimate bound occlusion background; do
  check "solve has the inner key $key" grep -q "^   *\"$key\": " "$work/solve.json"
done
number() { # the first number of an array, by key and the which-th time it occurs
  awk -v key="\"$1\": [" -v which="$2" 'index($0, key) { n++; if (n == which) { getline; print; exit } }' \
    "$work/solve.json" | tr -d ' ,'
}
value() { # the first value of a key
  grep -o "\"$1\": [^,]*" "$work/solve.json" | head -n 1 | cut -d' ' -f2
}
# tests/data/reference/radiosity_reference.csv
check "average of bottom" near "$(number average 1)" 1.26523096533323 1e-5
check "average of top" near "$(number average 2)" 0.575479501950071 1e-5
check "B at a quarter of bottom" near "$(number value 1)" 1.28925868287759 1e-3
check "B at half of top" near "$(number value 2)" 0.639919968806328 1e-3
# B = E + ρH with ρ = 1/2
check "H of bottom" near "$(number irradiance 1)" 0.53046193066646 3e-5
check "H of top" near "$(number irradiance 2)" 1.150959003900142 1e-5
check "B - H of top" near "$(number net_flux 2)" -0.575479501950071 1e-5
check "N of par0.1" grep -q '^  "elements": 4094,$' "$work/solve.json"
check "L of par0.1" grep -q '^  "links": 246082,$' "$work/solve.json"
check "CSV has a row for each leaf" [ "$(wc -l <"$work/solve.csv")" -eq 2049 ]
check "Q is B - H times the length" awk -F, 'NR > 1 {
    l = sqrt(($7 - $5)^2 + ($8 - $6)^2); d = $11 - ($9 - $10) * l
    if (d^2 > 1e-28) bad = 1; n++ } END { exit bad || !n }' "$work/solve.csv"
check "CSV has its header" grep -qx 'patch,name,t0,t1,ax,ay,bx,by,B0,H0,Q0' "$work/solve.csv"
if command -v python3 >/dev/null 2>&1; then
  check "JSON is JSON" python3 -m json.tool "$work/solve.json" /dev/null
fi
succeeds solve "$narrow" --quiet
check "quiet prints nothing" [ ! -s "$work/out" -a ! -s "$work/err" ]
succeeds solve "$narrow" --json -
check "JSON alone on standard output" [ "$(head -c 1 "$work/out")" = "{" ]
check "no table beside it" lacks '^scene' "$work/out"
succeeds solve "$scenes/lit-room.geojson" --csv -
check "three bands" [ "$(head -n 1 "$work/out")" = "patch,name,t0,t1,ax,ay,bx,by,B0,B1,B2,H0,H1,H2,Q0,Q1,Q2" ]
succeeds solve "$scenes/corner.geojson"
check "the recursion limit is told" \
  grep -q 'recursion limit acted on [0-9]* links at level 24 (touching patches)' "$work/out"
succeeds solve "$data/names.geojson" --at 'a:b, "c":0.5' --at 'größer:1' --csv -
check "CSV quotes names" grep -q '^0,"a:b, ""c""",0,' "$work/out"
succeeds solve "$far" --oracle bf --variant modified --multigrid 1:0.5 --eps 0.01 --threads 2 \
  --json "$work/bf.json"
check "bf is directed and named" grep -q '"oracle": "bf"' "$work/bf.json"
check "stages of multigridding have no rounds" grep -q '"rounds": 1,' "$work/bf.json"
# Emission alone makes 23,072 links of these, and an error of 23 %.
succeeds solve "$scenes/screened-room.geojson" --oracle bf --eps 0.0125 --no-error --json "$work/bf.json"
check "bf refines by the light found" \
  eval 'grep -q "3 rounds, each by the light of the last" "$work/out" && grep -q "\"links\": 27666," "$work/bf.json"'
succeeds solve "$scenes/screened-room.geojson" --oracle size --eps 0.2 --no-error --json "$work/size.json"
check "size does not ask for light" \
  eval 'lacks rounds "$work/out" && grep -q "\"rounds\": 1," "$work/size.json"'
succeeds solve "$narrow" --quiet --multigrid 1:0.5 --eps 0.0625 --json "$work/many.json"
check "multigridding ends with the links of the last step" \
  grep -q '^  "links": 15244,$' "$work/many.json"
hr2d solve "$scenes/square-room.geojson" --threads 1 --csv "$work/one.csv" --quiet
hr2d solve "$scenes/square-room.geojson" --threads 3 --csv "$work/three.csv" --quiet
check "threads leave no trace" cmp -s "$work/one.csv" "$work/three.csv"

# A closed room of E = 1 − ρ: B = H = 1, whatever the links.
succeeds solve "$scenes/furnace-enclosure.geojson" --at 0:0.3 --json "$work/solve.json"
check "H of an enclosure" near "$(number irradiance 1)" 1 1e-12
check "H at a point of it" near "$(number irradiance 5)" 1 1e-12
check "its net flux is 0" small "$(number net_flux 1)" 1e-12
check "its power balance" grep -q '^power  *emitted 0.4 = absorbed 0.4 + escaped 0 (' "$work/out"
check "closes" small "$(value relative_error)" 1e-12
succeeds solve "$data/sky.geojson" --json "$work/solve.json"
check "light that comes in is told" grep -q '^power 1 .* + received [0-9.]* = ' "$work/out"
check "and balanced" small "$(value relative_error)" 1e-12
succeeds solve "$scenes/occluders-200.geojson" --eps 1 --csv "$work/solve.csv"
check "long tables are cut short" grep -q '^  \.\.\.  366 more patches' "$work/out"
check "CSV is not" [ "$(cut -d, -f1 "$work/solve.csv" | sort -u | wc -l)" -eq 407 ]

# ---- factors
cells() { # cells FILE: rows of numbers, without the header
  sed 1d "$1" | tr , ' '
}
rows_sum_to_1() { # rows_sum_to_1 CSV N
  cells "$1" | awk -v n="$2" '{ s = 0; for (k = 1; k <= NF; k++) s += $k
                               if (NF != n || s < 1 - 2e-14 || s > 1 + 2e-14) bad = 1 }
                             END { exit bad || NR != n }'
}
reciprocal() { # reciprocal CSV JSON N: A_i F_ij = A_j F_ji
  { grep -o '"length": [^,]*' "$2" | cut -d' ' -f2; cells "$1"; } |
    awk -v n="$3" 'NR <= n { a[NR] = $1; next }
      { for (k = 1; k <= n; k++) f[NR - n, k] = a[NR - n] * $k }
      END { for (i = 1; i <= n; i++) for (j = 1; j < i; j++) {
              d = f[i, j] - f[j, i]; if (d > 1e-15 || d < -1e-15) bad = 1 }
            exit bad || NR != 2 * n }'
}
succeeds factors "$far" --csv -
check "CSV has a line of names" [ "$(head -n 1 "$work/out")" = "bottom,top" ]
# √2 − 1
check "F of two opposite sides of a square" \
  near "$(sed -n 2p "$work/out" | cut -d, -f2)" 0.41421356237309504880 1e-15
check "nothing sees itself" [ "$(sed -n 3p "$work/out" | cut -d, -f2)" = 0 ]
succeeds factors "$data/names.geojson" --csv -
check "CSV quotes names of columns" [ "$(head -n 1 "$work/out")" = '"a:b, ""c""",größer' ]
for scene in square-room:4 furnace:11 lit-room:9 castel-del-monte:14 partition:30 \
  occluders-200:406; do
  n=${scene#*:}
  succeeds factors "$scenes/${scene%:*}.geojson" --csv "$work/f.csv" --json "$work/f.json"
  check "rows of $scene sum to 1" rows_sum_to_1 "$work/f.csv" "$n"
  check "$scene is reciprocal" reciprocal "$work/f.csv" "$work/f.json" "$n"
  check "number of patches of $scene" grep -q "^patches   $n\$" "$work/out"
done
check "the table of many patches is cut short" grep -q '^  \.\.\.  366 more patches' "$work/out"
for key in scene cuts patches factors work seconds status; do
  check "factors has the key $key" grep -q "^  \"$key\": " "$work/f.json"
done
for key in index name length row_sum exchange_areas partial_pairs unseen_pairs \
  visibility_tests; do
  check "factors has the inner key $key" grep -q "\"$key\": " "$work/f.json"
done
if command -v python3 >/dev/null 2>&1; then
  check "factors are JSON" python3 -c 'import json, sys
d = json.load(open(sys.argv[1]))
n = len(d["patches"])
assert len(d["factors"]) == n
full = [[0.0] * n for row in range(n)]
for row, entries in zip(full, d["factors"]):
    assert len(entries["columns"]) == len(entries["values"])
    assert all(a < b for a, b in zip(entries["columns"], entries["columns"][1:]))
    for column, value in zip(entries["columns"], entries["values"]):
        assert value > 0
        row[column] = value
lines = open(sys.argv[2]).read().splitlines()[1:]
assert full == [[float(x) for x in line.split(",")] for line in lines]
assert all(abs(sum(row) - p["row_sum"]) < 1e-14 for row, p in zip(full, d["patches"]))
assert isinstance(d["seconds"], float)' "$work/f.json" "$work/f.csv"
fi
# ---- features
usage "--group and --elmer exclude each other" factors "$far" --group --elmer a
usage "'solve' has no option --group" solve "$far" --group
cat >"$work/backs.geojson" <<'END'
{"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"name": "room"},
   "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]]}},
  {"type": "Feature", "properties": {"name": "a/b", "sides": "both"},
   "geometry": {"type": "LineString", "coordinates": [[1, 1], [2, 1], [3, 2]]}},
  {"type": "Feature", "properties": {"name": "/1"},
   "geometry": {"type": "LineString", "coordinates": [[1, 2], [1, 2.5]]}}]}
END
succeeds factors "$work/backs.geojson" --group --csv -
check "names of features" [ "$(head -n 1 "$work/out")" = 'room,a/b,a/b (back),/1' ]
cat >"$work/group.py" <<'END'
import json, re, sys
patches, features = (json.load(open(path)) for path in sys.argv[1:])
name = [re.sub(r"(.)/\d+( \(back\))?$", r"\1\2", p["name"]) for p in patches["patches"]]
length, area = {}, {}
for g, p, row in zip(name, patches["patches"], patches["factors"]):
    length[g] = length.get(g, 0) + p["length"]
    for column, value in zip(row["columns"], row["values"]):
        area[g, name[column]] = area.get((g, name[column]), 0) + p["length"] * value
assert [f["name"] for f in features["patches"]] == list(length) and len(length) < len(name)
seen = 0
for f, row in zip(features["patches"], features["factors"]):
    assert abs(f["length"] - length[f["name"]]) < 1e-12
    assert abs(f["row_sum"] - sum(row["values"])) < 1e-14
    for column, value in zip(row["columns"], row["values"]):
        seen += 1
        other = features["patches"][column]["name"]
        assert abs(value - area[f["name"], other] / length[f["name"]]) < 1e-14, (f, other)
assert seen == len(area)
END
for scene in "$scenes/partition.geojson" "$scenes/occluders-200.geojson" "$work/backs.geojson"; do
  succeeds factors "$scene" --json "$work/f.json"
  succeeds factors "$scene" --group --json "$work/g.json" --mtx "$work/g.mtx"
  ! command -v python3 >/dev/null 2>&1 || check "factors of features of $scene" \
    python3 "$work/group.py" "$work/f.json" "$work/g.json"
done
if command -v python3 >/dev/null 2>&1; then
  sed 's/"values": \[0\./"values": [1./' "$work/g.json" >"$work/wrong.json"
  check "wrong ones would be found" sh -c '! python3 "$@" 2>/dev/null' - "$work/group.py" \
    "$work/f.json" "$work/wrong.json"
fi
# Lines pass an obstacle from (0.3, 0.5) to (0.7, 0.5) in a unit square on either side, by
# crossed strings √0.34 − ½ on each.
for scene in "$data/occluded.geojson" "$scenes/blk1.vs2"; do
  succeeds factors "$scene" --csv "$work/f.csv"
  check "F around the obstacle of $scene" \
    near "$(sed -n 2p "$work/f.csv" | cut -d, -f2)" 0.16619037896906 1e-13
  check "the pair is seen in part: $scene" \
    grep -q '^pairs .* 1 partly visible, [0-9]* see nothing of each other$' "$work/out"
done
succeeds factors "$far"
check "what escapes is told" grep -q '^worst .* = 5.858e-01, of patch 0 (bottom)$' "$work/out"
succeeds factors "$far" --quiet
check "quiet factors print nothing" [ ! -s "$work/out" -a ! -s "$work/err" ]
succeeds factors "$far" --json -
check "JSON of factors alone" [ "$(head -c 1 "$work/out")" = "{" ]
expect 1 "^hr2d: $work/no/x.csv: cannot be written" factors "$far" --csv "$work/no/x.csv"
[ ! -c /dev/full ] || expect 1 '^hr2d: /dev/full: cannot be written' factors "$far" --csv /dev/full
[ ! -c /dev/full ] || expect 1 '^hr2d: /dev/full: cannot be written' factors "$far" --json /dev/full
# An independent reader of Matrix Market, which writes a CSV of numbers.
read_mtx() { # read_mtx MTX
  awk 'NR == 1 { if ($0 != "%%MatrixMarket matrix coordinate real general") exit 1; next }
       /^%/ { next }
       !n { n = $1; entries = $3; if (NF != 3 || $2 != n) exit 1; next }
       { if (NF != 3 || $3 == 0 || (f[$1, $2] != "")) bad = 1; f[$1, $2] = $3; read++ }
       END { if (bad || read != entries) exit 1
             for (i = 1; i <= n; i++) for (j = 1; j <= n; j++)
               printf "%s%s", f[i, j] == "" ? "0" : f[i, j], j < n ? "," : "\n" }' "$1"
}
# An independent reader of ViewFactors.dat by the rules of Elmer's: the number of factors of each
# surface, then as many lines i j F_ij.
read_elmer() { # read_elmer DAT
  awk '!left { if (NF != 1 || $1 !~ /^[0-9]+$/) exit bad = 1
               left = $1; n++; next }
       { if (NF != 3 || $1 != n || $2 < 1 || f[n, $2] != "") exit bad = 1
         f[n, $2] = $3; left-- }
       END { if (bad || left) exit 1
             for (i = 1; i <= n; i++) for (j = 1; j <= n; j++)
               printf "%s%s", f[i, j] == "" ? "0" : f[i, j], j < n ? "," : "\n" }' "$1"
}
for scene in square-room furnace partition castel-del-monte; do
  succeeds factors "$scenes/$scene.geojson" --csv "$work/f.csv" --mtx "$work/f.mtx" \
    --elmer "$work/f.dat"
  read_elmer "$work/f.dat" >"$work/f.of-elmer"
  sed 1d "$work/f.csv" >"$work/f.numbers"
  read_mtx "$work/f.mtx" >"$work/f.read"
  check "Matrix Market of $scene has the numbers of CSV" cmp -s "$work/f.read" "$work/f.numbers"
  check "Elmer's file of $scene has them, too" cmp -s "$work/f.of-elmer" "$work/f.numbers"
done
# An independent reader of MOOSE's list of rows: between quotation marks, parted by semicolons.
read_moose() { # read_moose INPUT
  tr '\n' ' ' <"$1" | sed -n "s/.*view_factors = '\([^']*\)'.*/\1/p" | tr -s ' ' | tr ';' '\n' |
    sed 's/^ *//; s/ *$//; s/ /,/g'
  echo
}
succeeds factors "$scenes/furnace.geojson" --group --moose "$work/f.i" --csv "$work/f.csv"
read_moose "$work/f.i" >"$work/f.read"
sed 1d "$work/f.csv" >"$work/f.numbers"
check "MOOSE's block has the numbers of CSV" cmp -s "$work/f.read" "$work/f.numbers"
check "and tells where they come from" grep -q "^# hr2d .*SHA-256 of the scene" "$work/f.i"
check "and its boundaries in their order" [ "$(sed -n "s/.*boundary = '\(.*\)'/\1/p" "$work/f.i")" = \
  "$(sed -n 1p "$work/f.csv" | tr ',' ' ')" ]
walls() { # walls NAME: two walls of this name
  printf '{ "type": "FeatureCollection", "features": ['
  printf '%s { "type": "Feature", "properties": { "name": "%s" }, "geometry":
    { "type": "LineString", "coordinates": [[%d, 0], [1, %d]] } }' '' "$1" 0 0 , "$1" 2 1
  printf '] }\n'
}
walls twin >"$work/twins.geojson"
walls 'two words' >"$work/blank.geojson"
expect 1 "^hr2d: .*: --moose: rows 0 and 1 are both .*--group" factors "$work/twins.geojson" --moose "$work/g.i"
expect 1 "^hr2d: .*: --moose: row 0 .* no name that a boundary may have" factors "$work/blank.geojson" \
  --moose "$work/g.i"
check "what is refused leaves no file" [ ! -e "$work/g.i" ]
sed '$d' "$work/f.dat" >"$work/short.dat"
sed 2d "$work/f.dat" >"$work/less.dat"
sed '$d' "$work/f.mtx" >"$work/short.mtx"
not() { ! "$@" >/dev/null; }
check "a file that ends early is noticed" not read_mtx "$work/short.mtx"
check "an Elmer file that ends early is noticed" not read_elmer "$work/short.dat"
check "an Elmer file with a line less is noticed" not read_elmer "$work/less.dat"
succeeds factors "$far" --elmer -
check "Elmer's file goes to standard output" \
  [ "$(sed -n '1p;3p' "$work/out" | tr '\n' ' ')" = "1 1 " -a "$(wc -l <"$work/out")" -eq 4 ]
succeeds factors "$far" --mtx -
check "Matrix Market goes to standard output" \
  [ "$(sed -n 4p "$work/out")" = "2 2 2" -a "$(wc -l <"$work/out")" -eq 6 ]
expect 1 "^hr2d: $work/no/x.mtx: cannot be written" factors "$far" --mtx "$work/no/x.mtx"
[ ! -c /dev/full ] || expect 1 '^hr2d: /dev/full: cannot be written' factors "$far" --mtx /dev/full
usage "'solve' has no option --mtx" solve "$far" --mtx a
usage "two outputs go to 'a'" factors "$far" --mtx a --csv a
# Two rows of patches that all see each other: read at once, but they have 32 million factors.
awk 'BEGIN { printf "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\","
             printf "\"properties\": {}, \"geometry\": {\"type\": \"MultiLineString\", \"coordinates\": [["
             for (k = 0; k < 4000; k++) printf "[%d, 0], ", k
             printf "[4000, 0]], ["
             for (k = 4000; k > 0; k--) printf "[%d, 9], ", k
             print "[0, 9]]]}}]}" }' >"$work/line.geojson"
limited() { # limited ARGUMENTS...: with 300 MB of address space
  # shellcheck disable=SC3045
  (ulimit -v 300000 && exec "$HR2D_PROGRAM" "$@") >"$work/out" 2>"$work/err" </dev/null
  status=$?
}
limited info "$work/line.geojson"
if [ "$status" -eq 0 ]; then # a program with a sanitizer takes more
  limited factors "$work/line.geojson"
  check "a matrix that does not fit is told" \
    matches 1 "^hr2d: $work/line.geojson: out of memory: the factors of 8000 patches do not fit\$"
fi

# ---- crossings that are cut, effects that are forced
succeeds factors "$data/crossing.geojson" --split-crossings --csv "$work/f.csv"
check "the crossing is told" grep -q '^crossings 1 cut$' "$work/out"
check "pieces have names" grep -q 'cross/1 \[1\],' "$work/f.csv"
check "rows around the crossing sum to 1" rows_sum_to_1 "$work/f.csv" 12
for command in info solve study; do
  succeeds $command "$data/crossing.geojson" --split-crossings --json "$work/cut.json"
  check "$command tells the crossing" grep -q '^crossings  *1 cut$' "$work/out"
  check "$command writes it" grep -q '^  "cuts": 1,$' "$work/cut.json"
done
for effect in occlusion interreflection emission bands two-sided facing background corner medium; do
  hr2d solve "$far" --quiet --csv "$work/one.csv"
  hr2d solve "$far" --quiet --csv "$work/forced.csv" --force "$effect"
  check "forced $effect changes no bit" cmp -s "$work/one.csv" "$work/forced.csv"
done

# ---- gas
gas="$scenes/furnace-gas.geojson"
succeeds solve "$gas" --target-error 1e-6 --json "$work/gas.json"
check "the gas is told" grep -q '^gas       emission 371614, gives 1.255e+06 to the patches$' "$work/out"
check "the gas is written" grep -q '^  "gas": \[' "$work/gas.json"
check "and its absorption" grep -q '"absorption": 0.2' "$work/gas.json"
succeeds solve "$far" --json "$work/one.json"
check "nothing is written without gas" not grep '"gas"' "$work/one.json"
succeeds info "$gas"
check "info tells the gas" grep -q '^gas           absorbs 0.2 per length$' "$work/out"
through='the scene has a gas, "medium", through which this version does not compute'
expect 1 "$through" factors "$gas"
expect 1 "$through" cost "$gas"
expect 1 "the oracles l1, l1-grid and bounds estimate no errors through gas" study "$gas" --oracle l1
succeeds solve "$gas" --target-error 1e-3 --norm sup
check "errors at points go through gas" grep -q '^          at points about' "$work/out"
succeeds info "$scenes/furnace-flue-gas.geojson"
check "info tells all absorptions" grep -q '^gas           absorbs 0 to 35.613 per length$' "$work/out"
succeeds solve "$scenes/furnace-flue-gas.geojson" --target-error 1e-3
check "a clear band is told" grep -q '^gas 0     lets all light of this band through$' "$work/out"
sed 's/"emission": 1,//' "$narrow" >"$work/dark.geojson"
hr2d study "$narrow" --quiet --csv "$work/one.csv"
hr2d study "$work/dark.geojson" --quiet --csv "$work/dark.csv"
check "the scene is dark" lacks emission "$work/dark.geojson"
check "a study counts links in the dark" sh -c "cut -d, -f1-5 '$work/dark.csv' >'$work/a' &&
  cut -d, -f1-5 '$work/one.csv' | cmp -s - '$work/a'"

# ---- study
succeeds study "$narrow" --from 1 --to 0.015625 --steps 4 --json "$work/study.json" \
  --csv "$work/study.csv"
check "the fit is printed" grep -q '^R² = .*slope of log L on log N = ' "$work/out"
for key in a b c r2 slope; do
  check "the fit has the key $key" grep -q "^    \"$key\": [-0-9]" "$work/study.json"
done
for key in epsilon elements leaves links oracle_calls seconds; do
  check "rows have the key $key" grep -q "^      \"$key\": [0-9]" "$work/study.json"
done
awk -F, '$1 == "par0.1" && $2 == "original" { print $4 "," $6 "," $7 "," $10 "," $11 }' \
  "$reference/counts_maxAr_pow2.csv" | head -n 4 >"$work/expected"
sed 1d "$work/study.csv" | cut -d, -f1-5 >"$work/counted"
check "N, leaves, L and calls are the reference's" cmp "$work/expected" "$work/counted"
succeeds study "$narrow" --steps 2 --json "$work/two.json"
check "two rows have no fit" grep -q '^  "fit": null' "$work/two.json"

# ---- study, with the law: between parallel patches it has a closed form
law_holds() { # law_holds CSV: L and N of the law are those of patches of length 1, 0.1 apart
  awk -F, 'NR == 1 { ok = $7 == "law_elements" && $8 == "law_links" }
    NR > 1 { l2 = log(2); g = 10; n = 4 * g / l2 / $1 - 2
      l = 3 / l2 * (g * atan2(g, 1) - log(1 + g * g) / 2) / $1 ^ 2
      ok = ok && ($7 / n - 1) ^ 2 < 1e-16 && ($8 / l - 1) ^ 2 < 1e-16 }
    END { exit !(ok && NR == 4) }' "$1"
}
succeeds study "$narrow" --law --variant modified --steps 3 --json "$work/law.json" \
  --csv "$work/law.csv"
check "the law is printed" grep -q '^law: L ≈ 53.68434 ε^-2, N ≈ 57.7078 ε^-1 - 2$' "$work/out"
check "with L by N" grep -q '; L/N^2 → 0.016121$' "$work/out"
check "N and L by the law" law_holds "$work/law.csv"
law_fails() {
  ! law_holds "$1"
}
succeeds study "$narrow" --law --steps 3 --csv "$work/other.csv"
check "the law of the other variant is another" law_fails "$work/other.csv"
for key in period links elements factor power error; do
  check "the law has the key $key" grep -q "^ *\"$key\": " "$work/law.json"
done
cp "$work/law.csv" "$work/law-whole.csv"
sed -i 3d "$work/law.csv"
succeeds study "$narrow" --law --variant modified --steps 3 --resume --csv "$work/law.csv"
cut -d, -f1-5,7,8 "$work/law-whole.csv" >"$work/a"
check "a study with the law is resumed" sh -c "cut -d, -f1-5,7,8 '$work/law.csv' | cmp -s - '$work/a'"
succeeds study "$narrow" --variant modified --steps 3 --resume --csv "$work/law.csv" --json "$work/law.json"
check "and without it" sh -c "sed 1d '$work/law.csv' | awk -F, 'NF != 6 { exit 1 }'"
check "then there is none" lacks '"law"' "$work/law.json"
expect 1 'patch 0 ("floor") and patch 1 ("wall") touch: with the oracle "size" N and L have no law' \
  study "$HR2D_SRCDIR/examples/scenes/corner.geojson" --law
check "nothing is counted then" [ ! -s "$work/out" ]
expect 1 'there is no law for the oracle "bf"' study "$narrow" --law --oracle bf

# ---- study, resumed: as in one go, seconds apart
sweep() { # sweep CSV ARGUMENTS...
  csv=$1
  shift
  run study "$narrow" --to 0.015625 --steps 25 --quiet --csv "$csv" "$@"
}
same_counts() {
  cut -d, -f1-5 "$1" >"$work/counts"
  cut -d, -f1-5 "$2" | cmp -s "$work/counts"
}
sweep "$work/whole.csv"
check "the sweep has its rows" [ "$(wc -l <"$work/whole.csv")" -eq 26 ]
sweep "$work/none.csv" --resume
check "a file that does not exist is begun" same_counts "$work/whole.csv" "$work/none.csv"
awk -F, -v OFS=, 'NR > 1 { $6 = 12345 } NR < 4 || NR > 8 && NR < 20' "$work/whole.csv" \
  >"$work/part.csv"
sweep "$work/part.csv" --resume --json "$work/part.json"
check "a resumed sweep is that of one go" same_counts "$work/whole.csv" "$work/part.csv"
check "and counts no row again" [ "$(grep -c ',12345$' "$work/part.csv")" -eq 13 ]
check "and is complete" grep -q '^  "status": "ok"$' "$work/part.json"
sort "$work/part.csv" | grep -v epsilon | sed '1i epsilon,elements,leaves,links,oracle_calls,seconds' |
  sed 's/$/\r/' >"$work/sorted.csv"
sweep "$work/sorted.csv" --resume
check "the order of rows and the kind of line ends do not matter" \
  cmp -s "$work/part.csv" "$work/sorted.csv"
sweep "$work/part.csv" --resume --steps 4 --from 2
check "rows for other ε stay" [ "$(wc -l <"$work/part.csv")" -eq 29 ]
check "sorted by ε" sh -c "sed 1d '$work/part.csv' | sort -c -t, -k1,1gr"
sweep "$work/limit.csv" --max-links 20000 --json "$work/limit.json"
check "a limit ends a sweep with 1; was $status" matches 1 '20000 links'
check "its rows are kept" [ "$(wc -l <"$work/limit.csv")" -gt 10 ]
check "and called incomplete" grep -q '^  "status": "incomplete"$' "$work/limit.json"
sweep "$work/limit.csv" --resume
check "and taken up again" same_counts "$work/whole.csv" "$work/limit.csv"

refuses() { # refuses REGEX SCRIPT: what a sed script makes of the CSV is not resumed
  sed "$2" "$work/whole.csv" >"$work/bad.csv"
  cp "$work/bad.csv" "$work/kept.csv"
  sweep "$work/bad.csv" --resume
  check "a CSV after sed '$2' -> $1; was $(head -n 1 "$work/err")" \
    matches 1 "^hr2d: $work/bad.csv: cannot be resumed: .*$1"
  check "and is left alone" cmp -s "$work/bad.csv" "$work/kept.csv"
}
refuses 'it is empty' d
refuses 'line 1 is not the header' 1d
refuses 'line 1 is not the header' '1s/links/knots/'
refuses 'line 3 has fewer fields' '3s/,[^,]*$//'
refuses 'line 3 has more fields' '3s/$/,1/'
refuses 'line 3 has fewer fields' '3s/.*//'
refuses 'line 4 does not begin with an epsilon' '4s/^/x/'
refuses 'line 4 does not begin with an epsilon' '4s/^/-/'
refuses "line 5: '9x' is no number of leaves" '5s/,[^,]*/,9x/2'
refuses "line 5: '0' is no number of links" '5s/,[^,]*/,0/3'
refuses "line 5: '-1' is no number of oracle calls" '5s/,[^,]*/,-1/4'
refuses 'line 5 has no seconds' '5s/[^,]*$/soon/'
refuses 'line 6 contains a NUL byte' '6s/,/\x00/'
refuses 'is there twice' '7p'
refuses 'do not belong to a scene of 2 patches' '8s/,[^,]*/,999999/1'
refuses 'where this study counts' '2s/,[^,]*/,7777777/3'
head -c -3 "$work/whole.csv" >"$work/bad.csv"
sweep "$work/bad.csv" --resume
check "a CSV that is cut off" matches 1 'line 26 is cut off$'
for foreign in "$scenes/orth-near.geojson" "$narrow --oracle bf" "$narrow --variant modified"; do
  # shellcheck disable=SC2086
  run study $foreign --quiet --resume --csv "$work/whole.csv"
  check "the CSV of another study is refused: $foreign" matches 1 'where this study counts'
done
mkdir "$work/folder.csv"
sweep "$work/folder.csv" --resume
check "a folder is refused" [ "$status" -eq 1 ]

# ---- pair
echo '0 0 1 0 1 1 0 1' | hr2d pair >"$work/out"
# shellcheck disable=SC2046
set -- $(cat "$work/out")
check "four numbers for a pair" [ $# -eq 4 ]
check "unit square" near "$1" 0.41421356237309504880 2.5e-16
check "size oracle of the unit square" [ "$4" = 1 ]
awk -F, 'NR > 1 { print $2, $3, $4, $5, $6, $7, $8, $9 }' "$reference/formfactors.csv" |
  hr2d pair >"$work/out" 2>"$work/err"
check "the reference pairs are read" [ $? -eq 0 ]
# A denormal AF has no 17 digits to compare, but its view factors do.
sed 1d "$reference/formfactors.csv" | cut -d, -f10-12 | tr , ' ' | paste -d ' ' - "$work/out" |
  awk 'function off(x, y) { d = x - y; if (d < 0) d = -d; return d > 4e-15 * y }
       { if ($1 + 0 > 2.3e-308 && off($4, $1)) bad = 1
         if (off($5, $2) || off($6, $3)) { bad = 1; print "  line " NR ": " $0 } }
       END { exit bad || NR < 10 }'
check "pair agrees with the reference" [ $? -eq 0 ]
pair() { # pair STATUS REGEX INPUT
  # shellcheck disable=SC2059
  printf "$3" | hr2d pair >"$work/out" 2>"$work/err"
  status=$?
  check "pair '$3' -> $1, $2; was $status, $(head -n 1 "$work/err")" matches "$1" "$2"
}
pair 1 '^hr2d: standard input: line 3: expected 8 numbers, found 7$' \
  '# seven\n\n1 2 3 4 5 6 7\n'
pair 1 'line 1: expected 8 numbers, found 9$' '1 2 3 4 5 6 7 8 9\n'
pair 1 "line 1: 'x' is not a finite number" '1 2 3 4 x 6 7 8\n'
pair 1 "line 1: 'nan' is not" '1 2 3 4 nan 6 7 8\n'
pair 1 "line 1: 'inf' is not" '1 2 3 4 5 6 inf 8\n'
pair 1 'line 2: the first segment has length 0' '0 0 1 0 1 1 0 1\n1 1 1 1 0 0 1 0\n'
check "the lines before a bad one are answered" [ "$(wc -l <"$work/out")" -eq 1 ]
pair 1 'line 1: the second segment has length 0' '0 0 1 0 1 1 1 1'
pair 1 'line 1: contains a NUL byte' '0 0 1 0\0000 1 1 0 1\n'
printf '  \n# nothing\n0 0 1 0 0.5 -1 0.5 1\n' | hr2d pair --oracle size2 >"$work/out"
check "crossing segments have AF and no estimate" \
  grep -q '^0\.[0-9]* 0\.[0-9]* 0\.[0-9]* nan$' "$work/out"

# ---- files are whole or not there
echo old >"$work/old.csv"
echo old >"$work/old.png"
(
  trap '' XFSZ
  ulimit -f 8
  hr2d solve "$narrow" --eps 0.1 --quiet --csv "$work/old.csv" 2>"$work/err"
)
check "a write that fails is told" [ $? -eq 1 ]
check "by name" grep -q "^hr2d: $work/old.csv: cannot be written" "$work/err"
check "and leaves the old file" grep -qx old "$work/old.csv"
check "and nothing else" no_leftovers
succeeds solve "$narrow" --quiet --csv "$work/old.csv"
check "a write that succeeds replaces the old file" lacks '^old$' "$work/old.csv"
ln -s old.csv "$work/link.csv"
succeeds solve "$far" --quiet --csv "$work/link.csv"
check "a link stays a link" [ -L "$work/link.csv" ]
expect 1 "^hr2d: $work/no/x.json: cannot be written" solve "$far" --json "$work/no/x.json"
expect 1 "^hr2d: $work: cannot be written: is a directory" solve "$far" --json "$work"
if [ -c /dev/full ]; then
  expect 1 '^hr2d: /dev/full: cannot be written' solve "$far" --quiet --json /dev/full
  expect 1 '^hr2d: /dev/full: cannot be written' study "$far" --quiet --csv /dev/full
  check "a device stays a device" [ -c /dev/full ]
  hr2d solve "$far" >/dev/full 2>"$work/err"
  check "a full standard output is told" [ $? -eq 1 ]
  hr2d --help >/dev/full 2>"$work/err"
  check "also by --help" [ $? -eq 1 ]
fi
hr2d solve "$far" >&- 2>"$work/err"
check "a closed standard output is told" [ $? -eq 1 ]

# ---- interrupted: counts for minutes otherwise
"$HR2D_PROGRAM" study "$scenes/square-room.geojson" --from 1e-4 --to 1e-5 --json "$work/late.json" \
  >/dev/null 2>"$work/err" &
child=$!
# Until it has read its scene and catches signals, which shows in /proc where there is one.
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do
  sleep 1
  caught=$(sed -n 's/^SigCgt:.*\(....\)$/\1/p' "/proc/$child/status" 2>/dev/null) || caught=4000
  [ $((0x${caught:-4000} & 0x4000)) -eq 0 ] || break
done
kill -TERM "$child"
wait "$child"
check "an interrupt ends with 130" [ $? -eq 130 ]
check "and says so" grep -q 'interrupted$' "$work/err"
check "and leaves no file" is_absent "$work/late.json"
begin() { # begin SIGNAL: a sweep that takes minutes, ended once its CSV is there
  mkdir "$work/$1"
  "$HR2D_PROGRAM" study "$scenes/square-room.geojson" --to 1e-5 --steps 100 --threads 1 \
    --json "$work/$1/late.json" --csv "$work/$1/late.csv" >"$work/out" 2>"$work/err" &
  child=$!
  for _ in $(seq 120); do
    sleep 1
    [ "$(wc -l <"$work/$1/late.csv" 2>/dev/null || echo 0)" -lt 5 ] || break
  done
  kill -"$1" "$child"
  wait "$child"
  status=$?
}
whole_rows() {
  awk -F, 'NF != 6 { bad = 1 } END { exit bad || NR < 3 || NR > 90 }' "$1"
}
begin TERM
check "an interrupted sweep ends with 130 and says how far it came" \
  matches 130 '[0-9]* of 100 steps done when interrupted$'
check "its rows are written" whole_rows "$work/TERM/late.csv"
check "as JSON, too" grep -q '^  "status": "incomplete"$' "$work/TERM/late.json"
check "and fitted" grep -q '^R² = ' "$work/out"
begin KILL 2>/dev/null
check "a killed sweep leaves its rows, whole" whole_rows "$work/KILL/late.csv"

# ---- enclosures: one element for each patch, whatever --eps was
succeeds solve "$far" --enclosure --json "$work/enclosure.json" --no-error
check "the table names the method" grep -q '^method    enclosure: one radiosity for each patch$' "$work/out"
check "one element for each patch" grep -q '^elements  N = 2, of which 2 leaves' "$work/out"
check "no link is one of the recursion limit" lacks 'recursion limit' "$work/out"
check "JSON names it, too" grep -q '"oracle": "enclosure"' "$work/enclosure.json"
for other in '--eps 1' '--max-level 2' '--order 2' '--oracle bf' '--variant modified' '--multigrid 1:.5'; do
  # shellcheck disable=SC2086 # an option and its value
  usage "--enclosure and ${other%% *} exclude each other" solve "$far" --enclosure $other
done
usage "--target-error and --enclosure exclude each other" solve "$far" --enclosure --target-error .1

# ---- pictures
run solve "$far" --quiet --draw "$work/probe.svg"
if grep -q 'without cairo' "$work/err"; then
  check "no cairo is told" [ "$status" -eq 1 ]
else
  for scene in "$scenes"/*.geojson "$data/names.geojson"; do
    succeeds solve "$scene" --quiet --no-fill --draw "$work/picture.svg"
    check "SVG of $scene" magic "$work/picture.svg" 3c3f786d
    check "SVG of $scene is whole" grep -q '</svg>' "$work/picture.svg"
  done
  succeeds solve "$narrow" --quiet --draw "$work/old.png" --links-of top:0.3
  check "PNG" magic "$work/old.png" 89504e47
  succeeds solve "$far" --quiet --draw "$work/picture.pdf" --links-of 0:0
  succeeds solve "$narrow" --quiet --eps 0.25 --variant modified --draw "$work/picture.svg" \
    --links-of bottom:0.49 --link-level 5
  succeeds solve "$far" --quiet --eps 0.5 --variant modified --draw "$work/picture.svg" \
    --links-of bottom:0.3 --link-level 1 --link-parents
  succeeds solve "$far" --quiet --eps 0.5 --draw "$work/picture.svg" --links-of 1:1 --link-level 0
  usage "--link-level: the elements at this point have levels 0 to 1" solve "$far" --quiet \
    --eps 0.5 --draw "$work/picture.svg" --links-of 1:1 --link-level 2
  # With beams from a point between two patches: one ends at the other patch, two at the sky.
  fills() { # fills COLOUR: how many, the key included
    tr -d ' ' <"$work/picture.svg" | grep -o "fill[:=\"]*rgb($1)" | wc -l
  }
  for beams in "" "--beams-of bottom:0.5" "--beams-of 0:0.2 --beams-of top:1"; do
    # shellcheck disable=SC2086
    succeeds solve "$far" --quiet --draw "$work/picture.svg" $beams
    check "beams '$beams': $(fills 90%,42%,5%), $(fills 15%,50%,90%)" \
      [ "$(fills 90%,42%,5%),$(fills 15%,50%,90%)" = "$(case $beams in
        "") echo 0,0 ;; *0.5) echo 2,3 ;; *) echo 3,5 ;; esac)" ]
  done
  succeeds solve "$data/sky.geojson" --quiet --draw "$work/old.png" --beams-of 0:0 --beams-of 1:1
  check "PNG with beams" magic "$work/old.png" 89504e47
  succeeds solve "$narrow" --quiet --draw "$work/picture.pdf" --beams-of top:0.5 --links-of top:0.3
  check "PDF with beams" magic "$work/picture.pdf" 25504446
  expect 1 "^hr2d: $work/no/x.svg: cannot be written" solve "$far" --draw "$work/no/x.svg"
  check "PDF" magic "$work/picture.pdf" 25504446
  [ ! -c /dev/full ] || ln -s /dev/full "$work/full.png"
  [ ! -c /dev/full ] || expect 1 "^hr2d: $work/full.png: cannot be written" \
    solve "$far" --quiet --draw "$work/full.png"
fi
if command -v gnuplot >/dev/null 2>&1; then
  for end in svg:3c3f786d png:89504e47 pdf:25504446; do
    succeeds study "$narrow" --quiet --plot "$work/it's \"a\" plot.${end%:*}"
    check "plot as ${end%:*}" magic "$work/it's \"a\" plot.${end%:*}" "${end#*:}"
  done
  succeeds study "$narrow" --quiet --plot "$work/plot.svg" --plot-log
  check "the slope is on logarithmic axes" grep -q 'L ∝ N' "$work/plot.svg"
  check "and no law" lacks 'law of the means' "$work/plot.svg"
  succeeds study "$narrow" --quiet --law --plot "$work/plot.svg"
  check "the curve of the law" grep -q 'law of the means' "$work/plot.svg"
fi
# A gnuplot that fails, and a PATH that has everything but gnuplot.
mkdir "$work/bad" "$work/bin"
printf '#!/bin/sh\necho no luck >&2\nexit 3\n' >"$work/bad/gnuplot"
chmod +x "$work/bad/gnuplot"
ln -s /usr/bin/* /bin/* "$work/bin" 2>/dev/null
rm -f "$work"/bin/gnuplot*
usual=$PATH
PATH=$work/bad:$usual
expect 1 "^hr2d: $work/none.svg: gnuplot failed: no luck" study "$far" --quiet \
  --plot "$work/none.svg"
PATH=$work/bin
expect 1 "^hr2d: $work/none.svg: cannot be plotted: gnuplot is not installed" study "$far" \
  --quiet --plot "$work/none.svg"
PATH=$usual
check "a plot that fails leaves no file" is_absent "$work/none.svg"
# A file that is longer than 32 bits can say is replaced as any other, with its mode.
if truncate -s 3G "$work/long.json" 2>/dev/null; then
  chmod 640 "$work/long.json"
  succeeds solve "$far" --quiet --json "$work/long.json"
  check "a long file is replaced" [ "$(wc -c <"$work/long.json")" -lt 100000 ]
  check "with its mode" [ -n "$(find "$work/long.json" -perm 640)" ]
fi
check "no temporary file is left" no_leftovers

# ---- warnings about a scene
cat >"$work/loose.geojson" <<EOF
{"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"emission":1,"rho":0.5},
 "geometry":{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,3],[0,3],[0,0]]]}},
{"type":"Feature","properties":{"name":"stub","sides":"both"},
 "geometry":{"type":"LineString","coordinates":[[2,0.001],[2,1]]}}]}
EOF
for command in info solve; do
  succeeds "$command" "$work/loose.geojson" --json "$work/w.json"
  check "$command warns of rho" grep -q 'warning: feature 1: "rho" is not used' "$work/err"
  check "and of the stub" grep -q 'warning: patch 4 ("stub") ends at .*, 0.001 short' "$work/err"
  check "in JSON, too" grep -q '"code": "loose-end"' "$work/w.json"
  succeeds "$command" "$work/loose.geojson" --quiet
  check "$command --quiet is quiet" [ ! -s "$work/err" ]
  run "$command" "$work/loose.geojson" --strict
  check "$command --strict fails" [ "$status" -eq 1 ]
  check "and says why" grep -q '2 warnings with --strict' "$work/err"
  succeeds "$command" "$HR2D_SRCDIR/examples/scenes/lit-room.geojson" --strict
  check "$command has no warning about a sound scene" [ ! -s "$work/err" ]
done
# Of an export of OpenStreetMap three points are one line, and so are degrees; of IMDF the English name is printed.
strangers=$HR2D_SRCDIR/tests/data/strangers
succeeds info "$strangers/overpass.geojson"
check "three points are one line" \
  [ "$(grep -c 'feature 3, feature 4 ("Markt 1") and feature 5: a point is no wall' "$work/err")" -eq 1 ]
check "and points are in no other one" [ "$(grep -c 'a point' "$work/err")" -eq 1 ]
check "degrees are one line" [ "$(grep -c 'ogr2ogr -t_srs EPSG:32632' "$work/err")" -eq 1 ]
succeeds factors "$strangers/unit.geojson"
check "a unit has its English name" grep -q ' Office/1 ' "$work/out"
for file in polygon geometries collection drawing; do succeeds info "$strangers/$file.geojson"; done
# A NUL byte behind a number, and behind the end, of a file and of a pipe; the control has a space there.
for place in '8.5' '}$'; do
  sed "s/$place/&@/" "$strangers/polygon.geojson" >"$work/at.geojson"
  tr @ ' ' <"$work/at.geojson" >"$work/space.geojson"
  tr @ '\0' <"$work/at.geojson" >"$work/nul.geojson"
  succeeds info "$work/space.geojson"
  expect 1 '^hr2d: .*nul.geojson: line 1, column [0-9]*: a NUL byte' info "$work/nul.geojson"
  hr2d info - <"$work/nul.geojson" >"$work/out" 2>"$work/err"
  status=$?
  check "a NUL byte of a pipe" matches 1 'line 1, column [0-9]*: a NUL byte'
done
succeeds info "$work/loose.geojson" --snap 0.002
check "--snap tells what it moved" grep -q 'snapped: 0 ends joined, 1 feet moved' "$work/err"
check "and how far" grep -q 'farthest by 0.001, from (2, 0.001) to (2, 0)' "$work/err"
check "the stub ends on the floor" lacks '"stub") ends at' "$work/err"
run info "$work/loose.geojson" --snap 100
check "--snap refuses to drop all" grep -q 'no patch is longer than the tolerance' "$work/err"

# ---- a row of tubes, polygons, between two plates: far images show between the tubes here and there
tubes() { # tubes CELLS: of a period, with tubes of 16 sides
  awk -v cells="$1" 'BEGIN {
    print "{\"type\": \"FeatureCollection\", \"hr2d\": {\"period\": [" 2.5 * cells ", 0]}, \"features\": ["
    line = "{\"type\": \"Feature\", \"properties\": {%s}, \"geometry\": {\"type\": \"%s\", \"coordinates\": "
    printf line "[[%g, 2], [0, 2]]}},", "\"name\": \"lamp\", \"emission\": 1", "LineString", 2.5 * cells
    printf line "[[0, -2], [%g, -2]]}}", "\"name\": \"lower\"", "LineString", 2.5 * cells
    for (c = 0; c < cells; c++) {
      printf "," line "[[", "\"name\": \"tube\", \"faces\": \"out\"", "Polygon"
      for (k = 0; k <= 16; k++) {
        a = (k % 16 + .5) * atan2(0, -1) / 8
        printf "%s[%.15g, %.15g]", k ? ", " : "", 1.25 + 2.5 * c + .5 * cos(a), .5 * sin(a)
      }
      printf "]]}}"
    }
    print "]}" }'
}
missing() { # missing CELLS: $found becomes what is missing of the largest value, and the relative error
  tubes "$1" >"$work/tubes.geojson"
  expect 1 'draw 4 or more cells as one period: beyond [0-9]* images up to .* may be missing at patch [0-9]* ("tube/' \
    solve "$work/tubes.geojson" --target-error 1e-7
  found=$(sed -n 's/.*of a view, \([0-9.e-]*\) of the largest.*; the error is about \([0-9.e-]*\), .*/\1 \2/p' "$work/err")
}
missing 1
one=$found
missing 4
four=$found
check "the message says of what, how much, and what helps; $one, $four" \
  awk -v one="$one" -v four="$four" 'BEGIN { split(one, a); split(four, b)
    exit !(a[1] > 0 && a[1] <= a[2] && a[2] < 2e-3 && b[2] < a[2] / 2) }'

summary check-cli
