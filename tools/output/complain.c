/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each message is one line: what a terminal would obey in texts from outside becomes question
 * marks. */
#include "output/complain.h"

#include <stdarg.h>
#include <stdio.h>

#include "output/printable.h"

enum { LINE = 2048 };

static void one_line(char *text) {
  for (size_t length; *text; text += length ? length : 1) {
    length = printable_length(text);
    if (!length) *text = '?';
  }
}

static int silent;

void complain_silently(void) {
  silent = 1;
}

int complain(const char *where, const char *format, ...) {
  char place[LINE], line[LINE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  snprintf(place, sizeof place, "%s", where ? where : "");
  one_line(place);
  one_line(line);
  if (!silent) fprintf(stderr, PROGRAM_NAME ": %s%s%s\n", place, where ? ": " : "", line);
  return EXIT_FAILED;
}

static const char *subject;

void complain_about(const char *command) {
  subject = command;
}

int complain_usage(const char *format, ...) {
  char line[LINE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  one_line(line);
  fprintf(stderr, PROGRAM_NAME ": %s; try '" PROGRAM_NAME "%s%s --help'\n", line,
          subject ? " " : "", subject ? subject : "");
  return EXIT_USAGE;
}

int complain_memory(void) {
  return complain(NULL, "out of memory");
}

int complain_call(const char *path, const char *message, hr2d_status status) {
  if (status == HR2D_STOPPED) {
    complain(path, "interrupted");
    return EXIT_INTERRUPTED;
  }
  return complain(path, "%s", *message ? message : hr2d_strerror(status));
}

int complain_join(int first, int second) {
  return !first || second == EXIT_INTERRUPTED ? second : first;
}
