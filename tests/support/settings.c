/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/settings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

double test_multiplier(void) {
  const char *set = getenv("HR2D_TEST_MULTIPLIER");
  return set ? strtod(set, NULL) : 1;
}

int test_count(double count) {
  return (int)fmin(fmax(ceil(count * test_multiplier()), 1), 1e9);
}

size_t test_rounds(double max, size_t min) {
  return (size_t)(max * test_multiplier()) + min;
}

size_t test_some(size_t all, size_t min) {
  const double some = ceil((double)all * fmin(10 * test_multiplier(), 1));
  return (size_t)fmax(some, (double)min);
}

int test_meets(size_t number_of_case, size_t variant, size_t count) {
  return test_multiplier() >= 0.1 || (number_of_case + variant) % count == 0;
}

unsigned long test_seed(void) {
  const char *set = getenv("HR2D_TEST_SEED");
  return set ? strtoul(set, NULL, 0) : 20240229;
}

static const char *path_in(const char *variable, const char *otherwise, const char *file) {
  static char path[4096];
  const char *folder = getenv(variable);
  snprintf(path, sizeof path, "%s/%s", folder ? folder : otherwise, file);
  return path;
}

const char *test_scene_path(const char *file) {
  return path_in("HR2D_SCENES", "examples/scenes", file);
}

const char *test_data_path(const char *file) {
  return path_in("HR2D_TEST_DATA", "tests/data/reference", file);
}

const char *test_source_path(const char *file) {
  return path_in("HR2D_SRCDIR", ".", file);
}

int test_has_long_double(void) {
  volatile long double sum = 1;
  sum += 0x1p-60L;
  return sum > 1;
}
