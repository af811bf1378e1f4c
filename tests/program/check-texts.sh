#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Names and file names from strangers: what a terminal would obey is not printed, pictures stay
# well-formed and quick, and no output replaces an input.
#
# Environment: HR2D_PROGRAM, the program.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0

wrong() {
  echo "$1" >&2
  status=1
}

# scene FILE NAME: two walls, the first with a name as JSON spells it.
scene() {
  cat >"$1" <<END
{"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {"name": "$2", "emission": 1},
 "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, 0]]}},
{"type": "Feature", "properties": {"name": "other"},
 "geometry": {"type": "LineString", "coordinates": [[1, 1], [0, 1]]}}]}
END
}

# C0, C1, a bidi override: nothing but printable ASCII and line ends is left of these names.
scene "$work/a.geojson" '\u001b]0;owned\u0007\u009b2J\u202egnp\n    9  faked row'
for command in solve factors info; do
  "$HR2D_PROGRAM" "$command" "$work/a.geojson" >"$work/out" 2>&1 || wrong "$command: fails"
  LC_ALL=C tr -d '\n -~' <"$work/out" >"$work/rest"
  LC_ALL=C tr -d '\302\267\316\265\303\227' <"$work/rest" >"$work/raw"
  if [ -s "$work/raw" ]; then wrong "$command: a name is printed raw"; fi
  if grep -q '^    9  faked' "$work/out"; then wrong "$command: a name makes a row"; fi
done

# Messages about what a user or a file gives.
raw=$(printf '\302\233\342\200\256x\200')
for command in 'solve' 'pair' 'study --resume --csv'; do
  # shellcheck disable=SC2086 # words
  echo "$raw" | "$HR2D_PROGRAM" $command "$work/$raw" >"$work/out" 2>&1 && wrong "$command: no failure"
  if LC_ALL=C tr -d '\n -~' <"$work/out" | grep -q .; then wrong "$command: a message is raw"; fi
done

if "$HR2D_PROGRAM" --version --verbose 2>&1 | grep -q 'no pictures'; then :; else
  # 100 kB of a narrow letter: as long as a solve, and no longer.
  scene "$work/long.geojson" "$(head -c 100000 /dev/zero | tr '\0' i)"
  timeout 30 "$HR2D_PROGRAM" solve "$work/long.geojson" --quiet --draw "$work/long.svg" ||
    wrong "--draw: a long name takes 30 s"
  scene "$work/none.geojson" 'no \ufffe \uffff \u0001 characters'
  "$HR2D_PROGRAM" solve "$work/none.geojson" --quiet --draw "$work/none.svg" || wrong "--draw: fails"
  if LC_ALL=C grep -q "$(printf '\357\277[\276\277]\\|\001')" "$work/none.svg"; then
    wrong "--draw: the picture has what is no character of XML"
  fi
fi

# refused WORDS...: usage, and the scene is as before.
refused() {
  code=0
  "$HR2D_PROGRAM" "$@" >"$work/out" 2>&1 || code=$?
  [ "$code" = 2 ] || wrong "$*: exit $code, not 2"
  cmp -s "$work/in.geojson" "$work/before" || wrong "$*: the scene is replaced"
}
cd "$work"
scene in.geojson wall
cp in.geojson before
ln in.geojson hard.geojson
ln -s in.geojson soft.geojson
for file in in.geojson ./in.geojson "$work/in.geojson" hard.geojson soft.geojson; do
  for option in --json --csv --draw; do refused solve in.geojson "$option" "$file"; done
  refused factors in.geojson --mtx "$file"
  refused study in.geojson --csv "$file"
done
refused solve in.geojson --json new --csv ./new
refused solve in.geojson --json new --csv "$work/new"
exit $status
