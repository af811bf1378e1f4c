/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Floor plans that were rotated, moved, jittered and rounded: after hr2d_scene_snap() they are
   accepted, closed, and exchange light as the clean plan does. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/watch.h"
#include "support/random.h"
#include "support/support.h"

enum { MOST = 64, SIDES = 2 * MOST, PLANS = 200 };

typedef struct floor_plan {
  hr2d_segment s[MOST];
  hr2d_sides sides[MOST];
  size_t count;
} floor_plan;

static void draw(floor_plan *p, double ax, double ay, double bx, double by, hr2d_sides sides) {
  ck_assert_uint_lt(p->count, MOST);
  p->sides[p->count] = sides;
  p->s[p->count++] = (hr2d_segment){{ax, ay}, {bx, by}};
}

/* Tenths of a metre, so that no two things are nearer than 0.1 unless they touch. */
static double tenth(randoms *r, double low, double high) {
  const int tenths = (int)lround(10 * (high - low)) - 1;
  return low + (1 + random_below(r, tenths)) / 10.;
}

/* Divides a room by a wall with a door, and the halves again. */
static void divide(floor_plan *p, randoms *r, const double box[4], int depth) {
  const double w = box[2] - box[0], h = box[3] - box[1];
  if (depth == 0 || fmax(w, h) < 2 || fmin(w, h) < 1.5) return;
  const int upright = w > h;
  const double from = box[upright], to = box[upright + 2];
  const double at = tenth(r, box[!upright] + .5, box[!upright + 2] - .5);
  const double door = tenth(r, from, to - .8), end = door + .7;
  const double piece[2][2] = {{from, door}, {end, to}};
  for (int k = 0; k < 2; k++)
    if (upright)
      draw(p, at, piece[k][0], at, piece[k][1], HR2D_SIDES_BOTH);
    else
      draw(p, piece[k][0], at, piece[k][1], at, HR2D_SIDES_BOTH);
  double half[4];
  memcpy(half, box, sizeof half);
  half[2 + !upright] = at;
  divide(p, r, half, depth - 1);
  memcpy(half, box, sizeof half);
  half[!upright] = at;
  divide(p, r, half, depth - 1);
}

/* Rooms side by side, each with walls of its own, as a GIS has them: the walls of neighbours
   lie on one another in part, back to back. */
static void draw_rooms(floor_plan *p, randoms *r, const double box[4], int depth) {
  const double w = box[2] - box[0], h = box[3] - box[1];
  const int upright = w > h;
  if (depth == 0 || fmax(w, h) < 2) {
    draw(p, box[0], box[1], box[2], box[1], HR2D_SIDES_FRONT);
    draw(p, box[2], box[1], box[2], box[3], HR2D_SIDES_FRONT);
    draw(p, box[2], box[3], box[0], box[3], HR2D_SIDES_FRONT);
    draw(p, box[0], box[3], box[0], box[1], HR2D_SIDES_FRONT);
    return;
  }
  const double at = tenth(r, box[!upright] + .5, box[!upright + 2] - .5);
  double half[4];
  memcpy(half, box, sizeof half);
  half[2 + !upright] = at;
  draw_rooms(p, r, half, depth - 1);
  memcpy(half, box, sizeof half);
  half[!upright] = at;
  draw_rooms(p, r, half, depth - 1);
}

static void draw_plan(floor_plan *p, randoms *r, int rooms) {
  const double box[4] = {0, 0, tenth(r, 4, 9), tenth(r, 3, 8)};
  p->count = 0;
  if (rooms) {
    draw_rooms(p, r, box, 2 + random_below(r, 2));
    return;
  }
  draw(p, 0, 0, box[2], 0, HR2D_SIDES_FRONT);
  draw(p, box[2], 0, box[2], box[3], HR2D_SIDES_FRONT);
  draw(p, box[2], box[3], 0, box[3], HR2D_SIDES_FRONT);
  draw(p, 0, box[3], 0, 0, HR2D_SIDES_FRONT);
  divide(p, r, box, 1 + random_below(r, 3));
}

/* What is done to a drawing. */
typedef struct damage {
  double cosine, sine, dx, dy, jitter, digits; /* digits: a power of ten */
} damage;

static hr2d_point hit(const damage *d, randoms *r, hr2d_point p) {
  const double x =
      d->cosine * p.x - d->sine * p.y + d->dx + random_between(r, -1, 1) * d->jitter;
  const double y =
      d->sine * p.x + d->cosine * p.y + d->dy + random_between(r, -1, 1) * d->jitter;
  return (hr2d_point){nearbyint(x * d->digits) / d->digits,
                      nearbyint(y * d->digits) / d->digits};
}

static damage draw_damage(randoms *r) {
  const double angle = random_between(r, 0, 6.28);
  const int far = random_below(r, 2);
  return (damage){.cosine = cos(angle),
                  .sine = sin(angle),
                  .dx = far ? 391234.5 : 0,
                  .dy = far ? 5713456.25 : 0,
                  .jitter = 10 * random_power(r, -13, -3),
                  .digits = pow(10, 3 + random_below(r, 10))};
}

/* How far an end is moved at most, with the roundings of coordinates. */
static double size_of(const damage *d) {
  return sqrt(2) * (d->jitter + .5 / d->digits) + 8 * 0x1p-52 * (10 + d->dy);
}

static hr2d_scene *scene_of(const floor_plan *p) {
  static const double lamp = 1, grey = .5;
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < p->count; k++) {
    char name[32];
    snprintf(name, sizeof name, "w%zu", k);
    const hr2d_patch patch = {.a = p->s[k].a,
                              .b = p->s[k].b,
                              .name = name,
                              .emission = &lamp,
                              .emission_bands = k == 0,
                              .reflectance = &grey,
                              .reflectance_bands = 1,
                              .sides = p->sides[k]};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  return scene;
}

/* The exchange areas of a scene between the walls of its plan, two sides each, from all pieces;
 *leak becomes the largest difference of a row's sum from the length of its patch. */
static double *exchange(const hr2d_scene *scene, double *leak) {
  const size_t n = hr2d_scene_patches(scene);
  double *area = malloc(n * n * sizeof *area), *sum = calloc(SIDES * SIDES, sizeof *sum);
  size_t *side = malloc(n * sizeof *side);
  ck_assert(area && sum && side);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
  *leak = 0;
  for (size_t k = 0; k < n; k++) {
    const char *name = hr2d_scene_name(scene, k);
    ck_assert_int_eq(sscanf(name, "w%zu", &side[k]), 1);
    side[k] = 2 * side[k] + (strstr(name, "(back)") != NULL);
  }
  for (size_t i = 0; i < n; i++) {
    double row = 0;
    for (size_t j = 0; j < n; j++) {
      row += area[i * n + j];
      sum[side[i] * SIDES + side[j]] += area[i * n + j];
    }
    *leak = fmax(*leak, fabs(row - hr2d_scene_length(scene, i)));
  }
  free(area);
  free(side);
  return sum;
}

static double difference(const double *f, const double *g) {
  double max = 0;
  for (size_t k = 0; k < SIDES * SIDES; k++) max = fmax(max, fabs(f[k] - g[k]));
  return max;
}

/* An exchange area is half a sum of lengths of four strings, taut around ends of walls: moving
   these by d changes each string by 2 d at each of its few corners. */
#define STRINGS 4

START_TEST(damaged_plans_exchange_light_as_clean_ones) {
  const int plans = (int)fmax(test_count(PLANS), 10);
  int broken = 0;
  double worst = 0;
  for (int k = 0; k < plans; k++) {
    randoms r = randoms_stream(test_seed(), k);
    floor_plan clean, damaged;
    draw_plan(&clean, &r, _i);
    const damage d = draw_damage(&r);
    const double moved = size_of(&d), rounding = 1e-13 * (10 + d.dy) + 1e-11;
    damaged = clean;
    for (size_t m = 0; m < clean.count; m++)
      damaged.s[m] = (hr2d_segment){hit(&d, &r, clean.s[m].a), hit(&d, &r, clean.s[m].b)};
    hr2d_scene *scene = scene_of(&clean), *raw = scene_of(&damaged);
    hr2d_scene *snapped = scene_of(&damaged);
    hr2d_snap_report report;
    double leak;
    test_commit(scene);
    double *before = exchange(scene, &leak);
    ck_assert_double_lt(leak, 1e-11);
    /* the control: without the snap it is refused, or it leaks */
    if (hr2d_scene_commit(raw)) {
      broken++;
    } else {
      free(exchange(raw, &leak));
      broken += leak > rounding;
    }
    ck_assert_int_eq(hr2d_scene_snap(snapped, 2.5 * moved, &report), HR2D_OK);
    ck_assert_msg(report.farthest <= 5 * moved, "plan %d: %g", k, report.farthest / moved);
    ck_assert_msg(!hr2d_scene_commit(snapped), "plan %d: %s", k, hr2d_scene_message(snapped));
    double *after = exchange(snapped, &leak);
    ck_assert_msg(leak <= rounding, "plan %d leaks %g", k, leak);
    worst = fmax(worst, (difference(before, after) - rounding) / moved);
    free(before);
    free(after);
    hr2d_scene_destroy(scene);
    hr2d_scene_destroy(raw);
    hr2d_scene_destroy(snapped);
  }
  printf("%d of %d damaged plans leak or are refused; exchange is off by %.3g moves\n", broken,
         plans, worst);
  ck_assert_int_gt(2 * broken, plans);
  ck_assert_msg(worst < STRINGS, "%g", worst);
}
END_TEST

static hr2d_snap_report snap(hr2d_scene *scene, double tolerance) {
  hr2d_snap_report report = {0};
  ck_assert_msg(!hr2d_scene_snap(scene, tolerance, &report), "%s", hr2d_scene_message(scene));
  return report;
}

START_TEST(each_repair_is_told) {
  static const double at[][4] = {
      {0, 0, 4, 0},         {4.001, 0, 4, 3},                  /* an end beside another one */
      {4, 3, 0, 3},         {0, 3, 0, 0},     {2, .001, 2, 1}, /* short of the floor */
      {1, 1, 1, -.002},                                        /* through it */
      {3, 1, 3.001, 1.001},                                    /* a sliver */
      {4, 3, 0.001, 3.001}};                                   /* a copy */
  hr2d_scene *scene = test_open_scene(at, sizeof at / sizeof *at);
  const hr2d_snap_report r = snap(scene, .005);
  ck_assert_uint_eq(r.ends, 3);
  ck_assert_uint_eq(r.feet, 2);
  ck_assert_uint_eq(r.slivers, 1);
  ck_assert_uint_eq(r.copies, 1);
  ck_assert_uint_eq(r.cuts, 0);
  ck_assert_double_eq(r.farthest, .002);
  ck_assert_double_eq(r.from.y, -.002);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 6);
  ck_assert_double_eq(hr2d_scene_segment(scene, 4).a.y, 0);
  ck_assert_double_eq(hr2d_scene_segment(scene, 5).b.y, 0);
  ck_assert_double_eq(hr2d_scene_segment(scene, 1).a.x, 4);
  test_commit(scene);
  ck_assert_int_eq(hr2d_scene_snap(scene, 1, NULL), HR2D_ESTATE);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(what_is_exact_does_not_move) {
  static const double at[][4] = {
      {0, 0, 4, 0}, {4, 0, 4, 3}, {4, 3, 0, 3}, {0, 3, 0, 0}, {1, 0, 1, 2}};
  hr2d_scene *scene = test_open_scene(at, sizeof at / sizeof *at);
  const hr2d_snap_report r = snap(scene, .01);
  ck_assert_uint_eq(r.ends + r.feet + r.slivers + r.copies + r.cuts, 0);
  ck_assert_double_eq(r.farthest, 0);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(wrong_calls_change_nothing) {
  static const double at[][4] = {{0, 0, 4, 0}, {4, 0, 4, 3}};
  hr2d_scene *scene = test_open_scene(at, 2);
  const double wrong[] = {0, -1, NAN, INFINITY};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
    ck_assert_int_eq(hr2d_scene_snap(scene, wrong[k], NULL), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_scene_snap(scene, 100, NULL), HR2D_ESCENE);
  test_expect_message(scene, "no patch is longer than the tolerance of 100");
  ck_assert_uint_eq(hr2d_scene_patches(scene), 2);
  ck_assert_double_eq(hr2d_scene_segment(scene, 1).b.y, 3);
  hr2d_scene_destroy(scene);
  scene = test_new_scene(NULL);
  ck_assert_int_eq(hr2d_scene_snap(scene, 1, NULL), HR2D_OK);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status note_work(void *ctx, const hr2d_progress *progress) {
  *(uint64_t *)ctx += hr2di_watch_of(progress)->work + HR2DI_WATCH_SPAN;
  return HR2D_OK;
}

/* Copies are dropped before pairs are looked at, of which there are 10^8. */
START_TEST(copies_are_dropped_at_once) {
  enum { COPIES = 20000 };
  hr2d_scene *scene = NULL;
  hr2d_snap_report report;
  uint64_t work = 0;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (int k = 0; k < COPIES; k++) {
    const hr2d_patch p = {.a = {1e-12 * (k % 7), 0}, .b = {1, .3}};
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  hr2d_scene_set_progress(scene, note_work, &work);
  ck_assert_int_eq(hr2d_scene_snap(scene, 1e-9, &report), HR2D_OK);
  ck_assert_uint_eq(hr2d_scene_patches(scene), 1);
  ck_assert_uint_eq(report.copies, COPIES - 1);
  ck_assert_msg(work < 200 * COPIES, "%llu units of work", (unsigned long long)work);
  hr2d_scene_destroy(scene);
}
END_TEST

/* What the message says is typed: a window on the middle of a wall, which is cut twice.  The
   one that the message names, which comes first, gives its light to the stretch of both. */
START_TEST(messages_name_a_tolerance_that_helps) {
  const hr2d_segment wall = {{0, 0}, {4, 0}}, window = {{1, 0}, {3, 0}};
  for (int first = 0; first < 2; first++) {
    hr2d_scene *scene = test_new_scene(NULL);
    hr2d_snap_report r;
    test_add_patch(scene, first ? window : wall, 1, .5, HR2D_SIDES_FRONT);
    test_add_patch(scene, first ? wall : window, 2, .5, HR2D_SIDES_FRONT);
    ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
    const char *number = strstr(hr2d_scene_message(scene), "--snap ");
    ck_assert_ptr_nonnull(number);
    ck_assert_ptr_nonnull(strstr(number, "keeps patch 0 there"));
    const double tolerance = strtod(number + strlen("--snap "), NULL);
    ck_assert(tolerance > 0 && tolerance < 1e-3);
    ck_assert_int_eq(hr2d_scene_snap(scene, tolerance, &r), HR2D_OK);
    ck_assert_uint_eq(r.cuts, 2);
    ck_assert_uint_eq(r.copies, 1);
    ck_assert_uint_eq(hr2d_scene_patches(scene), 3);
    for (size_t k = 0; k < 3; k++)
      ck_assert_double_eq(hr2d_scene_emission(scene, k, 0),
                          !first || hr2d_scene_segment(scene, k).a.x == 1 ? 1 : 2);
    ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("snap") {
  REPEAT_TESTS(2, "plans", damaged_plans_exchange_light_as_clean_ones);
  ADD_TESTS("snap", messages_name_a_tolerance_that_helps, each_repair_is_told,
            what_is_exact_does_not_move, wrong_calls_change_nothing);
  ADD_TESTS("copies", copies_are_dropped_at_once);
}
