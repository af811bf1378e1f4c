/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temperatures and heat from a solution.

   Given q: σT⁴ = f with f = H + q/ε.  If f is known to δ, T lies between those of f − δ and
   f + δ, and T is concave in f: the lower distance is the larger one.  With f ≥ 0 but f < δ the
   interval begins at 0 K.  In several bands f and δ are those of the heat balance. */
#include <float.h>
#include <hr2d/thermal.h>
#include <math.h>
#include <string.h>

#include "accuracy/target.h"
#include "base/alloc.h"
#include "base/black-body.h"
#include "base/sized-struct.h"
#include "estimate/importance.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/emissivity.h"
#include "scene/frozen-temperatures.h"
#include "scene/panes.h"
#include "solution/solution-impl.h"

typedef struct reader {
  const hr2d_solution *solution;
  const hr2d_scene *scene;
  double floor;
  hr2d_error error; /* of H, relative */
} reader;

static double largest_irradiance(const hr2d_solution *s, size_t band) {
  double max = 0;
  for (size_t k = 0; k < hr2di_scene_cell(s->hierarchy->scene); k++)
    max = fmax(max, hr2d_solution_irradiance(s, k, band));
  return max;
}

static void put(double *array, size_t k, double value) {
  if (array) array[k] = value;
}

/* fmax() passes over NaN. */
static double error_of_temperature(double f, double off) {
  if (isnan(off)) return NAN;
  return fmax(hr2di_black_body_kelvin(f) - hr2di_black_body_kelvin(fmax(f - off, 0)),
              hr2di_black_body_kelvin(f + off) - hr2di_black_body_kelvin(f));
}

/* H of one band counts as no less than the floor. */
static double counted(const reader *r, size_t patch, size_t band, double largest) {
  return fmax(hr2d_solution_irradiance(r->solution, patch, band), r->floor * largest);
}

/* How far T is off if H is: T rises with H. */
static double error_of_found(const reader *r, size_t k, double h, double off) {
  const double f = hr2di_emissivity_radiance(r->scene, k, h);
  if (!hr2di_emissivity_depends(r->scene, k) || !(off < h)) return error_of_temperature(f, off);
  const double kelvin = hr2di_black_body_kelvin(f);
  const double low = hr2di_emissivity_radiance(r->scene, k, h - off);
  const double high = hr2di_emissivity_radiance(r->scene, k, h + off);
  return fmax(kelvin - hr2di_black_body_kelvin(fmax(low, 0)),
              hr2di_black_body_kelvin(high) - kelvin);
}

/* Of a shield in the only band, from H of both sides. */
static hr2d_temperature_state find_shield(const reader *r, size_t k, double largest,
                                          const hr2d_temperatures *to) {
  const size_t other = hr2di_scene_other_side(r->scene, k);
  const double f =
      hr2di_shield_radiance(r->scene, k, hr2d_solution_irradiance(r->solution, k, 0),
                            hr2d_solution_irradiance(r->solution, other, 0));
  const double base = hr2di_shield_radiance(r->scene, k, counted(r, k, 0, largest),
                                            counted(r, other, 0, largest));
  const double kelvin = hr2di_black_body_kelvin(f);
  put(to->kelvin, k, kelvin);
  put(to->estimate, k, error_of_temperature(f, r->error.estimate * base));
  put(to->bound, k,
      error_of_temperature(f, r->error.bound * base + 4 * DBL_EPSILON * f) +
          2 * DBL_EPSILON * kelvin);
  return HR2D_TEMPERATURE_FOUND;
}

/* Of a patch with a flux in the only band.  A function that gives no emissivity leaves NaN. */
static hr2d_temperature_state find(const reader *r, size_t k, double largest,
                                   const hr2d_temperatures *to) {
  const double h = hr2d_solution_irradiance(r->solution, k, 0);
  const double f = hr2di_emissivity_radiance(r->scene, k, h);
  const double rounding = 4 * DBL_EPSILON * (h + fabs(f - h));
  const double base = counted(r, k, 0, largest);
  if (!hr2di_scene_lit(r->scene, k)) return HR2D_TEMPERATURE_UNLIT;
  if (hr2di_shield_is(r->scene, k)) return find_shield(r, k, largest, to);
  if (f < 0) return HR2D_TEMPERATURE_IMPOSSIBLE;
  put(to->kelvin, k, hr2di_black_body_kelvin(f));
  put(to->estimate, k, error_of_found(r, k, h, r->error.estimate * base));
  put(to->bound, k,
      error_of_found(r, k, h, r->error.bound * base + rounding) +
          2 * DBL_EPSILON * hr2di_black_body_kelvin(f));
  return HR2D_TEMPERATURE_FOUND;
}

/* Of a patch with a flux in several bands. */
static hr2d_temperature_state find_settled(const reader *r, size_t k,
                                           const hr2d_temperatures *to) {
  const hr2di_found *found = &r->scene->found[k];
  const double f = fmax(found->radiance, 0), kelvin = hr2di_black_body_kelvin(f);
  const int known = !isnan(r->error.bound);
  if (!hr2di_scene_lit(r->scene, k)) return HR2D_TEMPERATURE_UNLIT;
  put(to->kelvin, k, kelvin);
  put(to->estimate, k, error_of_temperature(f, known ? found->estimate : NAN));
  put(to->bound, k,
      error_of_temperature(f, known ? found->bound : NAN) + 2 * DBL_EPSILON * kelvin);
  return HR2D_TEMPERATURE_FOUND;
}

static hr2d_temperature_state state_of(const reader *r, size_t k, double largest,
                                       const hr2d_temperatures *to) {
  double value;
  const hr2d_heat heat = hr2d_scene_heat(r->scene, k, &value);
  put(to->kelvin, k, NAN);
  put(to->estimate, k, NAN);
  put(to->bound, k, NAN);
  if (heat == HR2D_HEAT_NONE) return HR2D_TEMPERATURE_NONE;
  if (hr2di_scene_has_flux(r->scene, k))
    return r->scene->found ? find_settled(r, k, to) : find(r, k, largest, to);
  put(to->kelvin, k, value);
  put(to->estimate, k, 0);
  put(to->bound, k, 0);
  return HR2D_TEMPERATURE_GIVEN;
}

/* The heat of patches with a flux in several bands was given; its balance is off by a part of
   the error of T only. */
static void put_given_heat(const hr2d_scene *scene, const hr2d_temperatures *to) {
  double flux;
  for (size_t k = 0; k < hr2di_scene_cell(scene) && scene->found; k++) {
    if (hr2d_scene_heat(scene, k, &flux) != HR2D_HEAT_FLUX) continue;
    put(to->heat, k, flux * hr2d_scene_length(scene, k));
    put(to->heat_estimate, k, 0);
    put(to->heat_bound, k, DBL_EPSILON * fabs(flux * hr2d_scene_length(scene, k)));
  }
}

/* (1−ρ)f of a patch, and τ times that of the other side of a pane. */
static double stays(const hr2d_scene *scene, size_t patch, size_t band, double own,
                    double other) {
  const double part = (1 - hr2d_scene_reflectance(scene, patch, band)) * own;
  return hr2di_pane_is(scene, patch)
             ? part + hr2d_scene_transmittance(scene, patch, band) * other
             : part;
}

/* A·Σ(E − (1−ρ)H), of a pane with what passes it, added up band by band in the arrays. */
static void add_heat(const reader *r, size_t band, double largest,
                     const hr2d_temperatures *to) {
  for (size_t k = 0; k < hr2di_scene_cell(r->scene); k++) {
    const double length = hr2d_scene_length(r->scene, k);
    const size_t other = hr2di_scene_other_side(r->scene, k);
    const double absorbance = stays(r->scene, k, band, 1, 1);
    const double off = length * stays(r->scene, k, band, counted(r, k, band, largest),
                                      counted(r, other, band, largest));
    const double rounding =
        4 * DBL_EPSILON * length *
        (fabs(hr2d_scene_emission(r->scene, k, band)) +
         stays(r->scene, k, band, hr2d_solution_irradiance(r->solution, k, band),
               hr2d_solution_irradiance(r->solution, other, band)));
    if (to->heat) to->heat[k] += length * hr2d_solution_net_flux(r->solution, k, band);
    if (to->heat_estimate) to->heat_estimate[k] += absorbance > 0 ? r->error.estimate * off : 0;
    if (to->heat_bound)
      to->heat_bound[k] += absorbance > 0 ? r->error.bound * off + rounding : rounding;
  }
}

/* Errors of patches that are not important are not known. */
static void forget(const hr2d_scene *scene, const hr2d_target *target,
                   const hr2d_temperatures *to) {
  double *const array[] = {to->estimate, to->bound, to->heat_estimate, to->heat_bound};
  for (size_t k = 0; k < hr2di_scene_cell(scene) && target->important; k++)
    for (size_t a = 0; a < sizeof array / sizeof *array; a++)
      if (!hr2di_is_important(target, k)) put(array[a], k, NAN);
}

hr2d_status hr2d_solution_temperatures(const hr2d_solution *solution, const hr2d_target *given,
                                       const hr2d_account *account,
                                       const hr2d_temperatures *temperatures) {
  if (!solution) return HR2D_EINVAL;
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  if (scene->lender && scene->bands > scene->lender->bands) return HR2D_EUNSUPPORTED;
  hr2d_target target;
  hr2d_temperatures to = HR2D_TEMPERATURES_INIT;
  if (!temperatures || hr2di_sized_copy(&to, sizeof to, temperatures)) return HR2D_EINVAL;
  const hr2d_status status = hr2di_target_init(&target, scene, given, HR2D_DEFAULT_ERROR);
  if (status) return status;
  const reader r = {.solution = solution,
                    .scene = scene,
                    .floor = target.floor,
                    .error = account ? account->irradiance : (hr2d_error){NAN, NAN}};
  double *const sum[] = {to.heat, to.heat_estimate, to.heat_bound};
  for (size_t a = 0; a < sizeof sum / sizeof *sum; a++)
    if (sum[a]) memset(sum[a], 0, hr2di_scene_cell(scene) * sizeof *sum[a]);
  for (size_t band = 0; band < solution->bands; band++) {
    const double largest = largest_irradiance(solution, band);
    add_heat(&r, band, largest, &to);
    for (size_t k = 0; k < hr2di_scene_cell(scene) && band == 0; k++) {
      const hr2d_temperature_state state = state_of(&r, k, largest, &to);
      if (to.state) to.state[k] = (unsigned char)state;
    }
  }
  put_given_heat(scene, &to);
  forget(scene, &target, &to);
  hr2di_target_clear(&target, &scene->alloc);
  return HR2D_OK;
}

/* What does not change along a patch: given, in several bands, or not known. */
static double kelvin_of_patch(const hr2d_scene *scene, size_t patch) {
  double value;
  const hr2d_heat heat = hr2d_scene_heat(scene, patch, &value);
  if (!hr2di_scene_has_flux(scene, patch)) return heat == HR2D_HEAT_TEMPERATURE ? value : NAN;
  if (!scene->found || !hr2di_scene_lit(scene, patch)) return NAN;
  return hr2di_black_body_kelvin(fmax(scene->found[patch].radiance, 0));
}

/* Of a shield in one band, at points of a side. */
static hr2d_status gather_shield(const hr2d_solution *solution, size_t patch, const double *t,
                                 size_t count, double *kelvin) {
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  const size_t other = hr2di_scene_other_side(scene, patch);
  double *space = hr2di_alloc(&solution->alloc, 2 * count + 1, sizeof *space);
  if (!space) return HR2D_ENOMEM;
  double *place = space, *passed = space + count;
  for (size_t k = 0; k < count; k++) place[k] = 1 - t[k];
  hr2d_status status = hr2d_solution_gather_irradiance(solution, patch, t, count, kelvin);
  if (!status) status = hr2d_solution_gather_irradiance(solution, other, place, count, passed);
  for (size_t k = 0; k < count && !status; k++)
    kelvin[k] =
        hr2di_black_body_kelvin(hr2di_shield_radiance(scene, patch, kelvin[k], passed[k]));
  hr2di_alloc_free(&solution->alloc, space);
  return status;
}

hr2d_status hr2d_solution_gather_temperature(const hr2d_solution *solution, size_t patch,
                                             const double *t, size_t count, double *kelvin) {
  if (!hr2di_solution_has(solution, patch, 0) || (count && (!t || !kelvin))) return HR2D_EINVAL;
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  if (!hr2di_scene_has_flux(scene, patch) || scene->found || !hr2di_scene_lit(scene, patch)) {
    for (size_t k = 0; k < count; k++) kelvin[k] = kelvin_of_patch(scene, patch);
    return HR2D_OK;
  }
  if (hr2di_shield_is(scene, patch)) return gather_shield(solution, patch, t, count, kelvin);
  const hr2d_status status = hr2d_solution_gather_irradiance(solution, patch, t, count, kelvin);
  for (size_t k = 0; k < count && !status; k++) {
    const double f = hr2di_emissivity_radiance(scene, patch, kelvin[k]);
    kelvin[k] = f >= 0 ? hr2di_black_body_kelvin(f) : NAN;
  }
  return status;
}
