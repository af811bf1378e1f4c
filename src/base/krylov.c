/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Conjugate gradients for symmetric systems, and BiCGSTAB (van der Vorst 1992) for the others,
   which directed links make.  Scalars are kept per band; a band that has converged gets step 0
   from then on. */
#include "base/krylov.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/ordered-dot.h"

/* Items between two declarations of work.  Once the watch has stopped, numbers have no
   meaning. */
enum { BATCH = 4096 };

static inline hr2d_status declare(const hr2di_krylov_system *system, size_t item) {
  return item % BATCH == 0 ? hr2di_watch_work(system->watch, BATCH / 64 * system->bands)
                           : HR2D_OK;
}

/* Of one band, in four partial sums: each addition waits for the one before. */
static double dot_one(const hr2di_krylov_system *system, const double *u, const double *v) {
  const double *w = system->weight;
  double s[4] = {0}, rest = 0;
  size_t k = 0;
  for (; k + 4 <= system->size && !declare(system, k); k += 4)
    for (size_t m = 0; m < 4; m++) s[m] += w[k + m] * (u[k + m] * v[k + m]);
  for (; k < system->size; k++) rest += w[k] * (u[k] * v[k]);
  return hr2di_dot_four(s[0], s[1], s[2], s[3]) + rest;
}

void hr2di_krylov_dot(const hr2di_krylov_system *system, const double *u, const double *v,
                      double *product) {
  const size_t bands = system->bands;
  if (bands == 1) {
    product[0] = dot_one(system, u, v);
    return;
  }
  memset(product, 0, bands * sizeof *product);
  for (size_t k = 0; k < system->size && !declare(system, k); k++)
    for (size_t b = 0; b < bands; b++)
      product[b] += system->weight[k] * (u[k * bands + b] * v[k * bands + b]);
}

/* u += factor·v, per band. */
static void add(const hr2di_krylov_system *system, double *u, const double *factor,
                const double *v) {
  const size_t bands = system->bands;
  for (size_t k = 0; k < system->size && !declare(system, k); k++)
    for (size_t b = 0; b < bands; b++) u[k * bands + b] += factor[b] * v[k * bands + b];
}

/* u = v + factor·u, per band. */
static void scale_add(const hr2di_krylov_system *system, double *u, const double *factor,
                      const double *v) {
  const size_t bands = system->bands;
  for (size_t k = 0; k < system->size && !declare(system, k); k++)
    for (size_t b = 0; b < bands; b++)
      u[k * bands + b] = v[k * bands + b] + factor[b] * u[k * bands + b];
}

/* out = (I − S) in */
static void apply(const hr2di_krylov_system *system, const double *in, double *out) {
  system->apply(system->ctx, in, out);
  if (hr2di_watch_work(system->watch, system->size * system->bands / 64)) return;
  for (size_t k = 0; k < system->size * system->bands; k++) out[k] = in[k] - out[k];
}

/* Fields that conjugate gradients and BiCGSTAB work with. */
enum { SYMMETRIC_FIELDS = 3, FIELDS = 5, SCALARS = 7 };

typedef struct state {
  const hr2di_krylov_system *system;
  double *y;
  double *field[FIELDS]; /* work space */
  double *scalar[SCALARS];
  double residual; /* the largest over the bands, relative */
  int done;        /* every band has converged */
} state;

/* r = b − (I − S) y.  A band whose y is farther off than 0 begins with 0: a start for other
   light would leave its roundings. */
static void form_residual(state *s, const double *b) {
  const hr2di_krylov_system *system = s->system;
  const size_t bands = system->bands, field = system->size * bands;
  double *r = s->field[0], *rr = s->scalar[1], *bb = s->scalar[2];
  size_t zeros = 0;
  while (zeros < field && s->y[zeros] == 0) zeros++;
  if (zeros == field) {
    memcpy(r, b, field * sizeof *r);
    return;
  }
  apply(system, s->y, r);
  for (size_t k = 0; k < field; k++) r[k] = b[k] - r[k];
  hr2di_krylov_dot(system, r, r, rr);
  hr2di_krylov_dot(system, b, b, bb);
  for (size_t k = 0; k < field; k++) {
    if (rr[k % bands] <= bb[k % bands]) continue;
    s->y[k] = 0;
    r[k] = b[k];
  }
}

/* Measures the residual r and passes it to `report`.  active[b] becomes 1 if band b still needs
   work, else 0. */
static hr2d_status measure(state *s, const double *r, double *active) {
  double *square = s->scalar[1], *norm = s->scalar[2];
  hr2di_krylov_dot(s->system, r, r, square);
  s->system->scale(s->system->ctx, s->y, norm);
  s->residual = 0;
  s->done = 1;
  for (size_t b = 0; b < s->system->bands; b++) {
    const double size = sqrt(square[b]);
    active[b] = !(size <= s->system->tolerance * norm[b]);
    if (active[b] != 0) s->done = 0;
    if (!(size <= DBL_MAX)) return HR2D_ENOT_CONVERGED;
    if (size > 0) s->residual = fmax(s->residual, size / norm[b]);
  }
  if (!s->done && s->system->enough) s->done = s->system->enough(s->system->ctx, r);
  return s->system->report(s->system->ctx, s->residual);
}

static hr2d_status conjugate_gradients(state *s, const double *b) {
  const hr2di_krylov_system *system = s->system;
  double *r = s->field[0], *p = s->field[1], *q = s->field[2];
  double *active = s->scalar[0], *rr = s->scalar[3], *pq = s->scalar[4], *step = s->scalar[5],
         *next = s->scalar[6];
  form_residual(s, b);
  memcpy(p, r, system->size * system->bands * sizeof *p);
  hr2di_krylov_dot(system, r, r, rr);
  hr2d_status status = measure(s, r, active);
  for (unsigned k = 0; !status && !s->done; k++) {
    if (k == system->max_iterations) return HR2D_ENOT_CONVERGED;
    apply(system, p, q);
    hr2di_krylov_dot(system, p, q, pq);
    for (size_t c = 0; c < system->bands; c++) {
      if (active[c] != 0 && !(pq[c] > 0)) return HR2D_ENOT_CONVERGED;
      step[c] = active[c] != 0 ? rr[c] / pq[c] : 0;
    }
    add(system, s->y, step, p);
    for (size_t c = 0; c < system->bands; c++) step[c] = -step[c];
    add(system, r, step, q);
    hr2di_krylov_dot(system, r, r, next);
    for (size_t c = 0; c < system->bands; c++) {
      step[c] = rr[c] > 0 ? next[c] / rr[c] : 0;
      rr[c] = next[c];
    }
    scale_add(system, p, step, r);
    status = measure(s, r, active);
  }
  return status;
}

/* One BiCGSTAB iteration; r is the residual, r0 its first value, rho = <r0,r>. */
static hr2d_status stabilised_step(state *s, const double *active, double *rho) {
  const hr2di_krylov_system *system = s->system;
  double *r = s->field[0], *p = s->field[1], *v = s->field[2], *t = s->field[3];
  const double *r0 = s->field[4];
  double *alpha = s->scalar[4], *omega = s->scalar[5], *other = s->scalar[6];
  apply(system, p, v);
  hr2di_krylov_dot(system, r0, v, other);
  for (size_t c = 0; c < system->bands; c++) {
    if (active[c] != 0 && other[c] == 0) return HR2D_ENOT_CONVERGED;
    alpha[c] = active[c] != 0 ? rho[c] / other[c] : 0;
    other[c] = -alpha[c];
  }
  add(system, s->y, alpha, p);
  add(system, r, other, v);
  apply(system, r, t);
  hr2di_krylov_dot(system, t, t, other);
  hr2di_krylov_dot(system, t, r, omega);
  for (size_t c = 0; c < system->bands; c++)
    omega[c] = active[c] != 0 && other[c] > 0 ? omega[c] / other[c] : 0;
  add(system, s->y, omega, r);
  for (size_t c = 0; c < system->bands; c++) omega[c] = -omega[c];
  add(system, r, omega, t);
  add(system, p, omega, v); /* p − ω v, to be scaled by β */
  hr2di_krylov_dot(system, r0, r, other);
  for (size_t c = 0; c < system->bands; c++) {
    const double beta = rho[c] * omega[c] != 0 ? -other[c] / rho[c] * (alpha[c] / omega[c]) : 0;
    rho[c] = other[c];
    other[c] = beta;
  }
  scale_add(system, p, other, r);
  return HR2D_OK;
}

static hr2d_status stabilised_gradients(state *s, const double *b) {
  const hr2di_krylov_system *system = s->system;
  const size_t bytes = system->size * system->bands * sizeof(double);
  double *r = s->field[0], *active = s->scalar[0], *rho = s->scalar[3];
  form_residual(s, b);
  memcpy(s->field[1], r, bytes);
  memcpy(s->field[4], r, bytes);
  hr2di_krylov_dot(system, r, r, rho);
  hr2d_status status = measure(s, r, active);
  for (unsigned k = 0; !status && !s->done; k++) {
    if (k == system->max_iterations) return HR2D_ENOT_CONVERGED;
    status = stabilised_step(s, active, rho);
    if (!status) status = measure(s, r, active);
  }
  return status;
}

hr2d_status hr2di_krylov(const hr2di_krylov_system *system, const double *b, double *y,
                         double *residual) {
  state s = {.system = system, .y = y};
  const size_t field = system->size * system->bands,
               fields = system->symmetric ? SYMMETRIC_FIELDS : FIELDS;
  double *space =
      hr2di_alloc_zero(system->alloc, fields * field + SCALARS * system->bands, sizeof *space);
  if (!space) return HR2D_ENOMEM;
  for (size_t k = 0; k < fields; k++) s.field[k] = space + k * field;
  for (size_t k = 0; k < SCALARS; k++) s.scalar[k] = space + fields * field + k * system->bands;
  const hr2d_status status =
      system->symmetric ? conjugate_gradients(&s, b) : stabilised_gradients(&s, b);
  *residual = s.residual;
  hr2di_alloc_free(system->alloc, space);
  return hr2di_watch_status(system->watch) ? hr2di_watch_status(system->watch) : status;
}
