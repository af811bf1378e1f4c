/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vectors, the operator, solves and averages. */
#include "equation.h"

PetscErrorCode hr2dp_vector(hr2dp *p, Vec *v) {
  PetscFunctionBegin;
  PetscCheck(p->refined, p->comm, PETSC_ERR_ARG_WRONGSTATE, "there was no refinement");
  PetscCall(VecCreateMPI(p->comm, (PetscInt)(p->trees.leaves * p->bands), PETSC_DETERMINE, v));
  PetscFunctionReturn(0);
}

static PetscErrorCode check_vector(const hr2dp *p, Vec v) {
  PetscFunctionBegin;
  PetscInt size;
  PetscCheck(p->refined, p->comm, PETSC_ERR_ARG_WRONGSTATE, "there was no refinement");
  PetscCall(VecGetLocalSize(v, &size));
  int differs = size != (PetscInt)(p->trees.leaves * p->bands);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &differs, 1, MPI_INT, MPI_MAX, p->comm));
  PetscCheck(!differs, p->comm, PETSC_ERR_ARG_SIZ, "the vector is not one of hr2dp_vector()");
  PetscFunctionReturn(0);
}

static hr2d_status take_options(hr2dp *p, const hr2d_solve_options *given,
                                hr2d_solve_options *o) {
  const hr2d_solve_options defaults = HR2D_SOLVE_OPTIONS_INIT;
  *o = defaults;
  if (given && given->struct_size < sizeof given->struct_size)
    return hr2dpi_fail(p, HR2D_EINVAL, "struct_size is not set");
  if (given) memcpy(o, given, given->struct_size < sizeof *o ? given->struct_size : sizeof *o);
  if (o->tolerance != 0 && (!(o->tolerance >= 1e-15) || !isfinite(o->tolerance)))
    return hr2dpi_fail(p, HR2D_EINVAL, "tolerance %g is not a number ≥ 1e-15", o->tolerance);
  if ((unsigned)o->closure > HR2D_CLOSURE_OFF)
    return hr2dpi_fail(p, HR2D_EINVAL, "closure %d is no hr2d_closure", (int)o->closure);
  if (o->start) return hr2dpi_fail(p, HR2D_EINVAL, "the start of a solve is in its vector");
  return HR2D_OK;
}

/* Puts a field into a vector, in the unit of E.  HR2D_ERANGE is for the caller to agree on. */
static PetscErrorCode give(hr2dpi_equation *s, const double *field, Vec v,
                           hr2d_status *status) {
  PetscFunctionBegin;
  PetscScalar *to;
  PetscCall(VecGetArrayWrite(v, &to));
  for (size_t k = 0; k < s->field; k++) {
    to[k] = ldexp(field[k], s->exponent[k % s->p->bands]);
    if (!isfinite(to[k]))
      *status =
          hr2dpi_fail(s->p, HR2D_ERANGE, "a radiosity is beyond what a double can represent");
  }
  PetscCall(VecRestoreArrayWrite(v, &to));
  PetscFunctionReturn(0);
}

static PetscErrorCode solve(hr2dpi_equation *s, Vec b) {
  PetscFunctionBegin;
  const PetscScalar *start;
  if (!hr2d_scene_effect(s->p->scene, HR2D_EFFECT_INTERREFLECTION, NULL)) {
    PetscCall(hr2dpi_equation_take(s));
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetArrayRead(b, &start));
  const PetscErrorCode failed = hr2dpi_equation_start(s, start);
  PetscCall(VecRestoreArrayRead(b, &start));
  PetscCall(failed);
  PetscCall(hr2dpi_equation_solve(s));
  PetscCall(hr2dpi_equation_settle_power(s));
  PetscCall(hr2dpi_equation_check_sign(s));
  PetscFunctionReturn(0);
}

static PetscErrorCode fill_report(hr2dpi_equation *s, hr2dp_report *report) {
  PetscFunctionBegin;
  double residual;
  uint64_t sums = s->transport.row_sums;
  PetscCall(hr2dpi_add_counts(s->p, &sums, 1));
  if (report->power) PetscCall(hr2dpi_equation_power(s, report->power));
  PetscCall(hr2dpi_equation_residual(s, &residual));
  report->sweeps = s->transport.sweeps;
  report->iterations = s->looks ? s->looks - 1 : 0;
  report->row_sums = sums;
  report->residual = residual;
  PetscFunctionReturn(0);
}

static PetscErrorCode run(hr2dpi_equation *s, hr2dp *p, const hr2d_solve_options *options,
                          Vec b, Vec h, hr2dp_report *report) {
  PetscFunctionBegin;
  hr2d_status status = HR2D_OK;
  PetscCall(hr2dpi_equation_init(s, p, options));
  PetscCall(solve(s, b));
  if (report) PetscCall(fill_report(s, report));
  PetscCall(give(s, s->radiosity, b, &status));
  hr2dpi_closure_move_mean(&s->transport, s->radiosity, s->irradiance);
  if (h) PetscCall(give(s, s->irradiance, h, &status));
  PetscCall(hr2dpi_agree(p, status));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_solve(hr2dp *p, const hr2d_solve_options *given, Vec b, Vec h,
                           hr2dp_report *report) {
  PetscFunctionBegin;
  hr2d_solve_options options;
  hr2dpi_equation equation = {0};
  hr2dpi_begin(p);
  PetscCall(check_vector(p, b));
  if (h) PetscCall(check_vector(p, h));
  if (report && report->struct_size < sizeof *report)
    SETERRQ(p->comm, PETSC_ERR_ARG_SIZ, "struct_size is not set");
  PetscCall(hr2dpi_agree(p, take_options(p, given, &options)));
  const PetscErrorCode failed = run(&equation, p, &options, b, h, report);
  hr2dpi_equation_clear(&equation);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

static PetscErrorCode average(hr2dpi_transport *t, Vec v, double *value) {
  PetscFunctionBegin;
  const PetscScalar *field;
  PetscCall(VecGetArrayRead(v, &field));
  const PetscErrorCode failed = hr2dpi_transport_patch_averages(t, field, value);
  PetscCall(VecRestoreArrayRead(v, &field));
  PetscCall(failed);
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_averages(hr2dp *p, Vec v, double *value) {
  PetscFunctionBegin;
  hr2dpi_transport t = {0};
  hr2dpi_begin(p);
  PetscCall(check_vector(p, v));
  PetscErrorCode failed = hr2dpi_agree(p, hr2dpi_transport_init(&t, p));
  if (!failed) failed = average(&t, v, value);
  hr2dpi_transport_clear(&t);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

static PetscErrorCode multiply(Mat k, Vec x, Vec y) {
  PetscFunctionBegin;
  hr2dpi_equation *s;
  const PetscScalar *from;
  PetscScalar *to;
  PetscCall(MatShellGetContext(k, &s));
  PetscCall(VecGetArrayRead(x, &from));
  PetscCall(VecGetArrayWrite(y, &to));
  const PetscErrorCode failed = hr2dpi_transport_apply(&s->transport, from, to);
  PetscCall(VecRestoreArrayWrite(y, &to));
  PetscCall(VecRestoreArrayRead(x, &from));
  PetscCall(failed);
  PetscFunctionReturn(0);
}

static PetscErrorCode destroy(Mat k) {
  PetscFunctionBegin;
  hr2dpi_equation *s;
  PetscCall(MatShellGetContext(k, &s));
  hr2dp *p = s->p;
  hr2dpi_equation_clear(s);
  hr2dpi_free(p, s);
  PetscFunctionReturn(0);
}

static PetscErrorCode make_shell(hr2dp *p, hr2dpi_equation *s, Mat *k) {
  PetscFunctionBegin;
  const PetscInt size = (PetscInt)(p->trees.leaves * p->bands);
  PetscCall(MatCreateShell(p->comm, size, size, PETSC_DETERMINE, PETSC_DETERMINE, s, k));
  PetscCall(MatShellSetOperation(*k, MATOP_MULT, (void (*)(void))multiply));
  PetscCall(MatShellSetOperation(*k, MATOP_DESTROY, (void (*)(void))destroy));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dp_operator(hr2dp *p, const hr2d_solve_options *given, Mat *k) {
  PetscFunctionBegin;
  hr2d_solve_options options;
  hr2dpi_begin(p);
  PetscCheck(p->refined, p->comm, PETSC_ERR_ARG_WRONGSTATE, "there was no refinement");
  PetscCall(hr2dpi_agree(p, take_options(p, given, &options)));
  hr2dpi_equation *s = hr2dpi_alloc_zero(p, 1, sizeof *s);
  PetscErrorCode failed = hr2dpi_agree(p, s ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) failed = hr2dpi_equation_init(s, p, &options);
  if (!failed) failed = make_shell(p, s, k);
  if (failed && s) hr2dpi_equation_clear(s);
  if (failed) hr2dpi_free(p, s);
  PetscCall(failed);
  PetscFunctionReturn(0);
}
