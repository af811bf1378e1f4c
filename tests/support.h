/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the test programs share: scenes by name, reference tables, random numbers. */
#ifndef HR2D_TESTS_SUPPORT_H
#define HR2D_TESTS_SUPPORT_H

#include <check.h>
#include <hr2d/hr2d.h>
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
   "orth_touch_rho0.7", "square_rho0.9", "square_furnace_rho0.9". */
hr2d_scene *test_named_scene(const char *name);

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

/* Asserts that two counts are equal in every member. */
void test_same_counts(const hr2d_refine_counts *one, const hr2d_refine_counts *other);

/* Runs the suite; the exit status of the program. */
int test_run(Suite *suite);

#endif
