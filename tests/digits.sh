#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# digits.sh PROGRAM...: checks that builds of hr2d print the same numbers, to the last digit.
# Each solves the example scenes in several ways and integrates their view factors.  Its
# output, except seconds and memory, is compared with the output of the first PROGRAM.
set -u
scenes=$(cd "$(dirname "$0")/../examples/scenes" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# print PROGRAM FOLDER
print() {
  mkdir "$2"
  for scene in "$scenes"/*.geojson "$scenes"/*.vs2; do
    name=$(basename "$scene")
    solve="$1 solve $scene --json -"
    $solve --no-error --eps 0.3 --max-level 6 >"$2/$name, order 1"
    $solve --no-error --eps 0.7 --max-level 4 --order 5 >"$2/$name, order 5"
    $solve --no-error --oracle bf --eps 0.05 --max-level 5 --no-closure >"$2/$name, bf"
    [ "$name" = occluders-200.geojson ] || # takes minutes
      $solve --target-error 1e-3 >"$2/$name, target"
    "$1" factors "$scene" --csv - >"$2/$name, factors"
  done 2>/dev/null
  sed -i '/"seconds": {/,/}/d; /"peak_bytes"/d' "$2"/*
}

same=0 other=0 k=0
for program; do
  k=$((k + 1))
  print "$program" "$work/$k"
  [ $k -gt 1 ] || continue
  here=0
  for file in "$work/1"/*; do
    if cmp -s "$file" "$work/$k/${file##*/}"; then
      same=$((same + 1))
    else
      here=$((here + 1))
      echo "$program: other digits: ${file##*/}"
      diff "$file" "$work/$k/${file##*/}" | head -n 5
    fi
  done
  other=$((other + here))
  echo "$program: $here of $(find "$work/1" -type f | wc -l) outputs differ from those of $1"
done
echo "$same passed, $other failed"
exit $((other > 0))
