/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/frozen-temperatures.h"

#include <math.h>

#include "base/alloc.h"
#include "base/black-body.h"
#include "scene/emissivity.h"
#include "scene/patch-light.h"
#include "scene/relit-scene.h"

int hr2di_scene_is_unsettled(const hr2d_scene *scene) {
  size_t k = 0;
  if (scene->bands == 1 || scene->found) return 0;
  while (k < scene->patches && !hr2di_scene_has_flux(scene, k)) k++;
  return k < scene->patches;
}

const hr2d_scene *hr2di_scene_origin(const hr2d_scene *scene) {
  return scene->origin ? scene->origin : scene;
}

/* The numbers of a light with a value of each kind for each band. */
static size_t size_of(const hr2d_scene *scene) {
  return HR2DI_LIGHT_HEAD + 3 * scene->bands;
}

/* Such a light for patch k. */
static hr2di_light light_of(const hr2d_scene *scene, size_t k) {
  return (hr2di_light){.emission_bands = scene->bands,
                       .reflectance_bands = scene->bands,
                       .emissivity_bands = scene->bands,
                       .heat = scene->patch[k].light->heat,
                       .given = scene->patch[k].light->given};
}

static void make_lights(hr2d_scene *made, const hr2d_scene *scene) {
  const size_t cell = hr2di_scene_cell(scene);
  double *next = made->own_lights;
  for (size_t k = 0; k < scene->patches; k++) made->patch[k] = scene->patch[k];
  for (size_t k = 0; k < cell; k++) {
    if (!hr2di_scene_has_flux(scene, k)) continue;
    made->patch[k].light = (hr2di_light *)(void *)next;
    *made->patch[k].light = light_of(scene, k);
    next += size_of(scene);
  }
  for (size_t k = cell; k < scene->patches; k++)
    made->patch[k].light = made->patch[hr2di_scene_original(scene, k)].light;
}

hr2d_status hr2di_frozen_create(const hr2d_scene *scene, hr2d_scene **frozen) {
  size_t fluxes = 0;
  for (size_t k = 0; k < hr2di_scene_cell(scene); k++) fluxes += hr2di_scene_has_flux(scene, k);
  hr2d_scene *made = hr2di_alloc(&scene->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  *made = *scene;
  made->origin = made->lender = scene;
  made->patch = hr2di_alloc(&scene->alloc, scene->patches, sizeof *made->patch);
  made->found = hr2di_alloc_zero(&scene->alloc, scene->patches, sizeof *made->found);
  made->own_lights =
      hr2di_alloc_zero(&scene->alloc, fluxes * size_of(scene) + 1, sizeof(double));
  if (!made->patch || !made->found || !made->own_lights) {
    hr2di_relit_destroy(made);
    return HR2D_ENOMEM;
  }
  make_lights(made, scene);
  for (size_t k = 0; k < scene->patches; k++)
    made->found[k] = (hr2di_found){.estimate = NAN, .bound = NAN};
  *frozen = made;
  return HR2D_OK;
}

/* Below 0 K all emission, which is negative, is in the band of the longest waves, as in the
   limit of 0 K: so it rises steadily. */
static double kelvin_of(double radiance) {
  return radiance > 0 ? hr2di_black_body_kelvin(radiance) : 0;
}

/* ε and ρ at a temperature. */
static hr2d_status set_emissivity(hr2d_scene *frozen, size_t patch, double kelvin) {
  const size_t bands = frozen->bands;
  hr2di_light *light = frozen->patch[patch].light;
  for (size_t b = 0; b < bands; b++) {
    const double e = hr2d_scene_emissivity_at(frozen->origin, patch, b, kelvin);
    if (!(e > 0 && e <= 1)) return HR2D_ECALLBACK;
    light->value[2 * bands + b] = e;
    light->value[bands + b] = 1 - e;
  }
  return HR2D_OK;
}

hr2d_status hr2di_frozen_set(hr2d_scene *frozen, size_t patch, double radiance) {
  hr2di_light *light = frozen->patch[patch].light;
  const double kelvin = kelvin_of(radiance);
  frozen->found[patch].radiance = radiance;
  const hr2d_status status = set_emissivity(frozen, patch, kelvin);
  for (size_t b = 0; b < frozen->bands; b++)
    light->value[b] = (1 - light->value[frozen->bands + b]) *
                      (hr2di_scene_band_part(frozen, kelvin, b) * radiance);
  return status;
}

double hr2di_frozen_rise(const hr2d_scene *frozen, size_t patch, size_t band) {
  const double kelvin = kelvin_of(frozen->found[patch].radiance);
  const double rise = hr2di_scene_band_rise(frozen, kelvin, band);
  return (1 - hr2d_scene_reflectance(frozen, patch, band)) * rise;
}
