/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes link sets, refines them, solves them, and compares them. */
#ifndef HR2D_TESTS_SUPPORT_LINKS_H
#define HR2D_TESTS_SUPPORT_LINKS_H

#include <hr2d/hr2d.h>

#include "support/tables.h"

/* A hierarchy and an empty link set on a scene, to be destroyed together. */
typedef struct test_links {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
} test_links;

/* Takes over the scene. */
test_links test_make_links(hr2d_scene *scene, const hr2d_oracle *oracle, void *oracle_ctx,
                           const hr2d_policy *policy, void *policy_ctx);
void test_free_links(test_links *t);

/* Options that set ε, or ε and the deepest level, and leave all else at its default. */
hr2d_refine_options test_epsilon(double epsilon);
hr2d_refine_options test_options(double epsilon, unsigned max_level);

/* Refines the set, which may have links already, to ε. */
void test_refine(test_links *t, double epsilon, unsigned max_level);

/* Asserts that a refinement fails with this status and a message that contains the phrase, and
   leaves the objects as they were. */
void test_refuse(const test_links *t, const hr2d_refine_options *options, hr2d_status status,
                 const char *phrase);

/* Solves; `closure` is the only option that is not the default. */
hr2d_solution *test_solve(const test_links *t, int closure);
hr2d_solution *test_solve_by(const test_links *t, const hr2d_solve_options *options);

/* hr2d_solve_to() a target in averages, which is reached. */
hr2d_solution *test_solve_to(const hr2d_scene *scene, double error, unsigned threads,
                             hr2d_account *account);

/* The largest relative error of the averages of all patches; the rows of their scene in the
   table begin at `row`. */
double test_average_error(const test_links *t, const hr2d_solution *solution,
                          const test_table *table, size_t row);

/* Describes each link by the geometry of its elements, which does not depend on their numbers:
   the two centres and the exchange area, sorted.  Links of at most 1e-25 of the length of their
   element are left out, because rounding alone decides whether they exist.  The caller frees
   the array. */
double *test_sorted_links(const test_links *t, size_t *count);

/* Asserts that two sets have the same links. */
void test_same_links(const test_links *one, const test_links *other);

/* A visitor of hr2d_refine_visit() that keeps the links: its ctx. */
typedef struct test_collected {
  hr2d_link *link; /* to be freed */
  uint64_t count;
  uint64_t stop_at; /* says HR2D_STOPPED at so many links; 0: never */
} test_collected;
hr2d_status test_collect(void *ctx, const hr2d_link *links, size_t count);

/* Asserts that the links of a set are the collected ones, in their order and bit by bit. */
void test_expect_collected(const test_links *t, const test_collected *c);

/* Asserts that two counts are equal in every member. */
void test_same_counts(const hr2d_refine_counts *one, const hr2d_refine_counts *other);

#endif
