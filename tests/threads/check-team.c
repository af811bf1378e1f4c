/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library where the system gives it fewer threads than it asks for: pthread_create() of
   this program fails after some calls.  Results have the same bits, and no call ends the
   program.  And how often it asks for the number of processors, in sysconf() of this program,
   which opens a file of the system each time. */
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/team.h"
#include "support/support.h"

static atomic_int threads_left; /* until pthread_create() fails; negative: it never does */
static atomic_int refused, created;

int pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*start)(void *),
                   void *arg) {
  int (*real)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
  *(void **)&real = dlsym(RTLD_NEXT, "pthread_create");
  if (atomic_load(&threads_left) == 0) {
    atomic_fetch_add(&refused, 1);
    return EAGAIN;
  }
  if (atomic_load(&threads_left) > 0) atomic_fetch_sub(&threads_left, 1);
  atomic_fetch_add(&created, 1);
  return real(thread, attr, start, arg);
}

static atomic_int asked;

long sysconf(int name) {
  long (*real)(int);
  *(void **)&real = dlsym(RTLD_NEXT, "sysconf");
  if (name == _SC_NPROCESSORS_ONLN) atomic_fetch_add(&asked, 1);
  return real(name);
}

enum { TASKS = 1000, TEAM = 8 };

typedef struct tally {
  atomic_int done[TASKS];
  atomic_int busy[TEAM]; /* two threads with one number would meet here */
  atomic_int met;
} tally;

static void count(void *ctx, size_t worker, size_t k) {
  tally *t = ctx;
  if (worker >= TEAM || atomic_fetch_add(&t->busy[worker], 1) > 0) atomic_store(&t->met, 1);
  atomic_fetch_add(&t->done[k], 1);
  atomic_fetch_sub(&t->busy[worker], 1);
}

START_TEST(every_task_is_done_once) {
  for (int some = -1; some < TEAM; some++)
    for (size_t tasks = 0; tasks <= TASKS; tasks += 1 + tasks) {
      tally *t = calloc(1, sizeof *t);
      atomic_store(&threads_left, some);
      hr2di_team_run(TEAM, tasks, count, t, NULL);
      for (size_t k = 0; k < TASKS; k++) ck_assert_int_eq(atomic_load(&t->done[k]), k < tasks);
      ck_assert_int_eq(atomic_load(&t->met), 0);
      free(t);
    }
  atomic_store(&threads_left, -1);
}
END_TEST

enum { MOST = 64 };

typedef struct answer {
  double average[MOST], area[MOST * MOST], order_four[MOST];
  hr2d_refine_counts counts;
} answer;

static void solve(test_links *t, unsigned order, double *average) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = 4;
  ck_assert_int_eq(hr2d_hierarchy_set_order(t->hierarchy, order), HR2D_OK);
  hr2d_solution *solution = test_solve_by(t, &options);
  for (size_t k = 0; k < hr2d_scene_patches(t->scene); k++)
    average[k] = hr2d_solution_average(solution, k, 0);
  hr2d_solution_destroy(solution);
}

/* All four parallel loops, with threads that the system gives until `some` are made. */
static answer *answer_with(int some) {
  answer *a = calloc(1, sizeof *a);
  test_links t =
      test_make_links(test_shipped_scene("partition.geojson"), NULL, NULL, NULL, NULL);
  hr2d_matrix_options matrix = HR2D_MATRIX_OPTIONS_INIT;
  matrix.threads = 4;
  atomic_store(&threads_left, some);
  ck_assert_uint_le(hr2d_scene_patches(t.scene), MOST);
  ck_assert_int_eq(hr2d_exchange_matrix(t.scene, &matrix, a->area, NULL), HR2D_OK);
  hr2d_refine_options options = test_options(0.02, 24);
  options.threads = 4;
  ck_assert_int_eq(hr2d_refine_count(t.links, &options, &a->counts), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(t.links, &options), HR2D_OK);
  solve(&t, 1, a->average);
  test_links coarse = {t.scene, NULL, NULL};
  ck_assert_int_eq(hr2d_hierarchy_create(t.scene, &coarse.hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(coarse.hierarchy, NULL, NULL, NULL, NULL, &coarse.links),
                   HR2D_OK);
  test_refine(&coarse, 0.7, 24);
  solve(&coarse, 4, a->order_four);
  hr2d_linkset_destroy(coarse.links);
  hr2d_hierarchy_destroy(coarse.hierarchy);
  test_free_links(&t);
  atomic_store(&threads_left, -1);
  return a;
}

START_TEST(fewer_threads_give_the_same_bits) {
  if (hr2di_team_threads(4) == 1) return; /* a library without threads */
  answer *all = answer_with(-1);
  ck_assert_int_ge(atomic_load(&created), 9); /* a negative control: threads are asked for */
  for (int some = 0; some < 10; some++) {
    atomic_store(&refused, 0);
    answer *few = answer_with(some);
    ck_assert_int_gt(atomic_load(&refused), 0);
    ck_assert_int_eq(memcmp(few->average, all->average, sizeof all->average), 0);
    ck_assert_int_eq(memcmp(few->order_four, all->order_four, sizeof all->order_four), 0);
    ck_assert_int_eq(memcmp(few->area, all->area, sizeof all->area), 0);
    ck_assert_uint_eq(few->counts.links, all->counts.links);
    ck_assert_uint_eq(few->counts.elements, all->counts.elements);
    free(few);
  }
  free(all);
}
END_TEST

static int asked_by(hr2d_status status) {
  ck_assert_int_eq(status, HR2D_OK);
  return atomic_exchange(&asked, 0);
}

START_TEST(processors_are_counted_once_per_call) {
  if (hr2di_team_threads(4) == 1) return; /* a library without threads */
  test_links t =
      test_make_links(test_shipped_scene("partition.geojson"), NULL, NULL, NULL, NULL);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_refine_options refine = test_options(0.5, 24);
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_field_options field = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  hr2d_solution *to = NULL, *by = NULL;
  hr2d_prediction prediction;
  double mean[36];
  target.threads = refine.threads = solve.threads = field.threads = HR2D_ALL_THREADS;
  target.error = 1e-3;
  target.points = 1;
  grid.low = (hr2d_point){.1, .1}, grid.high = (hr2d_point){.4, .4};
  grid.columns = grid.rows = 6;
  grid.tolerance = .01;
  values.mean = mean;
  atomic_store(&asked, 0);
  ck_assert_int_eq(asked_by(hr2d_solve_to(t.scene, &target, &to, NULL)), 1);
  ck_assert_int_eq(asked_by(hr2d_predict(t.scene, &target, &prediction)), 1);
  ck_assert_int_eq(asked_by(hr2d_refine(t.links, &refine)), 1);
  ck_assert_int_eq(asked_by(hr2d_solve(t.links, &solve, &by)), 1);
  ck_assert_int_eq(asked_by(hr2d_solution_error(by, &target, NULL, NULL)), 1);
  ck_assert_int_eq(asked_by(hr2d_field_on_grid(to, &grid, &field, &values, NULL)), 1);
  hr2d_solution_destroy(to);
  hr2d_solution_destroy(by);
  test_free_links(&t);
}
END_TEST

TEST_PROGRAM("team") {
  ADD_TESTS("threads", every_task_is_done_once, fewer_threads_give_the_same_bits,
            processors_are_counted_once_per_call);
}
