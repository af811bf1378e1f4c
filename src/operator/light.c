/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a caller's light to that of the relit scene. */
#include <float.h>
#include <hr2d/symmetry.h>
#include <math.h>
#include <stdint.h>

#include "base/sized-struct.h"
#include "operator/operator-impl.h"
#include "solve/external-irradiance.h"

/* Beside the edge of a piece, in degrees. */
#define BESIDE 1e-7

hr2d_status hr2di_operator_light_of(hr2d_operator *op, const hr2d_light *given,
                                    hr2d_light *light) {
  *light = (hr2d_light)HR2D_LIGHT_INIT;
  if (hr2di_sized_copy(light, sizeof *light, given))
    return hr2di_message_fail(&op->message, HR2D_EINVAL, "struct_size is not set");
  if (!light->count) light->count = 1;
  if (light->count > SIZE_MAX / 16 / op->scene->bands)
    return hr2di_message_fail(&op->message, HR2D_EINVAL, "there are too many lights");
  return HR2D_OK;
}

static double at(const hr2d_operator *op, const hr2d_values *v, size_t light, size_t patch,
                 size_t band) {
  return hr2di_values_at(v, hr2di_scene_cell(op->scene), op->scene->bands, light, patch, band);
}

/* A temperature or a flux, which has no bands. */
static double heat_at(const hr2d_operator *op, const hr2d_values *v, size_t light,
                      size_t patch) {
  return hr2di_values_at(v, hr2di_scene_cell(op->scene), 1, light, patch, 0);
}

/* A value that is not valid: "light 0: emission of patch 3 ("wall") is -1: at least 0". */
static hr2d_status refuse(hr2d_operator *op, size_t light, const char *what, size_t patch,
                          double value, const char *why) {
  return hr2di_message_fail(&op->message, HR2D_EINVAL, "light %zu: %s of %s is %.10g: %s",
                            light, what, hr2di_patch_label(op->scene, patch).text, value, why);
}

/* E or ρ of a patch in all bands of a light. */
static hr2d_status take_surface(hr2d_operator *op, const hr2d_values *v, int is_emission,
                                size_t light, size_t k) {
  const size_t bands = op->scene->bands;
  const hr2d_heat heat = hr2d_scene_heat(op->scene, k, NULL);
  const int none = is_emission ? heat != HR2D_HEAT_NONE : hr2di_scene_has_flux(op->scene, k);
  const char *what = is_emission ? "emission" : "reflectance";
  double *to = is_emission ? hr2di_relit_emission(op->kept->relit, k)
                           : hr2di_relit_reflectance(op->kept->relit, k);
  for (size_t b = 0; b < bands && v->value; b++) {
    const double value = at(op, v, light, k, b);
    if (none && isnan(value)) continue;
    if (none)
      return refuse(op, light, what, k, value,
                    heat == HR2D_HEAT_FLUX     ? "it has a flux; NaN leaves it"
                    : heat == HR2D_HEAT_SHIELD ? "it is a shield; NaN leaves it"
                                               : "it has a temperature; NaN leaves it");
    if (!(value >= 0 && value <= (is_emission ? HUGE_VAL : 1)) || !isfinite(value))
      return refuse(op, light, what, k, value,
                    is_emission ? "it must be at least 0, and finite"
                                : "it must be from 0 to 1");
    to[light * bands + b] = value;
  }
  return HR2D_OK;
}

/* E = (1 − ρ − τ)σT⁴, as in thermal.c, for a temperature and ρ that may both be new. */
static void emit(hr2d_operator *op, size_t light, size_t k, double kelvin) {
  hr2d_scene *relit = op->kept->relit;
  const size_t bands = op->scene->bands;
  double *emission = hr2di_relit_emission(relit, k) + light * bands;
  for (size_t b = 0; b < bands; b++)
    emission[b] = hr2di_scene_absorptance(relit, k, light * bands + b) *
                  (hr2di_scene_band_part(op->scene, kelvin, b) * hr2d_black_body(kelvin));
}

static hr2d_status take_temperature(hr2d_operator *op, const hr2d_light *from, size_t light,
                                    size_t k) {
  double kelvin;
  const int has = hr2d_scene_heat(op->scene, k, &kelvin) == HR2D_HEAT_TEMPERATURE;
  const double given =
      from->temperature.value ? heat_at(op, &from->temperature, light, k) : NAN;
  if (!has && !isnan(given))
    return refuse(op, light, "temperature", k, given, "it has none; NaN leaves it");
  if (!has || (!from->temperature.value && !from->reflectance.value)) return HR2D_OK;
  if (from->temperature.value) {
    if (!(given >= 0) || !isfinite(hr2d_black_body(given)))
      return refuse(op, light, "temperature", k, given, "it must be kelvins, at least 0");
    kelvin = given;
  }
  op->kept->relit->patch[k].light->given = kelvin;
  emit(op, light, k, kelvin);
  return HR2D_OK;
}

/* In one band B = H + q: E is q where ρ is 1. */
static hr2d_status take_flux(hr2d_operator *op, const hr2d_light *from, size_t light,
                             size_t k) {
  const int has = hr2d_scene_heat(op->scene, k, NULL) == HR2D_HEAT_FLUX;
  if (!from->flux.value) return HR2D_OK;
  const double given = heat_at(op, &from->flux, light, k);
  if (!has && isnan(given)) return HR2D_OK;
  if (!has) return refuse(op, light, "flux", k, given, "it has none; NaN leaves it");
  if (!isfinite(given)) return refuse(op, light, "flux", k, given, "it must be finite");
  op->kept->relit->patch[k].light->given = given;
  hr2di_relit_emission(op->kept->relit, k)[light] = given;
  return HR2D_OK;
}

static hr2d_status refuse_outside(hr2d_operator *op, size_t light, const char *what,
                                  double value, const char *why) {
  return hr2di_message_fail(&op->message, HR2D_EINVAL, "light %zu: %s is %.10g: %s", light,
                            what, value, why);
}

static int is_light(double value) {
  return value >= 0 && isfinite(value);
}

/* Background, sun and sky of a light in one band. */
static hr2d_status take_outside(hr2d_operator *op, const hr2d_light *from, size_t light,
                                size_t band) {
  hr2d_scene *relit = op->kept->relit;
  const size_t bands = op->scene->bands, to = light * bands + band, pieces = relit->sky.pieces;
  const int looked = op->eq.transport.sky != NULL;
  if (from->background.value) {
    const double value = hr2di_values_at(&from->background, 1, bands, light, 0, band);
    if (!is_light(value) || (value > 0 && !looked))
      return refuse_outside(op, light, "the background", value,
                            is_light(value) ? "the scene has none, and is not forced to look"
                                            : "it must be at least 0, and finite");
    relit->background[to] = value;
  }
  if (from->sun.value) {
    const double value = hr2di_values_at(&from->sun, 1, bands, light, 0, band);
    if (!is_light(value) || (value > 0 && !(hr2d_scene_sun(op->scene, band).irradiance > 0)))
      return refuse_outside(op, light, "the irradiance of the sun", value,
                            is_light(value) ? "the scene has no sun that shines in this band"
                                            : "it must be at least 0, and finite");
    if (relit->sun) relit->sun[to].irradiance = value;
  }
  for (size_t k = 0; k < pieces && from->sky.value; k++) {
    const double value = hr2di_values_at(&from->sky, pieces, bands, light, k, band);
    if (!is_light(value))
      return refuse_outside(op, light, "a piece of the sky", value,
                            "it must be at least 0, and finite");
    relit->sky.value[k * relit->sky.bands + to] = value;
  }
  return HR2D_OK;
}

/* Elements end where an edge of the sky comes into sight, but only at edges at which the sky of
   the scene jumps; and under mirrors it has to stay symmetric. */
static hr2d_status check_sky(hr2d_operator *op, const hr2d_light *from) {
  const hr2d_scene *scene = op->scene;
  if (!scene->sky.pieces || (!from->sky.value && !from->background.value)) return HR2D_OK;
  if (!hr2di_external_has_pieces(scene) || !scene->effect[HR2D_EFFECT_BACKGROUND].on)
    return hr2di_message_fail(&op->message, HR2D_EINVAL,
                              "the sky of the scene has no light: it stays as it is");
  if (hr2d_scene_mirrors(scene) > 0)
    return hr2di_message_fail(&op->message, HR2D_EINVAL,
                              "under mirrors the pieces of the sky stay as they are");
  if (hr2di_sky_is_continuous(&scene->sky)) {
    if (!from->sky.value) return HR2D_OK;
    return hr2di_message_fail(&op->message, HR2D_EINVAL,
                              "a continuous sky stays as it is: give the scene a sky for each "
                              "band");
  }
  for (size_t k = 0; k < 2 * scene->sky.pieces; k++) {
    double edge, jump = 0;
    if (!hr2di_sky_edge(scene, k, &edge)) continue;
    for (size_t b = 0; b < scene->bands; b++)
      jump = fmax(jump, fabs(hr2d_scene_sky(scene, edge + BESIDE, b) -
                             hr2d_scene_sky(scene, edge - BESIDE, b)));
    if (!(jump > 0))
      return hr2di_message_fail(&op->message, HR2D_EINVAL,
                                "the sky of the scene does not change at the bearing %.10g, so "
                                "that elements do not end there: give it a jump in the scene",
                                edge);
  }
  return HR2D_OK;
}

/* ρ + τ ≤ 1 on a pane. */
static hr2d_status check_pane(hr2d_operator *op, const hr2d_light *from, size_t light,
                              size_t k) {
  const hr2d_scene *relit = op->kept->relit;
  for (size_t b = 0; b < op->scene->bands && from->reflectance.value; b++) {
    const size_t band = light * op->scene->bands + b;
    const double rho = hr2d_scene_reflectance(relit, k, band);
    if (rho + hr2d_scene_transmittance(relit, k, band) > 1 + 4 * DBL_EPSILON)
      return refuse(op, light, "reflectance", k, rho, "with its transmittance it is above 1");
  }
  return HR2D_OK;
}

static hr2d_status take_patch(hr2d_operator *op, const hr2d_light *from, size_t light,
                              size_t k) {
  hr2d_status status = take_surface(op, &from->emission, 1, light, k);
  if (!status) status = take_surface(op, &from->reflectance, 0, light, k);
  if (!status) status = check_pane(op, from, light, k);
  if (!status) status = take_temperature(op, from, light, k);
  return status ? status : take_flux(op, from, light, k);
}

static hr2d_status take(hr2d_operator *op, const hr2d_light *from, hr2di_watch *watch) {
  hr2d_status status = check_sky(op, from);
  for (size_t light = 0; light < from->count; light++) {
    for (size_t k = 0; k < hr2di_scene_cell(op->scene) && !status; k++) {
      status = take_patch(op, from, light, k);
      if (!status) status = hr2di_watch_work(watch, 1 + op->scene->bands / 2);
    }
    for (size_t band = 0; band < op->scene->bands && !status; band++)
      status = take_outside(op, from, light, band);
  }
  return status;
}

hr2d_status hr2di_operator_relight(hr2d_operator *op, const hr2d_light *light) {
  hr2di_watch watch;
  hr2d_status status = hr2di_operator_resize(op, light->count);
  if (status) return status;
  hr2di_scene_watch(op->scene, &watch, op->target.progress, op->target.progress_ctx, "solve");
  status = hr2di_relit_renew(op->kept->relit, op->scene, &watch);
  return status ? status : take(op, light, &watch);
}
