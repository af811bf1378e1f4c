/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Validation of links between elements of a few ulps, beside walls.  HR2D_TEST_SEED and
   HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <math.h>

#include "links/linkset-impl.h"
#include "support/support.h"

/* A turn and a shift, which may leave no length to a patch of an ulp. */
typedef struct frame {
  double cosine, sine, shift;
} frame;

static void add(hr2d_scene *scene, const frame *f, const double (*at)[4], size_t count,
                hr2d_sides sides) {
  for (size_t k = 0; k < count; k++) {
    hr2d_point end[2];
    for (int e = 0; e < 2; e++) {
      const double x = at[k][2 * e], y = at[k][2 * e + 1];
      end[e] = (hr2d_point){f->shift + f->cosine * x - f->sine * y,
                            f->shift + f->sine * x + f->cosine * y};
    }
    if (end[0].x != end[1].x || end[0].y != end[1].y)
      ck_assert_int_eq(test_add_patch(scene, (hr2d_segment){end[0], end[1]}, 0.5, 0.5, sides),
                       HR2D_OK);
  }
}

/* A scene with a patch of 1 to 500 ulps: in a corner, in a wall, in the room, beside a screen.
 */
static hr2d_scene *draw(randoms *r, int kind) {
  hr2d_scene *scene = test_new_scene(NULL);
  const double angle = random_between(r, 0, 6.28);
  const double shift = random_below(r, 2) ? 0 : random_power(r, -1, 6);
  const frame f = {cos(angle), sin(angle), shift};
  const hr2d_sides sides = random_below(r, 3) ? HR2D_SIDES_FRONT : HR2D_SIDES_BOTH;
  const double e = ldexp(random_between(r, 1, 2), random_below(r, 9) - 52) * fmax(shift, 1);
  const double y = e * random_unit(r), z = e + e * random_unit(r);
  if (kind == 0)
    add(scene, &f,
        (const double[][4]){{0, 0, 1, 0}, {1, 0, 1, e}, {1, e, .2, .9}, {.2, .9, 0, 0}}, 4,
        sides);
  else if (kind == 1)
    add(scene, &f,
        (const double[][4]){{0, 0, .5, 0}, {.5, 0, .5 + e, 0}, {.5 + e, 0, 1, 0}, {1, 1, 0, 1}},
        4, sides);
  else
    add(scene, &f, (const double[][4]){{0, 0, 1, 0}, {1, 1, 0, 1}}, 2, sides);
  if (kind == 2)
    add(scene, &f, (const double[][4]){{.5, .3, .5 + e, .3 + y}}, 1, HR2D_SIDES_BOTH);
  if (kind == 3)
    add(scene, &f, (const double[][4]){{.5, .9, .5, 0}, {.5 + e, y, .5 + e, z}}, 2,
        HR2D_SIDES_BOTH);
  return scene;
}

static int check_scene(randoms *r, int kind) {
  static const char *const oracle[] = {"l1", "size", "size2", "bf"};
  hr2d_scene *scene = draw(r, kind);
  if (hr2d_scene_commit(scene)) { /* of patches within a rounding of each other */
    hr2d_scene_destroy(scene);
    return 0;
  }
  test_links t = test_make_links(
      scene, hr2d_oracle_find(oracle[random_below(r, 4)]), NULL,
      random_below(r, 2) ? hr2d_policy_original() : hr2d_policy_modified(), NULL);
  hr2d_refine_options options =
      test_options(random_power(r, -1, 0), random_below(r, 3) ? 80 : 24);
  options.ordered = random_below(r, 3) == 0;
  options.max_links = 20000;
  const int refined = !hr2d_refine(t.links, &options);
  if (refined)
    ck_assert_msg(hr2d_linkset_validate(t.links) == HR2D_OK, "kind %d: %s", kind,
                  hr2d_linkset_message(t.links));
  test_free_links(&t);
  return refined;
}

START_TEST(elements_of_a_few_ulps_are_valid) {
  randoms r = randoms_stream(test_seed(), 4);
  int checked = 0;
  const int rounds = test_count(4000) + 200;
  for (int k = 0; k < rounds; k++) checked += check_scene(&r, k % 4);
  ck_assert_int_gt(checked, rounds / 2);
}
END_TEST

/* Negative control: what walls leave of an exchange area is still checked to its roundings. */
START_TEST(a_little_more_is_refused) {
  const double patch[][6] = {{0, 0, 1, 0, 1, .5},
                             {1, 1, 0, 1, 0, .5},
                             {.3, .5, .6, .4, 0, .5},
                             {.6, .4, .3, .5, 0, .5}};
  test_links t = test_make_links(test_scene(patch, 4), NULL, NULL, NULL, NULL);
  test_refine(&t, 0.5, 6);
  ck_assert_int_eq(hr2d_linkset_validate(t.links), HR2D_OK);
  hr2d_link *link = &t.links->store.open[hr2d_linkset_size(t.links) / 2];
  link->exchange_area += 1e-14;
  ck_assert_int_eq(hr2d_linkset_validate(t.links), HR2D_EINVAL);
  test_free_links(&t);
}
END_TEST

TEST_SUITE("validation of ulps") {
  ADD_TESTS("ulps", elements_of_a_few_ulps_are_valid, a_little_more_is_refused);
}
