/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/hard.h"

#include <check.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

hard_text hard_format(const char *format, ...) {
  hard_text made;
  va_list values;
  va_start(values, format);
  const int length = vsnprintf(made.text, sizeof made.text, format, values);
  va_end(values);
  ck_assert_int_lt(length, (int)sizeof made.text);
  return made;
}

void hard_case(const char *part, const char *name, hard_text textbook, hard_text library) {
  const char *file = getenv("HR2D_HARD_CASES");
  if (!file) return;
  FILE *table = fopen(file, "a");
  ck_assert_ptr_nonnull(table);
  fprintf(table, "| %s | %s | %s | %s |\n", part, name, textbook.text, library.text);
  ck_assert_int_eq(fclose(table), 0);
}
