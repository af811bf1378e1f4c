#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The rank that has most, beside the mean: links and visibility tests are counted, so that ranks
# may share processors.
# shellcheck disable=SC2154 # what ranks.sh sets
. "${HR2D_SRCDIR:=.}/tests/petsc/ranks.sh"
python3 "$HR2D_SRCDIR/tests/petsc/draw-many.py" "$work"
for scene in squares fibres plates room; do
  for n in 8 16; do
    aside $n ranks $n "$HR2D_BUILDDIR/hr2d-mpi" solve "$work/$scene.geojson" --quiet \
      --json "$work/$n.json" --eps "$(cat "$work/$scene.eps")"
  done
  for n in 8 16; do
    finish $n
    check "even shares of $scene on $n ranks: $(cat "$work/$n.errors")" \
      python3 "$HR2D_SRCDIR/tests/petsc/even-shares.py" "$work/$n.json"
  done
done
exit $failed
