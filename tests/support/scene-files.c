/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include "support/scene-files.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

hr2d_status file_parse_bytes(hr2d_scene *scene, const char *text, size_t size) {
  char *exact = malloc(size ? size : 1);
  ck_assert_ptr_nonnull(exact);
  memcpy(exact, text, size);
  const hr2d_status status = hr2d_scene_parse(scene, exact, size);
  free(exact);
  return status;
}

hr2d_status file_parse(hr2d_scene *scene, const char *text) {
  return file_parse_bytes(scene, text, strlen(text));
}

hr2d_scene *file_parsed(const char *text) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_status status = file_parse(scene, text);
  ck_assert_msg(status == HR2D_OK, "%s: %s", hr2d_scene_message(scene), text);
  return scene;
}

void file_expect_segment(const hr2d_scene *scene, size_t patch, double ax, double ay, double bx,
                         double by) {
  const hr2d_segment s = hr2d_scene_segment(scene, patch), expected = {{ax, ay}, {bx, by}};
  ck_assert_msg(memcmp(&s, &expected, sizeof s) == 0, "patch %zu: (%g %g)-(%g %g)", patch,
                s.a.x, s.a.y, s.b.x, s.b.y);
}

void file_expect_name(const hr2d_scene *scene, size_t patch, const char *name) {
  ck_assert_str_eq(hr2d_scene_name(scene, patch), name);
}

file_outline file_outline_of(const hr2d_scene *scene) {
  file_outline o = {0, 0, 0};
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    o.x += s.b.x - s.a.x;
    o.y += s.b.y - s.a.y;
    o.area += (s.a.x * s.b.y - s.a.y * s.b.x) / 2;
  }
  return o;
}

hr2d_scene *file_occupied_scene(void) {
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_patch patch = {.a = {-1, 0}, .b = {-2, 3}, .name = "before"};
  ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  return scene;
}

void file_expect_unchanged(const hr2d_scene *scene) {
  ck_assert_uint_eq(hr2d_scene_patches(scene), 1);
  file_expect_segment(scene, 0, -1, 0, -2, 3);
  file_expect_name(scene, 0, "before");
}

void file_expect_refused(const hr2d_scene *scene, const char *name, hr2d_status got,
                         hr2d_status status, const char *phrase) {
  const char *message = hr2d_scene_message(scene);
  ck_assert_msg(got == status, "%s: status %d, %s", name, (int)got, message);
  ck_assert_msg(strstr(message, phrase) == message, "%s: \"%s\" is not \"%s\"", name, message,
                phrase);
  file_expect_unchanged(scene);
}

int file_read_or_refused(const char *text, size_t size, const char *phrase) {
  hr2d_scene *scene = file_occupied_scene();
  const hr2d_status status = file_parse_bytes(scene, text, size);
  if (status) {
    const char *message = hr2d_scene_message(scene);
    ck_assert(status == HR2D_ESYNTAX || status == HR2D_ESCENE || status == HR2D_EUNSUPPORTED);
    ck_assert_str_ne(message, "");
    ck_assert_msg(strstr(message, phrase) == message, "%s", message);
    file_expect_unchanged(scene);
  }
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    ck_assert_double_gt(hr2d_scene_length(scene, k), 0);
    ck_assert(hr2d_scene_reflectance(scene, k, 0) >= 0);
    ck_assert(hr2d_scene_reflectance(scene, k, 0) <= 1);
  }
  hr2d_scene_destroy(scene);
  return status == HR2D_OK;
}

void file_expect_damage(const char *good, size_t size, const char *spice, size_t spices,
                        const char *phrase) {
  randoms r = randoms_stream(test_seed(), 1);
  const int count = test_count(20000);
  int accepted = 0;
  char *text = malloc(size);
  ck_assert_ptr_nonnull(text);
  for (int n = 0; n < count; n++) {
    memcpy(text, good, size);
    for (int k = 1 + random_below(&r, 4); k > 0; k--)
      text[random_below(&r, (int)size)] = random_below(&r, 2)
                                              ? spice[random_below(&r, (int)spices)]
                                              : (char)random_below(&r, 256);
    accepted += file_read_or_refused(text, size, phrase);
  }
  free(text);
  if (count >= 1000) ck_assert(accepted > 0 && accepted < count);
}

void file_expect_bits(void (*write)(char *text, size_t size, int k, double c[4])) {
  randoms r = randoms_stream(test_seed(), 2);
  char text[512];
  for (int k = test_count(20000); k > 0; k--) {
    double c[4];
    for (int m = 0; m < 4; m++) c[m] = random_finite(&r);
    write(text, sizeof text, k, c);
    if (c[0] == c[2] && c[1] == c[3]) continue;
    hr2d_scene *scene = file_parsed(text);
    file_expect_segment(scene, 0, c[0], c[1], c[2], c[3]);
    hr2d_scene_destroy(scene);
  }
}

FILE *file_temporary(char *path) {
  const int descriptor = mkstemp(path);
  ck_assert_int_ge(descriptor, 0);
  FILE *file = fdopen(descriptor, "w");
  ck_assert_ptr_nonnull(file);
  return file;
}

/* Allocation k fails; whether there was one. */
static int starve_once(hr2d_status (*read)(hr2d_scene *), size_t patches, long k,
                       int for_good) {
  test_memory memory = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&memory);
  hr2d_scene *scene = test_new_scene(&hooks);
  memory.until_failure = k;
  memory.for_good = for_good;
  const hr2d_status status = read(scene);
  const int failed = memory.failures > 0;
  memory.until_failure = -1;
  ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_patches(scene), failed ? 0 : patches);
  if (failed) {
    ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "out of memory"));
    ck_assert_int_eq(read(scene), HR2D_OK);
    ck_assert_uint_eq(hr2d_scene_patches(scene), patches);
  }
  hr2d_scene_destroy(scene);
  ck_assert_int_eq(memory.live, 0);
  return failed;
}

long file_starve(hr2d_status (*read)(hr2d_scene *scene), size_t patches) {
  long allocations[2] = {0, 0};
  for (int for_good = 0; for_good < 2; for_good++)
    while (starve_once(read, patches, allocations[for_good], for_good)) allocations[for_good]++;
  ck_assert_int_eq(allocations[0], allocations[1]);
  return allocations[0];
}
