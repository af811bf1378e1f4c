/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/heat-balance.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/black-body.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/linkset-impl.h"
#include "scene/emissivity.h"
#include "solve/closure.h"

/* B and H are accurate to 1e-13, and Newton's method needs no more of its steps than that each
   gains some digits. */
#define BALANCED   1e-13
#define ROUNDINGS  1e-10
#define STEP_ERROR 1e-5
#define STEP_SOLVE 1e-8

/* Of what E gains with S, against that of a constant ε. */
#define LEAST_SLOPE 0.05

/* Work for the parts of the black body of a band, in units of a watch. */
enum { PLANCK = 10 };

enum { ARRAYS = 9, ROOTS = 100, STEPS = 50, HALVINGS = 8, MOST_SOLVES = 2000 };

static int is_unknown(const hr2d_scene *scene, size_t k) {
  return hr2di_scene_has_flux(scene, k) && hr2di_scene_lit(scene, k);
}

/* Of the sides of a shield the first one has its unknown. */
static int is_back(const hr2d_scene *scene, size_t k) {
  return hr2di_shield_is(scene, k) && hr2di_scene_other_side(scene, k) < k;
}

/* Sets the sides: those of unknowns in the order of patches, then the backs in the order of
   their fronts. */
static void list_sides(hr2di_heat_balance *h) {
  const hr2d_scene *scene = h->scene;
  size_t at = 0;
  for (size_t k = 0; k < hr2di_scene_cell(scene); k++) {
    if (!is_unknown(scene, k) || is_back(scene, k)) continue;
    h->depends |= hr2di_emissivity_depends(hr2di_scene_origin(scene), k);
    h->length[at] = scene->patch[k].length;
    h->radiance[at] = scene->found[k].radiance;
    h->back[at] = HR2DI_NO_BACK;
    h->of[at] = at;
    h->patch[at++] = k;
  }
  for (size_t k = 0; k < h->count; k++) {
    if (!hr2di_shield_is(scene, h->patch[k])) continue;
    h->back[k] = at;
    h->of[at] = k;
    h->patch[at++] = hr2di_scene_other_side(scene, h->patch[k]);
  }
}

static hr2d_status reserve(hr2di_heat_balance *h) {
  const hr2d_scene *scene = h->scene;
  const size_t cell = hr2di_scene_cell(scene);
  for (size_t k = 0; k < cell; k++) {
    h->sides += (size_t)is_unknown(scene, k);
    h->count += (size_t)(is_unknown(scene, k) && !is_back(scene, k));
  }
  h->patch = hr2di_alloc(&scene->alloc, 3 * h->sides + 1, sizeof *h->patch);
  h->space = hr2di_alloc_zero(
      &scene->alloc, ARRAYS * h->count + 2 * scene->bands * h->sides + 1, sizeof *h->space);
  h->average = hr2di_alloc(&scene->alloc, scene->patches * scene->bands, sizeof *h->average);
  if (!h->patch || !h->space || !h->average) return HR2D_ENOMEM;
  double **const array[ARRAYS] = {&h->radiance, &h->defect, &h->size,  &h->slope, &h->length,
                                  &h->step,     &h->old,    &h->right, &h->gain};
  for (size_t k = 0; k < ARRAYS; k++) *array[k] = h->space + k * h->count;
  h->emission = h->space + ARRAYS * h->count;
  h->rise = h->emission + scene->bands * h->sides;
  h->of = h->patch + h->sides;
  h->back = h->of + h->sides;
  list_sides(h);
  return HR2D_OK;
}

hr2d_status hr2di_heat_balance_init(hr2di_heat_balance *h, hr2d_scene *frozen,
                                    hr2d_linkset *links, const hr2d_solve_options *options) {
  *h = (hr2di_heat_balance){.scene = frozen};
  const hr2di_equation_how how = hr2di_equation_how_of(links);
  hr2d_status status = hr2di_equation_init(&h->eq, links, frozen, &how, options);
  if (!status) status = reserve(h);
  if (status) hr2di_message_fail(&links->message, status, "%s", hr2d_strerror(status));
  return status;
}

void hr2di_heat_balance_clear(hr2di_heat_balance *h) {
  hr2di_equation_clear(&h->eq);
  hr2di_alloc_free(&h->scene->alloc, h->patch);
  hr2di_alloc_free(&h->scene->alloc, h->space);
  hr2di_alloc_free(&h->scene->alloc, h->average);
}

/* E of the scene, or what h->emission has of the unknown patches alone. */
static hr2d_status set_source(hr2di_heat_balance *h, int alone) {
  hr2di_equation *eq = &h->eq;
  const hr2di_transport *t = &eq->transport;
  const size_t bands = t->bands;
  double *of = h->average; /* of patches, for a while */
  for (size_t k = 0; k < h->scene->patches; k++)
    for (size_t b = 0; b < bands; b++)
      of[k * bands + b] = alone ? 0 : hr2d_scene_emission(h->scene, k, b);
  for (size_t m = 0; m < h->sides * bands && alone; m++)
    of[h->patch[m / bands] * bands + m % bands] = h->emission[m];
  memset(eq->source, 0, eq->field * sizeof *eq->source);
  memset(eq->y, 0, eq->field * sizeof *eq->y);
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t b = 0; b < bands; b++)
      eq->source[k * t->width + b] =
          ldexp(of[t->hierarchy->element[t->leaf[k]].patch * bands + b], -eq->exponent[b]);
  return hr2di_watch_work(&eq->watch, (h->scene->patches + t->leaves * t->order) * bands / 2);
}

hr2d_status hr2di_heat_balance_source(hr2di_heat_balance *h,
                                      const hr2d_solve_options *options) {
  h->eq.background = 1;
  h->eq.residuals = 0;
  h->eq.options.tolerance =
      options->tolerance > 0 ? options->tolerance : HR2D_DEFAULT_TOLERANCE;
  return set_source(h, 0);
}

/* The averages of a leaf field over patches. */
static hr2d_status take_averages(hr2di_heat_balance *h, const double *field, double *average) {
  hr2di_transport *t = &h->eq.transport;
  const size_t values = h->scene->patches * t->bands;
  hr2di_transport_pull(t, field);
  for (size_t m = 0; m < values; m++)
    average[m] =
        ldexp(t->up[m / t->bands * t->width + m % t->bands], h->eq.exponent[m % t->bands]);
  return t->failed ? t->failed : hr2di_watch_work(&h->eq.watch, values / 4);
}

static hr2d_status solve(hr2di_heat_balance *h, int alone) {
  hr2di_equation *eq = &h->eq;
  hr2d_status status = set_source(h, alone);
  eq->background = !alone;
  eq->residuals = 0;
  eq->options.tolerance = alone ? STEP_SOLVE : HR2D_DEFAULT_TOLERANCE;
  if (!status) status = hr2di_equation_solve(eq);
  if (!status && !alone) status = hr2di_equation_settle_power(eq);
  if (status) return status;
  h->solves++;
  hr2di_closure_move_mean(&eq->transport, eq->radiosity, eq->irradiance);
  return take_averages(h, eq->irradiance, h->average);
}

/* E and ρ for h->radiance. */
static hr2d_status set_radiance(hr2di_heat_balance *h) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < h->sides && !status; k++) {
    status = hr2di_watch_work(&h->eq.watch, PLANCK * h->scene->bands);
    if (status) break;
    status = hr2di_frozen_set(h->scene, h->patch[k], h->radiance[h->of[k]]);
    if (status)
      hr2di_message_fail(
          &h->eq.links->message, status,
          "the function of the emissivity of %s gives a value that is not in (0,1]",
          hr2di_patch_label(h->scene, h->patch[k]).text);
  }
  return status || !h->depends ? status : hr2di_equation_set_surfaces(&h->eq);
}

/* ∂E_b/∂S, with the change of ε of what is absorbed and sent back: where ε depends on T, B has
   ε'(f_b S − H̄_b) besides. */
static double rise_of(const hr2di_heat_balance *h, size_t patch, size_t band) {
  const double rise = hr2di_frozen_rise(h->scene, patch, band);
  const double radiance = h->scene->found[patch].radiance;
  const hr2d_scene *scene = hr2di_scene_origin(h->scene);
  if (!(radiance > 0) || !hr2di_emissivity_depends(scene, patch)) return rise;
  const double kelvin = hr2di_black_body_kelvin(radiance);
  const double black = hr2d_scene_emission(h->scene, patch, band) /
                       (1 - hr2d_scene_reflectance(h->scene, patch, band));
  return rise + hr2di_emissivity_slope(scene, patch, band, kelvin) / (4 * radiance) *
                    (black - h->average[patch * h->scene->bands + band]);
}

/* D and E' of an unknown patch.  With an ε that falls so fast that heat would not rise with T,
   they are those of a constant ε. */
static void set_slope(hr2di_heat_balance *h, size_t k) {
  const size_t bands = h->scene->bands;
  double plain = 0;
  h->slope[k] = 0;
  for (int m = 0; hr2di_heat_side(h, k, m) != HR2DI_NO_BACK; m++)
    for (size_t b = 0, s = hr2di_heat_side(h, k, m); b < bands; b++) {
      h->rise[s * bands + b] = rise_of(h, h->patch[s], b);
      h->slope[k] += h->rise[s * bands + b];
      plain += hr2di_frozen_rise(h->scene, h->patch[s], b);
    }
  if (h->slope[k] >= LEAST_SLOPE * plain) return;
  for (size_t b = 0; b < bands; b++) /* only where ε depends on T, as on no shield */
    h->rise[k * bands + b] = hr2di_frozen_rise(h->scene, h->patch[k], b);
  h->slope[k] = plain;
}

/* Adds Σ_b (E_b − a_b H̄_b) of a side to g of its unknown. */
static void add_defect(hr2di_heat_balance *h, size_t side) {
  const size_t bands = h->scene->bands, patch = h->patch[side], k = h->of[side];
  for (size_t b = 0; b < bands; b++) {
    const double emitted = hr2d_scene_emission(h->scene, patch, b);
    const double absorbed =
        (1 - hr2d_scene_reflectance(h->scene, patch, b)) * h->average[patch * bands + b];
    h->defect[k] += emitted - absorbed;
    h->size[k] += fabs(emitted) + fabs(absorbed);
  }
}

/* g, its size and D for h->radiance. */
static hr2d_status evaluate(hr2di_heat_balance *h) {
  const size_t bands = h->scene->bands;
  hr2d_status status = set_radiance(h);
  if (!status) status = solve(h, 0);
  h->worst = 0;
  h->power = 0;
  for (size_t k = 0; k < h->count && !status; k++) {
    const size_t patch = h->patch[k];
    double flux;
    status = hr2di_watch_work(&h->eq.watch, 3 * PLANCK * bands);
    hr2d_scene_heat(h->scene, patch, &flux);
    h->defect[k] = -flux;
    h->size[k] = fabs(flux);
    for (int m = 0; hr2di_heat_side(h, k, m) != HR2DI_NO_BACK; m++)
      add_defect(h, hr2di_heat_side(h, k, m));
    set_slope(h, k);
    h->power += h->length[k] * fabs(h->defect[k]);
    if (h->size[k] > 0) h->worst = fmax(h->worst, fabs(h->defect[k]) / h->size[k]);
  }
  return status;
}

static void set_emission(hr2di_heat_balance *h, const double *radiance) {
  const size_t bands = h->scene->bands;
  for (size_t m = 0; m < h->sides * bands; m++)
    h->emission[m] = h->rise[m] * radiance[h->of[m / bands]];
}

/* out = D⁻¹C in */
static void apply(void *ctx, const double *in, double *out) {
  hr2di_heat_balance *h = ctx;
  const size_t bands = h->scene->bands;
  set_emission(h, in);
  if (!h->failed) h->failed = solve(h, 1);
  for (size_t k = 0; k < h->count; k++) out[k] = 0;
  for (size_t s = 0; s < h->sides; s++)
    for (size_t b = 0; b < bands && !h->failed; b++)
      out[h->of[s]] += (1 - hr2d_scene_reflectance(h->scene, h->patch[s], b)) *
                       h->average[h->patch[s] * bands + b] / h->slope[h->of[s]];
}

static void scale(void *ctx, const double *y, double *norm) {
  const hr2di_heat_balance *h = ctx;
  (void)y;
  *norm = 0;
  for (size_t k = 0; k < h->count; k++) *norm += h->length[k] * (h->right[k] * h->right[k]);
  *norm = sqrt(*norm);
}

static hr2d_status report(void *ctx, double residual) {
  const hr2di_heat_balance *h = ctx;
  (void)residual;
  return h->failed;
}

hr2d_status hr2di_heat_balance_spread(hr2di_heat_balance *h, const double *off,
                                      double *radiance) {
  double residual;
  const hr2di_krylov_system system = {.alloc = &h->scene->alloc,
                                      .size = h->count,
                                      .bands = 1,
                                      .weight = h->length,
                                      .apply = apply,
                                      .scale = scale,
                                      .report = report,
                                      .ctx = h,
                                      .watch = &h->eq.watch,
                                      .tolerance = STEP_ERROR,
                                      .max_iterations = MOST_SOLVES};
  for (size_t k = 0; k < h->count; k++) {
    h->right[k] = off[k] / h->slope[k];
    radiance[k] = h->right[k];
  }
  h->failed = HR2D_OK;
  const hr2d_status status = hr2di_krylov(&system, h->right, radiance, &residual);
  return h->failed ? h->failed : status;
}

/* What an unknown emits with a radiance, in all bands. */
static double emitted(hr2di_heat_balance *h, size_t k, double radiance) {
  double sum = 0;
  for (int m = 0; hr2di_heat_side(h, k, m) != HR2DI_NO_BACK; m++) {
    const size_t patch = h->patch[hr2di_heat_side(h, k, m)];
    hr2di_frozen_set(h->scene, patch, radiance);
    for (size_t b = 0; b < h->scene->bands; b++) sum += hr2d_scene_emission(h->scene, patch, b);
  }
  return sum;
}

/* Σa of an unknown in a band. */
static double absorptance(const hr2di_heat_balance *h, size_t k, size_t band) {
  double sum = 0;
  for (int m = 0; hr2di_heat_side(h, k, m) != HR2DI_NO_BACK; m++)
    sum += 1 - hr2d_scene_reflectance(h->scene, h->patch[hr2di_heat_side(h, k, m)], band);
  return sum;
}

/* S with Σ E_b = P > 0: between P/max a and P/min a, by Newton's method, or by halving where
   that leaves the interval. */
static double radiance_of(hr2di_heat_balance *h, size_t k, double power, double guess) {
  const size_t bands = h->scene->bands;
  double low = HUGE_VAL, high = 0;
  for (size_t b = 0; b < bands; b++) {
    const double s = power / absorptance(h, k, b);
    low = fmin(low, s);
    high = fmax(high, s);
  }
  double s = fmin(fmax(guess, low), high);
  for (int n = 0; n < ROOTS && high > low; n++) {
    double rise = 0;
    const double over = emitted(h, k, s) - power;
    if (fabs(over) <= DBL_EPSILON * power) break;
    if (over > 0)
      high = s;
    else
      low = s;
    for (int m = 0; hr2di_heat_side(h, k, m) != HR2DI_NO_BACK; m++)
      for (size_t b = 0; b < bands; b++)
        rise += hr2di_frozen_rise(h->scene, h->patch[hr2di_heat_side(h, k, m)], b);
    const double next = s - over / rise;
    s = next > low && next < high ? next : 0.5 * (low + high);
  }
  return s;
}

/* A part of the step.  The unknown of the step is what a patch emits in all bands, P: then only
   its spectrum is not linear.  Below 0 K it is.  Where ε depends on T the unknown is S, which
   stays above 0. */
static hr2d_status take_step(hr2di_heat_balance *h, int halvings) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < h->count && !status; k++) {
    status = hr2di_watch_work(&h->eq.watch, 16 * PLANCK * h->scene->bands);
    if (hr2di_emissivity_depends(hr2di_scene_origin(h->scene), h->patch[k])) {
      h->radiance[k] = fmax(h->old[k] + ldexp(h->step[k], -halvings), h->old[k] / 16);
      continue;
    }
    const double power = emitted(h, k, h->old[k]) + ldexp(h->gain[k], -halvings);
    const double rest = absorptance(h, k, h->scene->bands - 1);
    h->radiance[k] = power > 0 ? radiance_of(h, k, power, h->old[k]) : power / rest;
  }
  return status;
}

/* One step from `old`, halved while the balance is not better.  Along the step g falls in
   proportion at first, and so does ΣA|g|. */
static hr2d_status improve(hr2di_heat_balance *h) {
  const double before = h->power;
  const int rounding = h->worst < ROUNDINGS;
  for (size_t k = 0; k < h->count; k++) {
    h->old[k] = h->radiance[k];
    h->defect[k] = -h->defect[k];
  }
  hr2d_status status = hr2di_heat_balance_spread(h, h->defect, h->step);
  for (size_t k = 0; k < h->count; k++) h->gain[k] = h->slope[k] * h->step[k];
  for (int m = 0; m <= HALVINGS && !status; m++) {
    status = take_step(h, m);
    if (!status) status = evaluate(h);
    if (h->power < before || rounding) break;
  }
  return status;
}

hr2d_status hr2di_heat_balance_settle(hr2di_heat_balance *h) {
  hr2di_message *message = &h->eq.links->message;
  hr2d_status status = evaluate(h);
  double before = HUGE_VAL;
  for (int k = 0; k < STEPS && !status && h->worst > BALANCED; k++) {
    if (before < ROUNDINGS && h->worst > 0.5 * before) break;
    before = h->worst;
    status = improve(h);
  }
  if (!status && !(h->worst < ROUNDINGS))
    status = hr2di_message_fail(message, HR2D_ENOT_CONVERGED,
                                "the temperatures of patches of given flux do not settle: "
                                "their heat is off by %.1e of itself",
                                h->worst);
  else if (status && !message->text[0])
    hr2di_message_fail(message, status, "heat balance: %s", hr2d_strerror(status));
  return status;
}

hr2d_status hr2di_heat_balance_respond(hr2di_heat_balance *h, const double *radiance,
                                       double *radiosity, double *irradiance) {
  set_emission(h, radiance);
  hr2d_status status = solve(h, 1);
  if (!status)
    memcpy(irradiance, h->average, h->scene->patches * h->scene->bands * sizeof *irradiance);
  return status ? status : take_averages(h, h->eq.radiosity, radiosity);
}
