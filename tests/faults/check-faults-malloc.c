/* SPDX-License-Identifier: GPL-3.0-or-later */
/* malloc() itself fails, for allocations that do not use the hooks: those of the library
   before there is a scene, of stdio, jansson and GSL.  GSL's error handler must not
   be reached either.  The suite skips itself where malloc() cannot be replaced: under
   sanitizers and valgrind. */
#include <errno.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__ || !defined __GLIBC__
#define REPLACED 0
#elif defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define REPLACED 0
#endif
#endif
#ifndef REPLACED
#define REPLACED 1
#endif

static test_memory memory = {.until_failure = -1};
static atomic_long calls;

#if REPLACED
/* Seen by other libraries, too. */
#define REPLACES __attribute__((visibility("default")))

/* glibc's own, under names that are not replaced. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *block, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);

/* Without memory_allocate() of the hooks, which calls malloc. */
static int runs_out(void) {
  calls++;
  if (memory.until_failure < 0) return 0;
  if (memory.until_failure > 0) {
    memory.until_failure--;
    return 0;
  }
  if (!memory.for_good) memory.until_failure = -1;
  memory.failures++;
  errno = ENOMEM;
  return 1;
}

REPLACES void *malloc(size_t size) {
  return runs_out() ? NULL : __libc_malloc(size);
}

REPLACES void *calloc(size_t count, size_t size) {
  return runs_out() ? NULL : __libc_calloc(count, size);
}

REPLACES void *realloc(void *block, size_t size) {
  return runs_out() ? NULL : __libc_realloc(block, size);
}

REPLACES void *aligned_alloc(size_t alignment, size_t size) {
  return runs_out() ? NULL : __libc_memalign(alignment, size);
}

REPLACES int posix_memalign(void **block, size_t alignment, size_t size);
int posix_memalign(void **block, size_t alignment, size_t size) {
  void *made = runs_out() ? NULL : __libc_memalign(alignment, size);
  if (!made) return ENOMEM;
  *block = made;
  return 0;
}
#endif

/* Whether the library's calls come here. */
static int is_replaced(void) {
  hr2d_scene *scene = NULL;
  const long before = calls;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  hr2d_scene_destroy(scene);
  if (calls > before) return 1;
  puts("skipped: malloc cannot be replaced here");
  return 0;
}

static void fail_test(const char *reason, const char *file, int line, int number) {
  memory.until_failure = -1;
  ck_abort_msg("GSL: %s, %s:%d, %d", reason, file, line, number);
}

/* A call on its own objects that ends with OK or ENOMEM. */
typedef hr2d_status (*call)(void *ctx);

/* Fails each allocation; returns how many there are.  The first call fails none. */
static long starve(const char *name, call run, void *ctx) {
  long k = 0;
  gsl_set_error_handler(fail_test);
  ck_assert_int_eq(run(ctx), HR2D_OK);
  for (int for_good = 0; for_good < 2; for_good++) {
    int failed = 1;
    for (k = 0; failed; k++) {
      memory = (test_memory){.until_failure = k, .for_good = for_good};
      const hr2d_status status = run(ctx);
      memory.until_failure = -1;
      failed = memory.failures > 0;
      ck_assert_msg(status == (failed ? HR2D_ENOMEM : HR2D_OK), "%s, allocation %ld, %s: %s",
                    name, k, for_good ? "for good" : "once", hr2d_strerror(status));
    }
  }
  gsl_set_error_handler(NULL);
  printf("%-24s %5ld allocations\n", name, k - 1);
  fflush(stdout);
  return k - 1;
}

static hr2d_status fit(void *ctx) {
  hr2d_study_fit made;
  return hr2d_study_fit_rows(ctx, 5, &made);
}

START_TEST(fits) {
  hr2d_study_row row[5];
  memset(row, 0, sizeof row);
  for (unsigned k = 0; k < 5; k++) {
    row[k].counts.elements = 10 + 3 * k * k;
    row[k].counts.links = 100 + 7 * k * k * k;
  }
  if (!is_replaced()) return;
  ck_assert_int_eq(starve("study_fit_rows", fit, row), 1);
}
END_TEST

static hr2d_status read_scene(void *ctx) {
  hr2d_scene *scene = NULL;
  hr2d_status status = hr2d_scene_create(NULL, &scene);
  if (!status) status = hr2d_scene_read(scene, ctx);
  memory.until_failure = -1; /* Check wants some, too */
  if (status && scene) ck_assert_uint_eq(hr2d_scene_patches(scene), 0);
  hr2d_scene_destroy(scene);
  return status;
}

START_TEST(scenes) {
  static const char *const files[] = {"furnace.geojson", "square-room.geojson", "blk1.vs2"};
  for (int k = 0; k < 3 && is_replaced(); k++) {
    char path[4096];
    snprintf(path, sizeof path, "%s", test_scene_path(files[k]));
    ck_assert_int_gt(starve(files[k], read_scene, path), 5);
  }
}
END_TEST

/* From a scene to a solution with the default hooks, one thread. */
static hr2d_status solve_plainly(hr2d_scene *scene, const hr2d_oracle *oracle, unsigned order) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_solution *solution = NULL;
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_refine_counts counts;
  double value[2], t = 0.5, area[16];
  refine.epsilon = 0.3;
  refine.max_level = 3;
  hr2d_status status = hr2d_hierarchy_create(scene, &hierarchy);
  if (!status) status = hr2d_hierarchy_set_order(hierarchy, order);
  if (!status) status = hr2d_linkset_create(hierarchy, oracle, NULL, NULL, NULL, &links);
  if (!status) status = hr2d_refine_count(links, &refine, &counts);
  if (!status) status = hr2d_refine(links, &refine);
  if (!status) status = hr2d_solve(links, NULL, &solution);
  if (!status) status = hr2d_solution_gather(solution, 0, &t, 1, value);
  if (!status) status = hr2d_exchange_matrix(scene, NULL, area, NULL);
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  return status;
}

static hr2d_status solve_by_size(void *ctx) {
  return solve_plainly(ctx, hr2d_oracle_size(), 1);
}

static hr2d_status solve_by_l1(void *ctx) {
  return solve_plainly(ctx, hr2d_oracle_l1(), 3);
}

static hr2d_status solve_to(void *ctx) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  target.error = 1e-3;
  const hr2d_status status = hr2d_solve_to(ctx, &target, &solution, NULL);
  hr2d_solution_destroy(solution);
  return status;
}

START_TEST(solutions) {
  hr2d_scene *scene = test_named_scene("square_rho0.9");
  if (is_replaced()) {
    ck_assert_int_gt(starve("solve by size", solve_by_size, scene), 50);
    ck_assert_int_gt(starve("solve by l1", solve_by_l1, scene), 50);
    if (test_multiplier() >= 0.1) ck_assert_int_gt(starve("solve_to", solve_to, scene), 50);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_PROGRAM("faults of malloc") {
  ADD_TESTS("malloc", fits, scenes, solutions);
}
