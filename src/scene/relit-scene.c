/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/relit-scene.h"

#include <string.h>

#include "base/alloc.h"
#include "scene/patch-light.h"

/* The numbers of a light with E and ρ of each of `bands`, and thermal properties as they are.
 */
static size_t size_of(const hr2di_light *from, size_t bands) {
  const size_t tables = from->kelvins ? from->kelvins : 1;
  return HR2DI_LIGHT_HEAD + 2 * bands + from->emissivity_bands * tables + from->kelvins;
}

/* Such a light; E and ρ are not set.  Of several lights in one scene none has a temperature. */
static void make_light(hr2di_light *light, const hr2di_light *from, size_t bands, int several) {
  const size_t thermal = size_of(from, bands) - HR2DI_LIGHT_HEAD - 2 * bands;
  *light = *from;
  light->emission_bands = light->reflectance_bands = bands;
  if (several) light->heat = HR2D_HEAT_NONE;
  memcpy(light->value + 2 * bands, from->value + from->emission_bands + from->reflectance_bands,
         thermal * sizeof *light->value);
}

static hr2d_status make_lights(hr2d_scene *made, const hr2d_scene *scene) {
  const size_t cell = hr2di_scene_cell(scene);
  size_t size = 0;
  for (size_t k = 0; k < cell; k++) size += size_of(scene->patch[k].light, made->bands);
  made->patch = hr2di_alloc(&scene->alloc, scene->patches, sizeof *made->patch);
  double *next = made->own_lights = hr2di_alloc(&scene->alloc, size, sizeof *next);
  if (!made->patch || !next) return HR2D_ENOMEM;
  memcpy(made->patch, scene->patch, scene->patches * sizeof *made->patch);
  for (size_t k = 0; k < cell; k++) {
    made->patch[k].light = (hr2di_light *)(void *)next;
    make_light(made->patch[k].light, scene->patch[k].light, made->bands,
               made->band_of || made->bands > made->lender->bands);
    next += size_of(scene->patch[k].light, made->bands);
  }
  for (size_t k = cell; k < scene->patches; k++)
    made->patch[k].light = made->patch[hr2di_scene_original(scene, k)].light;
  return HR2D_OK;
}

/* Room for background, suns and the sky, with a value for each band where there is any. */
static hr2d_status make_outside(hr2d_scene *made, const hr2d_scene *scene) {
  const size_t bands = made->bands, rows = hr2di_sky_rows(&scene->sky);
  const hr2d_allocator *alloc = &scene->alloc;
  made->background = hr2di_alloc(alloc, bands, sizeof *made->background);
  if (scene->sun) made->sun = hr2di_alloc(alloc, bands, sizeof *made->sun);
  if (rows) made->sky.value = hr2di_alloc(alloc, rows, bands * sizeof *made->sky.value);
  if (!made->background || (scene->sun && !made->sun) || (rows && !made->sky.value))
    return HR2D_ENOMEM;
  made->background_bands = made->sky.bands = bands;
  if (scene->sun) made->sun_bands = bands;
  return HR2D_OK;
}

/* The band of a scene of as many bands, or of a part of them, or of the lender. */
static size_t band_in(const hr2d_scene *relit, const hr2d_scene *scene, size_t band) {
  return relit->band_of ? relit->band_of[band] : band % scene->bands;
}

static void take_patch(hr2d_scene *relit, const hr2d_scene *scene, size_t k) {
  double *emission = hr2di_relit_emission(relit, k), *rho = hr2di_relit_reflectance(relit, k);
  relit->patch[k].light->given = scene->patch[k].light->given;
  for (size_t b = 0; b < relit->bands; b++) {
    emission[b] = hr2d_scene_emission(scene, k, band_in(relit, scene, b));
    rho[b] = hr2d_scene_reflectance(scene, k, band_in(relit, scene, b));
  }
}

static void take_outside(hr2d_scene *relit, const hr2d_scene *scene, size_t band) {
  const hr2di_sky *sky = &scene->sky;
  const size_t of = band_in(relit, scene, band);
  relit->background[band] = hr2d_scene_background(scene, of);
  if (scene->sun) relit->sun[band] = hr2d_scene_sun(scene, of);
  for (size_t k = 0; k < hr2di_sky_rows(sky); k++)
    relit->sky.value[k * relit->bands + band] =
        sky->value[k * sky->bands + (sky->bands == 1 ? 0 : of)];
}

hr2d_status hr2di_relit_renew(hr2d_scene *relit, const hr2d_scene *scene, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < hr2di_scene_cell(scene) && !status; k++) {
    take_patch(relit, scene, k);
    status = hr2di_watch_work(watch, 1 + relit->bands / 4);
  }
  for (size_t b = 0; b < relit->bands && !status; b++) {
    take_outside(relit, scene, b);
    status = hr2di_watch_work(watch, 1 + hr2di_sky_rows(&scene->sky) / 8);
  }
  return status;
}

/* A scene that has nothing of its own yet. */
static hr2d_scene *borrow(const hr2d_scene *scene, size_t bands) {
  hr2d_scene *made = hr2di_alloc(&scene->alloc, 1, sizeof *made);
  if (!made) return NULL;
  *made = *scene;
  made->lender = scene->lender ? scene->lender : scene;
  made->bands = bands;
  made->patch = NULL;
  made->own_lights = NULL;
  made->band_of = NULL;
  made->group = NULL;
  made->groups = 0;
  made->background = NULL;
  made->sun = NULL;
  made->sky.value = NULL;
  return made;
}

static hr2d_status fill(hr2d_scene *made, const hr2d_scene *scene, hr2d_scene **relit) {
  hr2d_status status = make_lights(made, scene);
  if (!status) status = make_outside(made, scene);
  if (status) {
    hr2di_relit_destroy(made);
    return status;
  }
  *relit = made;
  return hr2di_relit_renew(made, scene, NULL);
}

hr2d_status hr2di_relit_create(const hr2d_scene *scene, size_t times, hr2d_scene **relit) {
  const hr2d_scene *lender = scene->lender ? scene->lender : scene;
  hr2d_scene *made = borrow(scene, lender->bands * times);
  if (!made) return HR2D_ENOMEM;
  made->dark = NULL;
  made->effect[HR2D_EFFECT_INTERREFLECTION].on = 1;
  made->effect[HR2D_EFFECT_INTERREFLECTION].called_for = 1;
  return fill(made, scene, relit);
}

hr2d_status hr2di_relit_create_bands(const hr2d_scene *scene, const size_t *band_of,
                                     size_t bands, hr2d_scene **relit) {
  hr2d_scene *made = borrow(scene, bands);
  if (!made) return HR2D_ENOMEM;
  made->committed = 1;
  made->band_of = hr2di_alloc(&scene->alloc, bands, sizeof *made->band_of);
  if (made->band_of) memcpy(made->band_of, band_of, bands * sizeof *band_of);
  if (made->band_of) return fill(made, scene, relit);
  hr2di_relit_destroy(made);
  return HR2D_ENOMEM;
}

/* The lender may be gone. */
void hr2di_relit_destroy(hr2d_scene *relit) {
  if (!relit) return;
  const hr2d_allocator alloc = relit->alloc;
  hr2di_alloc_free(&alloc, relit->own_lights);
  hr2di_alloc_free(&alloc, relit->band_of);
  hr2di_alloc_free(&alloc, relit->patch);
  hr2di_alloc_free(&alloc, relit->found);
  if (!relit->origin) { /* a scene of frozen temperatures shares those */
    hr2di_alloc_free(&alloc, relit->background);
    hr2di_alloc_free(&alloc, relit->sun);
    hr2di_alloc_free(&alloc, relit->sky.value);
  }
  hr2di_alloc_free(&alloc, relit);
}

double *hr2di_relit_emission(hr2d_scene *relit, size_t patch) {
  return relit->patch[patch].light->value;
}

double *hr2di_relit_reflectance(hr2d_scene *relit, size_t patch) {
  return relit->patch[patch].light->value + relit->bands;
}
