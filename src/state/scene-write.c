/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a committed scene. */
#include <hr2d/symmetry.h>
#include <string.h>

#include "scene/emissivity.h"
#include "scene/scene-impl.h"
#include "state/byte-stream.h"
#include "state/scene-format.h"
#include "state/state-impl.h"

static int has_same_light(const hr2d_scene *scene, size_t patch) {
  return patch > 0 && scene->patch[patch].light == scene->patch[patch - 1].light;
}

static size_t values_of(const hr2di_light *l) {
  return l->emission_bands + l->reflectance_bands + l->emissivity_bands +
         l->transmittance_bands;
}

/* A transmittance of 0 is no pane, but a part of a light.  Beside a continuous sky there is
   room for them in any case. */
static int has_panes(const hr2d_scene *scene) {
  size_t k = 0;
  if (hr2di_sky_is_continuous(&scene->sky)) return 1;
  while (k < hr2di_scene_cell(scene) && !scene->patch[k].light->transmittance_bands) k++;
  return k < hr2di_scene_cell(scene);
}

static int has_day(const hr2d_scene *scene) {
  return scene->sun_bands || scene->sky.pieces;
}

/* Whether a period and mirrors are written. */
static int has_symmetry(const hr2d_scene *scene) {
  return hr2di_symmetry_wanted(&scene->symmetry) || has_panes(scene);
}

static uint64_t count_bytes(const hr2d_scene *scene) {
  const size_t mirrors = scene->symmetry.mirrors, numbers = has_panes(scene) ? 6 : 5;
  uint64_t bytes = 8 * (scene->background_bands + hr2di_scene_spectral_bands(scene));
  if (has_symmetry(scene))
    bytes += 8 * (HR2DI_SCENE_PERIOD_DOUBLES + HR2DI_SCENE_MIRROR_DOUBLES * (uint64_t)mirrors);
  bytes += 8 * HR2DI_SCENE_SUN_DOUBLES * (uint64_t)scene->sun_bands;
  bytes += 8 * ((uint64_t)scene->sky.pieces * (scene->sky.goes_on ? 3 : 2) +
                hr2di_sky_rows(&scene->sky) * scene->sky.bands);
  for (size_t k = 0; k < hr2di_scene_cell(scene); k++) {
    const hr2di_patch *p = &scene->patch[k];
    bytes += 4 + 4 * 8 + 4 + strlen(p->name);
    if (!has_same_light(scene, k)) bytes += 8 * (numbers + values_of(p->light));
  }
  return bytes;
}

/* In pieces that fit into the buffer of a writer. */
static void put_name(hr2di_writer *w, const char *name) {
  size_t left = strlen(name);
  hr2di_writer_half(w, (uint32_t)left);
  while (left > 0) {
    const size_t some = left < HR2DI_BYTES_AT_ONCE ? left : HR2DI_BYTES_AT_ONCE;
    hr2di_writer_text(w, name, some);
    name += some;
    left -= some;
  }
}

static void put_light(hr2di_writer *w, const hr2di_light *l, int panes) {
  hr2di_writer_word(w, (uint64_t)l->heat);
  hr2di_writer_word(w, l->emission_bands);
  hr2di_writer_word(w, l->reflectance_bands);
  hr2di_writer_word(w, l->emissivity_bands);
  if (panes) hr2di_writer_word(w, l->transmittance_bands);
  hr2di_writer_double(w, l->given);
  for (size_t k = 0; k < values_of(l); k++) hr2di_writer_double(w, l->value[k]);
}

static void put_segment(hr2di_writer *w, hr2d_segment s) {
  const double end[] = {s.a.x, s.a.y, s.b.x, s.b.y};
  for (int k = 0; k < 4; k++) hr2di_writer_double(w, end[k]);
}

/* As it was drawn: commit may have moved it by periods. */
static void put_patch(hr2di_writer *w, const hr2d_scene *scene, size_t patch, int same_light,
                      int panes) {
  hr2di_writer_half(w, (uint32_t)same_light);
  if (!same_light) put_light(w, scene->patch[patch].light, panes);
  put_segment(w, hr2d_scene_segment(scene, patch));
  put_name(w, scene->patch[patch].name);
}

static uint64_t forced_effects(const hr2d_scene *scene) {
  uint64_t bits = 0;
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) bits |= (uint64_t)scene->effect[e].forced << e;
  return bits;
}

static const char *title_of(const hr2d_scene *scene) {
  return hr2di_sky_is_continuous(&scene->sky) ? HR2DI_SCENE_SKY_TITLE
         : has_panes(scene)                   ? HR2DI_SCENE_PANES_TITLE
         : has_symmetry(scene)                ? HR2DI_SCENE_SYMMETRY_TITLE
         : has_day(scene)                     ? HR2DI_SCENE_DAY_TITLE
                                              : HR2DI_SCENE_TITLE;
}

static void put_head(hr2di_writer *w, const hr2d_scene *scene) {
  hr2di_writer_text(w, title_of(scene), HR2DI_SCENE_TITLE_BYTES);
  hr2di_writer_word(w, hr2di_scene_cell(scene));
  hr2di_writer_word(w, count_bytes(scene));
  hr2di_writer_word(w, forced_effects(scene));
  hr2di_writer_word(w, scene->background_bands);
  hr2di_writer_word(w, scene->spectrum.wavelengths);
  if (!has_day(scene) && !has_symmetry(scene)) return;
  hr2di_writer_word(w, scene->sun_bands);
  hr2di_writer_word(w, scene->sky.pieces);
  hr2di_writer_word(w, scene->sky.bands);
  if (has_symmetry(scene)) hr2di_writer_word(w, scene->symmetry.mirrors);
  if (hr2di_sky_is_continuous(&scene->sky)) hr2di_writer_word(w, scene->sky.terms);
}

static void put_symmetry(hr2di_writer *w, const hr2di_symmetry *s) {
  hr2di_writer_double(w, s->period.x);
  hr2di_writer_double(w, s->period.y);
  for (size_t k = 0; k < s->mirrors; k++) put_segment(w, s->mirror[k]);
}

static void put_lights(hr2di_writer *w, const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->background_bands; k++)
    hr2di_writer_double(w, scene->background[k]);
  for (size_t k = 0; k < scene->spectrum.wavelengths; k++)
    hr2di_writer_double(w, scene->spectrum.wavelength[k]);
  for (size_t k = 0; k < scene->sun_bands; k++) {
    hr2di_writer_double(w, scene->sun[k].direction.x);
    hr2di_writer_double(w, scene->sun[k].direction.y);
    hr2di_writer_double(w, scene->sun[k].irradiance);
  }
  const hr2di_sky *sky = &scene->sky;
  for (size_t k = 0; k < sky->pieces; k++) {
    hr2di_writer_double(w, sky->piece[k].from);
    hr2di_writer_double(w, sky->piece[k].to);
    if (sky->goes_on) hr2di_writer_double(w, sky->goes_on[k]);
    for (size_t m = 0; m < sky->terms * sky->bands; m++)
      hr2di_writer_double(w, sky->value[k * sky->terms * sky->bands + m]);
  }
}

hr2d_status hr2d_state_write_scene(const hr2d_scene *scene, hr2d_write_fn write, void *ctx) {
  if (!scene || !write) return HR2D_EINVAL;
  if (!scene->committed) return HR2D_ESTATE;
  if (hr2di_scene_has_gas(scene) || scene->spectrum.weights) return HR2D_EUNSUPPORTED;
  const size_t patches = hr2di_scene_cell(scene);
  const int panes = has_panes(scene);
  for (size_t k = 0; k < patches; k++)
    if (hr2di_emissivity_depends(scene, k)) return HR2D_EUNSUPPORTED;
  hr2di_writer w;
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "state");
  hr2di_writer_init(&w, write, ctx);
  put_head(&w, scene);
  put_lights(&w, scene);
  if (has_symmetry(scene)) put_symmetry(&w, &scene->symmetry);
  for (size_t k = 0; k < patches && !w.status; k++) {
    const int same_light = has_same_light(scene, k);
    put_patch(&w, scene, k, same_light, panes);
    if (!w.status)
      w.status = hr2di_watch_work(&watch,
                                  1 + (same_light ? 0 : values_of(scene->patch[k].light) / 16));
  }
  hr2di_writer_word(&w, hr2di_state_scene(scene, &watch));
  if (!w.status) w.status = watch.status;
  return hr2di_writer_end(&w);
}
