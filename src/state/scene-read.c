/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads a scene, and commits it. */
#include <float.h>
#include <hr2d/symmetry.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "state/byte-stream.h"
#include "state/scene-format.h"
#include "state/state-impl.h"

typedef struct loading {
  hr2di_reader reader;
  hr2di_watch watch;
  hr2d_scene *scene;
  int panes;     /* lights have a transmittance */
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
  const int flux = t->given == HR2D_HEAT_FLUX, shield = t->given == HR2D_HEAT_SHIELD;
  int valid = isfinite(t->value) != 0;
  if (shield) /* which has nothing but ε */
    valid &= t->value == 0 && !patch->emission_bands && !patch->reflectance_bands &&
             !patch->transmittance_bands;
  for (size_t k = 0; k < patch->emission_bands; k++)
    valid &= isfinite(patch->emission[k]) && (flux || patch->emission[k] >= 0);
  for (size_t k = 0; k < patch->reflectance_bands; k++)
    valid &= patch->reflectance[k] >= 0 && patch->reflectance[k] <= 1;
  for (size_t k = 0; k < t->emissivity_bands; k++)
    valid &= t->emissivity[k] >= (flux || shield ? DBL_MIN : 0) && t->emissivity[k] <= 1;
  return valid;
}

/* Its arrays are in l->value. */
static hr2d_status read_light(loading *l, hr2d_patch *patch, hr2d_thermal *t) {
  hr2di_reader *r = &l->reader;
  const int numbers = l->panes ? 4 : 3;
  uint64_t bands[4] = {0};
  const uint64_t heat = hr2di_reader_word(r);
  for (int k = 0; k < numbers; k++) bands[k] = hr2di_reader_word(r);
  t->value = hr2di_reader_double(r);
  if (r->status) return r->status;
  if (heat > HR2D_HEAT_SHIELD) return damaged(l, "what is given of a patch");
  for (int k = 0; k < numbers; k++)
    if (bands[k] > UINT64_MAX / 32) return damaged(l, "its number of bands");
  const hr2d_status status = read_values(l, bands[0] + bands[1] + bands[2] + bands[3]);
  if (status) return status;
  t->given = (hr2d_heat)heat;
  patch->emission_bands = (size_t)bands[0];
  patch->reflectance_bands = (size_t)bands[1];
  t->emissivity_bands = (size_t)bands[2];
  patch->emission = l->value;
  patch->reflectance = bands[1] > 0 ? l->value + bands[0] : NULL;
  t->emissivity = bands[2] > 0 ? l->value + bands[0] + bands[1] : NULL;
  patch->transmittance_bands = (size_t)bands[3];
  patch->transmittance = bands[3] > 0 ? l->value + bands[0] + bands[1] + bands[2] : NULL;
  return HR2D_OK;
}

static hr2d_status read_patch(loading *l) {
  hr2di_reader *r = &l->reader;
  hr2d_patch patch = {.sides = HR2D_SIDES_FRONT};
  hr2d_thermal thermal = HR2D_THERMAL_INIT;
  const uint32_t same_light = hr2di_reader_half(r);
  hr2d_status status = hr2di_watch_work(&l->watch, 1);
  if (!status) status = r->status;
  if (!status && same_light > (l->scene->patches > 0)) status = damaged(l, "a patch");
  if (!status && !same_light) status = read_light(l, &patch, &thermal);
  double *const end[] = {&patch.a.x, &patch.a.y, &patch.b.x, &patch.b.y};
  for (int k = 0; k < 4; k++) *end[k] = hr2di_reader_double(r);
  if (!status) status = r->status ? r->status : read_name(l);
  if (status) return status;
  patch.name = l->name;
  if (same_light) return hr2di_scene_add_alike(l->scene, &patch, l->scene->patches - 1);
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
  hr2d_status status = read_values(l, HR2DI_SCENE_SUN_DOUBLES * count);
  if (status) return status;
  hr2d_sun *sun = hr2di_alloc(&l->scene->alloc, (size_t)count, sizeof *sun);
  if (!sun) return out_of_memory(l);
  for (size_t k = 0; k < count; k++) {
    const double *v = l->value + HR2DI_SCENE_SUN_DOUBLES * k;
    sun[k] = (hr2d_sun){{v[0], v[1]}, v[2]};
  }
  status = hr2d_scene_set_sun(l->scene, sun, (size_t)count);
  hr2di_alloc_free(&l->scene->alloc, sun);
  return status;
}

/* Of each piece its two bearings, of a continuous sky whether it goes on, and its values. Moves
   values to the front. */
static void take_pieces(loading *l, hr2di_sky *sky) {
  const size_t values = sky->terms * sky->bands, each = values + (sky->goes_on ? 3 : 2);
  for (size_t k = 0; k < sky->pieces; k++) {
    const double *v = l->value + k * each;
    sky->piece[k] = (hr2d_sky_piece){v[0], v[1]};
    if (sky->goes_on) sky->goes_on[k] = v[2] != 0;
    for (size_t m = 0; m < values; m++) l->value[k * values + m] = v[each - values + m];
  }
}

static hr2d_status read_sky(loading *l, uint64_t pieces, uint64_t bands, uint64_t terms) {
  const hr2d_allocator *alloc = &l->scene->alloc;
  const int continuous = terms > 1;
  if (pieces == 0) return HR2D_OK;
  if (pieces > HR2DI_SKY_PIECES || terms < 1 || terms > HR2DI_SKY_TERMS ||
      bands > UINT64_MAX / 32 / HR2DI_SKY_PIECES / HR2DI_SKY_TERMS)
    return damaged(l, "its sky");
  hr2d_status status = read_values(l, pieces * ((continuous ? 3 : 2) + terms * bands));
  if (status) return status;
  hr2di_sky sky = {.pieces = (size_t)pieces, .terms = (size_t)terms, .bands = (size_t)bands};
  sky.piece = hr2di_alloc(alloc, sky.pieces, sizeof *sky.piece);
  if (continuous) sky.goes_on = hr2di_alloc(alloc, sky.pieces, sizeof *sky.goes_on);
  status = sky.piece && (!continuous || sky.goes_on) ? HR2D_OK : out_of_memory(l);
  if (!status) {
    take_pieces(l, &sky);
    sky.value = l->value;
    status = hr2di_scene_copy_sky(l->scene, &sky);
    sky.value = NULL;
  }
  hr2di_sky_clear(&sky, alloc);
  return status;
}

/* The period, and the mirrors. */
static hr2d_status read_symmetry(loading *l, uint64_t mirrors) {
  if (mirrors > HR2DI_MIRRORS) return damaged(l, "its number of mirrors");
  hr2d_status status =
      read_values(l, HR2DI_SCENE_PERIOD_DOUBLES + HR2DI_SCENE_MIRROR_DOUBLES * mirrors);
  if (status) return status;
  const double *v = l->value;
  status = hr2d_scene_set_period(l->scene, (hr2d_point){v[0], v[1]});
  v += HR2DI_SCENE_PERIOD_DOUBLES;
  for (uint64_t k = 0; k < mirrors && !status; k++, v += HR2DI_SCENE_MIRROR_DOUBLES)
    status = hr2d_scene_add_mirror(l->scene, (hr2d_segment){{v[0], v[1]}, {v[2], v[3]}});
  if (!status && !l->panes && !hr2di_symmetry_wanted(&l->scene->symmetry))
    return damaged(l, "its symmetry");
  return status;
}

static hr2d_status force_effects(loading *l, uint64_t bits) {
  if (bits >> HR2D_EFFECT_COUNT) return damaged(l, "its effects");
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) l->scene->effect[e].forced = (int)(bits >> e & 1);
  return HR2D_OK;
}

/* What the head tells, beside the size. */
typedef struct head {
  int symmetric;
  uint64_t patches, bytes, forced, background_bands, wavelengths;
  uint64_t suns, sky_pieces, sky_bands; /* 0 without daylight */
  uint64_t mirrors;                     /* 0 without symmetry */
  uint64_t sky_terms;                   /* 1 without a continuous sky */
} head;

/* The line that names the format: which one, from 0, or −1. */
static int read_title(loading *l) {
  static const char *const titles[] = {HR2DI_SCENE_TITLE, HR2DI_SCENE_DAY_TITLE,
                                       HR2DI_SCENE_SYMMETRY_TITLE, HR2DI_SCENE_PANES_TITLE,
                                       HR2DI_SCENE_SKY_TITLE};
  char title[HR2DI_SCENE_TITLE_BYTES];
  hr2di_reader_expect(&l->reader, HR2DI_SCENE_TITLE_BYTES + 8 * HR2DI_SCENE_HEAD_WORDS);
  hr2di_reader_text(&l->reader, title, HR2DI_SCENE_TITLE_BYTES);
  for (int k = 0; k < 5 && !l->reader.status; k++)
    if (memcmp(title, titles[k], HR2DI_SCENE_TITLE_BYTES) == 0) return k;
  return -1;
}

static hr2d_status read_head(loading *l, head *h) {
  hr2di_reader *r = &l->reader;
  const int format = read_title(l);
  *h = (head){.symmetric = format >= 2, .sky_terms = 1};
  l->panes = format >= 3;
  if (r->status) return r->status;
  if (format < 0)
    return hr2di_message_fail(&l->scene->message, HR2D_ESYNTAX,
                              "this is not a scene of hr2d_state_write_scene()");
  uint64_t *const word[] = {&h->patches,     &h->bytes,    &h->forced,     &h->background_bands,
                            &h->wavelengths, &h->suns,     &h->sky_pieces, &h->sky_bands,
                            &h->mirrors,     &h->sky_terms};
  int words = HR2DI_SCENE_HEAD_WORDS;
  if (format > 0) words += HR2DI_SCENE_DAY_WORDS;
  if (format > 1) words += HR2DI_SCENE_SYMMETRY_WORDS;
  if (format > 3) words += HR2DI_SCENE_SKY_WORDS;
  hr2di_reader_expect(r, 8 * (uint64_t)(words - HR2DI_SCENE_HEAD_WORDS));
  for (int k = 0; k < words; k++) *word[k] = hr2di_reader_word(r);
  if (r->status) return r->status;
  if (h->bytes > UINT64_MAX / 2) return damaged(l, "its size");
  hr2di_reader_expect(r, h->bytes + 8);
  return HR2D_OK;
}

static hr2d_status read_all(loading *l) {
  head h;
  hr2d_status status = read_head(l, &h);
  if (!status) status = force_effects(l, h.forced);
  if (!status) status = read_background(l, h.background_bands);
  if (!status) status = read_wavelengths(l, h.wavelengths);
  if (!status) status = read_suns(l, h.suns);
  if (!status) status = read_sky(l, h.sky_pieces, h.sky_bands, h.sky_terms);
  if (!status && h.symmetric) status = read_symmetry(l, h.mirrors);
  if (status) return status;
  for (uint64_t k = 0; k < h.patches && !status; k++) status = read_patch(l);
  const uint64_t hash = hr2di_reader_word(&l->reader);
  if (!status && hr2di_reader_end(&l->reader)) status = l->reader.status;
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
  hr2di_alloc_free(&scene->alloc, scene->spectrum.wavelength);
  scene->spectrum.wavelength = NULL;
  scene->spectrum.wavelengths = 0;
  scene->symmetry.mirrors = 0;
  scene->symmetry.period = (hr2d_point){0, 0};
  scene->committed = 0;
  hr2di_scene_clear_commit(scene);
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) scene->effect[e].forced = 0;
}

hr2d_status hr2d_state_read_scene(hr2d_scene *scene, hr2d_read_fn read, void *ctx) {
  if (!scene || !read) return HR2D_EINVAL;
  if (scene->committed || scene->patches > 0 || scene->background ||
      hr2di_scene_spectral_bands(scene) > 1 || scene->gases.count || scene->sun ||
      scene->sky.pieces || hr2di_symmetry_wanted(&scene->symmetry))
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
