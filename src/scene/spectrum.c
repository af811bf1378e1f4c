/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/spectrum.h"

#include <hr2d/thermal.h>
#include <math.h>

#include "base/alloc.h"
#include "base/black-body.h"
#include "scene/scene-impl.h"

/* a and its derivative by T, of a band with weights; the first band has what others leave. */
static double weight_of(const hr2di_spectrum *s, double kelvin, size_t band, double *slope) {
  double part = 0;
  *slope = 0;
  if (band == 0) {
    part = 1;
    for (size_t b = 1; b <= s->weights; b++) {
      double other;
      part -= weight_of(s, kelvin, b, &other);
      *slope -= other;
    }
    return part;
  }
  const double *c = s->weight + (band - 1) * s->terms;
  for (size_t j = s->terms; j-- > 0;) {
    *slope = *slope * kelvin + part;
    part = part * kelvin + c[j];
  }
  return part;
}

double hr2di_spectrum_part(const hr2di_spectrum *s, double kelvin, size_t band) {
  const size_t count = s->wavelengths;
  double slope;
  band %= hr2di_spectrum_bands(s);
  if (s->weights) return weight_of(s, kelvin, band, &slope);
  if (!count) return 1;
  return hr2d_black_body_part(kelvin, band ? s->wavelength[band - 1] : 0,
                              band < count ? s->wavelength[band] : HUGE_VAL);
}

double hr2di_spectrum_rise(const hr2di_spectrum *s, double kelvin, size_t band) {
  const size_t count = s->wavelengths;
  double slope;
  band %= hr2di_spectrum_bands(s);
  if (s->weights) {
    const double part = weight_of(s, kelvin, band, &slope);
    return part + kelvin * slope / 4;
  }
  return hr2di_black_body_rise(kelvin, band ? s->wavelength[band - 1] : 0,
                               band < count ? s->wavelength[band] : HUGE_VAL);
}

/* The first band may miss 0 by what the others round. */
#define ROUNDING 1e-12

int hr2di_spectrum_knows(const hr2di_spectrum *s, double kelvin, size_t *band) {
  for (size_t b = 0; b <= s->weights && s->weights; b++) {
    const double part = hr2di_spectrum_part(s, kelvin, b);
    *band = b;
    if (!(part >= -ROUNDING && part <= 1 + ROUNDING)) return 0;
  }
  return 1;
}

static int has_heat(const hr2d_scene *scene) {
  size_t k = 0;
  while (k < scene->patches && scene->patch[k].light->heat == HR2D_HEAT_NONE) k++;
  return k < scene->patches;
}

/* The bands of a spectrum may change as long as nothing has values for them. */
static hr2d_status check_new(hr2d_scene *scene, const char *what) {
  if (!scene->committed && !has_heat(scene)) return HR2D_OK;
  return hr2di_message_fail(&scene->message, HR2D_ESTATE, "%s: the scene %s already", what,
                            scene->committed ? "is committed" : "has temperatures or fluxes");
}

static void take(hr2d_scene *scene, hr2di_spectrum spectrum) {
  hr2di_alloc_free(&scene->alloc, scene->spectrum.wavelength);
  hr2di_alloc_free(&scene->alloc, scene->spectrum.weight);
  scene->spectrum = spectrum;
}

hr2d_status hr2d_scene_set_wavelengths(hr2d_scene *scene, const double *wavelength,
                                       size_t count) {
  if (!scene) return HR2D_EINVAL;
  const hr2d_status status = check_new(scene, "wavelengths");
  if (status) return status;
  if (count && !wavelength)
    return hr2di_message_fail(&scene->message, HR2D_EINVAL,
                              "wavelengths: a number of them but no values");
  if (count > HR2D_MAX_WAVELENGTHS)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "wavelengths: %zu are too many: at most %d", count,
                              HR2D_MAX_WAVELENGTHS);
  for (size_t k = 0; k < count; k++)
    if (!(wavelength[k] > (k ? wavelength[k - 1] : 0) && isfinite(wavelength[k])))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "wavelengths: number %zu is not above %s, or not finite", k + 1,
                                k ? "the one before" : "0");
  double *copy = count ? hr2di_alloc(&scene->alloc, count, sizeof *copy) : NULL;
  if (count && !copy)
    return hr2di_message_fail(&scene->message, HR2D_ENOMEM,
                              "out of memory for the wavelengths");
  for (size_t k = 0; k < count; k++) copy[k] = wavelength[k];
  take(scene, (hr2di_spectrum){.wavelength = copy, .wavelengths = count});
  return HR2D_OK;
}

hr2d_status hr2d_scene_set_weights(hr2d_scene *scene, const double *weight, size_t count,
                                   size_t terms) {
  if (!scene) return HR2D_EINVAL;
  const hr2d_status status = check_new(scene, "weights");
  if (status) return status;
  if (count && (!weight || !terms))
    return hr2di_message_fail(&scene->message, HR2D_EINVAL,
                              "weights: a number of them but no values");
  if (count > HR2D_MAX_WAVELENGTHS || terms > HR2D_MAX_WAVELENGTHS)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "weights: %zu of %zu terms are too many: at most %d", count,
                              terms, HR2D_MAX_WAVELENGTHS);
  for (size_t k = 0; k < count * terms; k++)
    if (!isfinite(weight[k]))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                "weights: number %zu of band %zu is not finite", k % terms + 1,
                                k / terms + 1);
  double *copy = count ? hr2di_alloc(&scene->alloc, count, terms * sizeof *copy) : NULL;
  if (count && !copy)
    return hr2di_message_fail(&scene->message, HR2D_ENOMEM, "out of memory for the weights");
  for (size_t k = 0; k < count * terms; k++) copy[k] = weight[k];
  take(scene, (hr2di_spectrum){.weight = copy, .weights = count, .terms = count ? terms : 0});
  return HR2D_OK;
}
