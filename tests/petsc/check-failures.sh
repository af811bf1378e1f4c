#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# An allocation that fails on one of two ranks makes both return; valgrind finds nothing wrong on
# two ranks.
# shellcheck disable=SC2154 # what ranks.sh sets
. "${HR2D_SRCDIR:=.}/tests/petsc/ranks.sh"
aside faults ranks 2 "$programs/check-rank-faults"

# ---- memory of two ranks; what MPI and PETSc keep is their own
watched() { # watched PROGRAM...: on two ranks under valgrind
  "$HR2D_BUILDDIR/libtool" --mode=execute timeout 900 "$MPIEXEC" -n 2 valgrind --quiet \
    --suppressions=/usr/share/openmpi/openmpi-valgrind.supp --error-exitcode=0 "$@"
}
if command -v valgrind >/dev/null; then
  # Case 13 has walls, bands, a sky and a halo.
  aside case watched "$programs/check-ranks" 13
  aside target watched "$HR2D_BUILDDIR/hr2d-mpi" solve \
    "$HR2D_SRCDIR/examples/scenes/lit-room.geojson" --target-error 1e-2
  finish case
  check "the case ran under valgrind: $(cat "$work/case.errors")" grep -q bits "$work/case"
  finish target
  check "so did a target: $(cat "$work/target.errors")" grep -q ranks "$work/target"
  cat "$work/case.errors" "$work/target.errors" >"$work/valgrind"
  check "no error of this library: $(grep -B 3 -A 12 'hr2d' "$work/valgrind" | head -40)" \
    [ "$(grep -c 'hr2dp\|libhr2d' "$work/valgrind")" = 0 ]
else
  echo "no valgrind: memory of two ranks is not looked at"
  [ -z "${HR2D_NEED_PETSC-}" ] || failed=1
fi
finish faults
check "all ranks return: $(cat "$work/faults.errors")" [ $status -eq 0 ]
check "allocations did fail: $(cat "$work/faults")" \
  [ "$(grep -c 'allocations failed' "$work/faults")" = 2 ]
exit $failed
