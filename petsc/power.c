/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where lengths of patches differ much, a residual that is small in ∫B² may have much of the
   power of all light.  Then the residual is the source of a second solve, in the norm Σ (A B)²
   of powers, in which K is not self-adjoint; the sum of both solutions is the radiosity.  As in
   the library's equation-power.c. */
#include "equation.h"

/* Residuals of at most this part of ∫B are roundings; above the other one the solve fails. */
#define ROUNDING 1e-13
#define FAILED   1e-9

enum { ATTEMPTS = 3 };

/* Q + ρH − B */
static double residual_at(const hr2dpi_equation *s, size_t k) {
  return s->source[k] + s->root_rho[k] * s->root_rho[k] * s->irradiance[k] - s->radiosity[k];
}

/* The largest ∫|r|/∫|B| over the bands. */
static PetscErrorCode measure(hr2dpi_equation *s, double *off) {
  PetscFunctionBegin;
  hr2dp *p = s->p;
  *off = 0;
  for (size_t b = 0; b < p->bands; b++) {
    hr2dpi_sum sum[2] = {{{0}}, {{0}}};
    for (size_t k = 0; k < s->leaves; k++) {
      hr2dpi_sum_add(&sum[0], s->weight[k] * fabs(residual_at(s, k * p->bands + b)));
      hr2dpi_sum_add(&sum[1], s->weight[k] * fabs(s->radiosity[k * p->bands + b]));
    }
    PetscCall(hr2dpi_sum_all(p, sum, 2));
    const double residual = hr2dpi_sum_total(&sum[0]);
    if (residual > 0) *off = fmax(*off, residual / hr2dpi_sum_total(&sum[1]));
  }
  PetscFunctionReturn(0);
}

/* Takes the residual as the source, times a power of two that brings its power near 1. */
static PetscErrorCode set_source(hr2dpi_equation *s, const double *residual, double *max) {
  PetscFunctionBegin;
  const size_t bands = s->p->bands;
  for (size_t b = 0; b < bands; b++) max[b] = 0;
  for (size_t k = 0; k < s->field; k++)
    max[k % bands] = fmax(max[k % bands], fabs(s->weight[k / bands] * residual[k]));
  PetscCall(hr2dpi_max_doubles(s->p, max, (int)bands));
  for (size_t b = 0; b < bands; b++) max[b] = max[b] > 0 ? ilogb(max[b]) : 0;
  for (size_t k = 0; k < s->field; k++) s->source[k] = ldexp(residual[k], -(int)max[k % bands]);
  memset(s->y, 0, s->field * sizeof *s->y);
  PetscFunctionReturn(0);
}

/* Solves for the residual.  A solve that does not converge leaves the radiosity as it was; the
   caller measures again. */
static PetscErrorCode add_solution_in(hr2dpi_equation *s, double *space, double *exponent) {
  PetscFunctionBegin;
  const size_t bytes = s->field * sizeof *space;
  double *residual = space, *source = space + s->field, *radiosity = source + s->field;
  const int background = s->background;
  for (size_t k = 0; k < s->field; k++) residual[k] = residual_at(s, k);
  memcpy(source, s->source, bytes);
  memcpy(radiosity, s->radiosity, bytes);
  PetscCall(set_source(s, residual, exponent));
  s->background = 0;
  s->square = radiosity + s->field;
  for (size_t k = 0; k < s->leaves; k++) s->square[k] = s->weight[k] * s->weight[k];
  const PetscErrorCode failed = hr2dpi_equation_solve(s);
  s->square = NULL;
  s->background = background;
  memcpy(s->source, source, bytes);
  PetscCall(failed);
  for (size_t k = 0; k < s->field; k++)
    radiosity[k] += ldexp(s->radiosity[k], (int)exponent[k % s->p->bands]);
  PetscCall(hr2dpi_equation_set_unknown(s, radiosity));
  PetscCall(hr2dpi_equation_take(s));
  PetscFunctionReturn(0);
}

static PetscErrorCode add_solution(hr2dpi_equation *s) {
  PetscFunctionBegin;
  hr2dp *p = s->p;
  double *space = hr2dpi_alloc(p, 3 * s->field + s->leaves + p->bands, sizeof *space);
  PetscErrorCode failed = hr2dpi_agree(p, space ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) failed = add_solution_in(s, space, space + 3 * s->field + s->leaves);
  hr2dpi_free(p, space);
  PetscCall(failed);
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_equation_settle_power(hr2dpi_equation *s) {
  PetscFunctionBegin;
  const double wanted = fmax(ROUNDING, s->options.tolerance);
  hr2d_status status = HR2D_OK;
  double off = 0;
  for (int k = 0; k <= ATTEMPTS; k++) {
    PetscCall(measure(s, &off));
    if (off <= wanted || k == ATTEMPTS) break;
    PetscCall(add_solution(s));
  }
  if (!(off <= fmax(FAILED, s->options.tolerance)))
    status = hr2dpi_fail(s->p, HR2D_ENOT_CONVERGED,
                         "the residual has %.1e of the power of all light: the lengths of the "
                         "patches differ too much",
                         off);
  PetscCall(hr2dpi_agree(s->p, status));
  PetscFunctionReturn(0);
}

enum { EMITTED, RECEIVED, ABSORBED, ESCAPED, POWERS };

static void add_leaf(const hr2dpi_equation *s, size_t leaf, size_t band, hr2dpi_sum *sum) {
  const hr2dp *p = s->p;
  const size_t at = leaf * p->bands + band;
  const size_t patch = hr2d_hierarchy_elements(p->hierarchy)[p->trees.leaf[leaf]].patch;
  const double area = s->weight[leaf];
  const double sky = s->transport.sky ? s->transport.sky[leaf] * s->light[band] : 0;
  const double absorbance = 1 - hr2d_scene_reflectance(p->scene, patch, band);
  hr2dpi_sum_add(&sum[EMITTED], area * s->source[at]);
  hr2dpi_sum_add(&sum[RECEIVED], area * sky);
  hr2dpi_sum_add(&sum[ABSORBED], area * (absorbance * s->irradiance[at]));
  if (hr2dpi_balance_holds(&s->balance, leaf)) {
    hr2dpi_sum_add(&sum[ESCAPED], area * (s->balance.missing[leaf] * s->radiosity[at]));
    return;
  }
  hr2dpi_sum_add(&sum[ESCAPED], area * s->radiosity[at]);
  hr2dpi_sum_add(&sum[ESCAPED], -area * s->irradiance[at]);
  hr2dpi_sum_add(&sum[ESCAPED], area * sky);
}

PetscErrorCode hr2dpi_equation_power(hr2dpi_equation *s, hr2d_power *power) {
  PetscFunctionBegin;
  const double unit = hr2d_scene_unit(s->p->scene);
  for (size_t b = 0; b < s->p->bands; b++) {
    hr2dpi_sum sum[POWERS];
    double total[POWERS];
    memset(sum, 0, sizeof sum);
    for (size_t k = 0; k < s->leaves; k++) add_leaf(s, k, b, sum);
    PetscCall(hr2dpi_sum_all(s->p, sum, POWERS));
    for (int k = 0; k < POWERS; k++)
      total[k] = ldexp(unit * hr2dpi_sum_total(&sum[k]), s->exponent[b]);
    power[b] = (hr2d_power){total[EMITTED], total[RECEIVED], total[ABSORBED], total[ESCAPED]};
  }
  PetscFunctionReturn(0);
}
