/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/suite.h"

#include <stdio.h>
#include <stdlib.h>

#include "support/settings.h"

void test_add(Suite *suite, const char *group, int times, const TTest *const *tests) {
  TCase *tcase = tcase_create(group);
  if (!getenv("CK_DEFAULT_TIMEOUT")) tcase_set_timeout(tcase, 600);
  for (; *tests; tests++) tcase_add_loop_test(tcase, *tests, 0, times);
  suite_add_tcase(suite, tcase);
}

int test_run(const char *name, void (*add_tests)(Suite *suite)) {
  Suite *suite = suite_create(name);
  add_tests(suite);
  printf("seed %lu\n", test_seed());
  fflush(stdout);
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  const int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
