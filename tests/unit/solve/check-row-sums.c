/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Row sums of leaves, against exchange areas of single leaves among all walls: with every
   patch, and with a box around the scene, which is the sky.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "solve/row-sums.h"
#include "support/grid-plans.h"
#include "support/support.h"

/* Row sums of a link set. */
typedef struct summed {
  test_links links;
  hr2di_watch watch;
  hr2di_transport transport;
  hr2di_row_sums rows;
  uint64_t work;
} summed;

/* Takes over the scene, and makes leaves with the given ε. */
static void sum_up(summed *s, hr2d_scene *scene, double epsilon) {
  *s = (summed){.transport.alloc = hr2di_alloc_default()};
  s->links = test_make_links(scene, hr2d_oracle_find("size"), NULL, NULL, NULL);
  test_refine(&s->links, epsilon, 6);
  hr2di_watch_init(&s->watch, NULL, NULL, "rows");
  ck_assert_int_eq(hr2di_transport_init(&s->transport, s->links.links, 0, 1, &s->watch),
                   HR2D_OK);
  const uint64_t before = s->watch.total + s->watch.work;
  ck_assert_int_eq(
      hr2di_row_sums_init(&s->rows, &s->transport, scene->effect[HR2D_EFFECT_BACKGROUND].on),
      HR2D_OK);
  s->work = s->watch.total + s->watch.work - before;
}

static void release(summed *s) {
  hr2di_row_sums_clear(&s->rows);
  hr2di_transport_clear(&s->transport);
  test_free_links(&s->links);
}

static void set_background(hr2d_scene *scene) {
  const double light = 1;
  ck_assert_int_eq(hr2d_scene_set_background(scene, &light, 1), HR2D_OK);
}

/* What stands in the way. */
typedef struct obstacles {
  hr2d_segment *wall;
  size_t count;
} obstacles;

static obstacles all_walls(const hr2d_scene *scene) {
  obstacles o = {malloc(scene->walls.walls * sizeof *o.wall), scene->walls.walls};
  ck_assert_ptr_nonnull(o.wall);
  for (size_t k = 0; k < o.count; k++) o.wall[k] = scene->walls.wall[k].at;
  return o;
}

static double between(hr2d_segment leaf, hr2d_segment other, const obstacles *o) {
  double area;
  ck_assert_int_eq(hr2d_exchange_area_occluded(&leaf, &other, o->wall, o->count, NULL, &area),
                   HR2D_OK);
  return area;
}

static double over_patches(const hr2d_scene *scene, hr2d_segment leaf, size_t own,
                           const obstacles *o) {
  double sum = 0;
  for (size_t k = 0; k < scene->patches; k++)
    if (k != own) sum += between(leaf, scene->patch[k].scaled, o);
  return sum;
}

/* Scaled coordinates are at most 2. */
static double over_sky(hr2d_segment leaf, const obstacles *o) {
  static const hr2d_point corner[] = {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}, {-3, -3}};
  double sum = 0;
  for (int k = 0; k < 4; k++) sum += between(leaf, (hr2d_segment){corner[k], corner[k + 1]}, o);
  return sum;
}

typedef struct tally {
  int leaves, backs, sky, differ;
} tally;

/* Some leaf of a patch that is not closed.  With a wall less, which is the negative control,
   `differ` counts. */
static void check_leaf(randoms *r, const summed *s, tally *t) {
  const hr2d_scene *scene = s->links.scene;
  const hr2d_hierarchy *h = s->links.hierarchy;
  const uint32_t leaf = s->transport.leaf[random_below(r, (int)s->transport.leaves)];
  const hr2d_element *e = &h->element[leaf];
  if (s->rows.closed[e->patch]) return;
  obstacles o = all_walls(scene);
  const hr2d_segment at = {e->a, e->b};
  const double front = s->rows.front[leaf] * e->length, back = s->rows.back[leaf] * e->length;
  const double patches = over_patches(scene, at, e->patch, &o), sky = over_sky(at, &o);
  ck_assert_double_eq_tol(front, patches, 3e-15);
  ck_assert_double_eq_tol(front + back + sky, e->length, 3e-15);
  t->leaves++;
  t->backs += back > 0.01 * e->length;
  t->sky += sky > 0.01 * e->length;
  o.wall[random_below(r, (int)o.count)] = o.wall[o.count - 1];
  o.count--;
  t->differ += fabs(over_patches(scene, at, e->patch, &o) - front) > 1e-3 * e->length;
  free(o.wall);
}

static hr2d_scene *draw(randoms *r) {
  plan p = grid_plan(r, random_below(r, 2));
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < p.walls; k++)
    test_add_patch(scene, p.wall[k], 1, 0.5,
                   random_below(r, 2) ? p.sides[k] : HR2D_SIDES_FRONT);
  plan_free(&p);
  set_background(scene);
  if (hr2d_scene_commit(scene) == HR2D_OK) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

START_TEST(rows_are_what_leaves_see) {
  randoms r = randoms_stream(test_seed(), 1);
  const int count = test_count(200) + 10;
  tally t = {0, 0, 0, 0};
  for (int k = 0; k < count; k++) {
    hr2d_scene *scene = draw(&r);
    if (!scene) continue;
    summed s;
    sum_up(&s, scene, random_power(&r, -1, 0));
    for (int m = 0; m < 10; m++) check_leaf(&r, &s, &t);
    release(&s);
  }
  ck_assert_int_gt(t.leaves, 4 * count);
  ck_assert_int_gt(t.backs, count);
  ck_assert_int_gt(t.sky, count / 2);
  ck_assert_int_gt(t.differ, count / 10);
}
END_TEST

static double seen_of(const summed *s, uint32_t leaf, hr2d_segment other) {
  const hr2d_element *e = &s->links.hierarchy->element[leaf];
  const double unit = hr2d_scene_unit(s->links.scene);
  const hr2d_segment at = {{e->a.x * unit, e->a.y * unit}, {e->b.x * unit, e->b.y * unit}};
  return hr2d_exchange_area(&at, &other) / (e->length * unit);
}

/* A wall with its back to the floor, and before it a shorter one with its front to
   the floor; roundings alone tell them apart. */
START_TEST(no_back_is_seen_through_a_front) {
  static const double at[] = {0.5 - 0x1p-53, 0.5 - 0x1p-54, 0.5};
  static const hr2d_segment floor = {{0, 0}, {1, 0}}, back = {{0.75, 0.5}, {0.25, 0.5}};
  for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
    const hr2d_segment front = {{0.625, at[k]}, {0.375, at[k]}};
    hr2d_scene *scene = test_new_scene(NULL);
    test_add_patch(scene, floor, 1, 0.5, HR2D_SIDES_FRONT);
    test_add_patch(scene, (hr2d_segment){back.b, back.a}, 1, 0.5, HR2D_SIDES_FRONT);
    test_add_patch(scene, front, 1, 0.5, HR2D_SIDES_FRONT);
    set_background(scene);
    test_commit(scene);
    summed s;
    sum_up(&s, scene, 0.3);
    for (size_t m = 0; m < s.transport.leaves; m++) {
      const uint32_t leaf = s.transport.leaf[m];
      if (s.links.hierarchy->element[leaf].patch != 0) continue;
      const double in_front = seen_of(&s, leaf, front);
      ck_assert_double_eq_tol(s.rows.front[leaf], in_front, 1e-14);
      ck_assert_double_eq_tol(s.rows.back[leaf], seen_of(&s, leaf, back) - in_front, 1e-14);
    }
    release(&s);
  }
}
END_TEST

/* Where nobody knows how walls cross, all patches are asked; here there is nothing to cross. */
START_TEST(rows_without_a_plane_are_the_same) {
  static const double walls[][6] = {{0, 0, 2, 0, 1, 0.5},
                                    {2, 0, 2, 0.75, 1, 0.5},
                                    {2, 0.75, 2, 1, 1, 0.5},
                                    {1, 1.5, 0.25, 1.5, 1, 0.5}};
  summed with, without;
  hr2d_scene *scene = test_scene(walls, 4);
  ck_assert_ptr_null(scene->parts.wanted);
  scene->unclear.is = 1;
  sum_up(&without, scene, 0.2);
  sum_up(&with, test_scene(walls, 4), 0.2);
  ck_assert_uint_gt(with.rows.leaves, 20);
  for (size_t k = 0; k < with.transport.leaves; k++) {
    const uint32_t leaf = with.transport.leaf[k];
    ck_assert_double_eq_tol(with.rows.front[leaf], without.rows.front[leaf], 1e-15);
    ck_assert_double_gt(with.rows.front[leaf], 0.1);
  }
  ck_assert_uint_ne(with.work, without.work);
  release(&with);
  release(&without);
}
END_TEST

static hr2d_point on_circle(int k, int n) {
  return (hr2d_point){cos(6.25 * k / n), sin(6.25 * k / n)};
}

/* n patches: all see each other, or none sees another. */
static hr2d_scene *ring(int n, int inside) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < n; k++) {
    const hr2d_point a = on_circle(k, n), b = on_circle(k + 1, n);
    test_add_patch(scene, inside ? (hr2d_segment){a, b} : (hr2d_segment){b, a}, 1, 0.5,
                   HR2D_SIDES_FRONT);
  }
  test_commit(scene);
  return scene;
}

/* n small squares before a sky. */
static hr2d_scene *squares(int n) {
  randoms r = randoms_stream(test_seed(), 2);
  hr2d_scene *scene = test_new_scene(NULL);
  const int side = (int)ceil(sqrt(n));
  for (int k = 0; k < n; k++) {
    const double x = k % side + random_between(&r, 0, 0.3), angle = random_between(&r, 0, 6.28);
    const double y = k / side + random_between(&r, 0, 0.3);
    hr2d_point at[5];
    for (int m = 0; m < 5; m++)
      at[m] = (hr2d_point){x + 0.3 * cos(angle - 1.5707963267948966 * (m % 4)),
                           y + 0.3 * sin(angle - 1.5707963267948966 * (m % 4))};
    for (int m = 0; m < 4; m++)
      test_add_patch(scene, (hr2d_segment){at[m], at[m + 1]}, 1, 0.5, HR2D_SIDES_FRONT);
  }
  set_background(scene);
  test_commit(scene);
  return scene;
}

static double work_of(hr2d_scene *scene) {
  summed s;
  sum_up(&s, scene, 1);
  const double work = (double)s.work;
  ck_assert_uint_gt(s.rows.leaves, 0);
  release(&s);
  return work;
}

/* p where work grows like N^p. */
static double growth(double few, double many, double times) {
  return log(many / few) / log(times);
}

/* Negative control: in a ring all is seen from everywhere. */
START_TEST(work_grows_with_what_is_seen) {
  ck_assert_double_lt(growth(work_of(squares(100)), work_of(squares(900)), 9), 1.25);
  ck_assert_double_lt(growth(work_of(ring(100, 0)), work_of(ring(900, 0)), 9), 1.1);
  ck_assert_double_gt(growth(work_of(ring(100, 1)), work_of(ring(400, 1)), 4), 1.7);
}
END_TEST

/* For callers: without links, all or some rows, with backs or not. */
START_TEST(leaves_are_asked_alone) {
  summed s;
  sum_up(&s, squares(64), 0.3);
  const hr2d_hierarchy *h = s.links.hierarchy;
  double *front = calloc(h->elements, sizeof *front), *back = calloc(h->elements, sizeof *back),
         *some = calloc(h->elements, sizeof *some);
  ck_assert_int_eq(hr2d_leaf_sums(h, 0, 0, front, back), HR2D_OK);
  ck_assert_int_eq(hr2d_leaf_sums(h, 20, 70, some, NULL), HR2D_OK);
  int between = 0;
  for (size_t m = 0; m < s.transport.leaves; m++) {
    const uint32_t leaf = s.transport.leaf[m];
    const size_t patch = h->element[leaf].patch;
    ck_assert(front[leaf] == s.rows.front[leaf] && back[leaf] == s.rows.back[leaf]);
    ck_assert_double_eq_tol(some[leaf], patch >= 20 && patch < 70 ? front[leaf] : 0, 1e-15);
    between += front[leaf] > 0.1 && front[leaf] < 0.9;
  }
  ck_assert_int_gt(between, 100);
  ck_assert_int_eq(hr2d_leaf_sums(h, 0, 0, NULL, back), HR2D_OK);
  ck_assert_int_eq(hr2d_leaf_sums(h, 3, 2, front, NULL), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_leaf_sums(h, 0, 1000, front, NULL), HR2D_EINVAL);
  free(front);
  free(back);
  free(some);
  release(&s);
}
END_TEST

static int has_backs(const double (*at)[4], size_t count) {
  int found;
  hr2d_scene *scene = test_open_scene(at, count);
  set_background(scene);
  test_commit(scene);
  ck_assert_int_eq(hr2di_side_parts_find_backs(scene, &found, NULL), HR2D_OK);
  hr2d_scene_destroy(scene);
  return found;
}

START_TEST(what_no_patch_covers_is_a_back) {
  static const double two_sided[][4] = {{0, 0, 1, 0}, {1, 0, 0, 0}};
  static const double in_parts[][4] = {{0, 0, 1, 0}, {1, 0, 0.5, 0}, {0.5, 0, 0, 0}};
  static const double in_part[][4] = {{0, 0, 1, 0}, {1, 0, 0.5, 0}};
  static const double gap[][4] = {{0, 0, 1, 0}, {1, 0, 0.75, 0}, {0.5, 0, 0, 0}};
  static const double longer[][4] = {{0, 0, 1, 0}, {1, 0, 0.5, 0}, {0.5, 0, -1, 0}};
  static const double one[][4] = {{0, 0, 1, 0}};
  static const double room[][4] = {{0, 0, 1, 0}, {1, 0, 0, 1}, {0, 1, 0, 0}};
  ck_assert_int_eq(has_backs(two_sided, 2), 0);
  ck_assert_int_eq(has_backs(in_parts, 3), 0);
  ck_assert_int_eq(has_backs(in_part, 2), 1);
  ck_assert_int_eq(has_backs(gap, 3), 1);
  ck_assert_int_eq(has_backs(longer, 3), 1);
  ck_assert_int_eq(has_backs(one, 1), 1);
  ck_assert_int_eq(has_backs(room, 3), 1);
}
END_TEST

TEST_SUITE("row-sums") {
  ADD_TESTS("leaves", rows_are_what_leaves_see, no_back_is_seen_through_a_front,
            rows_without_a_plane_are_the_same, leaves_are_asked_alone);
  ADD_TESTS("work", work_grows_with_what_is_seen);
  ADD_TESTS("backs", what_no_patch_covers_is_a_back);
}
