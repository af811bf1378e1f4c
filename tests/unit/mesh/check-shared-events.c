/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several shares find the events of one process, in all bits, and divide the looking among
   themselves; where there are too many for one, there are for all. */
#include <check.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "mesh/events.h"
#include "support/shares.h"
#include "support/slow-scenes.h"
#include "support/support.h"

typedef struct job {
  const hr2d_scene *scene;
  unsigned generations;
  size_t max;
  hr2d_status status[SHARES_MOST];
  hr2di_events found[SHARES_MOST];
} job;

static void look(hr2d_share *share, void *ctx) {
  job *j = ctx;
  const hr2d_allocator alloc = hr2di_alloc_default();
  j->status[share->number] = hr2di_events_init(&j->found[share->number], j->scene, &alloc,
                                               j->generations, j->max, share, NULL);
}

static int same(const hr2di_event *e, const hr2di_event *f) {
  const double x[] = {e->at, e->origin_at, e->past.x, e->past.y, e->spread};
  const double y[] = {f->at, f->origin_at, f->past.x, f->past.y, f->spread};
  return e->patch == f->patch && e->generation == f->generation && e->origin == f->origin &&
         !memcmp(x, y, sizeof x);
}

static void expect(const hr2di_events *found, const hr2di_events *one) {
  ck_assert_uint_eq(found->count, one->count);
  for (size_t k = 0; k < one->count; k++) ck_assert(same(&found->event[k], &one->event[k]));
}

/* Returns the steps of all shares together. */
static uint64_t share_out(job *j, unsigned count, hr2d_status status, const hr2di_events *one) {
  uint64_t steps = 0;
  shares_run(count, look, j);
  for (unsigned k = 0; k < count; k++) {
    ck_assert_int_eq(j->status[k], status);
    if (!status) expect(&j->found[k], one);
    steps += j->found[k].steps;
    hr2di_events_clear(&j->found[k]);
  }
  return steps;
}

static void add_box(hr2d_scene *scene, hr2d_point from, double width, double height) {
  const hr2d_point to = {from.x + width, from.y + height};
  const hr2d_point corner[] = {from, {to.x, from.y}, to, {from.x, to.y}};
  const int step = width > 0 && height > 0 ? 1 : 3;
  for (int k = 0; k < 4; k++) {
    const hr2d_segment side = {corner[step * k % 4], corner[step * (k + 1) % 4]};
    ck_assert_int_eq(test_add_patch(scene, side, 1, 0.5, HR2D_SIDES_FRONT), HR2D_OK);
  }
}

/* Aligned squares in a room: many lines through two ends go through more of them. */
static void add_aligned(hr2d_scene *scene) {
  add_box(scene, (hr2d_point){0, 0}, 8, 8);
  for (int k = 0; k < 9; k++)
    add_box(scene, (hr2d_point){2 * (k % 3) + 2, 2 * (k / 3) + 1.5}, -0.5, 0.5);
}

static hr2d_scene *make(int kind) {
  hr2d_scene *scene = test_new_scene(NULL);
  if (kind < SLOW_KINDS)
    ck_assert_int_eq(slow_add(scene, (slow_kind)kind, 30), HR2D_OK);
  else
    add_aligned(scene);
  test_commit(scene);
  return scene;
}

START_TEST(finds_what_one_finds) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_scene *scene = make(_i);
  for (unsigned generations = 1; generations <= 2; generations++) {
    hr2di_events one;
    job j = {.scene = scene, .generations = generations, .max = SIZE_MAX};
    ck_assert_int_eq(hr2di_events_init(&one, scene, &alloc, generations, SIZE_MAX, NULL, NULL),
                     HR2D_OK);
    const unsigned count = 1 + generations;
    ck_assert_uint_eq(share_out(&j, count, HR2D_OK, &one), one.steps);
    j.max = one.count; /* lists of shares may be too long, and each looks again */
    ck_assert_uint_ge(share_out(&j, count, HR2D_OK, &one), one.steps);
    j.max = one.count / 64;
    if (one.count > 0) share_out(&j, count, HR2D_EMAX_ELEMENTS, NULL);
    hr2di_events_clear(&one);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("shared events") {
  REPEAT_TESTS(SLOW_KINDS + 1, "shares", finds_what_one_finds);
}
