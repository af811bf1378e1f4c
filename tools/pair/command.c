/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d pair`: exchange areas of segments, line by line from standard input. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "cli/commands.h"
#include "output/complain.h"
#include "pair/line.h"

#define INPUT "standard input"

/* The oracle's estimate for element 0 of a hierarchy as receiver and 1 as source, both as
   bright as the brightest element. */
static hr2d_status ask(const hr2d_oracle *oracle, const hr2d_hierarchy *hierarchy,
                       double *error) {
  const hr2d_pair pair = {0, 1};
  const double brightness[2] = {1, 1};
  const hr2d_batch batch = {.struct_size = sizeof batch,
                            .hierarchy = hierarchy,
                            .elements = hr2d_hierarchy_elements(hierarchy),
                            .pairs = &pair,
                            .count = 1,
                            .unit = hr2d_scene_unit(hr2d_hierarchy_scene(hierarchy)),
                            .brightness = brightness};
  return oracle->estimate(NULL, &batch, error);
}

/* The estimate is NaN if the two segments are no valid scene. */
static hr2d_status estimate(const hr2d_oracle *oracle, const hr2d_segment *i,
                            const hr2d_segment *j, double *error) {
  hr2d_scene *scene = NULL;
  hr2d_hierarchy *hierarchy = NULL;
  const hr2d_patch first = {.a = i->a, .b = i->b}, second = {.a = j->a, .b = j->b};
  *error = NAN;
  hr2d_status status = hr2d_scene_create(NULL, &scene);
  if (!status) status = hr2d_scene_add(scene, &first, NULL);
  if (!status) status = hr2d_scene_add(scene, &second, NULL);
  if (!status) status = hr2d_scene_commit(scene);
  if (!status) status = hr2d_hierarchy_create(scene, &hierarchy);
  if (!status) status = ask(oracle, hierarchy, error);
  hr2d_hierarchy_destroy(hierarchy);
  hr2d_scene_destroy(scene);
  return status == HR2D_ESCENE || status == HR2D_ERANGE ? HR2D_OK : status;
}

static double length(const hr2d_segment *s) {
  return hypot(s->b.x - s->a.x, s->b.y - s->a.y);
}

static int complain_of_line(const pair_line *line, const char *where) {
  return line->word ? complain(INPUT, "%s: '%s' is not a finite number", where, line->word)
                    : complain(INPUT, "%s: expected 8 numbers, found %d", where, line->found);
}

static int print_pair(const options *o, pair_line *line, const char *where) {
  double error = NAN, *const x = line->x;
  const int exponent = pair_grow(x);
  const hr2d_segment i = {{x[0], x[1]}, {x[2], x[3]}}, j = {{x[4], x[5]}, {x[6], x[7]}};
  const double li = length(&i), lj = length(&j);
  if (!(li > 0)) return complain(INPUT, "%s: the first segment has length 0", where);
  if (!(lj > 0)) return complain(INPUT, "%s: the second segment has length 0", where);
  const double area = hr2d_exchange_area(&i, &j);
  if (!isfinite(li + lj) || isnan(area))
    return complain(INPUT, "%s: the coordinates are too large", where);
  const hr2d_status status = estimate(o->oracle, &i, &j, &error);
  if (status) return complain(INPUT, "%s: %s", where, hr2d_strerror(status));
  printf("%.17g %.17g %.17g ", ldexp(area, exponent), area / li, area / lj);
  if (isnan(error))
    puts("nan");
  else
    printf("%.17g\n", error);
  return EXIT_DONE;
}

int pair_command(const options *o) {
  char *line = NULL;
  size_t capacity = 0;
  int status = EXIT_DONE;
  if (isatty(STDIN_FILENO))
    complain(NULL, "pair reads lines ax ay bx by cx cy dx dy from the terminal, up to Ctrl-D");
  errno = 0;
  for (unsigned long long number = 1; !status; number++) {
    char where[32];
    pair_line numbers;
    const ssize_t size = getline(&line, &capacity, stdin);
    if (size < 0) break;
    snprintf(where, sizeof where, "line %llu", number);
    if (memchr(line, '\0', (size_t)size))
      status = complain(INPUT, "%s: contains a NUL byte", where);
    else if (!pair_is_empty(line))
      status = pair_read(line, &numbers) ? complain_of_line(&numbers, where)
                                         : print_pair(o, &numbers, where);
  }
  if (!status && !feof(stdin)) status = complain(INPUT, "%s", strerror(errno));
  free(line);
  return status;
}
