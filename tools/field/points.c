/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/numbers.h"
#include "field/field.h"
#include "output/complain.h"
#include "output/output.h"

/* The two numbers of a line; 1: it has none; -1: it has something else. */
static int read_line(char *line, hr2d_point *at) {
  char *rest = NULL;
  const char *x = strtok_r(line, " \t\r\n", &rest);
  if (!x || *x == '#') return 1;
  const char *y = strtok_r(NULL, " \t\r\n", &rest);
  if (!y || strtok_r(NULL, " \t\r\n", &rest)) return -1;
  return number_real(x, &at->x) || number_real(y, &at->y) ? -1 : 0;
}

static int add_point(field *f, size_t *room, hr2d_point at) {
  if (f->count == *room) {
    const size_t more = *room ? 2 * *room : 256;
    hr2d_point *larger = realloc(f->at, more * sizeof *larger);
    if (!larger) return complain_memory();
    f->at = larger;
    *room = more;
  }
  f->at[f->count++] = at;
  return 0;
}

int field_read_points(field *f, const char *path) {
  const int standard = output_is_stdout(path);
  FILE *stream = standard ? stdin : fopen(path, "r");
  char *line = NULL;
  size_t size = 0, room = 0, number = 0;
  int status = 0;
  if (!stream) return complain(path, "cannot be opened");
  while (!status && getline(&line, &size, stream) >= 0) {
    hr2d_point at;
    number++;
    const int kind = read_line(line, &at);
    if (kind < 0) status = complain(path, "line %zu: not two numbers", number);
    if (kind == 0) status = add_point(f, &room, at);
  }
  if (!status && ferror(stream)) status = complain(path, "cannot be read");
  free(line);
  if (!standard) fclose(stream);
  return status;
}
