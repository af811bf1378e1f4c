/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/patch-light.h"

#include <math.h>
#include <stdint.h>

#include "base/alloc.h"
#include "scene/panes.h"
#include "scene/relit-scene.h"

hr2di_light *hr2di_light_make(const hr2d_allocator *alloc, const hr2d_patch *patch,
                              const hr2d_thermal *thermal) {
  const size_t e = patch->emission_bands, r = patch->reflectance_bands,
               t = patch->transmittance_bands;
  const hr2d_heat heat = thermal ? thermal->given : HR2D_HEAT_NONE;
  const size_t kelvins = thermal ? thermal->kelvins : 0;
  const size_t emissivities = thermal ? thermal->emissivity_bands * (kelvins ? kelvins : 1) : 0;
  if (e > SIZE_MAX / 8 || r > SIZE_MAX / 8 || t > SIZE_MAX / 8 || emissivities > SIZE_MAX / 8 ||
      kelvins > SIZE_MAX / 8)
    return NULL;
  hr2di_light *light =
      hr2di_alloc(alloc, HR2DI_LIGHT_HEAD + e + r + emissivities + kelvins + t, sizeof(double));
  if (!light) return NULL;
  *light = (hr2di_light){.users = 1,
                         .emission_bands = e,
                         .reflectance_bands = r,
                         .transmittance_bands = t,
                         .emissivity_bands = thermal ? thermal->emissivity_bands : 0,
                         .heat = heat == HR2D_HEAT_POWER ? HR2D_HEAT_FLUX : heat,
                         .given = thermal ? thermal->value : 0,
                         .power = heat == HR2D_HEAT_POWER ? thermal->value : 0,
                         .kelvins = kelvins,
                         .emissivity_of = thermal ? thermal->emissivity_of : NULL,
                         .emissivity_ctx = thermal ? thermal->emissivity_ctx : NULL};
  for (size_t k = 0; k < e; k++) light->value[k] = patch->emission[k];
  for (size_t k = 0; k < r; k++) light->value[e + k] = patch->reflectance[k];
  for (size_t k = 0; k < emissivities; k++) light->value[e + r + k] = thermal->emissivity[k];
  for (size_t k = 0; k < kelvins; k++)
    light->value[e + r + emissivities + k] = thermal->kelvin[k];
  for (size_t k = 0; k < t; k++)
    light->value[e + r + emissivities + kelvins + k] = patch->transmittance[k];
  return light;
}

void hr2di_light_add_length(hr2di_light *light, hr2d_segment patch) {
  if (light->power == 0) return;
  light->across += hypot(patch.b.x - patch.a.x, patch.b.y - patch.a.y);
  light->given = light->value[0] = light->power / light->across;
}

void hr2di_light_release(const hr2d_allocator *alloc, hr2di_light *light) {
  if (light && --light->users == 0) hr2di_alloc_free(alloc, light);
}

double hr2d_scene_emission(const hr2d_scene *scene, size_t patch, size_t band) {
  if (!hr2di_scene_has(scene, patch) || !hr2di_scene_has_band(scene, band)) return NAN;
  const hr2di_light *light = scene->patch[patch].light;
  return hr2di_band_value(light->value, light->emission_bands, band);
}

/* A shield in one band is a pane that absorbs nothing.  In several it waits for its
   temperature, as patches of given flux do. */
static double transmittance_of_shield(const hr2d_scene *scene, size_t patch) {
  if (scene->bands > 1) return 0;
  const double e = hr2d_scene_emissivity(scene, patch, 0),
               other = hr2d_scene_emissivity(scene, hr2di_scene_other_side(scene, patch), 0);
  return e / (e + other) * other;
}

double hr2d_scene_reflectance(const hr2d_scene *scene, size_t patch, size_t band) {
  if (!hr2di_scene_has(scene, patch) || !hr2di_scene_has_band(scene, band)) return NAN;
  const hr2di_light *light = scene->patch[patch].light;
  if (light->heat == HR2D_HEAT_SHIELD && !light->reflectance_bands)
    return 1 - transmittance_of_shield(scene, patch);
  return hr2di_band_value(light->value + light->emission_bands, light->reflectance_bands, band);
}

/* A scene with other light has the panes of its lender, whose bands repeat. */
double hr2d_scene_transmittance(const hr2d_scene *scene, size_t patch, size_t band) {
  if (!hr2di_scene_has(scene, patch) || !hr2di_scene_has_band(scene, band)) return NAN;
  if (scene->lender)
    return hr2d_scene_transmittance(scene->lender, patch, hr2di_relit_band(scene, band));
  const hr2di_light *light = scene->patch[patch].light;
  if (light->heat == HR2D_HEAT_SHIELD) return transmittance_of_shield(scene, patch);
  const size_t tables = light->kelvins ? light->kelvins : 1;
  return hr2di_band_value(light->value + light->emission_bands + light->reflectance_bands +
                              light->emissivity_bands * tables + light->kelvins,
                          light->transmittance_bands, band);
}

double hr2d_scene_background(const hr2d_scene *scene, size_t band) {
  if (!hr2di_scene_has_band(scene, band)) return NAN;
  return hr2di_band_value(scene->background, scene->background_bands, band);
}
