/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the test programs share: scenes by name and from plans, reference tables, random
   numbers, memory that runs out. */
#ifndef HR2D_TESTS_SUPPORT_SUPPORT_H
#define HR2D_TESTS_SUPPORT_SUPPORT_H

#include <check.h>
#include <hr2d/hr2d.h>
#include <stdatomic.h>
#include <stdio.h>

/* HR2D_TEST_MULTIPLIER: how much of the work to do, 1 unless set. */
double test_multiplier(void);

/* HR2D_TEST_SEED, or a fixed one; printed by whoever draws from it. */
unsigned long test_seed(void);

/* SplitMix64: a number in [0,1), and the next state. */
double test_random(unsigned long *state);

/* A committed scene of patches given as ax ay bx by E rho each. */
hr2d_scene *test_scene(const double (*patch)[6], size_t count);

/* The scenes of the reference tables: "par0.1", "orth10", "par_d0.1_rho0.5",
   "orth_touch_rho0.7", "square_rho0.9", "square_furnace_rho0.9",
   "occ_square_walls0.5_occ0.5". */
hr2d_scene *test_named_scene(const char *name);

struct plan;    /* of room_plans.h */
struct randoms; /* of pair_classes.h */

/* What the patches of a plan are made of. */
typedef struct test_paint {
  struct randoms *r;  /* draws ρ and E; NULL: each is the most it may be */
  double reflectance; /* at most */
  double emission;    /* at most */
  int isothermal;     /* E = 1 − ρ instead */
  double background;
  unsigned forced; /* 1 << effect for each that is forced */
} test_paint;

/* A committed scene of a plan whose crossings, if it has any, are cut. */
hr2d_scene *test_painted_scene(const struct plan *room, const test_paint *paint);

/* A table of comma-separated values with a header line. */
typedef struct test_table {
  char *text;
  char ***cell; /* cell[row][column]; row 0 is the header */
  size_t rows;
} test_table;

test_table test_read_table(const char *file);
void test_free_table(test_table *table);

/* The cell below the header `column` in `row` ≥ 1. */
const char *test_cell(const test_table *table, size_t row, const char *column);
double test_number(const test_table *table, size_t row, const char *column);

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

/* Refines an empty set, or one that has links, to ε. */
void test_refine(test_links *t, double epsilon, unsigned max_level);

/* Solves; closure is the one option that is not the default. */
hr2d_solution *test_solve(const test_links *t, int closure);

/* All links by the geometry of their elements, which does not depend on their numbers:
   centre, centre and exchange area of each, sorted; to be freed.  Without those that only
   rounding leaves, of 1e-25 of their elements' length and less. */
double *test_sorted_links(const test_links *t, size_t *count);

/* Asserts that two sets have the same links. */
void test_same_links(const test_links *one, const test_links *other);

/* Memory that runs out: the hooks' ctx. */
typedef struct test_memory {
  atomic_long until_failure; /* allocations that still succeed; negative: no failure */
  int for_good;              /* once it has failed it fails for ever */
  atomic_long failures;
  atomic_long live; /* blocks not yet released */
} test_memory;

hr2d_allocator test_hooks(test_memory *memory);

/* Asserts that two counts are equal in every member. */
void test_same_counts(const hr2d_refine_counts *one, const hr2d_refine_counts *other);

/* Whether a long double has more digits than a double: under valgrind it has not. */
int test_has_long_double(void);

/* Runs the suite; the exit status of the program. */
int test_run(Suite *suite);

#endif
