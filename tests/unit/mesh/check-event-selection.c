/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Events that matter: how large jumps at events may be, and where elements are divided. */
#include <math.h>

#include "base/alloc.h"
#include "estimate/importance.h"
#include "mesh/event-selection.h"
#include "support/accuracy-tally.h"
#include "support/slow-scenes.h"
#include "support/support.h"
#include "visibility/point-view.h"

/* A lamp over a room with two screens that nothing repeats. */
static hr2d_scene *room(void) {
  const double patch[][6] = {{0, 0, 3, 0, 0, .6},          {3, 0, 3, 2, 0, .5},
                             {3, 2, 1.7, 2, 0, .7},        {1.7, 2, .4, 2, 1, .4},
                             {.4, 2, 0, 2, 0, .7},         {0, 2, 0, 0, 0, .3},
                             {.7, .31, 1.1, .83, 0, .5},   {1.1, .83, .7, .31, 0, .6},
                             {1.9, 1.21, 2.3, .57, 0, .4}, {2.3, .57, 1.9, 1.21, 0, .2}};
  return test_scene(patch, sizeof patch / sizeof *patch);
}

static hr2di_events events_of(const hr2d_scene *scene, unsigned generations) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_events events;
  ck_assert_int_eq(hr2di_events_init(&events, scene, &alloc, generations, SIZE_MAX, NULL, NULL),
                   HR2D_OK);
  return events;
}

/* What falls on a point if each patch has a light of its own. */
static double received(hr2di_point_viewer *viewer, size_t patch, double at,
                       const double *light) {
  hr2di_view_from seen;
  double sum = 0;
  ck_assert_int_eq(hr2di_view_at(viewer, patch, at, &seen), HR2D_OK);
  for (size_t k = 0; k < seen.count; k++)
    sum += seen.interval[k].sine * light[seen.interval[k].patch];
  return sum;
}

/* At an event of generation 1 the derivative jumps by no more than `spread` times the largest
   difference of lights, and twice that on the line of a screen. */
START_TEST(jumps_are_bounded) {
  hr2d_scene *scene = room();
  const hr2d_allocator alloc = hr2di_alloc_default();
  const hr2di_events events = events_of(scene, 1);
  hr2di_point_viewer *viewer;
  randoms r = {test_seed() + (uint64_t)_i};
  double light[10], largest = 0;
  for (int k = 0; k < 10; k++) light[k] = random_below(&r, 2);
  ck_assert_int_eq(hr2di_point_viewer_create(scene, &alloc, NULL, &viewer), HR2D_OK);
  for (size_t k = 0; k < events.count; k++) {
    const hr2di_event *e = &events.event[k];
    const double step = 1e-6, far = 1e-3;
    if (e->at < far || e->at > 1 - far || (k > 0 && e->at - e[-1].at < far) ||
        (k + 1 < events.count && fabs(e[1].at - e->at) < far))
      continue;
    const double jump = (received(viewer, e->patch, e->at + step, light) +
                         received(viewer, e->patch, e->at - step, light) -
                         2 * received(viewer, e->patch, e->at, light)) /
                        (step * scene->patch[e->patch].length);
    ck_assert_double_le(fabs(jump), 2.001 * e->spread + 1e-3);
    largest = fmax(largest, fabs(jump) / e->spread);
  }
  /* Negative control: some jumps are as large. */
  ck_assert_double_gt(largest, 0.8);
  hr2di_point_viewer_destroy(viewer);
  hr2di_events events_to_clear = events;
  hr2di_events_clear(&events_to_clear);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Leaves of a room that is divided at its events until those inside make `allowed`. */
static size_t leaves_for(const hr2d_scene *scene, double allowed) {
  hr2d_hierarchy *h;
  hr2di_events events = events_of(scene, 1);
  hr2di_primal_dual lights = {0};
  hr2d_target target = HR2D_TARGET_INIT;
  hr2di_message message;
  hr2di_survey survey;
  double *unresolved_jump;
  target.floor = HR2D_FLOOR;
  ck_assert_int_eq(hr2di_importance(scene, &target, NULL, &lights, &survey, &message), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  h->order = 4;
  ck_assert_int_eq(
      hr2di_events_select(h, &events, &lights, allowed, 0, 1, NULL, &unresolved_jump), HR2D_OK);
  size_t marked = 0, elements = h->elements;
  for (size_t k = 0; k < elements; k++) {
    ck_assert(!(unresolved_jump[k] > 0) || !h->element[k].child);
    marked += unresolved_jump[k] > 0;
  }
  ck_assert_int_eq(marked > 0, allowed > 0);
  const size_t leaves = (size_t)hr2d_hierarchy_count(h).leaves;
  ck_assert_uint_le(leaves, 10 + events.count);
  hr2di_alloc_free(&h->alloc, unresolved_jump);
  hr2di_primal_dual_clear(&lights, scene);
  hr2di_events_clear(&events);
  hr2d_hierarchy_destroy(h);
  return leaves;
}

START_TEST(few_events_matter) {
  hr2d_scene *scene = room();
  const size_t all = leaves_for(scene, 0);
  size_t before = leaves_for(scene, 1e6);
  ck_assert_uint_eq(before, 10); /* nothing is divided */
  for (double allowed = 1e-1; allowed > 1e-9; allowed *= 1e-2) {
    const size_t leaves = leaves_for(scene, allowed);
    ck_assert_uint_ge(leaves, before);
    before = leaves;
  }
  ck_assert_uint_ge(all, before);
  ck_assert_uint_lt(leaves_for(scene, 1e-3), all / 2);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The target is reached with fewer elements than events would make, and the estimate shows the
   kinks that are left. */
START_TEST(answers_are_right_without_max_events) {
  hr2d_scene *scene = room();
  hr2di_events events = events_of(scene, 1);
  hr2d_account a, b;
  hr2d_solution *truth = accuracy_solve(scene, 1e-10, HR2D_NORM_AVERAGE, &b);
  for (double error = 1e-3; error > 1e-8; error *= 1e-2) {
    hr2d_solution *solution = accuracy_solve(scene, error, HR2D_NORM_AVERAGE, &a);
    double worst = 0;
    for (size_t k = 0; k < 10; k++)
      worst = fmax(
          worst,
          fabs(hr2d_solution_average(solution, k, 0) / hr2d_solution_average(truth, k, 0) - 1));
    ck_assert_double_le(worst, error);
    ck_assert_double_le(worst, a.average.bound);
    ck_assert_double_le(worst, 2 * a.average.estimate);
    ck_assert_uint_lt(a.leaves, b.leaves);
    hr2d_solution_destroy(solution);
  }
  hr2d_solution_destroy(truth);
  hr2di_events_clear(&events);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Leaves that are divided at events by so many threads, and what is left inside them. */
static hr2d_hierarchy *cut_by(const hr2d_scene *scene, const hr2di_events *events,
                              const hr2di_primal_dual *lights, unsigned threads,
                              double **unresolved_jump) {
  hr2d_hierarchy *h;
  ck_assert_int_eq(hr2d_hierarchy_create(scene, &h), HR2D_OK);
  h->order = 3;
  ck_assert_int_eq(
      hr2di_events_select(h, events, lights, 1e-4, 0, threads, NULL, unresolved_jump), HR2D_OK);
  return h;
}

START_TEST(threads_change_no_bit) {
  hr2d_scene *scene = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(slow_add(scene, SLOW_SQUARES, 60), HR2D_OK);
  test_commit(scene);
  hr2di_events events = events_of(scene, 2);
  hr2di_primal_dual lights = {0};
  hr2d_target target = HR2D_TARGET_INIT;
  hr2di_message message;
  hr2di_survey survey;
  target.floor = HR2D_FLOOR;
  ck_assert_int_eq(hr2di_importance(scene, &target, NULL, &lights, &survey, &message), HR2D_OK);
  double *unresolved_jump, *bent_alone;
  hr2d_hierarchy *alone = cut_by(scene, &events, &lights, 1, &bent_alone);
  ck_assert_uint_gt(alone->elements, 2 * hr2d_scene_patches(scene));
  for (unsigned threads = 2; threads < 5; threads++) {
    hr2d_hierarchy *h = cut_by(scene, &events, &lights, threads, &unresolved_jump);
    ck_assert_uint_eq(h->elements, alone->elements);
    ck_assert_mem_eq(unresolved_jump, bent_alone, h->elements * sizeof *unresolved_jump);
    for (uint32_t k = 0; k < h->elements; k++) {
      ck_assert_uint_eq(h->element[k].child, alone->element[k].child);
      ck_assert(h->element[k].length == alone->element[k].length);
    }
    hr2di_alloc_free(&h->alloc, unresolved_jump);
    hr2d_hierarchy_destroy(h);
  }
  printf("%zu events, %zu elements\n", events.count, alone->elements);
  hr2di_alloc_free(&alone->alloc, bent_alone);
  hr2d_hierarchy_destroy(alone);
  hr2di_primal_dual_clear(&lights, scene);
  hr2di_events_clear(&events);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("kinks") {
  REPEAT_TESTS(3, "kinks", jumps_are_bounded);
  ADD_TESTS("kinks", threads_change_no_bit, few_events_matter,
            answers_are_right_without_max_events);
}
