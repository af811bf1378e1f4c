/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/scenes.h"

#include <check.h>
#include <string.h>

#include "support/radiosity-scenes.h"
#include "support/random.h"
#include "support/room-plans.h"
#include "support/settings.h"

hr2d_scene *test_new_scene(const hr2d_allocator *hooks) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(hooks, &scene), HR2D_OK);
  ck_assert_str_eq(hr2d_scene_message(scene), "");
  return scene;
}

void test_commit(hr2d_scene *scene) {
  ck_assert_msg(hr2d_scene_commit(scene) == HR2D_OK, "%s", hr2d_scene_message(scene));
}

hr2d_scene *test_shipped_scene(const char *file) {
  hr2d_scene *scene = test_new_scene(NULL);
  ck_assert_msg(hr2d_scene_read(scene, test_scene_path(file)) == HR2D_OK, "%s: %s", file,
                hr2d_scene_message(scene));
  test_commit(scene);
  return scene;
}

void test_expect_message(const hr2d_scene *scene, const char *phrase) {
  ck_assert_msg(strstr(hr2d_scene_message(scene), phrase) != NULL, "\"%s\" is not in \"%s\"",
                phrase, hr2d_scene_message(scene));
}

hr2d_patch test_patch(double ax, double ay, double bx, double by) {
  hr2d_patch patch = HR2D_PATCH_INIT;
  patch.a = (hr2d_point){ax, ay};
  patch.b = (hr2d_point){bx, by};
  return patch;
}

void test_add_black(hr2d_scene *scene, const double at[4]) {
  const hr2d_patch patch = test_patch(at[0], at[1], at[2], at[3]);
  ck_assert_msg(hr2d_scene_add(scene, &patch, NULL) == HR2D_OK, "%s",
                hr2d_scene_message(scene));
}

hr2d_scene *test_open_scene(const double (*at)[4], size_t count) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < count; k++) test_add_black(scene, at[k]);
  return scene;
}

hr2d_status test_add_patch(hr2d_scene *scene, hr2d_segment at, double emission,
                           double reflectance, hr2d_sides sides) {
  const hr2d_patch patch = {.a = at.a,
                            .b = at.b,
                            .emission = &emission,
                            .emission_bands = 1,
                            .reflectance = &reflectance,
                            .reflectance_bands = 1,
                            .sides = sides};
  return hr2d_scene_add(scene, &patch, NULL);
}

hr2d_scene *test_coloured_scene(const hr2d_segment *at, const double (*emission)[3],
                                const double (*reflectance)[3], size_t count) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < count; k++) {
    const hr2d_patch patch = {.a = at[k].a,
                              .b = at[k].b,
                              .emission = emission[k],
                              .emission_bands = 3,
                              .reflectance = reflectance[k],
                              .reflectance_bands = 3};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  test_commit(scene);
  return scene;
}

hr2d_scene *test_scene_hooked(const double (*patch)[6], size_t count,
                              const hr2d_allocator *hooks) {
  hr2d_scene *scene = test_new_scene(hooks);
  for (size_t k = 0; k < count; k++) {
    const double *p = patch[k];
    const hr2d_segment at = {{p[0], p[1]}, {p[2], p[3]}};
    const hr2d_status status = test_add_patch(scene, at, p[4], p[5], HR2D_SIDES_FRONT);
    ck_assert_msg(status == HR2D_OK, "%s", hr2d_scene_message(scene));
  }
  test_commit(scene);
  return scene;
}

hr2d_scene *test_scene(const double (*patch)[6], size_t count) {
  return test_scene_hooked(patch, count, NULL);
}

hr2d_scene *test_named_scene(const char *name) {
  radiosity_scene named;
  const radiosity_scene *s = &named;
  ck_assert_msg(radiosity_scene_name(&named, name) == 0, "no scene is called %s", name);
  return test_scene(s->patch, s->patches);
}

static hr2d_status add_painted(hr2d_scene *scene, hr2d_segment at, hr2d_sides sides,
                               const test_paint *paint) {
  const double rho = paint->reflectance * (paint->r ? random_unit(paint->r) : 1);
  const double e = paint->emission * (paint->r ? random_unit(paint->r) : 1);
  const double emission = paint->isothermal ? 1 - rho : e;
  return test_add_patch(scene, at, emission, rho, sides);
}

hr2d_scene *test_painted_scene(const struct plan *room, const test_paint *paint) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < room->walls; k++)
    ck_assert_int_eq(add_painted(scene, room->wall[k], room->sides[k], paint), HR2D_OK);
  if (room->crossing) ck_assert_int_eq(hr2d_scene_split_crossings(scene, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_background(scene, &paint->background, 1), HR2D_OK);
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    if (paint->forced & (1u << e))
      ck_assert_int_eq(hr2d_scene_force(scene, (hr2d_effect)e), HR2D_OK);
  test_commit(scene);
  return scene;
}
