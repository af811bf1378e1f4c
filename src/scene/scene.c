/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene object: adding patches, committing, reading back. */
#include <hr2d/hierarchy.h>
#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/alloc.h"
#include "scene/band-groups.h"
#include "scene/patch-light.h"
#include "scene/regions.h"
#include "scene/scene-impl.h"

hr2d_status hr2d_scene_create(const hr2d_allocator *allocator, hr2d_scene **scene) {
  if (!scene) return HR2D_EINVAL;
  hr2d_allocator alloc = allocator ? *allocator : hr2di_alloc_default();
  if (!hr2di_alloc_has_hooks(&alloc)) return HR2D_EINVAL;
  hr2d_scene *made = hr2di_alloc_zero(&alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  made->alloc = alloc;
  hr2di_scene_clear_commit(made);
  *scene = made;
  return HR2D_OK;
}

/* Patches go back to where they were drawn. */
static void put_back(hr2d_scene *scene) {
  hr2di_symmetry *s = &scene->symmetry;
  for (size_t k = 0; s->added && k < s->cell && k < scene->patches; k++)
    scene->patch[k].given = s->added[k];
  hr2di_alloc_free(&scene->alloc, s->added);
  s->added = NULL;
}

void hr2di_scene_clear_commit(hr2d_scene *scene) {
  if (scene->symmetry.motion) hr2di_scene_truncate(scene, scene->symmetry.cell);
  put_back(scene);
  hr2di_symmetry_clear(&scene->symmetry, &scene->alloc);
  hr2di_walls_clear(&scene->walls);
  scene->walls = (hr2di_walls){.alloc = scene->alloc};
  hr2di_runs_clear(&scene->runs);
  scene->runs = (hr2di_runs){.alloc = scene->alloc};
  hr2di_scene_clear_plane(scene);
  hr2di_sunlight_clear(&scene->sunlight, &scene->alloc);
  hr2di_band_groups_clear(scene);
  hr2di_regions_clear(scene);
  hr2di_alloc_free(&scene->alloc, scene->dark);
  scene->dark = NULL;
  hr2di_alloc_free(&scene->alloc, scene->other_side);
  scene->other_side = NULL;
  scene->bands = 1;
  scene->exponent = 0;
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) {
    scene->effect[e].on = 0;
    scene->effect[e].reason[0] = '\0';
  }
}

void hr2d_scene_destroy(hr2d_scene *scene) {
  if (!scene) return;
  hr2di_scene_truncate(scene, 0);
  hr2di_alloc_free(&scene->alloc, scene->patch);
  hr2di_alloc_free(&scene->alloc, scene->background);
  hr2di_alloc_free(&scene->alloc, scene->sun);
  hr2di_sky_clear(&scene->sky, &scene->alloc);
  hr2di_alloc_free(&scene->alloc, scene->spectrum.wavelength);
  hr2di_alloc_free(&scene->alloc, scene->spectrum.weight);
  hr2di_gases_clear(&scene->gases, &scene->alloc);
  hr2di_scene_clear_commit(scene);
  const hr2d_allocator alloc = scene->alloc;
  hr2di_alloc_free(&alloc, scene);
}

void hr2di_scene_truncate(hr2d_scene *scene, size_t patches) {
  while (scene->patches > patches) {
    const hr2di_patch *last = &scene->patch[--scene->patches];
    hr2di_alloc_free(&scene->alloc, last->name);
    hr2di_light_release(&scene->alloc, last->light);
  }
}

const hr2d_allocator *hr2di_scene_allocator(const hr2d_scene *scene) {
  return &scene->alloc;
}

hr2di_message *hr2di_scene_message(hr2d_scene *scene) {
  return &scene->message;
}

hr2di_notes *hr2di_scene_notes(hr2d_scene *scene) {
  return &scene->notes;
}

int hr2di_scene_committed(const hr2d_scene *scene) {
  return scene->committed;
}

/* Allocates the name of a patch to be added, or of its back. */
static char *make_name(hr2d_scene *scene, const char *name, size_t index, int back) {
  char numbered[32];
  snprintf(numbered, sizeof numbered, "patch %zu", index);
  if (!name) name = numbered;
  const char *suffix = back ? " (back)" : "";
  const size_t size = strlen(name) + strlen(suffix) + 1;
  char *made = hr2di_alloc(&scene->alloc, size, 1);
  if (made) snprintf(made, size, "%s%s", name, suffix);
  return made;
}

static hr2d_status add_side(hr2d_scene *scene, const hr2d_patch *patch, size_t index, int back,
                            hr2di_light *light) {
  if (hr2di_alloc_reserve(&scene->alloc, &scene->patch, &scene->capacity, scene->patches + 1,
                          sizeof *scene->patch))
    return HR2D_ENOMEM;
  hr2di_patch made = {.given = {patch->a, patch->b}, .light = light};
  if (back) made.given = (hr2d_segment){patch->b, patch->a};
  made.name = make_name(scene, patch->name, index, back);
  if (!made.name) return HR2D_ENOMEM;
  light->users++;
  scene->patch[scene->patches++] = made;
  hr2di_light_add_length(light, made.given);
  return HR2D_OK;
}

/* Ends the caller's use of the light, also on failure.  `light` is NULL if there was no memory
   for it. */
static hr2d_status add_sides(hr2d_scene *scene, const hr2d_patch *patch, hr2di_light *light) {
  const size_t front = scene->patches;
  hr2d_status status = light ? add_side(scene, patch, front, 0, light) : HR2D_ENOMEM;
  if (!status && patch->sides == HR2D_SIDES_BOTH)
    status = add_side(scene, patch, front, 1, light);
  hr2di_light_release(&scene->alloc, light);
  if (!status) return HR2D_OK;
  hr2di_scene_truncate(scene, front);
  return hr2di_message_fail(&scene->message, status, "out of memory for patch %zu", front);
}

hr2d_status hr2di_patch_copy(const hr2d_allocator *alloc, const hr2di_patch *patch,
                             size_t number, hr2di_patch *copy) {
  const size_t size = strlen(patch->name) + 32;
  *copy = *patch;
  copy->name = hr2di_alloc(alloc, size, 1);
  if (!copy->name) return HR2D_ENOMEM;
  copy->light->users++;
  if (number)
    snprintf(copy->name, size, "%s [%zu]", patch->name, number);
  else
    snprintf(copy->name, size, "%s", patch->name);
  return HR2D_OK;
}

/* patch 3; patch 3 ("door"); without a name patch 3 (feature 2): its number is not in the file
 */
static hr2di_label make_label(size_t index, const char *name, uint32_t feature) {
  hr2di_label label;
  char numbered[32];
  snprintf(numbered, sizeof numbered, "patch %zu", index);
  if (feature)
    snprintf(label.text, sizeof label.text, "%s (feature %" PRIu32 ")", numbered, feature);
  else if (!name || strcmp(name, numbered) == 0)
    snprintf(label.text, sizeof label.text, "%s", numbered);
  else
    snprintf(label.text, sizeof label.text, "%s (%s)", numbered,
             hr2di_message_quote(name).text);
  return label;
}

hr2di_label hr2di_patch_label(const hr2d_scene *scene, size_t patch) {
  const hr2di_symmetry *s = &scene->symmetry;
  const char *name = scene->patch[patch].name;
  hr2di_label label;
  if (patch < hr2di_scene_cell(scene))
    return make_label(patch, name, scene->patch[patch].feature);
  if (patch >= s->motions * s->cell) {
    hr2di_message_copy(label.text, sizeof label.text, name);
    return label;
  }
  static const char of[] = "an image of ";
  memcpy(label.text, of, sizeof of);
  hr2di_message_copy(label.text + sizeof of - 1, sizeof label.text - sizeof of + 1,
                     make_label(patch % s->cell, name, scene->patch[patch].feature).text);
  return label;
}

hr2di_label hr2di_new_patch_label(const hr2d_scene *scene, const char *name) {
  return make_label(scene->patches, name, 0);
}

static hr2d_status check_values(hr2d_scene *scene, const char *label, const char *what,
                                const double *value, size_t count, double max) {
  if (count > 0 && !value)
    return hr2di_message_fail(&scene->message, HR2D_EINVAL, "%s: %s: %zu bands but no values",
                              label, what, count);
  for (size_t k = 0; k < count; k++) {
    if (!isfinite(value[k]))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE, "%s: %s is not finite", label,
                                what);
    if (value[k] < 0)
      return hr2di_message_fail(&scene->message, HR2D_ESCENE, "%s: %s %g is negative", label,
                                what, value[k]);
    if (value[k] > max)
      return hr2di_message_fail(&scene->message, HR2D_ESCENE, "%s: %s %.17g is above %g", label,
                                what, value[k], max);
  }
  return HR2D_OK;
}

static hr2d_status check_segment(hr2d_scene *scene, const hr2d_patch *patch,
                                 const char *label) {
  if (patch->name && !hr2di_message_is_utf8(patch->name))
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "%s: its name is not UTF-8; convert it, for instance by iconv",
                              label);
  const double coordinate[] = {patch->a.x, patch->a.y, patch->b.x, patch->b.y};
  for (int k = 0; k < 4; k++)
    if (!isfinite(coordinate[k]))
      return hr2di_message_fail(&scene->message, HR2D_ESCENE, "%s: a coordinate is not finite",
                                label);
  if (patch->a.x == patch->b.x && patch->a.y == patch->b.y)
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "%s: its length is zero, at (%.17g, %.17g)", label, patch->a.x,
                              patch->a.y);
  if (patch->sides != HR2D_SIDES_FRONT && patch->sides != HR2D_SIDES_BOTH)
    return hr2di_message_fail(&scene->message, HR2D_EINVAL, "%s: sides has no meaning", label);
  return HR2D_OK;
}

/* E and ρ of a patch with thermal properties follow from these, which are checked already. */
static hr2d_status check_light(hr2d_scene *scene, const hr2d_patch *patch,
                               const hr2d_thermal *thermal, const char *label) {
  hr2d_status status = check_values(scene, label, "transmittance", patch->transmittance,
                                    patch->transmittance_bands, 1);
  if (thermal || status) return status;
  status =
      check_values(scene, label, "emission", patch->emission, patch->emission_bands, HUGE_VAL);
  return status ? status
                : check_values(scene, label, "reflectance", patch->reflectance,
                               patch->reflectance_bands, 1);
}

hr2d_status hr2di_scene_add(hr2d_scene *scene, const hr2d_patch *patch,
                            const hr2d_thermal *thermal, size_t *index) {
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE,
                              "a committed scene takes no more patches");
  const size_t front = scene->patches;
  const hr2di_label label = make_label(front, patch->name, 0);
  hr2d_status status = check_segment(scene, patch, label.text);
  if (!status) status = check_light(scene, patch, thermal, label.text);
  if (!status)
    status = add_sides(scene, patch, hr2di_light_make(&scene->alloc, patch, thermal));
  if (!status && index) *index = front;
  return status;
}

hr2d_status hr2d_scene_add(hr2d_scene *scene, const hr2d_patch *patch, size_t *index) {
  if (!scene || !patch) return HR2D_EINVAL;
  return hr2di_scene_add(scene, patch, NULL, index);
}

hr2d_status hr2di_scene_add_alike(hr2d_scene *scene, const hr2d_patch *patch, size_t like) {
  hr2d_status status =
      check_segment(scene, patch, make_label(scene->patches, patch->name, 0).text);
  if (status) return status;
  hr2di_light *light = scene->patch[like].light;
  light->users++;
  return add_sides(scene, patch, light);
}

hr2d_status hr2d_scene_set_background(hr2d_scene *scene, const double *background,
                                      size_t bands) {
  if (!scene) return HR2D_EINVAL;
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE,
                              "a committed scene takes no background");
  hr2d_status status =
      check_values(scene, "background", "radiosity", background, bands, HUGE_VAL);
  if (status) return status;
  double *copy = hr2di_alloc(&scene->alloc, bands, sizeof *copy);
  if (!copy)
    return hr2di_message_fail(&scene->message, HR2D_ENOMEM, "out of memory for the background");
  for (size_t k = 0; k < bands; k++) copy[k] = background[k];
  hr2di_alloc_free(&scene->alloc, scene->background);
  scene->background = copy;
  scene->background_bands = bands;
  return HR2D_OK;
}

hr2d_status hr2d_scene_force(hr2d_scene *scene, hr2d_effect effect) {
  if (!scene) return HR2D_EINVAL;
  if ((unsigned)effect >= HR2D_EFFECT_COUNT)
    return hr2di_message_fail(&scene->message, HR2D_EINVAL, "there is no effect %d",
                              (int)effect);
  if (scene->committed)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE, "the scene is committed already");
  scene->effect[effect].forced = 1;
  return HR2D_OK;
}

void hr2d_scene_set_progress(hr2d_scene *scene, hr2d_progress_fn progress, void *ctx) {
  if (!scene) return;
  scene->progress = progress;
  scene->progress_ctx = ctx;
}

void hr2di_scene_choose_progress(const hr2d_scene *scene, hr2d_progress_fn *progress,
                                 void **ctx) {
  const hr2d_scene *own = scene->lender ? scene->lender : scene;
  if (*progress) return;
  *progress = own->progress;
  *ctx = own->progress_ctx;
}

void hr2di_scene_watch(const hr2d_scene *scene, hr2di_watch *watch, hr2d_progress_fn progress,
                       void *ctx, const char *phase) {
  hr2di_scene_choose_progress(scene, &progress, &ctx);
  hr2di_watch_init(watch, progress, ctx, phase);
}

hr2d_status hr2di_scene_fail(hr2d_scene *scene, hr2d_status status, const hr2di_watch *watch,
                             const char *what) {
  if (hr2di_watch_refused(watch))
    return hr2di_message_fail(&scene->message, status, "callback \"progress\": %s",
                              hr2d_strerror(status));
  return hr2di_message_fail(&scene->message, status, "out of memory for %s", what);
}

const char *hr2d_scene_message(const hr2d_scene *scene) {
  if (!scene) return "";
  return scene->message.text;
}

size_t hr2d_scene_patches(const hr2d_scene *scene) {
  if (!scene) return 0;
  return hr2di_scene_cell(scene);
}

size_t hr2d_scene_bands(const hr2d_scene *scene) {
  if (!scene) return 0;
  return scene->bands;
}

hr2d_segment hr2d_scene_segment(const hr2d_scene *scene, size_t patch) {
  if (!hr2di_scene_has(scene, patch)) return (hr2d_segment){{NAN, NAN}, {NAN, NAN}};
  const hr2d_segment *added = scene->symmetry.added;
  return added && patch < scene->symmetry.cell ? added[patch] : scene->patch[patch].given;
}

double hr2d_scene_length(const hr2d_scene *scene, size_t patch) {
  if (!hr2di_scene_has(scene, patch)) return NAN;
  if (scene->committed) return ldexp(scene->patch[patch].length, scene->exponent);
  const hr2d_segment s = scene->patch[patch].given;
  return hypot(s.b.x - s.a.x, s.b.y - s.a.y);
}

const char *hr2d_scene_name(const hr2d_scene *scene, size_t patch) {
  if (!hr2di_scene_has(scene, patch)) return NULL;
  return scene->patch[patch].name;
}

hr2d_status hr2d_scene_find(const hr2d_scene *scene, const char *name, size_t *patch) {
  if (!scene || !name || !patch) return HR2D_EINVAL;
  for (size_t k = 0; k < hr2di_scene_cell(scene); k++)
    if (strcmp(scene->patch[k].name, name) == 0) {
      *patch = k;
      return HR2D_OK;
    }
  return HR2D_EINVAL;
}

size_t hr2d_scene_other_side(const hr2d_scene *scene, size_t patch) {
  return hr2di_scene_has(scene, patch) ? hr2di_scene_other_side(scene, patch) : HR2D_NO_ELEMENT;
}

double hr2d_scene_unit(const hr2d_scene *scene) {
  if (!scene) return NAN;
  return ldexp(1, scene->exponent);
}
