#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What gas costs: solves to 1e-6 with gas of four absorptions, and of three in as many bands, in
# terms of the time without.
#
#   bench/gas.sh [SCENE.geojson...]    those given; else boxes-3, partition and a round room of
#                                      4,000 patches
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

# round PATCHES: a round room, an eighth of which is a lamp.
round() {
  awk -v n="$1" 'BEGIN {
    step = 2 * atan2(0, -1) / n
    printf "{\n  \"type\": \"FeatureCollection\",\n  \"features\": ["
    for (k = 0; k < n; k++)
      printf "%s\n    {\"type\": \"Feature\", \"properties\": {\"emission\": %d, \"reflectance\": 0.5}, " \
        "\"geometry\": {\"type\": \"LineString\", \"coordinates\": [[%.17g, %.17g], [%.17g, %.17g]]}}", \
        k ? "," : "", k < n / 8, cos(k * step), sin(k * step), cos((k + 1) % n * step), sin((k + 1) % n * step)
    print "\n  ]\n}"
  }'
}

round 4000 >"$work/round-4000.geojson"
[ $# -gt 0 ] ||
  set -- bench/scenes/boxes-3.geojson examples/scenes/partition.geojson "$work/round-4000.geojson"
for scene; do
  clear=$(least "$scene")
  for absorption in 1e-6 0.25 1 10 '[0.25, 1, 3]'; do
    sed '0,/"FeatureCollection",/s//"FeatureCollection", "hr2d": { "medium": { "absorption": '"$absorption"', "emission": 1 } },/' \
      "$scene" >"$work/gas.geojson"
    printf '%s\t' "$(basename "$scene")" "$absorption" "$clear" "$(least "$work/gas.geojson")" |
      awk -F '\t' '{ printf "%-36s absorption %-12s %.2f times %.4f s\n", $1, $2, $4 / $3, $3 }'
  done
done
