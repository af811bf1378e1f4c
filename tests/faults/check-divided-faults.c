/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Allocations that fail on one share while divided elements are linked: all shares return the
   same status, none waits for ever, nothing is lost. */
#include <stdlib.h>
#include <string.h>

#include "base/share.h"
#include "hierarchy/hierarchy-impl.h"
#include "mesh/reuse-links.h"
#include "solve/solve-how.h"
#include "support/shares.h"
#include "support/slow-scenes.h"
#include "support/support.h"

enum { SHARES = 3, PATCHES = 16, ORDER = 2 };

typedef struct own {
  test_memory memory;
  hr2d_status status, other; /* of the links; of the solve on them */
  uint64_t links, stay;      /* of this share: all, and those that have their blocks still */
  double average;
} own;

typedef struct plan {
  unsigned victim;
  int single;    /* blocks are of floats */
  long fails_at; /* an allocation within hr2di_reuse_links(); negative: none */
  own of[SHARES];
} plan;

typedef struct trees {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
} trees;

static void clear(trees *t) {
  hr2d_solution_destroy(t->solution);
  hr2d_linkset_destroy(t->links);
  hr2d_hierarchy_destroy(t->hierarchy);
}

static hr2d_status solve_with(trees *t, int single) {
  const hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  return hr2di_solve(t->links, &(hr2di_equation_how){.single = single}, &options, &t->solution);
}

/* Links with blocks, as a solve leaves them. */
static hr2d_status solve(trees *t, const hr2d_scene *scene, const hr2d_refine_options *options,
                         int single) {
  hr2d_status status = hr2d_hierarchy_create(scene, &t->hierarchy);
  if (!status) status = hr2d_linkset_create(t->hierarchy, NULL, NULL, NULL, NULL, &t->links);
  if (!status) status = hr2d_refine(t->links, options);
  if (!status) status = hr2d_hierarchy_set_order(t->hierarchy, ORDER);
  return status ? status : solve_with(t, single);
}

/* A leaf of some patches is halved. */
static hr2d_status divide(trees *fine, const trees *coarse) {
  hr2d_status status = hr2di_hierarchy_clone(coarse->hierarchy, &fine->hierarchy);
  const size_t elements = status ? 0 : fine->hierarchy->elements;
  size_t next = 0; /* patch */
  for (size_t e = 0; e < elements && !status; e++)
    if (!fine->hierarchy->element[e].child && fine->hierarchy->element[e].patch == next &&
        (next += 5))
      status = hr2d_hierarchy_divide(fine->hierarchy, (uint32_t)e, 0.5, NULL);
  return status ? status
                : hr2d_linkset_create(fine->hierarchy, NULL, NULL, NULL, NULL, &fine->links);
}

/* With a smaller ε pairs of these patches get other links. */
static void try(plan *p, hr2d_share *share, const hr2d_refine_options *given, trees *coarse,
                trees *fine) {
  own *o = &p->of[share->number];
  hr2d_refine_options options = *given;
  options.epsilon *= 0.5;
  options.max_level++;
  hr2di_share_begin(share);
  if (p->fails_at >= 0 && share->number == p->victim)
    atomic_store(&o->memory.until_failure, p->fails_at);
  const hr2d_status status =
      hr2di_reuse_links(fine->links, coarse->links, &(hr2di_refine_how){0}, &options);
  atomic_store(&o->memory.until_failure, -1);
  o->status = hr2di_share_agree(share, status);
  if (o->status) return;
  o->links = hr2d_linkset_size(fine->links);
  o->stay = fine->links->blocks.links;
  o->other = solve_with(fine, p->single);
  if (!o->other) o->average = hr2d_solution_average(fine->solution, 1, 0);
}

static void work(hr2d_share *share, void *ctx) {
  plan *p = ctx;
  own *o = &p->of[share->number];
  memset(o, 0, sizeof *o);
  atomic_store(&o->memory.until_failure, -1);
  const hr2d_allocator hooks = test_hooks(&o->memory);
  hr2d_scene *scene = test_new_scene(&hooks);
  trees coarse = {0}, fine = {0};
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 0.5;
  options.max_level = 3;
  options.share = share;
  if (slow_add(scene, SLOW_SQUARES, PATCHES) || hr2d_scene_commit(scene) ||
      solve(&coarse, scene, &options, p->single) || divide(&fine, &coarse))
    abort();
  try(p, share, &options, &coarse, &fine);
  clear(&fine);
  clear(&coarse);
  hr2d_scene_destroy(scene);
}

static void expect_the_same(const plan *p) {
  for (unsigned k = 0; k < SHARES; k++) {
    ck_assert_int_eq(p->of[k].status, p->of[0].status);
    ck_assert_int_eq(p->of[k].other, HR2D_OK);
    ck_assert_int_eq(atomic_load(&p->of[k].memory.live), 0);
    ck_assert(p->of[k].average == p->of[0].average);
  }
}

/* The first places one by one, later ones in steps that grow with the place. */
static long next_place(long at) {
  return at + 1 + at / (long)test_rounds(20, 1);
}

START_TEST(allocations_fail) {
  plan p = {.single = _i / SHARES, .fails_at = -1};
  long at = 0, failed = 0;
  shares_run(SHARES, work, &p);
  expect_the_same(&p);
  ck_assert_int_eq(p.of[0].status, HR2D_OK);
  const double average = p.of[0].average;
  uint64_t added = 0; /* by all shares */
  for (unsigned k = 0; k < SHARES; k++) {
    ck_assert_uint_gt(p.of[k].stay, 0);
    added += p.of[k].links - p.of[k].stay;
  }
  ck_assert_uint_gt(added, 0);
  p.victim = (unsigned)_i % SHARES;
  for (;; at = next_place(at)) {
    p.fails_at = at;
    shares_run(SHARES, work, &p);
    expect_the_same(&p);
    if (atomic_load(&p.of[p.victim].memory.failures) == 0) break;
    ck_assert(p.of[0].status == HR2D_ENOMEM || p.of[0].average == average);
    failed += p.of[0].status == HR2D_ENOMEM;
  }
  ck_assert_int_gt(failed, 3);
  printf("%ld allocations, %ld failures\n", at, failed);
}
END_TEST

TEST_SUITE("faults of divided links") {
  REPEAT_TESTS(2 * SHARES, "shares", allocations_fail);
}
