/* SPDX-License-Identifier: GPL-3.0-or-later */
/* check-suites FILE: runs the suite of a file of tests, by its path or its last name. */
#include <stdio.h>
#include <stdlib.h>

#include "support/suite.h"

int main(int count, char **arguments) {
  const test_suite *suite = count == 2 ? test_find(arguments[1]) : NULL;
  if (suite) return test_run(suite);
  fprintf(stderr,
          "usage: check-suites FILE, as in check-suites tests/unit/base/check-status.c\n");
  return EXIT_FAILURE;
}
