/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines that labels keep clear of. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"

int obstacles_add(picture *p, hr2d_point a, hr2d_point b) {
  obstacles *o = &p->obstacles;
  if (o->count == o->capacity) {
    const size_t capacity = o->capacity ? 2 * o->capacity : 64;
    line *lines = realloc(o->lines, capacity * sizeof *lines);
    if (!lines) return complain_memory();
    o->lines = lines;
    o->capacity = capacity;
  }
  o->lines[o->count++] = (line){a, b};
  return EXIT_DONE;
}

int obstacles_add_box(picture *p, const box *b) {
  const int status = obstacles_add(p, (hr2d_point){b->x0, b->y0}, (hr2d_point){b->x1, b->y1});
  return status ? status
                : obstacles_add(p, (hr2d_point){b->x0, b->y1}, (hr2d_point){b->x1, b->y0});
}

/* Narrows [*t0, *t1] to where lo ≤ x + t·d ≤ hi.  Returns whether anything is left. */
static int clip(double x, double d, double lo, double hi, double *t0, double *t1) {
  if (d == 0) return x >= lo && x <= hi;
  const double u = (lo - x) / d, v = (hi - x) / d;
  *t0 = fmax(*t0, fmin(u, v));
  *t1 = fmin(*t1, fmax(u, v));
  return *t0 <= *t1;
}

static int meets(const box *b, const line *l) {
  double t0 = 0, t1 = 1;
  return clip(l->a.x, l->b.x - l->a.x, b->x0, b->x1, &t0, &t1) &&
         clip(l->a.y, l->b.y - l->a.y, b->y0, b->y1, &t0, &t1);
}

int obstacles_meet(const picture *p, const box *b) {
  for (size_t k = 0; k < p->obstacles.count; k++)
    if (meets(b, &p->obstacles.lines[k])) return 1;
  return 0;
}
#endif
