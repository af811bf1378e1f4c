/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/band-groups.h"

#include "base/alloc.h"
#include "scene/relit-scene.h"

/* The number of absorptions, the first band of each in `first`; HR2DI_BAND_GROUPS + 1 if there
   are more.  `group` receives that of each band. */
static size_t find(const hr2d_scene *scene, size_t *first, size_t *group, hr2di_watch *watch,
                   hr2d_status *status) {
  size_t count = 0;
  for (size_t b = 0; b < scene->bands && !*status; b++) {
    size_t g = 0;
    while (g < count && !hr2di_scene_absorbs_alike(scene, first[g], b)) g++;
    if (g == HR2DI_BAND_GROUPS) return g + 1;
    if (g == count) first[count++] = b;
    group[b] = g;
    *status = hr2di_watch_work(watch, 1 + count * scene->gases.count / 8);
  }
  return count;
}

/* A gas of one group: grey, with E_g of each band.  It is where that of the scene is. */
static hr2d_status give_gas(hr2d_scene *made, const hr2d_scene *scene, size_t k,
                            double *emission) {
  hr2di_gas *grey;
  const double absorption = hr2d_scene_absorption(scene, k, made->band_of[0]);
  for (size_t b = 0; b < made->bands; b++)
    emission[b] = hr2di_scene_gas_emission(scene, k, made->band_of[b]);
  hr2d_gas gas = HR2D_GAS_INIT;
  gas.absorption = &absorption;
  gas.absorption_bands = 1;
  gas.emission = emission;
  gas.emission_bands = made->bands;
  gas.section = hr2di_scene_section(scene);
  hr2d_status status = hr2di_scene_make_gas(made, &gas, &grey);
  if (status) return status;
  grey->border_points = scene->gases.gas[k]->border_points; /* whose points nobody asks for */
  status = hr2di_gases_take(&made->gases, made, grey);
  if (status) hr2di_alloc_free(&scene->alloc, grey);
  return status;
}

static hr2d_status give_gases(hr2d_scene *made, const hr2d_scene *scene) {
  hr2d_status status = HR2D_OK;
  double *emission = hr2di_alloc(&scene->alloc, made->bands, sizeof *emission);
  made->gases = (hr2di_gases){0};
  if (!emission) return HR2D_ENOMEM;
  for (size_t k = 0; k < scene->gases.count && !status; k++)
    status = give_gas(made, scene, k, emission);
  if (!status) status = hr2di_scene_check_gas(made, NULL);
  hr2di_alloc_free(&scene->alloc, emission);
  return status;
}

/* The scene of group g, of which `room` may hold the bands. */
static hr2d_status make(const hr2d_scene *scene, const size_t *group, size_t g, size_t *room,
                        hr2d_scene **made) {
  size_t bands = 0;
  for (size_t b = 0; b < scene->bands; b++)
    if (group[b] == g) room[bands++] = b;
  const hr2d_status status = hr2di_relit_create_bands(scene, room, bands, made);
  return status ? status : give_gases(*made, scene);
}

static hr2d_status make_all(hr2d_scene *scene, size_t groups, const size_t *group, size_t *room,
                            hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  scene->group = hr2di_alloc_zero(&scene->alloc, groups, sizeof *scene->group);
  if (!scene->group) return HR2D_ENOMEM;
  scene->groups = groups;
  for (size_t g = 0; g < groups && !status; g++) {
    status = hr2di_watch_work(watch, scene->patches / 4 + scene->bands);
    if (!status) status = make(scene, group, g, room, &scene->group[g]);
  }
  return status;
}

hr2d_status hr2di_band_groups_make(hr2d_scene *scene, hr2di_watch *watch) {
  size_t first[HR2DI_BAND_GROUPS];
  int alike = 1;
  for (size_t b = 1; b < scene->bands && alike; b++)
    alike = hr2di_scene_absorbs_alike(scene, 0, b);
  if (alike) return HR2D_OK;
  size_t *group = hr2di_alloc(&scene->alloc, scene->bands, 2 * sizeof *group);
  hr2d_status status = group ? HR2D_OK : HR2D_ENOMEM;
  const size_t groups = group ? find(scene, first, group, watch, &status) : 0;
  if (!status && groups > HR2DI_BAND_GROUPS) {
    hr2di_alloc_free(&scene->alloc, group);
    return hr2di_message_fail(&scene->message, HR2D_EUNSUPPORTED,
                              "gas: more than %d bands differ in their absorption",
                              HR2DI_BAND_GROUPS);
  }
  if (!status) status = make_all(scene, groups, group, group + scene->bands, watch);
  hr2di_alloc_free(&scene->alloc, group);
  return status;
}

void hr2di_band_groups_clear(hr2d_scene *scene) {
  for (size_t g = 0; g < scene->groups; g++) {
    if (scene->group[g]) hr2di_gases_clear(&scene->group[g]->gases, &scene->alloc);
    hr2di_relit_destroy(scene->group[g]);
  }
  hr2di_alloc_free(&scene->alloc, scene->group);
  scene->group = NULL;
  scene->groups = 0;
}
