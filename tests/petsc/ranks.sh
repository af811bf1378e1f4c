# shellcheck shell=sh disable=SC2034 # what the tests use
# SPDX-License-Identifier: GPL-3.0-or-later
# For the tests of several ranks: a folder of their own, and `ranks N PROGRAM...`, which starts
# them.  A test is skipped if there is no PETSc, unless HR2D_NEED_PETSC is set.
: "${HR2D_BUILDDIR:=.}" "${HR2D_SRCDIR:=.}" "${MPIEXEC:=mpirun}"
programs=$HR2D_BUILDDIR/tests/petsc
if [ ! -x "$programs/check-ranks" ]; then
  echo "SKIP: built without PETSc; configure --with-petsc"
  [ -n "${HR2D_NEED_PETSC-}" ] && exit 1
  exit 77
fi
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
# Ranks share processors here, and a container may have no other user than root.
OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
OMP_NUM_THREADS=1
export OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMPI_MCA_mpi_yield_when_idle
export OMPI_MCA_rmaps_base_oversubscribe OMPI_MCA_btl_vader_single_copy_mechanism
# Jobs that share a folder remove it while another one begins.
OMPI_MCA_orte_tmpdir_base=$work
export OMP_NUM_THREADS OMPI_MCA_orte_tmpdir_base

ranks() { # ranks N COMMAND...
  count=$1
  shift
  timeout 900 "$MPIEXEC" -n "$count" "$@"
}
# What a job waits for is mostly its start: several run side by side.
aside() { # aside NAME COMMAND...: begins it; its output is in $work/NAME and $work/NAME.errors
  name=$1
  shift
  mkdir -p "$work/of-$name"
  (OMPI_MCA_orte_tmpdir_base=$work/of-$name && "$@") >"$work/$name" 2>"$work/$name.errors" &
  eval "job_$name=$!"
}
finish() { # finish NAME: waits for it; sets `status`
  eval "wait \"\$job_$1\""
  status=$?
}
failed=0
check() { # check WHAT COMMAND...: the command succeeds
  what=$1
  shift
  "$@" && return
  echo "FAIL: $what"
  failed=1
}
