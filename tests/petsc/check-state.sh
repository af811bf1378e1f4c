#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# B saved on 4 ranks is loaded on 1, 2 and 3, and a run goes on from there; the bytes are those of
# one rank; what does not fit or is damaged is refused.
# shellcheck disable=SC2154 # what ranks.sh sets
. "${HR2D_SRCDIR:=.}/tests/petsc/ranks.sh"
solver=$programs/check-rank-state
kept() { # kept NAME KIND CASE PROGRAM [ORDER]: saves by 4 ranks, loads by 1, 2 and 3
  file=$work/$1-$2-$3 kind=$2 scene=$3 program=$4 order=${5-}
  ranks 4 "$program" "$kind" save "$file" "$scene" $order >"$work/saved" 2>"$work/errors"
  check "$1, $kind, $scene: saved on 4 ranks: $(cat "$work/errors")" grep -q . "$work/saved"
  for n in 1 2 3; do
    aside $n ranks $n "$program" "$kind" load "$file" "$scene" $order
  done
  for n in 1 2 3; do
    finish $n
    check "$1, $kind, $scene: goes on on $n ranks: $(cat "$work/$n.errors")" [ $status -eq 0 ]
    check "$1, $kind, $scene: the same bits on $n ranks" cmp -s "$work/saved" "$work/$n"
  done
}
for kind in binary hdf5; do
  kept constants $kind plates "$solver"
  kept constants $kind blocks "$solver"
  kept whole $kind blocks "$programs/check-rank-solution" 3
done
ranks 1 "$solver" binary save "$work/one" plates >"$work/out" 2>&1
check "the file does not depend on the ranks" cmp -s "$work/one" "$work/constants-binary-plates"
ranks 1 "$programs/check-rank-solution" binary save "$work/whole" blocks 3 >"$work/out" 2>&1
check "nor does that of a whole solution" cmp -s "$work/whole" "$work/whole-binary-blocks"
ranks 2 "$programs/check-rank-solution" binary load "$work/one" plates 1 >"$work/out" 2>&1
check "constants are loaded by shares: $(cat "$work/out")" [ $? -eq 0 ]

refuses() { # refuses REASON PROGRAM ARGUMENTS...
  reason=$1 program=$2
  shift 2
  ranks 2 "$program" binary load "$@" >"$work/out" 2>"$work/errors"
  status=$?
  check "$reason; was $status: $(cat "$work/errors")" [ $status -ne 0 ]
  check "it says: $reason: $(cat "$work/errors")" grep -q "refused: .*$reason" "$work/errors"
}
solution=$programs/check-rank-solution
refuses "the state is of another scene" "$solver" "$work/one" blocks
refuses "the state is of another scene" "$solution" "$work/whole" plates 3
refuses "of another oracle, policy or order" "$solution" "$work/whole" blocks 2
# The last byte of a double of B, long before the end.
for file in one whole; do
  cp "$work/$file" "$work/damaged-$file"
  printf '\125' | dd of="$work/damaged-$file" bs=1 seek=1007 conv=notrunc 2>"$work/dd"
done
refuses "the state is damaged" "$solver" "$work/damaged-one" plates
refuses "the state is damaged" "$solution" "$work/damaged-whole" blocks 3
exit $failed
