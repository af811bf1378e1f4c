#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# choices.sh NAME VALUE...: what another value of a choice in src/base/choices.h costs.  Builds
# the program with each VALUE of HR2DI_CHOICE_NAME, in a copy of this tree, and prints for some
# scenes and targets the processor time in terms of that with the value in the file, in turn and
# with the median of ROUNDS, 5 unless set.  SCENES are files of examples/scenes; ERRORS targets.
# Below 15 % is noise on a busy machine.
set -eu
[ $# -ge 2 ] || { sed -n '3,7s/^# //p' "$0" >&2; exit 2; }
source=$(cd "$(dirname "$0")/.." && pwd)
name=HR2DI_CHOICE_$1
shift
table=src/base/choices.h
old=$(sed -n "s/^#define $name  *//p" "$source/$table")
[ -n "$old" ] || { echo "choices.sh: no $name in $table" >&2; exit 2; }
: "${ROUNDS:=5}" "${ERRORS:=1e-2 1e-3 1e-4 1e-6}"
: "${SCENES:=partition boxes-3 enfilade furnace-walls street-canyon occluders-200}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# program NUMBER VALUE: builds it.
program() {
  mkdir "$work/$1"
  sed "s|^#define $name  *.*|#define $name $2|" "$work/tree/$table" >"$work/table"
  cat "$work/table" >"$work/tree/$table"
  (cd "$work/$1" && ../tree/configure --quiet --disable-shared && make -s -j"$(nproc)") \
    >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
}

# seconds PROGRAM SCENE ERROR: of its processor.
seconds() {
  ( "$work/$1/tools/hr2d" solve "$source/examples/scenes/$2.geojson" --target-error "$3" \
      >/dev/null 2>&1 || [ $? = 1 ]
    times ) | sed -n 2p | awk '{ gsub(/[ms]/, " "); print $1 * 60 + $2 + $3 * 60 + $4 }'
}

mkdir "$work/tree"
(cd "$source" && git ls-files -z | xargs -0 tar cf -) | tar xf - -C "$work/tree"
(cd "$work/tree" && autoreconf -fi) >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
program 0 "$old"
count=0
for value; do
  count=$((count + 1))
  program $count "$value"
done
echo "time in terms of $name $old"
for scene in $SCENES; do
  for error in $ERRORS; do
    round=0
    : >"$work/times"
    while [ $round -lt "$ROUNDS" ]; do
      round=$((round + 1))
      line=$(seconds 0 "$scene" "$error")
      for k in $(seq $count); do line="$line $(seconds "$k" "$scene" "$error")"; done
      echo "$line" >>"$work/times"
    done
    printf '%-16s %-6s' "$scene" "$error"
    for k in $(seq $count); do
      awk -v k=$((k + 1)) '$1 > 0 { print $k / $1 }' "$work/times" | sort -g |
        awk '{ r[NR] = $1 } END { printf " %8.2f", r[int((NR + 1) / 2)] }'
    done
    echo
  done
done
