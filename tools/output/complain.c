/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line per complaint, whatever the names in it contain. */
#include "output/complain.h"

#include <stdarg.h>
#include <stdio.h>

enum { LINE = 2048 };

static void one_line(char *text) {
  for (; *text; text++)
    if ((unsigned char)*text < ' ' || *text == 127) *text = '?';
}

int fail(const char *where, const char *format, ...) {
  char place[LINE], line[LINE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  snprintf(place, sizeof place, "%s", where ? where : "");
  one_line(place);
  one_line(line);
  fprintf(stderr, "hr2d: %s%s%s\n", place, where ? ": " : "", line);
  return EXIT_FAILED;
}

int usage_error(const char *format, ...) {
  char line[LINE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  one_line(line);
  fprintf(stderr, "hr2d: %s; try 'hr2d --help'\n", line);
  return EXIT_USAGE;
}

int fail_memory(void) {
  return fail(NULL, "out of memory");
}
