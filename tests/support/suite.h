/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Puts a suite together and runs it. */
#ifndef HR2D_TESTS_SUPPORT_SUITE_H
#define HR2D_TESTS_SUPPORT_SUITE_H

#include <check.h>

/* The program itself: `TEST_SUITE("name") { ADD_TESTS(…); … }` prints the seed, runs the tests
   and returns 0 if all of them pass. */
#define TEST_SUITE(name)                                                                       \
  static void add_tests(Suite *suite);                                                         \
  int main(void) {                                                                             \
    return test_run((name), add_tests);                                                        \
  }                                                                                            \
  static void add_tests(Suite *suite)
int test_run(const char *name, void (*add_tests)(Suite *suite));

/* Within a suite: adds tests under the name of a group.  Each runs once, or `times` times with
   _i from 0.  A test may take 600 s, or the time that CK_DEFAULT_TIMEOUT gives. */
#define ADD_TESTS(group, ...) REPEAT_TESTS(1, group, __VA_ARGS__)
#define REPEAT_TESTS(times, group, ...)                                                        \
  test_add(suite, (group), (int)(times), (const TTest *const[]){__VA_ARGS__, NULL})
void test_add(Suite *suite, const char *group, int times, const TTest *const *tests);

#endif
