/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/settings.h"

/* Check writes each assertion that holds to a file, to say which was the last one of a test
   that crashes.  A test with a million assertions then takes seconds for this alone.  So the
   first thousand are written, and one in a hundred of the others. */
#undef _mark_point
void _mark_point(const char *file, int line);
void test_mark_point(const char *file, int line) {
  enum { ALL = 1000, ONE_IN = 100 };
  static _Thread_local unsigned long marks;
  if (++marks <= ALL || marks % ONE_IN == 0) _mark_point(file, line);
}

void test_add(Suite *suite, const char *group, int times, const TTest *const *tests) {
  TCase *tcase = tcase_create(group);
  if (!getenv("CK_DEFAULT_TIMEOUT")) tcase_set_timeout(tcase, 600);
  for (; *tests; tests++) tcase_add_loop_test(tcase, *tests, 0, times);
  suite_add_tcase(suite, tcase);
}

static test_suite *listed;

void test_list(test_suite *suite) {
  suite->next = listed;
  listed = suite;
}

/* The last name of a path, and its length without an extension. */
static const char *last_name(const char *path, size_t *length) {
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
  *length = strcspn(name, ".");
  return name;
}

const test_suite *test_find(const char *file) {
  size_t length, other;
  const char *name = last_name(file, &length);
  for (const test_suite *suite = listed; suite; suite = suite->next)
    if (strncmp(last_name(suite->file, &other), name, length) == 0 && other == length)
      return suite;
  return NULL;
}

int test_run(const test_suite *tests) {
  Suite *suite = suite_create(tests->name);
  tests->add_tests(suite);
  printf("seed %lu\n", test_seed());
  fflush(stdout);
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  const int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
