/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads what the environment sets for the tests: how much random work they do, from which seed,
   and where files are.  Without Check, so that benchmarks can use it too. */
#ifndef HR2D_TESTS_SUPPORT_SETTINGS_H
#define HR2D_TESTS_SUPPORT_SETTINGS_H

#include <stddef.h>

/* HR2D_TEST_MULTIPLIER: how much of the work to do, 1 unless set. */
double test_multiplier(void);

/* A number of random cases, scaled by the multiplier: from 1 to 10⁹. */
int test_count(double count);

/* At least `min` random cases, and `max` more at a multiplier of 1. */
size_t test_rounds(double max, size_t min);

/* Of `all` cases that `make check` has at its multiplier of 0.1: fewer in proportion below it,
   and at least `min`. */
size_t test_some(size_t all, size_t min);

/* Whether a case meets variant number `variant` of `count`.  From a multiplier of 0.1 on it
   meets them all; below, one of them, and the next case the next one. */
int test_meets(size_t number_of_case, size_t variant, size_t count);

/* HR2D_TEST_SEED, or a fixed one; test_run() prints it. */
unsigned long test_seed(void);

/* Paths of a shipped scene (HR2D_SCENES), of a reference table (HR2D_TEST_DATA) and of any
   other file of the source tree (HR2D_SRCDIR); if a variable is not set, the path is relative
   to the source tree.  Valid until the next call. */
const char *test_scene_path(const char *file);
const char *test_data_path(const char *file);
const char *test_source_path(const char *file);

/* Whether a long double has more digits than a double: under valgrind it has not. */
int test_has_long_double(void);

#endif
