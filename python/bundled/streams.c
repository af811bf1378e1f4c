/* SPDX-License-Identifier: GPL-3.0-or-later
 * The standard streams of the C library, for archives that cannot name them in a shared object.
 *
 * The static libraries of a distribution are often made for programs (-fPIE): what they read of
 * another library's variables they expect in the program itself.  GSL and jansson read three
 * such variables.  The linker's --wrap gives them these copies, which no other object can see.
 */
#include <stdio.h>

extern FILE *__real_stdin, *__real_stdout, *__real_stderr;

#define HIDDEN __attribute__((visibility("hidden")))
extern HIDDEN FILE *__wrap_stdin, *__wrap_stdout, *__wrap_stderr;
FILE *__wrap_stdin, *__wrap_stdout, *__wrap_stderr;

__attribute__((constructor)) static void copy_streams(void) {
  __wrap_stdin = __real_stdin;
  __wrap_stdout = __real_stdout;
  __wrap_stderr = __real_stderr;
}
