#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The rank that has most, beside the mean: links and visibility tests are counted, so that ranks
# may share processors.
# shellcheck disable=SC2154 # what ranks.sh sets
. "${HR2D_SRCDIR:=.}/tests/petsc/ranks.sh"
python3 "$HR2D_SRCDIR/tests/petsc/draw-many.py" "$work"
counts="8 16"
even() { # even SCENE ARGUMENTS...: on each of $counts
  scene=$1
  shift
  for n in $counts; do
    aside $n ranks $n "$HR2D_BUILDDIR/hr2d-mpi" solve "$work/$scene.geojson" --quiet \
      --json "$work/$n.json" "$@"
  done
  for n in $counts; do
    finish $n
    check "even shares of $scene on $n ranks with $*: $(cat "$work/$n.errors")" \
      python3 "$HR2D_SRCDIR/tests/petsc/even-shares.py" "$work/$n.json"
  done
}
for scene in squares fibres plates room bed; do
  even $scene --eps "$(cat "$work/$scene.eps")"
done
# Two plates have too few links here; tests/unit/accuracy/check-shares.c has nearer ones.
for scene in squares fibres room bed; do
  even $scene --target-error 0.1 --no-error
done
counts=8
even walls --eps "$(cat "$work/walls.eps")"
exit $failed
