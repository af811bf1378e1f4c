/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temperatures and heat of the patches of a run. */
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"
#include "run/run.h"

enum { ARRAYS = 6 };

int run_heat_exists(const hr2d_scene *scene) {
  size_t k = 0;
  while (k < hr2d_scene_patches(scene) && !hr2d_scene_heat(scene, k, NULL)) k++;
  return k < hr2d_scene_patches(scene);
}

int run_sun_exists(const hr2d_scene *scene) {
  size_t b = 0;
  while (b < hr2d_scene_bands(scene) && !(hr2d_scene_sun(scene, b).irradiance > 0)) b++;
  return b < hr2d_scene_bands(scene);
}

/* That of a shield needs H of both sides. */
double run_heat_at(const run *r, size_t patch, double t, double irradiance) {
  double kelvin;
  const hr2d_heat heat = hr2d_scene_heat(r->scene, patch, NULL);
  if (heat != HR2D_HEAT_SHIELD && (heat != HR2D_HEAT_FLUX || hr2d_scene_bands(r->scene) == 1))
    return hr2d_scene_temperature(r->scene, patch, irradiance);
  return hr2d_solution_gather_temperature(r->solution, patch, &t, 1, &kelvin) ? NAN : kelvin;
}

const char *run_heat_word(unsigned char state) {
  static const char *const word[] = {[HR2D_TEMPERATURE_NONE] = "none",
                                     [HR2D_TEMPERATURE_GIVEN] = "given",
                                     [HR2D_TEMPERATURE_FOUND] = "found",
                                     [HR2D_TEMPERATURE_IMPOSSIBLE] = "impossible",
                                     [HR2D_TEMPERATURE_UNLIT] = "unlit"};
  return word[state];
}

static hr2d_status ask(const run *r, run_heat *heat) {
  const size_t patches = hr2d_scene_patches(r->scene);
  hr2d_target target = HR2D_TARGET_INIT;
  target.important = run_important(r);
  target.important_count = r->options->importance.count;
  target.floor = r->options->floor;
  heat->of = (hr2d_temperatures){.struct_size = sizeof heat->of,
                                 .kelvin = heat->kelvin,
                                 .estimate = heat->kelvin + patches,
                                 .bound = heat->kelvin + 2 * patches,
                                 .heat = heat->kelvin + 3 * patches,
                                 .heat_estimate = heat->kelvin + 4 * patches,
                                 .heat_bound = heat->kelvin + 5 * patches,
                                 .state = heat->state};
  return hr2d_solution_temperatures(r->solution, &target, &r->account, &heat->of);
}

int run_heat_find(const run *r, run_heat *heat) {
  const size_t patches = hr2d_scene_patches(r->scene);
  *heat = (run_heat){.exists = run_heat_exists(r->scene)};
  if (!heat->exists) return 0;
  heat->kelvin = calloc(patches, ARRAYS * sizeof *heat->kelvin);
  heat->state = calloc(patches, 1);
  if (!heat->kelvin || !heat->state) return complain_memory();
  const hr2d_status status = ask(r, heat);
  return status ? complain_call(r->options->scene, "", status) : 0;
}

void run_heat_release(run_heat *heat) {
  free(heat->kelvin);
  free(heat->state);
}
