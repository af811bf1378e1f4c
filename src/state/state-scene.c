/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a committed scene and reads it back.  The format:

   - a line that names it;
   - the number of patches, the bytes of all that is between here and the hash, the bits of the
     effects that are forced, the bands of the background and the number of wavelengths, as
     words; with daylight, for which the line is another one, the numbers of suns,
     of pieces of the sky and of bands of these as well;
   - the background, the wavelengths, the suns, and the pieces with their values;
   - per patch: whether it has the light of the one before, as a half word; if not, what heat is
     given, the bands of E, ρ and ε, as words, the heat and their values; the ends; the length
   of the name, as a half word, and the name;
   - the hash of the scene in memory, and that of all bytes.

   What commit finds is not written: it follows from the rest, with the same bits. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "scene/emissivity.h"
#include "scene/scene-impl.h"
#include "state/byte-stream.h"
#include "state/state-impl.h"

#define TITLE     "libhr2d scene 1\n"
#define DAY_TITLE "libhr2d scene 2\n"

enum { TITLE_BYTES = sizeof TITLE - 1, HEAD_WORDS = 5, DAY_WORDS = 3, SUN_DOUBLES = 3 };

static int is_alike(const hr2d_scene *scene, size_t patch) {
  return patch > 0 && scene->patch[patch].light == scene->patch[patch - 1].light;
}

static size_t values_of(const hr2di_light *l) {
  return l->emission_bands + l->reflectance_bands + l->emissivity_bands;
}

static uint64_t count_bytes(const hr2d_scene *scene) {
  uint64_t bytes = 8 * (scene->background_bands + scene->wavelengths + 1);
  bytes += 8 * SUN_DOUBLES * (uint64_t)scene->sun_bands;
  bytes += 8 * (uint64_t)scene->sky.pieces * (2 + scene->sky.bands);
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2di_patch *p = &scene->patch[k];
    bytes += 4 + 4 * 8 + 4 + strlen(p->name);
    if (!is_alike(scene, k)) bytes += 8 * (5 + values_of(p->light));
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

static void put_light(hr2di_writer *w, const hr2di_light *l) {
  hr2di_writer_word(w, (uint64_t)l->heat);
  hr2di_writer_word(w, l->emission_bands);
  hr2di_writer_word(w, l->reflectance_bands);
  hr2di_writer_word(w, l->emissivity_bands);
  hr2di_writer_double(w, l->given);
  for (size_t k = 0; k < values_of(l); k++) hr2di_writer_double(w, l->value[k]);
}

static void put_patch(hr2di_writer *w, const hr2di_patch *p, int alike) {
  hr2di_writer_half(w, (uint32_t)alike);
  if (!alike) put_light(w, p->light);
  const double end[] = {p->given.a.x, p->given.a.y, p->given.b.x, p->given.b.y};
  for (int k = 0; k < 4; k++) hr2di_writer_double(w, end[k]);
  put_name(w, p->name);
}

static uint64_t forced_effects(const hr2d_scene *scene) {
  uint64_t bits = 0;
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) bits |= (uint64_t)scene->effect[e].forced << e;
  return bits;
}

static int has_day(const hr2d_scene *scene) {
  return scene->sun_bands || scene->sky.pieces;
}

static void put_head(hr2di_writer *w, const hr2d_scene *scene) {
  hr2di_writer_text(w, has_day(scene) ? DAY_TITLE : TITLE, TITLE_BYTES);
  hr2di_writer_word(w, scene->patches);
  hr2di_writer_word(w, count_bytes(scene));
  hr2di_writer_word(w, forced_effects(scene));
  hr2di_writer_word(w, scene->background_bands);
  hr2di_writer_word(w, scene->wavelengths);
  if (!has_day(scene)) return;
  hr2di_writer_word(w, scene->sun_bands);
  hr2di_writer_word(w, scene->sky.pieces);
  hr2di_writer_word(w, scene->sky.bands);
}

static void put_lights(hr2di_writer *w, const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->background_bands; k++)
    hr2di_writer_double(w, scene->background[k]);
  for (size_t k = 0; k < scene->wavelengths; k++) hr2di_writer_double(w, scene->wavelength[k]);
  for (size_t k = 0; k < scene->sun_bands; k++) {
    hr2di_writer_double(w, scene->sun[k].direction.x);
    hr2di_writer_double(w, scene->sun[k].direction.y);
    hr2di_writer_double(w, scene->sun[k].irradiance);
  }
  const hr2di_sky *sky = &scene->sky;
  for (size_t k = 0; k < sky->pieces; k++) {
    hr2di_writer_double(w, sky->piece[k].from);
    hr2di_writer_double(w, sky->piece[k].to);
    for (size_t b = 0; b < sky->bands; b++)
      hr2di_writer_double(w, sky->value[k * sky->bands + b]);
  }
}

hr2d_status hr2d_state_write_scene(const hr2d_scene *scene, hr2d_write_fn write, void *ctx) {
  if (!scene->committed) return HR2D_ESTATE;
  if (scene->symmetry.motion) return HR2D_EUNSUPPORTED;
  for (size_t k = 0; k < scene->patches; k++)
    if (hr2di_emissivity_depends(scene, k)) return HR2D_EUNSUPPORTED;
  hr2di_writer w;
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, NULL, NULL, "state");
  hr2di_writer_init(&w, write, ctx);
  put_head(&w, scene);
  put_lights(&w, scene);
  for (size_t k = 0; k < scene->patches && !w.status; k++) {
    const int alike = is_alike(scene, k);
    put_patch(&w, &scene->patch[k], alike);
    if (!w.status)
      w.status =
          hr2di_watch_work(&watch, 1 + (alike ? 0 : values_of(scene->patch[k].light) / 16));
  }
  hr2di_writer_word(&w, hr2di_state_scene(scene, &watch));
  if (!w.status) w.status = watch.status;
  return hr2di_writer_end(&w);
}

typedef struct loading {
  hr2di_reader reader;
  hr2di_watch watch;
  hr2d_scene *scene;
  double *value; /* of the light of a patch */
  size_t values;
  char *name;
  size_t name_room;
} loading;

static hr2d_status damaged(loading *l, const char *what) {
  return hr2di_message_fail(&l->scene->message, HR2D_ESYNTAX, "the scene is damaged: %s", what);
}

static hr2d_status out_of_memory(loading *l) {
  return hr2di_message_fail(&l->scene->message, HR2D_ENOMEM, "out of memory for the scene");
}

/* Announced bytes that were not asked for. */
static uint64_t left_of(const hr2di_reader *r) {
  return r->expected + (r->held - r->at);
}

/* Reads so many doubles, if there are so many: memory grows with what was read. */
static hr2d_status read_values(loading *l, uint64_t count) {
  if (count > left_of(&l->reader) / 8) return damaged(l, "its number of bands");
  for (size_t k = 0; k < count; k++) {
    if (hr2di_alloc_reserve(&l->scene->alloc, &l->value, &l->values, k + 1, sizeof *l->value))
      return out_of_memory(l);
    l->value[k] = hr2di_reader_double(&l->reader);
    if (l->reader.status) return l->reader.status;
    const hr2d_status status = k % 256 ? HR2D_OK : hr2di_watch_work(&l->watch, 32);
    if (status) return status;
  }
  return HR2D_OK;
}

static hr2d_status read_name(loading *l) {
  const uint32_t size = hr2di_reader_half(&l->reader);
  if (l->reader.status) return l->reader.status;
  if (size > left_of(&l->reader)) return damaged(l, "the length of a name");
  for (uint32_t at = 0, some = 0; at <= size; at += some) {
    some = size - at < HR2DI_BYTES_AT_ONCE ? size - at : HR2DI_BYTES_AT_ONCE;
    if (hr2di_alloc_reserve(&l->scene->alloc, &l->name, &l->name_room, at + some + 1, 1))
      return out_of_memory(l);
    hr2di_reader_text(&l->reader, l->name + at, some);
    l->name[at + some] = '\0';
    if (l->reader.status) return l->reader.status;
    if (some == 0) break;
  }
  return strlen(l->name) == size ? HR2D_OK : damaged(l, "a name");
}

/* What hr2d_scene_add_thermal() makes: E may be negative on a patch of given flux. */
static int is_thermal(const hr2d_patch *patch, const hr2d_thermal *t) {
  const int flux = t->given == HR2D_HEAT_FLUX;
  int valid = isfinite(t->value) != 0;
  for (size_t k = 0; k < patch->emission_bands; k++)
    valid &= isfinite(patch->emission[k]) && (flux || patch->emission[k] >= 0);
  for (size_t k = 0; k < patch->reflectance_bands; k++)
    valid &= patch->reflectance[k] >= 0 && patch->reflectance[k] <= 1;
  for (size_t k = 0; k < t->emissivity_bands; k++)
    valid &= t->emissivity[k] >= (flux ? DBL_MIN : 0) && t->emissivity[k] <= 1;
  return valid;
}

/* Its arrays are in l->value. */
static hr2d_status read_light(loading *l, hr2d_patch *patch, hr2d_thermal *t) {
  hr2di_reader *r = &l->reader;
  uint64_t bands[3];
  const uint64_t heat = hr2di_reader_word(r);
  for (int k = 0; k < 3; k++) bands[k] = hr2di_reader_word(r);
  t->value = hr2di_reader_double(r);
  if (r->status) return r->status;
  if (heat > HR2D_HEAT_FLUX) return damaged(l, "what is given of a patch");
  for (int k = 0; k < 3; k++)
    if (bands[k] > UINT64_MAX / 32) return damaged(l, "its number of bands");
  const hr2d_status status = read_values(l, bands[0] + bands[1] + bands[2]);
  if (status) return status;
  t->given = (hr2d_heat)heat;
  patch->emission_bands = (size_t)bands[0];
  patch->reflectance_bands = (size_t)bands[1];
  t->emissivity_bands = (size_t)bands[2];
  patch->emission = l->value;
  patch->reflectance = bands[1] > 0 ? l->value + bands[0] : NULL;
  t->emissivity = bands[2] > 0 ? l->value + bands[0] + bands[1] : NULL;
  return HR2D_OK;
}

static hr2d_status read_patch(loading *l) {
  hr2di_reader *r = &l->reader;
  hr2d_patch patch = {.sides = HR2D_SIDES_FRONT};
  hr2d_thermal thermal = HR2D_THERMAL_INIT;
  const uint32_t alike = hr2di_reader_half(r);
  hr2d_status status = hr2di_watch_work(&l->watch, 1);
  if (!status) status = r->status;
  if (!status && alike > (l->scene->patches > 0)) status = damaged(l, "a patch");
  if (!status && !alike) status = read_light(l, &patch, &thermal);
  double *const end[] = {&patch.a.x, &patch.a.y, &patch.b.x, &patch.b.y};
  for (int k = 0; k < 4; k++) *end[k] = hr2di_reader_double(r);
  if (!status) status = r->status ? r->status : read_name(l);
  if (status) return status;
  patch.name = l->name;
  if (alike) return hr2di_scene_add_alike(l->scene, &patch);
  if (thermal.given == HR2D_HEAT_NONE) return hr2d_scene_add(l->scene, &patch, NULL);
  if (!is_thermal(&patch, &thermal)) return damaged(l, "the heat of a patch");
  return hr2di_scene_add(l->scene, &patch, &thermal, NULL);
}

static hr2d_status read_background(loading *l, uint64_t bands) {
  if (bands == 0) return HR2D_OK;
  const hr2d_status status = read_values(l, bands);
  return status ? status : hr2d_scene_set_background(l->scene, l->value, (size_t)bands);
}

static hr2d_status read_wavelengths(loading *l, uint64_t count) {
  if (count == 0) return HR2D_OK;
  const hr2d_status status = read_values(l, count);
  return status ? status : hr2d_scene_set_wavelengths(l->scene, l->value, (size_t)count);
}

/* hr2d_sun is three doubles. */
static hr2d_status read_suns(loading *l, uint64_t count) {
  if (count == 0) return HR2D_OK;
  if (count > UINT64_MAX / 32) return damaged(l, "its number of suns");
  hr2d_status status = read_values(l, SUN_DOUBLES * count);
  if (status) return status;
  hr2d_sun *sun = hr2di_alloc(&l->scene->alloc, (size_t)count, sizeof *sun);
  if (!sun) return out_of_memory(l);
  for (size_t k = 0; k < count; k++) {
    const double *v = l->value + SUN_DOUBLES * k;
    sun[k] = (hr2d_sun){{v[0], v[1]}, v[2]};
  }
  status = hr2d_scene_set_sun(l->scene, sun, (size_t)count);
  hr2di_alloc_free(&l->scene->alloc, sun);
  return status;
}

/* Of each piece its two bearings, and its values. */
static hr2d_status read_sky(loading *l, uint64_t pieces, uint64_t bands) {
  if (pieces == 0) return HR2D_OK;
  if (pieces > HR2DI_SKY_PIECES || bands > UINT64_MAX / 32 / HR2DI_SKY_PIECES)
    return damaged(l, "its sky");
  hr2d_status status = read_values(l, pieces * (2 + bands));
  if (status) return status;
  const size_t count = (size_t)pieces, each = (size_t)bands + 2;
  hr2d_sky_piece *piece = hr2di_alloc(&l->scene->alloc, count, sizeof *piece);
  if (!piece) return out_of_memory(l);
  for (size_t k = 0; k < count; k++) {
    const double *v = l->value + k * each;
    piece[k] = (hr2d_sky_piece){v[0], v[1]};
    for (size_t b = 0; b < each - 2; b++) l->value[k * (each - 2) + b] = v[2 + b];
  }
  status = hr2d_scene_set_sky(l->scene, piece, count, l->value, (size_t)bands);
  hr2di_alloc_free(&l->scene->alloc, piece);
  return status;
}

static hr2d_status force_effects(loading *l, uint64_t bits) {
  if (bits >> HR2D_EFFECT_COUNT) return damaged(l, "its effects");
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) l->scene->effect[e].forced = (int)(bits >> e & 1);
  return HR2D_OK;
}

static hr2d_status read_all(loading *l) {
  hr2di_reader *r = &l->reader;
  char title[TITLE_BYTES];
  uint64_t head[HEAD_WORDS + DAY_WORDS] = {0};
  hr2di_reader_expect(r, TITLE_BYTES + 8 * HEAD_WORDS);
  hr2di_reader_text(r, title, TITLE_BYTES);
  const int sunny = !r->status && memcmp(title, DAY_TITLE, TITLE_BYTES) == 0;
  if ((r->status && r->status != HR2D_ESYNTAX) || sunny ||
      (!r->status && memcmp(title, TITLE, TITLE_BYTES) == 0)) {
    for (int k = 0; k < HEAD_WORDS; k++) head[k] = hr2di_reader_word(r);
    if (sunny && !r->status) hr2di_reader_expect(r, 8 * DAY_WORDS);
    for (int k = 0; k < DAY_WORDS && sunny && !r->status; k++)
      head[HEAD_WORDS + k] = hr2di_reader_word(r);
  } else {
    return hr2di_message_fail(&l->scene->message, HR2D_ESYNTAX,
                              "this is not a scene of hr2d_state_write_scene()");
  }
  if (r->status) return r->status;
  if (head[1] > UINT64_MAX / 2) return damaged(l, "its size");
  hr2di_reader_expect(r, head[1] + 8);
  hr2d_status status = force_effects(l, head[2]);
  if (!status) status = read_background(l, head[3]);
  if (!status) status = read_wavelengths(l, head[4]);
  if (!status) status = read_suns(l, head[HEAD_WORDS]);
  if (!status) status = read_sky(l, head[HEAD_WORDS + 1], head[HEAD_WORDS + 2]);
  for (uint64_t k = 0; k < head[0] && !status; k++) status = read_patch(l);
  const uint64_t hash = hr2di_reader_word(r);
  if (!status && hr2di_reader_end(r)) status = r->status;
  if (!status) status = hr2d_scene_commit(l->scene);
  if (!status && hash != hr2di_state_scene(l->scene, &l->watch))
    status =
        l->watch.status ? l->watch.status : damaged(l, "its hash is not that of the scene");
  return status;
}

/* Says why reading has failed, where nobody has. */
static hr2d_status explain(loading *l, hr2d_status status) {
  if (status == HR2D_ESYNTAX && l->reader.status)
    return damaged(l, "it ends too early, or its hash is not that of its contents");
  if (status && (status == l->reader.status || l->watch.refused))
    return hr2di_message_fail(&l->scene->message, status, "reading the scene: %s",
                              hr2d_strerror(status));
  return status;
}

/* As it was before. */
static void empty(hr2d_scene *scene) {
  hr2di_scene_truncate(scene, 0);
  hr2di_alloc_free(&scene->alloc, scene->background);
  scene->background = NULL;
  scene->background_bands = 0;
  hr2di_scene_take_sun(scene, NULL, 0);
  hr2di_sky_clear(&scene->sky, &scene->alloc);
  hr2di_alloc_free(&scene->alloc, scene->wavelength);
  scene->wavelength = NULL;
  scene->wavelengths = 0;
  scene->committed = 0;
  hr2di_scene_clear_commit(scene);
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) scene->effect[e].forced = 0;
}

hr2d_status hr2d_state_read_scene(hr2d_scene *scene, hr2d_read_fn read, void *ctx) {
  if (scene->committed || scene->patches > 0 || scene->background || scene->wavelengths ||
      scene->sun || scene->sky.pieces)
    return hr2di_message_fail(&scene->message, HR2D_ESTATE, "the scene is not empty");
  loading l = {.scene = scene};
  hr2di_scene_watch(scene, &l.watch, NULL, NULL, "state");
  hr2di_reader_init(&l.reader, read, ctx);
  const hr2d_status status = explain(&l, read_all(&l));
  hr2di_alloc_free(&scene->alloc, l.value);
  hr2di_alloc_free(&scene->alloc, l.name);
  if (status) empty(scene);
  return status;
}
