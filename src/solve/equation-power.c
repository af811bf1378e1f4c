/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual in the norm ∫|r|.

   The iteration ends by the norm ∫B², in which a patch with little radiosity and a large length
   counts for nothing, although its power ∫B may be that of all others: B = 1 on a length of 1
   and 1e-75 on one of 1e75.  So the residual is measured by its power, too.  If it is too
   large, it becomes the source of a second solve, in the norm ∑ (A B)² of powers.  There K is
   not self-adjoint, which takes BiCGSTAB.  The sum of both solutions is the radiosity. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/neumaier-sum.h"
#include "solve/equation.h"

/* Residuals of at most this part of ∫B are roundings; above the other one the solve fails. */
#define ROUNDING 1e-13
#define FAILED   1e-9

enum { ATTEMPTS = 3 };

/* Sets `work` to ρH. */
static void scatter(hr2di_equation *s) {
  memcpy(s->work, s->irradiance, s->field * sizeof *s->work);
  hr2di_equation_scatter(s, s->work);
}

/* Q + ρH − B, after scatter(). */
static double residual_at(const hr2di_equation *s, size_t k) {
  return s->source[k] + s->work[k] - s->radiosity[k];
}

/* The largest ∫|r|/∫|B| over the bands. */
static double measure(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  double max = 0;
  scatter(s);
  for (size_t b = 0; b < t->bands; b++) {
    hr2di_sum off = {0, 0}, all = {0, 0};
    for (size_t k = 0; k < t->leaves; k++) {
      const double area = s->weight[k * t->order];
      hr2di_sum_add(&off, area * fabs(residual_at(s, k * t->width + b)));
      hr2di_sum_add(&all, area * fabs(s->radiosity[k * t->width + b]));
    }
    if (hr2di_sum_total(&off) > 0)
      max = fmax(max, hr2di_sum_total(&off) / hr2di_sum_total(&all));
  }
  return max;
}

/* Takes the residual as the source, times a power of two that brings its power near 1. */
static void set_source(hr2di_equation *s, const double *residual, int *exponent) {
  const size_t bands = s->transport.bands;
  for (size_t b = 0; b < bands; b++) {
    double max = 0;
    for (size_t k = b; k < s->field; k += bands)
      max = fmax(max, fabs(s->weight[k / bands] * residual[k]));
    exponent[b] = max > 0 ? ilogb(max) : 0;
    for (size_t k = b; k < s->field; k += bands)
      s->source[k] = ldexp(residual[k], -exponent[b]);
  }
  memset(s->y, 0, s->field * sizeof *s->y);
}

/* y = (B − Q)/√ρ, less √ρ c in balanced components. */
static void set_unknown(hr2di_equation *s, const double *radiosity) {
  const hr2di_transport *t = &s->transport;
  hr2di_equation_balance(s);
  for (size_t k = 0; k < s->field; k++) {
    const size_t m = k % t->width;
    const double c = m < t->bands ? hr2di_balance_at(&s->balance, t, k / t->width, m) : 0;
    s->y[k] = s->root_rho[k] > 0
                  ? (radiosity[k] - s->source[k]) / s->root_rho[k] - s->root_rho[k] * c
                  : 0;
  }
  hr2di_equation_set_panes_unknown(s, radiosity);
}

/* Adds the solution for the residual to the radiosity.  `space` holds three fields and the
   squares of A. */
static hr2d_status add_solution_in(hr2di_equation *s, double *space, int *exponent) {
  const size_t bytes = s->field * sizeof *space;
  double *residual = space, *source = space + s->field, *radiosity = source + s->field;
  const int background = s->background;
  scatter(s);
  for (size_t k = 0; k < s->field; k++) residual[k] = residual_at(s, k);
  memcpy(source, s->source, bytes);
  memcpy(radiosity, s->radiosity, bytes);
  set_source(s, residual, exponent);
  s->background = 0;
  s->square = radiosity + s->field;
  for (size_t k = 0; k < s->items; k++) s->square[k] = s->weight[k] * s->weight[k];
  hr2d_status status = hr2di_equation_solve(s);
  s->square = NULL;
  s->background = background;
  memcpy(s->source, source, bytes);
  for (size_t k = 0; k < s->field && !status; k++)
    radiosity[k] += ldexp(s->radiosity[k], exponent[k % s->transport.bands]);
  set_unknown(s, radiosity);
  const hr2d_status taken = hr2di_equation_take(s);
  return status ? status : taken;
}

static hr2d_status add_solution(hr2di_equation *s) {
  const hr2d_allocator *alloc = &s->links->alloc;
  double *space = hr2di_alloc(alloc, 3 * s->field + s->items, sizeof *space);
  int *exponent = hr2di_alloc(alloc, s->transport.bands, sizeof *exponent);
  const hr2d_status status =
      space && exponent ? add_solution_in(s, space, exponent) : HR2D_ENOMEM;
  hr2di_alloc_free(alloc, space);
  hr2di_alloc_free(alloc, exponent);
  return status;
}

hr2d_status hr2di_equation_settle_power(hr2di_equation *s) {
  hr2d_status status = HR2D_OK;
  double off = 0;
  for (int k = 0; k <= ATTEMPTS && !status; k++) {
    off = measure(s);
    if (off <= fmax(ROUNDING, fmax(s->options.tolerance, s->enough.part)) || k == ATTEMPTS)
      break;
    status = add_solution(s);
  }
  if (status == HR2D_ENOT_CONVERGED && off <= FAILED) status = HR2D_OK;
  if (!status && !(off <= fmax(FAILED, fmax(s->options.tolerance, s->enough.part))))
    status = hr2di_message_fail(&s->links->message, HR2D_ENOT_CONVERGED,
                                "the residual has %.1e of the power of all light: the lengths "
                                "of the patches differ too much",
                                off);
  return status;
}
