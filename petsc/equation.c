/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "equation.h"

#include <float.h>

static uint32_t patch_of(const hr2dpi_equation *s, size_t leaf) {
  const hr2dp *p = s->p;
  return hr2d_hierarchy_elements(p->hierarchy)[p->trees.leaf[leaf]].patch;
}

/* Powers of two that bring the light of each band near 1; the same on all ranks. */
static void set_exponents(hr2dpi_equation *s) {
  const hr2dp *p = s->p;
  for (size_t b = 0; b < p->bands; b++) {
    double max = hr2d_scene_background(p->scene, b);
    for (size_t k = 0; k < p->patches; k++)
      max = fmax(max, fabs(hr2d_scene_emission(p->scene, k, b)));
    s->exponent[b] = max > 0 ? ilogb(max) : 0;
    s->light[b] = ldexp(hr2d_scene_background(p->scene, b), -s->exponent[b]);
  }
}

static void set_leaves(hr2dpi_equation *s) {
  const hr2dp *p = s->p;
  const hr2d_element *element = hr2d_hierarchy_elements(p->hierarchy);
  for (size_t k = 0; k < s->leaves; k++) {
    s->weight[k] = element[p->trees.leaf[k]].length;
    for (size_t b = 0; b < p->bands; b++) {
      const size_t at = k * p->bands + b, patch = patch_of(s, k);
      s->source[at] = ldexp(hr2d_scene_emission(p->scene, patch, b), -s->exponent[b]);
      s->root_rho[at] = sqrt(hr2d_scene_reflectance(p->scene, patch, b));
    }
  }
}

static hr2d_status reserve(hr2dpi_equation *s) {
  const hr2dp *p = s->p;
  s->leaves = p->trees.leaves;
  s->field = s->leaves * p->bands;
  s->exponent = hr2dpi_alloc(p, p->bands, sizeof *s->exponent);
  s->space = hr2dpi_alloc_zero(p, s->leaves + 7 * s->field + 3 * p->bands, sizeof *s->space);
  if (!s->space || !s->exponent) return HR2D_ENOMEM;
  double **const field[] = {&s->source, &s->root_rho, &s->radiosity, &s->irradiance,
                            &s->y,      &s->b,        &s->work};
  s->weight = s->space;
  for (size_t k = 0; k < 7; k++) *field[k] = s->space + s->leaves + k * s->field;
  s->norm[0] = s->space + s->leaves + 7 * s->field;
  s->norm[1] = s->norm[0] + p->bands;
  s->light = s->norm[1] + p->bands;
  set_exponents(s);
  set_leaves(s);
  return hr2dpi_transport_init(&s->transport, s->p);
}

PetscErrorCode hr2dpi_equation_init(hr2dpi_equation *s, hr2dp *p,
                                    const hr2d_solve_options *options) {
  PetscFunctionBegin;
  const int closure = options->closure != HR2D_CLOSURE_OFF;
  *s = (hr2dpi_equation){.p = p, .options = *options, .background = 1};
  if (!(s->options.tolerance > 0)) s->options.tolerance = HR2D_DEFAULT_TOLERANCE;
  if (!s->options.max_iterations) s->options.max_iterations = HR2D_DEFAULT_MAX_ITERATIONS;
  PetscCall(hr2dpi_agree(p, reserve(s)));
  PetscCall(hr2dpi_exchange_find(&s->exchange, p));
  PetscCall(hr2dpi_agree(p, hr2dpi_exchange_check(&s->exchange, p)));
  PetscCall(hr2dpi_agree(
      p, hr2dpi_transport_join(&s->transport, s->exchange.number, s->exchange.count)));
  PetscCall(hr2dpi_closure_set(&s->transport, &s->exchange, closure));
  if (s->transport.closure && !p->directed)
    PetscCall(hr2dpi_balance_init(&s->balance, &s->transport, &s->exchange));
  PetscFunctionReturn(0);
}

void hr2dpi_equation_clear(hr2dpi_equation *s) {
  if (!s->p) return;
  hr2dpi_balance_clear(&s->balance);
  hr2dpi_transport_clear(&s->transport);
  hr2dpi_exchange_clear(&s->exchange, s->p);
  hr2dpi_free(s->p, s->space);
  hr2dpi_free(s->p, s->exponent);
}

/* out = √ρ K √ρ in */
static PetscErrorCode apply(void *ctx, const double *in, double *out) {
  PetscFunctionBegin;
  hr2dpi_equation *s = ctx;
  for (size_t k = 0; k < s->field; k++) s->work[k] = s->root_rho[k] * in[k];
  PetscCall(hr2dpi_transport_apply(&s->transport, s->work, out));
  for (size_t k = 0; k < s->field; k++) out[k] *= s->root_rho[k];
  PetscFunctionReturn(0);
}

static double level_of(const hr2dpi_equation *s, size_t k) {
  return hr2dpi_balance_at(&s->balance, k / s->p->bands, k % s->p->bands);
}

/* out = z = Q' + √ρ y */
static void set_fluctuation(hr2dpi_equation *s, const double *y, double *out) {
  for (size_t k = 0; k < s->field; k++) {
    const double rho =
        hr2d_scene_reflectance(s->p->scene, patch_of(s, k / s->p->bands), k % s->p->bands);
    out[k] = s->source[k] - (1 - rho) * level_of(s, k);
    if (y) out[k] += s->root_rho[k] * y[k];
  }
}

static hr2dpi_krylov_system make_system(hr2dpi_equation *s);

/* The norms of B = c + z. */
static PetscErrorCode scale(void *ctx, const double *y, double *norm) {
  PetscFunctionBegin;
  hr2dpi_equation *s = ctx;
  const hr2dpi_krylov_system system = make_system(s);
  set_fluctuation(s, y, s->radiosity);
  for (size_t k = 0; k < s->field; k++) s->radiosity[k] += level_of(s, k);
  PetscCall(hr2dpi_krylov_dot(&system, s->radiosity, s->radiosity, norm));
  for (size_t b = 0; b < s->p->bands; b++) norm[b] = sqrt(norm[b]);
  PetscFunctionReturn(0);
}

/* Rank 0 asks whether to go on. */
static PetscErrorCode report(void *ctx, double residual) {
  PetscFunctionBegin;
  hr2dpi_equation *s = ctx;
  const double digits = residual > 0 ? log(residual) / log(s->options.tolerance) : 1;
  const hr2d_progress told = {sizeof told,
                              "solve",
                              s->p->counts.whole.elements,
                              s->p->counts.whole.links,
                              fmin(fmax(digits, 0), 1),
                              residual};
  hr2d_status status = HR2D_OK;
  s->looks++;
  if (s->p->rank == 0 && s->options.progress)
    status = s->options.progress(s->options.progress_ctx, &told);
  PetscCall(hr2dpi_agree(s->p, status));
  PetscFunctionReturn(0);
}

static hr2dpi_krylov_system make_system(hr2dpi_equation *s) {
  return (hr2dpi_krylov_system){.p = s->p,
                                .size = s->leaves,
                                .weight = s->square ? s->square : s->weight,
                                .symmetric = !s->p->directed && !s->square,
                                .apply = apply,
                                .scale = scale,
                                .report = report,
                                .ctx = s,
                                .tolerance = s->options.tolerance,
                                .max_iterations = s->options.max_iterations};
}

/* h = Kz + S − mc */
static PetscErrorCode gather_rest(hr2dpi_equation *s, const double *z, double *out) {
  PetscFunctionBegin;
  const hr2dpi_transport *t = &s->transport;
  const size_t bands = s->p->bands;
  PetscCall(hr2dpi_transport_apply(&s->transport, z, out));
  for (size_t k = 0; k < s->field; k++) {
    if (s->background && t->sky) out[k] += t->sky[k / bands] * s->light[k % bands];
    if (s->balance.count > 0) out[k] -= s->balance.missing[k / bands] * level_of(s, k);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode balance_source(hr2dpi_equation *s) {
  PetscFunctionBegin;
  PetscCall(hr2dpi_balance_set(&s->balance, s->source, s->background ? s->light : NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_equation_set_unknown(hr2dpi_equation *s, const double *radiosity) {
  PetscFunctionBegin;
  PetscCall(balance_source(s));
  for (size_t k = 0; k < s->field; k++)
    s->y[k] = s->root_rho[k] > 0 ? (radiosity[k] - s->source[k]) / s->root_rho[k] -
                                       s->root_rho[k] * level_of(s, k)
                                 : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_equation_start(hr2dpi_equation *s, const double *radiosity) {
  PetscFunctionBegin;
  double upper = 0;
  for (size_t k = 0; k < s->field; k++) {
    s->radiosity[k] = ldexp(radiosity[k], -s->exponent[k % s->p->bands]);
    upper = isfinite(radiosity[k]) ? fmax(upper, fabs(radiosity[k])) : HUGE_VAL;
  }
  PetscCall(hr2dpi_max_doubles(s->p, &upper, 1));
  if (!isfinite(upper))
    PetscCall(hr2dpi_agree(s->p, hr2dpi_fail(s->p, HR2D_EINVAL, "the start is not finite")));
  if (upper > 0) PetscCall(hr2dpi_equation_set_unknown(s, s->radiosity));
  PetscFunctionReturn(0);
}

static hr2d_status describe(hr2dpi_equation *s, hr2d_status found, double residual) {
  if (!found) return found;
  if (s->looks <= s->options.max_iterations)
    return hr2dpi_fail(
        s->p, found,
        "after %llu iterations I − ρK is found not to be positive definite: rows "
        "of the links exceed 1, and closure or finer links are needed",
        (unsigned long long)s->looks);
  return hr2dpi_fail(
      s->p, found, "the relative residual is %.1e where %.1e was asked for, after %llu gathers",
      residual, s->options.tolerance, (unsigned long long)s->transport.sweeps);
}

PetscErrorCode hr2dpi_equation_solve(hr2dpi_equation *s) {
  PetscFunctionBegin;
  double residual = 0;
  hr2d_status found = HR2D_OK;
  PetscCall(balance_source(s));
  set_fluctuation(s, NULL, s->radiosity);
  PetscCall(gather_rest(s, s->radiosity, s->irradiance));
  for (size_t k = 0; k < s->field; k++) s->b[k] = s->root_rho[k] * s->irradiance[k];
  const hr2dpi_krylov_system system = make_system(s);
  PetscCall(hr2dpi_krylov(&system, s->b, s->y, &residual, &found));
  PetscCall(hr2dpi_agree(s->p, describe(s, found, residual)));
  PetscCall(hr2dpi_equation_take(s));
  PetscFunctionReturn(0);
}

/* H = c + h with c corrected, and B = Q + ρH. */
static PetscErrorCode balance(hr2dpi_equation *s) {
  PetscFunctionBegin;
  PetscCall(hr2dpi_balance_correct(&s->balance, s->source, s->irradiance));
  for (size_t k = 0; k < s->field; k++) {
    s->irradiance[k] += level_of(s, k);
    if (hr2dpi_balance_holds(&s->balance, k / s->p->bands))
      s->radiosity[k] = s->source[k] + s->root_rho[k] * s->root_rho[k] * s->irradiance[k];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_equation_take(hr2dpi_equation *s) {
  PetscFunctionBegin;
  set_fluctuation(s, s->y, s->radiosity);
  PetscCall(gather_rest(s, s->radiosity, s->irradiance));
  if (s->balance.count > 0) PetscCall(balance(s));
  PetscFunctionReturn(0);
}

/* With B = c + z the defect is Q − (1−ρ)c + ρ(Kz + S − mc) − z. */
static PetscErrorCode find_defect(hr2dpi_equation *s, double *out) {
  PetscFunctionBegin;
  for (size_t k = 0; k < s->field; k++) s->work[k] = s->radiosity[k] - level_of(s, k);
  PetscCall(gather_rest(s, s->work, out));
  for (size_t k = 0; k < s->field; k++)
    out[k] = s->root_rho[k] * s->root_rho[k] * out[k] - s->work[k];
  set_fluctuation(s, NULL, s->work);
  for (size_t k = 0; k < s->field; k++) out[k] += s->work[k];
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_equation_residual(hr2dpi_equation *s, double *residual) {
  PetscFunctionBegin;
  const hr2dpi_krylov_system system = make_system(s);
  if (s->balance.count > 0)
    PetscCall(find_defect(s, s->y));
  else
    for (size_t k = 0; k < s->field; k++)
      s->y[k] =
          s->source[k] + s->root_rho[k] * s->root_rho[k] * s->irradiance[k] - s->radiosity[k];
  PetscCall(hr2dpi_krylov_dot(&system, s->y, s->y, s->norm[0]));
  PetscCall(hr2dpi_krylov_dot(&system, s->radiosity, s->radiosity, s->norm[1]));
  *residual = 0;
  for (size_t b = 0; b < s->p->bands; b++)
    if (s->norm[0][b] > 0) *residual = fmax(*residual, sqrt(s->norm[0][b] / s->norm[1][b]));
  PetscFunctionReturn(0);
}

/* Parts of the largest B below which a negative one is a rounding, and of the background's
   light that are roundings of row sums. */
#define ROUNDING     1e-6
#define ROW_ROUNDING 1e-12

static int has_taker(const hr2dp *p) {
  for (size_t k = 0; k < p->patches; k++)
    if (hr2d_scene_emission(p->scene, k, 0) < 0) return 1;
  return 0;
}

static hr2d_status refuse_averages(hr2dpi_equation *s, const double *average) {
  size_t lowest = 0;
  double high = 0;
  for (size_t k = 0; k < s->p->patches; k++) {
    high = fmax(high, average[k]);
    if (average[k] < average[lowest]) lowest = k;
  }
  if (average[lowest] >= -ROUNDING * high && (average[lowest] >= 0 || high > 0)) return HR2D_OK;
  return hr2dpi_fail(
      s->p, HR2D_ENO_SOLUTION,
      "no solution: patch %zu would send a negative radiosity, %.4g: the negative "
      "fluxes of the scene take away more heat than there is",
      lowest, ldexp(average[lowest], s->exponent[0]));
}

/* With a negative flux averages tell whether so much heat can leave a patch; such scenes have
   one band. */
static PetscErrorCode check_averages(hr2dpi_equation *s) {
  PetscFunctionBegin;
  hr2dp *p = s->p;
  double *average = hr2dpi_alloc(p, p->patches, p->bands * sizeof *average);
  PetscErrorCode failed = hr2dpi_agree(p, average ? HR2D_OK : HR2D_ENOMEM);
  if (!failed) failed = hr2dpi_transport_patch_averages(&s->transport, s->radiosity, average);
  const hr2d_status status = failed ? HR2D_OK : refuse_averages(s, average);
  hr2dpi_free(p, average);
  PetscCall(failed);
  PetscCall(hr2dpi_agree(p, status));
  PetscFunctionReturn(0);
}

PetscErrorCode hr2dpi_equation_check_sign(hr2dpi_equation *s) {
  PetscFunctionBegin;
  hr2dp *p = s->p;
  hr2d_status status = HR2D_OK;
  if (has_taker(p)) {
    PetscCall(check_averages(s));
    PetscFunctionReturn(0);
  }
  for (size_t b = 0; b < p->bands && !status; b++) {
    double ends[2] = {0, 0}; /* of −B and of B */
    for (size_t k = b; k < s->field; k += p->bands) {
      ends[0] = fmax(ends[0], -s->radiosity[k]);
      ends[1] = fmax(ends[1], s->radiosity[k]);
    }
    PetscCall(hr2dpi_max_doubles(p, ends, 2));
    const double high = fmax(ends[1], ROW_ROUNDING / ROUNDING * s->light[b]);
    if (ends[0] > ROUNDING * high || (ends[0] > 0 && high == 0))
      status =
          hr2dpi_fail(p, HR2D_ENOT_CONVERGED,
                      "in band %zu the links reflect more light than falls on them, so that "
                      "it grows for ever: closure or finer links are needed",
                      b);
  }
  PetscCall(hr2dpi_agree(p, status));
  PetscFunctionReturn(0);
}
