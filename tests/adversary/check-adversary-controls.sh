#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Negative controls of the adversary: answers and accounts that are falsified by a few times the
# stated errors are reported, each under its own check, and a hill of errors is climbed.
set -eu
adversary=$HR2D_BUILDDIR/tests/adversary/adversary
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# Copies with the same bounds; for false bounds, copies with other errors.
transform=mirror,reorder

# run OPTION...: four runs in which the library is right.
run() {
  "$adversary" --only convex,star,junctions,soup --runs 4 --error 1e-6 --lines 0 --limit 60 \
    --law copy --transform "$transform" "$@" >"$work/out" 2>&1 || true
}

# violations CHECK: the number of runs that violate a check.
violations() {
  sed -n "s/^| $1 | \([0-9]*\) |.*/\1/p" "$work/out"
}

# expect CORRUPTION CHECK...: these checks notice it in most runs.
expect() {
  corruption=$1
  shift
  run --corrupt "$corruption"
  for check; do
    found=$(violations "$check")
    [ "${found:-0}" -lt 3 ] || continue
    echo "$corruption: $check is violated in ${found:-no} of 4 runs"
    failures=$((failures + 1))
  done
}

run
for check in "average B" "average H" "point B" "point H" "end B" "end H" power negative \
  "estimate or bound" status; do
  found=$(violations "$check")
  if [ "$found" != 0 ]; then
    echo "nothing is falsified, but $check is violated in $found runs"
    failures=$((failures + 1))
  fi
done

expect average-b "average B"
expect average-h "average H"
expect point-b "point B"
expect point-h "point H"
expect end-b "end B"
expect end-h "end H"
expect power power
expect negative negative
expect estimate "estimate or bound"
expect infinite "estimate or bound"
expect status status
expect reason status
transform=split,halve
expect bound "average B" "average H"

# One falsified value is enough for the exit status.
for options in "--runs 1 --only convex" "--only convex --case 1"; do
  # shellcheck disable=SC2086
  if "$adversary" $options --folder "$work" --corrupt negative >/dev/null 2>&1; then
    echo "$options: a violation, but exit status 0"
    failures=$((failures + 1))
  fi
done

# What was written is read as the same scene.
"$adversary" --only bands --case 3 --law copy --folder "$work" >/dev/null 2>&1 || true
for scene in "$work/bands-3.geojson" "$work/bands-3-copy1.geojson"; do
  "$HR2D_PROGRAM" info "$scene" >/dev/null || failures=$((failures + 1))
done

# climb N OPTION...: climbs in rooms, in which the library is right.
climb() {
  "$adversary" --climb "$@" --family rooms --seed 8 --error 1e-6 >"$work/out" 2>"$work/err"
}

# expect_climb N CORRUPTION COLUMN LEAST: a climb gets that far, and its exit status tells.
expect_climb() {
  climb "$1" --corrupt "$2" --folder "$work" && status=0 || status=$?
  if [ "$status" != 1 ] ||
    ! awk -F'|' "\$2 ~ /rooms/ { found = \$$3 > $4 } END { exit !found }" "$work/out"; then
    echo "climbing, $2: exit status $status, and column $3 is not above $4:"
    cat "$work/out"
    failures=$((failures + 1))
  fi
}

if ! climb 100; then
  echo "nothing is falsified, but a climb finds violations:"
  cat "$work/err"
  failures=$((failures + 1))
fi
expect_climb 30 bound 7 1
expect_climb 30 bound 8 1
expect_climb 30 average-b 7 1
expect_climb 30 average-h 8 1
expect_climb 30 point-h 9 1
# What is allowed leaves the exit status 0, and no more.
for allow in 1e9 100; do
  climb 250 --corrupt hill --allow "$allow" && status=0 || status=$?
  case "$allow $status" in
  "1e9 0" | "100 1") ;;
  *)
    echo "climbing, up to $allow times allowed: exit status $status"
    failures=$((failures + 1))
    ;;
  esac
done

# As many scenes by chance come as near to the top in one of ten cases.
expect_climb 250 hill 7 200

# What was found is found again, and its scene is read.
found=$(sed -n 's/^\(--climb .*\)/\1/p' "$work/err" | head -n 1)
# shellcheck disable=SC2086
"$adversary" $found --error 1e-6 --corrupt hill >"$work/out" 2>"$work/again" || true
if [ -z "$found" ] || ! grep -qF "$(grep -m 1 VIOLATED "$work/err")" "$work/again"; then
  echo "not found again: $found"
  failures=$((failures + 1))
fi
"$HR2D_PROGRAM" info "$work/rooms-8.geojson" >/dev/null || failures=$((failures + 1))

for options in "--only nothing" "--case 1" "--climb 1 --family nothing" "--runs x" "--unknown" "stray"; do
  # shellcheck disable=SC2086
  "$adversary" $options >/dev/null 2>&1 && status=0 || status=$?
  if [ "$status" != 2 ]; then
    echo "$options: exit status $status"
    failures=$((failures + 1))
  fi
done
[ "$failures" = 0 ]
