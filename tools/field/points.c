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

/* The two numbers of a line, or four; 0: it has none; -1: it has something else. */
static int read_line(char *line, double number[4]) {
  char *rest = NULL;
  int count = 0;
  for (const char *word = strtok_r(line, " \t\r\n", &rest); word;
       word = strtok_r(NULL, " \t\r\n", &rest)) {
    if (count == 0 && *word == '#') return 0;
    if (count == 4 || number_real(word, &number[count])) return -1;
    count++;
  }
  return count == 0 || count == 2 || count == 4 ? count : -1;
}

/* Room for one more point, and for its normal if they have some. */
static int need_room(field *f, size_t *room, int normals) {
  if (f->count < *room) return 0;
  const size_t more = *room ? 2 * *room : 256;
  hr2d_point *larger = realloc(f->at, more * sizeof *larger);
  if (larger) f->at = larger;
  hr2d_point *normal = normals ? realloc(f->normal, more * sizeof *normal) : NULL;
  if (normal) f->normal = normal;
  if (!larger || (normals && !normal)) return complain_memory();
  *room = more;
  return 0;
}

static int add_point(field *f, size_t *room, const double number[4], int count,
                     const char *path, size_t line) {
  if (f->count > 0 && (f->normal != NULL) != (count == 4))
    return complain(path, "line %zu: some points have a normal, and some do not", line);
  if (count == 4 && number[2] == 0 && number[3] == 0)
    return complain(path, "line %zu: the normal is 0", line);
  if (need_room(f, room, count == 4)) return EXIT_FAILED;
  f->at[f->count] = (hr2d_point){number[0], number[1]};
  if (count == 4) f->normal[f->count] = (hr2d_point){number[2], number[3]};
  f->count++;
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
    double value[4];
    number++;
    const int count = read_line(line, value);
    if (count < 0) status = complain(path, "line %zu: not two numbers, or four", number);
    if (count > 0) status = add_point(f, &room, value, count, path, number);
  }
  if (!status && ferror(stream)) status = complain(path, "cannot be read");
  free(line);
  if (!standard) fclose(stream);
  return status;
}
