/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stars spare pairs, and no pair that meets: pairs are compared with all pairs of the sweep. */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "geometry/crossings.h"
#include "geometry/stars.h"
#include "scene/scene-impl.h"
#include "support/memory.h"
#include "support/random.h"
#include "support/settings.h"
#include "support/suite.h"

enum { MOST = 400, PAIRS = MOST * MOST };

typedef struct pairs {
  const hr2d_segment *segment;
  size_t at[PAIRS][2], count;
} pairs;

static hr2d_status keep(void *ctx, size_t i, size_t j) {
  pairs *p = ctx;
  ck_assert_uint_lt(i, j);
  ck_assert_uint_lt(p->count, PAIRS);
  p->at[p->count][0] = i;
  p->at[p->count++][1] = j;
  return HR2D_OK;
}

static int meets(const pairs *p, size_t k) {
  const hr2di_meeting m =
      hr2di_crossings_meet(&p->segment[p->at[k][0]], &p->segment[p->at[k][1]]);
  return m.kind != HR2DI_MEET_FREE || m.together;
}

/* Spokes of lengths 2^-30 to 1 from a few centres, of which many differ by some roundings only
   in direction or are copies, among others that cross them. */
static size_t draw_spokes(randoms *r, hr2d_segment *s) {
  const size_t count = 60 + (size_t)(random_unit(r) * (MOST - 60));
  hr2d_point centre[3];
  for (int c = 0; c < 3; c++)
    centre[c] = (hr2d_point){random_unit(r) - .5, random_unit(r) - .5};
  for (size_t k = 0; k < count; k++) {
    const hr2d_point p = centre[(size_t)(random_unit(r) * 3)];
    const double length = random_unit(r) < .5 ? random_unit(r) : exp2(-30 * random_unit(r));
    double angle = 6.28 * random_unit(r);
    if (random_unit(r) < .4) angle = floor(angle) + exp2(-30 - 24 * random_unit(r));
    hr2d_point q = {p.x + length * cos(angle), p.y + length * sin(angle)};
    if (random_unit(r) < .1) q = (hr2d_point){random_unit(r), random_unit(r)};
    s[k] = random_unit(r) < .5 ? (hr2d_segment){p, q} : (hr2d_segment){q, p};
    if (k > 0 && random_unit(r) < .05) s[k] = s[k - 1];
    if (random_unit(r) < .1) s[k].a = (hr2d_point){random_unit(r), random_unit(r)};
  }
  return count;
}

static hr2d_status go_on(void *ctx, const hr2d_progress *progress) {
  (void)ctx;
  (void)progress;
  return HR2D_OK;
}

/* 5 ms of work lie between two questions, as in check-polls, at most. */
START_TEST(large_stars_poll) {
  enum { COUNT = 200000 };
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_segment *s = malloc(COUNT * sizeof *s);
  hr2di_stars stars;
  hr2di_watch watch;
  ck_assert_ptr_nonnull(s);
  for (size_t k = 0; k < COUNT; k++)
    s[k] = (hr2d_segment){{0, 0}, {cos((double)k), sin((double)k)}};
  hr2di_watch_init(&watch, go_on, NULL, "stars");
  ck_assert_int_eq(hr2di_stars_init(&stars, &alloc, s, COUNT, sizeof *s, &watch), HR2D_OK);
  ck_assert_uint_eq(stars.count, 1);
  ck_assert_uint_gt(watch.total, COUNT);
  ck_assert_uint_le(watch.max, 5 * HR2DI_WATCH_SPAN);
  hr2di_stars_clear(&stars);
  free(s);
}
END_TEST

START_TEST(no_pair_that_meets_is_spared) {
  static hr2d_segment s[MOST];
  static pairs all, found;
  const hr2d_allocator alloc = hr2di_alloc_default();
  randoms r = randoms_stream(test_seed(), _i);
  const size_t count = draw_spokes(&r, s);
  all = (pairs){.segment = s};
  found = (pairs){.segment = s};
  ck_assert_int_eq(hr2di_crossings_sweep(&alloc, s, count, sizeof *s, keep, &all, NULL), 0);
  ck_assert_int_eq(hr2di_crossings_find(&alloc, s, count, sizeof *s, NULL, keep, &found, NULL),
                   0);
  ck_assert_uint_lt(found.count, all.count);
  size_t next = 0, met = 0;
  for (size_t k = 0; k < all.count; k++) {
    const int is_next = next < found.count && found.at[next][0] == all.at[k][0] &&
                        found.at[next][1] == all.at[k][1];
    next += (size_t)is_next;
    met += (size_t)meets(&all, k);
    ck_assert_msg(is_next || !meets(&all, k), "%zu and %zu meet", all.at[k][0], all.at[k][1]);
  }
  ck_assert_uint_eq(next, found.count); /* in the same order */
  ck_assert_uint_gt(met, 0);
}
END_TEST

START_TEST(memory_that_runs_out_is_told_and_released) {
  static hr2d_segment s[MOST];
  static pairs found;
  randoms r = randoms_stream(test_seed(), 0);
  const size_t count = draw_spokes(&r, s);
  long failures = 0;
  for (int status = HR2D_ENOMEM; status != HR2D_OK; failures++) {
    test_memory memory = {.until_failure = failures};
    const hr2d_allocator alloc = test_hooks(&memory);
    found = (pairs){.segment = s};
    status = (int)hr2di_crossings_find(&alloc, s, count, sizeof *s, NULL, keep, &found, NULL);
    ck_assert(status == HR2D_OK || status == HR2D_ENOMEM);
    ck_assert_int_eq(memory.live, 0);
  }
  ck_assert_int_gt(failures, 10);
}
END_TEST

static hr2d_status note_work(void *ctx, const hr2d_progress *progress) {
  *(uint64_t *)ctx = hr2di_watch_of(progress)->total;
  return HR2D_OK;
}

static hr2d_status ignore(void *ctx, const hr2d_warning *warning) {
  (void)ctx;
  return warning->text ? HR2D_OK : HR2D_EINVAL;
}

/* Two-sided segments from one point to a circle. */
static hr2d_scene *make_star(size_t count) {
  hr2d_scene *scene;
  const double half = .5, one = 1;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (size_t k = 0; k < count; k++) {
    const double angle = 6.28318530717958647692 * (double)k / (double)count;
    hr2d_patch p = HR2D_PATCH_INIT;
    p.b = (hr2d_point){cos(angle), sin(angle)};
    p.reflectance = &half;
    p.reflectance_bands = 1;
    p.sides = HR2D_SIDES_BOTH;
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_set_background(scene, &one, 1), HR2D_OK);
  return scene;
}

static uint64_t work_of(size_t count, int lints) {
  hr2d_scene *scene = make_star(count);
  uint64_t work = 0;
  if (!lints) hr2d_scene_set_progress(scene, note_work, &work);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  if (lints) hr2d_scene_set_progress(scene, note_work, &work);
  if (lints) ck_assert_int_eq(hr2d_scene_lint(scene, ignore, NULL, NULL), HR2D_OK);
  hr2d_scene_destroy(scene);
  return work;
}

/* Some sorts of 16,000 patches, their plane, and what a view passes: 300 units of a tenth of a
   microsecond for each.  With all pairs there are 4,000 at least. */
START_TEST(work_for_a_star_is_not_quadratic) {
  const uint64_t work = work_of(8000, _i);
  ck_assert_uint_gt(work, 10000);
  ck_assert_msg(work < 16000 * 500, "%llu units of work", (unsigned long long)work);
}
END_TEST

/* Of the warnings: how many there are, and how many say that a patch of the star is loose. */
typedef struct tally {
  size_t all, loose, of_star;
} tally;

static hr2d_status tell(void *ctx, const hr2d_warning *warning) {
  tally *t = ctx;
  t->all++;
  t->loose += warning->code == HR2D_WARNING_LOOSE_END && warning->patch[0] < t->of_star;
  return HR2D_OK;
}

/* A wall ends a little short of the point of a star: that is an opening between walls, one of
   whose ends is loose, and not the point of the star, though its patches are not compared with
   each other. */
START_TEST(the_point_of_a_star_is_no_loose_end) {
  hr2d_scene *scene = make_star(20);
  const double angle = 6.28318530717958647692 / 40;
  const hr2d_patch spoke = {.a = {1e-3 * cos(angle), 1e-3 * sin(angle)},
                            .b = {cos(angle), sin(angle)},
                            .sides = HR2D_SIDES_BOTH};
  tally t = {.of_star = 40};
  ck_assert_int_eq(hr2d_scene_add(scene, &spoke, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_lint(scene, tell, &t, NULL), HR2D_OK);
  hr2d_scene_destroy(scene);
  ck_assert_uint_gt(t.all, 0);
  ck_assert_uint_eq(t.loose, 0);
}
END_TEST

TEST_SUITE("check-stars") {
  REPEAT_TESTS(test_count(400), "pairs", no_pair_that_meets_is_spared);
  ADD_TESTS("memory", memory_that_runs_out_is_told_and_released);
  REPEAT_TESTS(2, "work", work_for_a_star_is_not_quadratic);
  ADD_TESTS("polls", large_stars_poll);
  ADD_TESTS("lint", the_point_of_a_star_is_no_loose_end);
}
