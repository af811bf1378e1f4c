#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# B saved on 4 ranks is loaded on 1, 2 and 3, and a run goes on from there; the bytes are those of
# one rank; what does not fit or is damaged is refused.
# shellcheck disable=SC2154 # what ranks.sh sets
. "${HR2D_SRCDIR:=.}/tests/petsc/ranks.sh"
program=$programs/check-rank-state
for kind in binary hdf5; do
  for scene in plates blocks; do
    file=$work/$kind-$scene
    ranks 4 "$program" $kind save "$file" $scene >"$work/saved" 2>"$work/errors"
    check "$kind, $scene: saved on 4 ranks: $(cat "$work/errors")" grep -q . "$work/saved"
    for n in 1 2 3; do
      aside $n ranks $n "$program" $kind load "$file" $scene
    done
    for n in 1 2 3; do
      finish $n
      check "$kind, $scene: goes on on $n ranks: $(cat "$work/$n.errors")" [ $status -eq 0 ]
      check "$kind, $scene: the same bits on $n ranks" cmp -s "$work/saved" "$work/$n"
    done
  done
done
ranks 1 "$program" binary save "$work/one" plates >"$work/out" 2>&1
check "the file does not depend on the ranks" cmp -s "$work/one" "$work/binary-plates"

refuses() { # refuses FILE CASE REASON
  ranks 2 "$program" binary load "$1" "$2" >"$work/out" 2>"$work/errors"
  status=$?
  check "$3; was $status: $(cat "$work/errors")" [ $status -ne 0 ]
  check "it says: $3: $(cat "$work/errors")" grep -q "refused: $3" "$work/errors"
}
refuses "$work/one" "blocks" "the state is of another scene"
# The last byte of a double of B, long before the end.
cp "$work/one" "$work/damaged"
printf '\125' | dd of="$work/damaged" bs=1 seek=1007 conv=notrunc 2>"$work/dd"
refuses "$work/damaged" "plates" "the state is damaged"
exit $failed
