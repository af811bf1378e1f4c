/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes as bytes: what is made of one that was read has the bits of the one that was written;
   damaged bytes are refused or do no harm. */
#include <hr2d/symmetry.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene-impl.h"
#include "support/slow-scenes.h"
#include "support/support.h"
#include "support/tape.h"

enum { PATCHES = 60 };

static hr2d_scene *make_slow(slow_kind kind) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(slow_add(scene, kind, PATCHES), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* All kinds of patches: with bands of their own, with one for all, with none; two-sided, with
   lights that are shared, a long name, a background, and a forced effect. */
static hr2d_scene *make_motley_under(const hr2d_allocator *hooks, int sunny) {
  const double three[] = {1, 0.5, 0}, one = 0.25, sky[] = {0.1, 0.2, 0.3};
  char name[5000];
  hr2d_scene *scene = NULL;
  memset(name, 'n', sizeof name - 1);
  name[sizeof name - 1] = '\0';
  ck_assert_int_eq(hr2d_scene_create(hooks, &scene), HR2D_OK);
  hr2d_patch p = HR2D_PATCH_INIT;
  p.b.x = 1;
  p.emission = p.reflectance = three;
  p.emission_bands = p.reflectance_bands = 3;
  ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  p = (hr2d_patch){.a = {0.2, 0.5}, .b = {0.8, 0.6}, .sides = HR2D_SIDES_BOTH, .name = name};
  p.reflectance = &one;
  p.reflectance_bands = 1;
  ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  p = (hr2d_patch){.a = {1, 1}, .b = {0, 1}, .name = "dark"};
  ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, sky, 3), HR2D_OK);
  const hr2d_sun suns[] = {{{1, -2}, 3}, {{0, 0}, 0}, {{-1, -0.1}, 5}};
  const hr2d_sky_piece piece[] = {{-90, 10}, {10, 80}};
  const double light[] = {1, 2, 3, 4, 5, 6};
  if (sunny) ck_assert_int_eq(hr2d_scene_set_sun(scene, suns, 3), HR2D_OK);
  if (sunny == 1) ck_assert_int_eq(hr2d_scene_set_sky(scene, piece, 2, light, 3), HR2D_OK);
  hr2d_sky clear = HR2D_SKY_INIT;
  clear.irradiance = 2;
  clear.sun_elevation = 30;
  clear.tolerance = 1e-4;
  ck_assert_int_eq(hr2d_sky_cie(12, &clear), HR2D_OK);
  if (sunny == 2) ck_assert_int_eq(hr2d_scene_set_continuous_sky(scene, &clear, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_force(scene, HR2D_EFFECT_FACING), HR2D_OK);
  test_commit(scene);
  return scene;
}

static hr2d_scene *make_motley(const hr2d_allocator *hooks) {
  return make_motley_under(hooks, 0);
}

static tape write_tape(const hr2d_scene *scene) {
  tape t = {.until_failure = -1};
  ck_assert_int_eq(hr2d_state_write_scene(scene, tape_record, &t), HR2D_OK);
  return t;
}

static hr2d_status read_tape(tape *t, const hr2d_allocator *hooks, hr2d_scene **scene) {
  t->at = 0;
  ck_assert_int_eq(hr2d_scene_create(hooks, scene), HR2D_OK);
  return hr2d_state_read_scene(*scene, tape_play, t);
}

static void same_scenes(const hr2d_scene *one, const hr2d_scene *other) {
  ck_assert_uint_eq(hr2d_scene_patches(one), hr2d_scene_patches(other));
  ck_assert_uint_eq(hr2d_scene_bands(one), hr2d_scene_bands(other));
  for (size_t k = 0; k < hr2d_scene_patches(one); k++) {
    const hr2d_segment s = hr2d_scene_segment(one, k), t = hr2d_scene_segment(other, k);
    ck_assert_int_eq(memcmp(&s, &t, sizeof s), 0);
    ck_assert_str_eq(hr2d_scene_name(one, k), hr2d_scene_name(other, k));
    for (size_t b = 0; b < hr2d_scene_bands(one); b++) {
      ck_assert(hr2d_scene_emission(one, k, b) == hr2d_scene_emission(other, k, b));
      ck_assert(hr2d_scene_reflectance(one, k, b) == hr2d_scene_reflectance(other, k, b));
    }
  }
  for (size_t b = 0; b < hr2d_scene_bands(one); b++)
    ck_assert(hr2d_scene_background(one, b) == hr2d_scene_background(other, b));
  for (size_t b = 0; b < hr2d_scene_bands(one); b++) {
    const hr2d_sun s = hr2d_scene_sun(one, b), t = hr2d_scene_sun(other, b);
    ck_assert(s.irradiance == t.irradiance && s.direction.x == t.direction.x &&
              s.direction.y == t.direction.y);
    for (double at = -180; at < 180; at += 20)
      ck_assert(hr2d_scene_sky(one, at, b) == hr2d_scene_sky(other, at, b));
    for (size_t k = 0; k < hr2d_scene_patches(one); k++)
      ck_assert(hr2d_scene_sunlight(one, k, b) == hr2d_scene_sunlight(other, k, b));
  }
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) {
    const char *reason[2];
    ck_assert_int_eq(hr2d_scene_effect(one, (hr2d_effect)e, &reason[0]),
                     hr2d_scene_effect(other, (hr2d_effect)e, &reason[1]));
    ck_assert_str_eq(reason[0], reason[1]);
  }
}

/* T, q and ε, with wavelengths or without. */
static hr2d_scene *make_thermal(int bands) {
  static const double micrometres[] = {3, 8}, epsilon[] = {0.9, 0.5, 0.2};
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  if (bands) ck_assert_int_eq(hr2d_scene_set_wavelengths(scene, micrometres, 2), HR2D_OK);
  const hr2d_point corner[] = {{0, 0}, {2, 0}, {1, 1.5}, {0, 0}};
  for (int k = 0; k < 3; k++) {
    const hr2d_patch patch = {.a = corner[k], .b = corner[k + 1]};
    hr2d_thermal t = HR2D_THERMAL_INIT;
    const int flux = k == 2 && !bands;
    t.given = flux ? HR2D_HEAT_FLUX : HR2D_HEAT_TEMPERATURE;
    t.value = flux ? -20 : 300 + 100 * k;
    t.emissivity = epsilon;
    t.emissivity_bands = bands ? 3 : 1;
    ck_assert_int_eq(hr2d_scene_add_thermal(scene, &patch, &t, NULL), HR2D_OK);
  }
  test_commit(scene);
  return scene;
}

static void same_heat(const hr2d_scene *one, const hr2d_scene *other) {
  for (size_t k = 0; k < hr2d_scene_patches(one); k++) {
    double given[2];
    ck_assert_int_eq(hr2d_scene_heat(one, k, &given[0]), hr2d_scene_heat(other, k, &given[1]));
    ck_assert(given[0] == given[1] || (isnan(given[0]) && isnan(given[1])));
    for (size_t b = 0; b < hr2d_scene_bands(one); b++) {
      const double e = hr2d_scene_emissivity(one, k, b), f = hr2d_scene_emissivity(other, k, b);
      ck_assert(e == f || (isnan(e) && isnan(f)));
    }
  }
}

/* Half a room with two-sided furniture; plates that were drawn periods apart, along an oblique
   period, which see for ever; and between parallel mirrors, with a third one, under a sky. */
enum { SYMMETRIC = 3 };

static void add_mirror(hr2d_scene *scene, double ax, double ay, double bx, double by) {
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{ax, ay}, {bx, by}}), HR2D_OK);
}

static hr2d_scene *make_symmetric(int kind) {
  const hr2d_sky_piece piece[] = {{-60, -20}, {20, 60}, {120, 160}, {200, 240}};
  const double light[] = {1, 1, 1, 1}, grey = 0.25;
  const hr2d_sun sun = {{0, -1}, 3};
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  test_add_patch(scene, (hr2d_segment){{0.1, 0}, {1.1, 0.5}}, 1, .5, HR2D_SIDES_FRONT);
  if (kind == 0) {
    test_add_patch(scene, (hr2d_segment){{0.3, 0.9}, {0.6, 1}}, 0, .7, HR2D_SIDES_BOTH);
    add_mirror(scene, 0.1, 7, 0.1, 3);
    ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  } else if (kind == 1) {
    test_add_patch(scene, (hr2d_segment){{7.1, 4}, {6.1, 3.5}}, 0, .5, HR2D_SIDES_FRONT);
    ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0.5}), HR2D_OK);
  } else {
    add_mirror(scene, 0, 1, 0, 2);
    add_mirror(scene, 5, -0.25, 6, -0.25);
    add_mirror(scene, 1.5, 1, 1.5, 4);
    ck_assert_int_eq(hr2d_scene_set_background(scene, &grey, 1), HR2D_OK);
    ck_assert_int_eq(hr2d_scene_set_sky(scene, piece, 4, light, 1), HR2D_OK);
  }
  test_commit(scene);
  return scene;
}

static void same_symmetry(const hr2d_scene *one, const hr2d_scene *other) {
  const hr2d_point d = hr2d_scene_period(one), e = hr2d_scene_period(other);
  ck_assert_uint_eq(hr2d_scene_mirrors(one), hr2d_scene_mirrors(other));
  ck_assert_int_eq(memcmp(&d, &e, sizeof d), 0);
  ck_assert_uint_eq(hr2d_scene_images(one), hr2d_scene_images(other));
  for (size_t k = 0; k < hr2d_scene_mirrors(one); k++) {
    const hr2d_segment s = hr2d_scene_mirror(one, k), t = hr2d_scene_mirror(other, k);
    ck_assert_int_eq(memcmp(&s, &t, sizeof s), 0);
  }
}

/* The links and B of a coarse solve, as a state. */
static tape solved(hr2d_scene *scene) {
  test_links t = test_make_links(scene, NULL, NULL, NULL, NULL);
  const hr2d_refine_options options = test_options(0.7, 4);
  hr2d_solution *solution = NULL;
  tape of = {.until_failure = -1};
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  ck_assert_int_eq(hr2d_solve(t.links, NULL, &solution), HR2D_OK);
  ck_assert_int_eq(hr2d_state_write(solution, tape_record, &of), HR2D_OK);
  hr2d_solution_destroy(solution);
  test_free_links(&t);
  return of;
}

START_TEST(what_is_read_has_the_same_bits) {
  hr2d_scene *one = _i < SLOW_KINDS       ? make_slow((slow_kind)_i)
                    : _i == SLOW_KINDS    ? make_motley(NULL)
                    : _i < SLOW_KINDS + 3 ? make_thermal(_i - SLOW_KINDS - 1)
                    : _i < SLOW_KINDS + 5 ? make_motley_under(NULL, _i - SLOW_KINDS - 2)
                                          : make_symmetric(_i - SLOW_KINDS - 5);
  hr2d_scene *other;
  tape t = write_tape(one);
  ck_assert_int_eq(read_tape(&t, NULL, &other), HR2D_OK);
  ck_assert_uint_eq(t.at, t.size);
  same_scenes(one, other);
  same_heat(one, other);
  same_symmetry(one, other);
  tape again = write_tape(other);
  ck_assert_uint_eq(again.size, t.size);
  ck_assert_int_eq(memcmp(again.byte, t.byte, t.size), 0);
  tape of_one = solved(one), of_other = solved(other);
  ck_assert_uint_eq(of_one.size, of_other.size);
  ck_assert_int_eq(memcmp(of_one.byte, of_other.byte, of_one.size), 0);
  free(of_one.byte);
  free(of_other.byte);
  free(t.byte);
  free(again.byte);
}
END_TEST

/* Both sides of a patch share a light, before and after. */
START_TEST(lights_stay_shared) {
  hr2d_scene *one = make_motley(NULL), *other;
  tape t = write_tape(one);
  ck_assert_int_eq(read_tape(&t, NULL, &other), HR2D_OK);
  ck_assert_ptr_eq(other->patch[1].light, other->patch[2].light);
  ck_assert_ptr_ne(other->patch[0].light, other->patch[1].light);
  hr2d_scene_destroy(one);
  hr2d_scene_destroy(other);
  free(t.byte);
}
END_TEST

/* Each byte changed, and each length. */
START_TEST(damage_is_found) {
  hr2d_scene *one = _i == 0   ? make_slow(SLOW_COMB)
                    : _i <= 2 ? make_motley_under(NULL, _i)
                              : make_symmetric(_i - 3);
  hr2d_scene *other;
  tape t = write_tape(one);
  const size_t size = t.size;
  for (size_t k = 0; k < size; k++) {
    t.byte[k] ^= (unsigned char)(1 + k % 255);
    const hr2d_status status = read_tape(&t, NULL, &other);
    ck_assert_msg(status != HR2D_OK, "byte %zu", k);
    ck_assert_uint_eq(hr2d_scene_patches(other), 0);
    ck_assert_uint_eq(hr2d_scene_mirrors(other), 0);
    ck_assert(hr2d_scene_period(other).x == 0);
    ck_assert_str_ne(hr2d_scene_message(other), "");
    t.byte[k] ^= (unsigned char)(1 + k % 255);
    hr2d_scene_destroy(other);
  }
  for (t.size = 0; t.size < size; t.size += 1 + t.size / 7) {
    ck_assert_int_eq(read_tape(&t, NULL, &other), HR2D_ESYNTAX);
    hr2d_scene_destroy(other);
  }
  /* Negative control, after failures into the same scene. */
  t.size = size / 2;
  ck_assert_int_eq(read_tape(&t, NULL, &other), HR2D_ESYNTAX);
  t.size = size;
  t.at = 0;
  ck_assert_int_eq(hr2d_state_read_scene(other, tape_play, &t), HR2D_OK);
  same_scenes(one, other);
  ck_assert_int_eq(hr2d_state_read_scene(other, tape_play, &t), HR2D_ESTATE);
  hr2d_scene_destroy(one);
  hr2d_scene_destroy(other);
  free(t.byte);
}
END_TEST

/* Sizes that the bytes do not have take no memory. */
START_TEST(claims_take_no_memory) {
  enum { HEAD = 16, BACKGROUND = HEAD + 24 };
  hr2d_scene *one = make_motley(NULL), *other = NULL;
  tape t = write_tape(one);
  for (int k = 0; k < 5; k++) {
    test_meter m = {0, 0};
    const hr2d_allocator hooks = test_metered(&m);
    unsigned char kept[8];
    unsigned char *word = t.byte + HEAD + 8 * k;
    memcpy(kept, word, sizeof kept);
    memset(word, 0x3f, sizeof kept);
    ck_assert_int_ne(read_tape(&t, &hooks, &other), HR2D_OK);
    ck_assert_int_le(m.peak, 64 * (long long)t.size);
    hr2d_scene_destroy(other);
    ck_assert_int_eq(m.held, 0);
    memcpy(word, kept, sizeof kept);
  }
  hr2d_scene_destroy(one);
  free(t.byte);
}
END_TEST

START_TEST(callbacks_may_fail) {
  hr2d_scene *one = make_motley_under(NULL, 1), *other = NULL;
  tape t = write_tape(one), cut = {.failure = HR2D_EIO};
  ck_assert_int_eq(hr2d_state_write_scene(one, tape_record, &cut), HR2D_EIO);
  t.failure = HR2D_EIO;
  for (t.until_failure = 0; t.until_failure < 3; t.until_failure++) {
    const long calls = t.until_failure;
    ck_assert_int_eq(read_tape(&t, NULL, &other), HR2D_EIO);
    ck_assert_uint_eq(hr2d_scene_patches(other), 0);
    hr2d_scene_destroy(other);
    t.until_failure = calls;
  }
  ck_assert_int_eq(hr2d_scene_create(NULL, &other), HR2D_OK);
  ck_assert_int_eq(hr2d_state_write_scene(other, tape_record, &cut), HR2D_ESTATE);
  hr2d_scene_destroy(other);
  hr2d_scene_destroy(one);
  free(t.byte);
}
END_TEST

START_TEST(any_allocation_may_fail) {
  hr2d_scene *one = _i > 1 ? make_symmetric(_i) : make_motley_under(NULL, 1 + _i);
  tape t = write_tape(one);
  long failures = 1;
  for (long k = 0; failures; k++) {
    test_memory memory = {.until_failure = -1};
    const hr2d_allocator hooks = test_hooks(&memory);
    hr2d_scene *other = NULL;
    ck_assert_int_eq(hr2d_scene_create(&hooks, &other), HR2D_OK);
    memory.until_failure = k;
    memory.for_good = (int)(k % 2);
    t.at = 0;
    const hr2d_status status = hr2d_state_read_scene(other, tape_play, &t);
    failures = memory.failures;
    ck_assert_int_eq(status, failures ? HR2D_ENOMEM : HR2D_OK);
    ck_assert(!failures || hr2d_scene_patches(other) == 0);
    ck_assert(failures || k > 4);
    memory.until_failure = -1;
    hr2d_scene_destroy(other);
    ck_assert_int_eq(memory.live, 0);
  }
  hr2d_scene_destroy(one);
  free(t.byte);
}
END_TEST

START_TEST(only_an_empty_scene_is_read_into) {
  hr2d_scene *one = make_symmetric(0);
  tape t = write_tape(one);
  for (int k = 0; k < 2; k++) {
    hr2d_scene *other = NULL;
    ck_assert_int_eq(hr2d_scene_create(NULL, &other), HR2D_OK);
    if (k)
      ck_assert_int_eq(hr2d_scene_set_period(other, (hr2d_point){9, 9}), HR2D_OK);
    else
      add_mirror(other, 0, 0, 1, 1);
    ck_assert_int_eq(hr2d_state_read_scene(other, tape_play, &t), HR2D_ESTATE);
    hr2d_scene_destroy(other);
  }
  hr2d_scene_destroy(one);
  free(t.byte);
}
END_TEST

/* The last bytes are the hash of those before, FNV-1a: a forger knows it. */
static void forge_hash(tape *t) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (size_t k = 0; k < t->size - 8; k++) hash = (hash ^ t->byte[k]) * 0x100000001b3u;
  for (size_t k = 0; k < 8; k++) t->byte[t->size - 8 + k] = (unsigned char)(hash >> 8 * k);
}

/* Names of continuation bytes alone have no place where a message could cut them. */
START_TEST(names_are_utf8) {
  char name[201];
  hr2d_patch patch = {.b = {1, 0}, .name = name};
  hr2d_scene *one = NULL, *other = NULL;
  memset(name, 'x', sizeof name);
  name[sizeof name - 1] = '\0';
  ck_assert_int_eq(hr2d_scene_create(NULL, &one), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_add(one, &patch, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(one), HR2D_OK);
  tape t = write_tape(one);
  forge_hash(&t);
  ck_assert_int_eq(read_tape(&t, NULL, &other), HR2D_OK);
  hr2d_scene_destroy(other);
  for (size_t k = 0; k + sizeof name <= t.size; k++)
    if (!memcmp(t.byte + k, name, sizeof name - 1)) memset(t.byte + k, 0x80, sizeof name - 1);
  forge_hash(&t);
  ck_assert_int_eq(read_tape(&t, NULL, &other), HR2D_ESCENE);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(other), "not UTF-8"));
  memset(name, 0xA0, sizeof name - 1);
  ck_assert_int_eq(hr2d_scene_add(other, &patch, NULL), HR2D_ESCENE);
  ck_assert_uint_eq(hr2d_scene_patches(other), 0);
  hr2d_scene_destroy(other);
  hr2d_scene_destroy(one);
  free(t.byte);
}
END_TEST

TEST_SUITE("state-scene") {
  REPEAT_TESTS(SLOW_KINDS + 5 + SYMMETRIC, "bits", what_is_read_has_the_same_bits);
  REPEAT_TESTS(3 + SYMMETRIC, "damage", damage_is_found);
  REPEAT_TESTS(SYMMETRIC, "memory", any_allocation_may_fail);
  ADD_TESTS("all", lights_stay_shared, claims_take_no_memory, callbacks_may_fail,
            only_an_empty_scene_is_read_into, names_are_utf8);
}
