#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What gas costs: solves to 1e-6 with gas of four absorptions, in terms of the time without.
#
#   bench/gas.sh [SCENE.geojson...]    those given; else boxes-3 and partition
#
# HR2D names the program; else it is build/tools/hr2d, or hr2d of the PATH.
set -eu
cd "$(dirname "$0")/.."
hr2d=${HR2D:-build/tools/hr2d}
[ -x "$hr2d" ] || hr2d=hr2d
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# least SCENE: the least time of five solves.
least() {
  for _ in 1 2 3 4 5; do
    "$hr2d" solve "$1" --target-error 1e-6 --quiet --json - | sed -n 's/.*"total": \([0-9.e-]*\).*/\1/p'
  done | sort -g | head -n 1
}

[ $# -gt 0 ] || set -- bench/scenes/boxes-3.geojson examples/scenes/partition.geojson
for scene; do
  clear=$(least "$scene")
  for absorption in 1e-6 0.25 1 10; do
    sed '0,/"FeatureCollection",/s//"FeatureCollection", "hr2d": { "medium": { "absorption": '$absorption', "emission": 1 } },/' \
      "$scene" >"$work/gas.geojson"
    echo "$scene $absorption $clear $(least "$work/gas.geojson")" |
      awk '{ printf "%-36s absorption %-5s %.2f times %.4f s\n", $1, $2, $4 / $3, $3 }'
  done
done
