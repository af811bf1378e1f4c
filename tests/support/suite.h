/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Puts a suite together and runs it. */
#ifndef HR2D_TESTS_SUPPORT_SUITE_H
#define HR2D_TESTS_SUPPORT_SUITE_H

#include <check.h>

/* A suite: `TEST_SUITE("name") { ADD_TESTS(…); … }` at the end of a file adds it to those of
   the program before main() begins.  A suite that is a program of its own is called
   TEST_PROGRAM: it has a main(). */
#define TEST_SUITE(title)                                                                      \
  static void add_tests(Suite *suite);                                                         \
  __attribute__((constructor)) static void list_suite(void) {                                  \
    static test_suite suite = {.name = (title), .file = __FILE__, .add_tests = add_tests};     \
    test_list(&suite);                                                                         \
  }                                                                                            \
  static void add_tests(Suite *suite)
#define TEST_PROGRAM(title)                                                                    \
  static void add_tests(Suite *suite);                                                         \
  int main(void) {                                                                             \
    return test_run(&(test_suite){.name = (title), .add_tests = add_tests});                   \
  }                                                                                            \
  static void add_tests(Suite *suite)

typedef struct test_suite test_suite;
struct test_suite {
  const char *name, *file;
  void (*add_tests)(Suite *suite);
  test_suite *next;
};
void test_list(test_suite *suite);

/* The suite of a file, by its last name with or without ".c"; NULL if there is none. */
const test_suite *test_find(const char *file);

/* Prints the seed and runs the tests; EXIT_SUCCESS if all pass. */
int test_run(const test_suite *suite);

/* Within a suite: adds tests under the name of a group.  Each runs once, or `times` times with
   _i from 0.  A test may take 600 s, or the time that CK_DEFAULT_TIMEOUT gives. */
#define ADD_TESTS(group, ...) REPEAT_TESTS(1, group, __VA_ARGS__)
#define REPEAT_TESTS(times, group, ...)                                                        \
  test_add(suite, (group), (int)(times), (const TTest *const[]){__VA_ARGS__, NULL})
void test_add(Suite *suite, const char *group, int times, const TTest *const *tests);

#endif
