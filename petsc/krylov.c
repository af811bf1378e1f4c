/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Conjugate gradients, and BiCGSTAB (van der Vorst 1992) where links are directed, as in the
   library.  A band that has converged gets step 0 from then on.  Inner products are exact sums,
   so that each scalar has the same bits for any number of ranks. */
#include "krylov.h"

#include <float.h>

PetscErrorCode hr2dpi_krylov_dot(const hr2dpi_krylov_system *system, const double *u,
                                 const double *v, double *product) {
  PetscFunctionBegin;
  hr2dp *p = system->p;
  const size_t bands = p->bands;
  hr2dpi_sum *sum = hr2dpi_alloc_zero(p, bands, sizeof *sum);
  PetscErrorCode failed = hr2dpi_agree(p, sum ? HR2D_OK : HR2D_ENOMEM);
  for (size_t k = 0; k < system->size * bands && !failed; k++)
    hr2dpi_sum_add(&sum[k % bands], system->weight[k / bands] * (u[k] * v[k]));
  if (!failed) failed = hr2dpi_sum_all(p, sum, bands);
  for (size_t b = 0; b < bands && !failed; b++) product[b] = hr2dpi_sum_total(&sum[b]);
  hr2dpi_free(p, sum);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

/* u += factor·v, per band. */
static void add(const hr2dpi_krylov_system *system, double *u, const double *factor,
                const double *v) {
  const size_t bands = system->p->bands;
  for (size_t k = 0; k < system->size * bands; k++) u[k] += factor[k % bands] * v[k];
}

/* u = v + factor·u, per band. */
static void scale_add(const hr2dpi_krylov_system *system, double *u, const double *factor,
                      const double *v) {
  const size_t bands = system->p->bands;
  for (size_t k = 0; k < system->size * bands; k++) u[k] = v[k] + factor[k % bands] * u[k];
}

/* out = (I − S) in */
static PetscErrorCode apply(const hr2dpi_krylov_system *system, const double *in, double *out) {
  PetscFunctionBegin;
  PetscCall(system->apply(system->ctx, in, out));
  for (size_t k = 0; k < system->size * system->p->bands; k++) out[k] = in[k] - out[k];
  PetscFunctionReturn(0);
}

enum { FIELDS = 5, SCALARS = 7 };

typedef struct state {
  const hr2dpi_krylov_system *system;
  size_t bands, size; /* of fields, too */
  double *y;
  double *field[FIELDS]; /* work space */
  double *scalar[SCALARS];
  double residual; /* the largest over the bands, relative */
  int done;        /* every band has converged */
  hr2d_status found;
} state;

/* Measures the residual r; active[b] becomes 1 if band b still needs work. */
static PetscErrorCode look(state *s, const double *r, double *active) {
  PetscFunctionBegin;
  double *square = s->scalar[1], *norm = s->scalar[2];
  PetscCall(hr2dpi_krylov_dot(s->system, r, r, square));
  PetscCall(s->system->scale(s->system->ctx, s->y, norm));
  s->residual = 0;
  s->done = 1;
  for (size_t b = 0; b < s->bands; b++) {
    const double size = sqrt(square[b]);
    active[b] = !(size <= s->system->tolerance * norm[b]);
    if (active[b] != 0) s->done = 0;
    if (!(size <= DBL_MAX)) s->found = HR2D_ENOT_CONVERGED;
    if (size > 0) s->residual = fmax(s->residual, size / norm[b]);
  }
  if (!s->found) PetscCall(s->system->report(s->system->ctx, s->residual));
  PetscFunctionReturn(0);
}

/* r = b − (I − S) y */
static PetscErrorCode form_residual(state *s, const double *b, double *r) {
  PetscFunctionBegin;
  PetscCall(apply(s->system, s->y, r));
  for (size_t k = 0; k < s->size; k++) r[k] = b[k] - r[k];
  PetscFunctionReturn(0);
}

static PetscErrorCode conjugate_step(state *s, double *active) {
  PetscFunctionBegin;
  const hr2dpi_krylov_system *system = s->system;
  double *r = s->field[0], *p = s->field[1], *q = s->field[2];
  double *rr = s->scalar[3], *pq = s->scalar[4], *step = s->scalar[5], *next = s->scalar[6];
  PetscCall(apply(system, p, q));
  PetscCall(hr2dpi_krylov_dot(system, p, q, pq));
  for (size_t c = 0; c < s->bands; c++) {
    if (active[c] != 0 && !(pq[c] > 0)) s->found = HR2D_ENOT_CONVERGED;
    step[c] = active[c] != 0 ? rr[c] / pq[c] : 0;
  }
  if (s->found) PetscFunctionReturn(0);
  add(system, s->y, step, p);
  for (size_t c = 0; c < s->bands; c++) step[c] = -step[c];
  add(system, r, step, q);
  PetscCall(hr2dpi_krylov_dot(system, r, r, next));
  for (size_t c = 0; c < s->bands; c++) {
    step[c] = rr[c] > 0 ? next[c] / rr[c] : 0;
    rr[c] = next[c];
  }
  scale_add(system, p, step, r);
  PetscFunctionReturn(0);
}

/* One BiCGSTAB iteration; r is the residual, r0 its first value, rho = <r0,r>. */
static PetscErrorCode stabilised_step(state *s, double *active) {
  PetscFunctionBegin;
  const hr2dpi_krylov_system *system = s->system;
  double *r = s->field[0], *p = s->field[1], *v = s->field[2], *t = s->field[3];
  const double *r0 = s->field[4];
  double *rho = s->scalar[3], *alpha = s->scalar[4], *omega = s->scalar[5],
         *other = s->scalar[6];
  PetscCall(apply(system, p, v));
  PetscCall(hr2dpi_krylov_dot(system, r0, v, other));
  for (size_t c = 0; c < s->bands; c++) {
    if (active[c] != 0 && other[c] == 0) s->found = HR2D_ENOT_CONVERGED;
    alpha[c] = active[c] != 0 ? rho[c] / other[c] : 0;
    other[c] = -alpha[c];
  }
  if (s->found) PetscFunctionReturn(0);
  add(system, s->y, alpha, p);
  add(system, r, other, v);
  PetscCall(apply(system, r, t));
  PetscCall(hr2dpi_krylov_dot(system, t, t, other));
  PetscCall(hr2dpi_krylov_dot(system, t, r, omega));
  for (size_t c = 0; c < s->bands; c++)
    omega[c] = active[c] != 0 && other[c] > 0 ? omega[c] / other[c] : 0;
  add(system, s->y, omega, r);
  for (size_t c = 0; c < s->bands; c++) omega[c] = -omega[c];
  add(system, r, omega, t);
  add(system, p, omega, v); /* p − ω v, to be scaled by β */
  PetscCall(hr2dpi_krylov_dot(system, r0, r, other));
  for (size_t c = 0; c < s->bands; c++) {
    const double beta = rho[c] * omega[c] != 0 ? -other[c] / rho[c] * (alpha[c] / omega[c]) : 0;
    rho[c] = other[c];
    other[c] = beta;
  }
  scale_add(system, p, other, r);
  PetscFunctionReturn(0);
}

static PetscErrorCode iterate(state *s, const double *b) {
  PetscFunctionBegin;
  const hr2dpi_krylov_system *system = s->system;
  double *r = s->field[0], *active = s->scalar[0];
  PetscCall(form_residual(s, b, r));
  memcpy(s->field[1], r, s->size * sizeof *r);
  memcpy(s->field[4], r, s->size * sizeof *r);
  PetscCall(hr2dpi_krylov_dot(system, r, r, s->scalar[3]));
  PetscCall(look(s, r, active));
  for (unsigned k = 0; !s->found && !s->done; k++) {
    if (k == system->max_iterations) {
      s->found = HR2D_ENOT_CONVERGED;
      break;
    }
    PetscCall((system->symmetric ? conjugate_step : stabilised_step)(s, active));
    if (!s->found) PetscCall(look(s, r, active));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_krylov(const hr2dpi_krylov_system *system, const double *b, double *y,
                             double *residual, hr2d_status *found) {
  PetscFunctionBegin;
  hr2dp *p = system->p;
  state s = {.system = system, .bands = p->bands, .size = system->size * p->bands, .y = y};
  double *space = hr2dpi_alloc_zero(p, FIELDS * s.size + SCALARS * s.bands, sizeof *space);
  PetscErrorCode failed = hr2dpi_agree(p, space ? HR2D_OK : HR2D_ENOMEM);
  for (size_t k = 0; k < FIELDS && !failed; k++) s.field[k] = space + k * s.size;
  for (size_t k = 0; k < SCALARS && !failed; k++)
    s.scalar[k] = space + FIELDS * s.size + k * s.bands;
  if (!failed) failed = iterate(&s, b);
  hr2dpi_free(p, space);
  *residual = s.residual;
  *found = s.found;
  PetscCall(failed);
  PetscFunctionReturn(0);
}
