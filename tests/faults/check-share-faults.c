/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What fails on one share fails on all, with the same status, and none waits for ever: failed
   allocations, callbacks that stop, budgets of links and of time.  Nothing is lost, and the
   same calls succeed afterwards. */
#include <stdlib.h>
#include <string.h>

#include "support/shares.h"
#include "support/slow-scenes.h"
#include "support/support.h"

enum { SHARES = 3, VALUES = 1000 };

/* What each share has of its own. */
typedef struct own {
  test_memory memory;
  unsigned questions; /* of the callback */
  hr2d_status status;
  size_t values;
  double average[VALUES];
} own;

typedef struct plan {
  slow_kind kind;
  size_t patches;
  int heated;     /* in the place of the kind */
  double error;   /* of a target; 0: a solve by ε at order 2 */
  double seconds; /* budgets */
  uint64_t max_links;
  unsigned victim;
  long fails_at; /* an allocation; negative: none */
  long stops_at; /* a question; negative: none */
  own of[SHARES];
} plan;

enum { STOP = 77 };

typedef struct asked {
  plan *p;
  unsigned number;
} asked;

static hr2d_status ask(void *ctx, const hr2d_progress *progress) {
  const asked *a = ctx;
  own *o = &a->p->of[a->number];
  (void)progress;
  const int stops = a->number == a->p->victim && a->p->stops_at >= 0;
  return stops && (long)o->questions++ >= a->p->stops_at ? (hr2d_status)STOP : HR2D_OK;
}

static void keep(const hr2d_scene *scene, const hr2d_solution *solution, own *o) {
  o->values = hr2d_scene_patches(scene);
  ck_assert_uint_le(o->values, VALUES);
  for (size_t k = 0; k < o->values; k++) o->average[k] = hr2d_solution_average(solution, k, 0);
}

static hr2d_status solve_to(plan *p, const hr2d_scene *scene, hr2d_share *share, asked *a) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  target.error = p->error;
  target.seconds = p->seconds;
  target.max_links = p->max_links;
  target.points = p->victim % 2 == 0;
  target.share = share;
  target.progress = ask;
  target.progress_ctx = a;
  const hr2d_status status = hr2d_solve_to(scene, &target, &solution, NULL);
  if (solution) keep(scene, solution, &p->of[share->number]);
  hr2d_solution_destroy(solution);
  return status;
}

static hr2d_status solve_by(plan *p, const hr2d_scene *scene, hr2d_share *share, asked *a) {
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_hierarchy *h = NULL;
  hr2d_linkset *links = NULL;
  hr2d_solution *solution = NULL;
  refine.epsilon = 0.5;
  refine.max_level = 4;
  refine.share = share;
  refine.progress = options.progress = ask;
  refine.progress_ctx = options.progress_ctx = a;
  hr2d_status status = hr2d_hierarchy_create(scene, &h);
  if (!status) status = hr2d_linkset_create(h, NULL, NULL, NULL, NULL, &links);
  /* A share that cannot begin tells the others by a call of its own. */
  status = share->combine(share->ctx, status, HR2D_COMBINE_SUM, NULL, 0);
  if (!status) status = hr2d_refine(links, &refine);
  if (!status) status = hr2d_hierarchy_set_order(h, 2);
  if (!status) status = hr2d_solve(links, &options, &solution);
  if (solution) keep(scene, solution, &p->of[share->number]);
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(h);
  return status;
}

static void work(hr2d_share *share, void *ctx) {
  plan *p = ctx;
  own *o = &p->of[share->number];
  memset(o, 0, sizeof *o);
  atomic_store(&o->memory.until_failure, -1);
  const hr2d_allocator hooks = test_hooks(&o->memory);
  asked a = {p, share->number};
  hr2d_scene *scene = test_new_scene(&hooks);
  hr2d_status status =
      p->heated ? slow_add_heated(scene) : slow_add(scene, p->kind, p->patches);
  if (!status) status = hr2d_scene_commit(scene);
  if (status) abort();
  if (p->fails_at >= 0 && share->number == p->victim)
    atomic_store(&o->memory.until_failure, p->fails_at);
  o->status = (p->error > 0 ? solve_to : solve_by)(p, scene, share, &a);
  atomic_store(&o->memory.until_failure, -1);
  hr2d_scene_destroy(scene);
}

static void expect_the_same(const plan *p) {
  for (unsigned k = 0; k < SHARES; k++) {
    ck_assert_int_eq(p->of[k].status, p->of[0].status);
    ck_assert_int_eq(atomic_load(&p->of[k].memory.live), 0);
    ck_assert_uint_eq(p->of[k].values, p->of[0].values);
    ck_assert_int_eq(memcmp(p->of[k].average, p->of[0].average, sizeof p->of[k].average), 0);
  }
}

static plan make_plan(int kind) {
  static const plan plans[] = {
      {.kind = SLOW_SQUARES, .patches = 20, .error = 1e-2, .fails_at = -1, .stops_at = -1},
      {.kind = SLOW_ROUND, .patches = 260, .error = 1e-3, .fails_at = -1, .stops_at = -1},
      {.kind = SLOW_CITY, .patches = 20, .fails_at = -1, .stops_at = -1},
      {.heated = 1, .error = 1e-1, .fails_at = -1, .stops_at = -1},
      {.heated = 1, .fails_at = -1, .stops_at = -1},
  };
  return plans[kind];
}

enum { PLANS = 5 };

/* The first places one by one, later ones in steps that grow with the place. */
static long next_place(long at) {
  return at + 1 + at / (long)test_rounds(15, 1);
}

/* Allocations of a whole run on one share. */
START_TEST(allocations_fail) {
  plan p = make_plan(_i);
  long at = 0, failed = 0;
  shares_run(SHARES, work, &p);
  expect_the_same(&p);
  own whole = p.of[0];
  for (;; at = next_place(at)) {
    p.fails_at = at;
    p.victim = (unsigned)at % SHARES;
    shares_run(SHARES, work, &p);
    expect_the_same(&p);
    if (atomic_load(&p.of[p.victim].memory.failures) == 0) break;
    failed += p.of[0].status == HR2D_ENOMEM;
  }
  ck_assert_int_gt(failed, 5);
  p.fails_at = -1;
  shares_run(SHARES, work, &p);
  ck_assert_int_eq(memcmp(whole.average, p.of[1].average, sizeof whole.average), 0);
  printf("%ld allocations, %ld failures\n", at, failed);
}
END_TEST

START_TEST(callbacks_stop) {
  plan p = make_plan(_i);
  unsigned stopped = 0;
  for (long at = 0;; at = next_place(at)) {
    p.stops_at = at;
    p.victim = (unsigned)at % SHARES;
    shares_run(SHARES, work, &p);
    expect_the_same(&p);
    if (p.of[0].status != (hr2d_status)STOP) break;
    stopped++;
  }
  ck_assert_uint_gt(stopped, 0);
  printf("stopped %u times\n", stopped);
}
END_TEST

START_TEST(budgets_end) {
  plan p = make_plan(_i);
  p.max_links = 40;
  shares_run(SHARES, work, &p);
  expect_the_same(&p);
  ck_assert_int_eq(p.of[0].status, p.error > 0 ? HR2D_EACCURACY : HR2D_OK);
  p.max_links = 0;
  for (unsigned k = 0; k < test_rounds(8, 2) && p.error > 0; k++) {
    p.seconds = k ? 2e-3 * (1 << k) : 1e-9;
    shares_run(SHARES, work, &p);
    expect_the_same(&p);
    ck_assert(p.of[0].status == HR2D_OK || p.of[0].status == HR2D_EACCURACY);
    /* Temperatures may need more time than there is. */
    ck_assert(p.heated || p.of[0].values > 0);
  }
}
END_TEST

TEST_SUITE("faults of shares") {
  REPEAT_TESTS(PLANS, "ends", allocations_fail, callbacks_stop, budgets_end);
}
