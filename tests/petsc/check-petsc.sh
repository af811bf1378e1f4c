#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# libhr2d-petsc on 1, 2, 3 and 4 ranks: counts of one process, B to 1e-12, and the same bits.
# shellcheck disable=SC2154 # what ranks.sh sets
. "${HR2D_SRCDIR:=.}/tests/petsc/ranks.sh"
for n in 1 2 3 4; do
  aside $n ranks $n "$programs/check-ranks"
done
for n in 1 2 3 4; do
  finish $n
  check "as one process on $n ranks: $(cat "$work/$n.errors")" [ $status -eq 0 ]
  check "the same bits on 1 and $n ranks: $(diff "$work/1" "$work/$n")" \
    cmp -s "$work/1" "$work/$n"
done
check "all cases ran" [ "$(grep -c bits "$work/1")" -ge 37 ]
exit $failed
