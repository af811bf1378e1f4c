/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same endless scene by other mirrors, periods and patches.  All are exact: reflections of
   integer points that are none do not apply. */
#include <math.h>

#include "adversary/transform.h"

enum { BITS = 44 };

static int64_t divisor(int64_t a, int64_t b) {
  while (b) {
    int64_t rest = a % b;
    a = b;
    b = rest;
  }
  return a < 0 ? -a : a;
}

/* The shortest integer vector along a mirror. */
static void direction(const adv_line *m, int64_t *u, int64_t *v) {
  *u = m->x[1] - m->x[0];
  *v = m->y[1] - m->y[0];
  const int64_t by = divisor(*u, *v);
  *u /= by;
  *v /= by;
}

/* p − 2 (n·(p − a)) n/n² for a normal n of the mirror through a; 0: not an integer. */
static int reflect(const adv_line *m, int64_t *x, int64_t *y) {
  int64_t u, v;
  direction(m, &u, &v);
  if (u > 1 << 14 || u < -(1 << 14) || v > 1 << 14 || v < -(1 << 14)) return 0;
  const int64_t off = 2 * (u * (*y - m->y[0]) - v * (*x - m->x[0])), size = u * u + v * v;
  if (off % size) return 0;
  *x += off / size * v;
  *y -= off / size * u;
  return 1;
}

static int along(const adv_line *m, const adv_line *n) {
  int64_t u, v, s, t;
  direction(m, &u, &v);
  direction(n, &s, &t);
  return u * t == v * s;
}

/* The mirror parallel to another; ADV_MIRRORS: none. */
static size_t partner(const adv_scene *scene, size_t mirror) {
  for (size_t k = 0; k < scene->mirrors; k++)
    if (k != mirror && along(&scene->mirror[k], &scene->mirror[mirror])) return k;
  return ADV_MIRRORS;
}

static int reflect_patch(const adv_line *m, adv_patch *p) {
  adv_patch old = *p;
  for (int end = 0; end < 2; end++) {
    if (!reflect(m, &old.x[end], &old.y[end])) return 0;
    p->x[1 - end] = old.x[end];
    p->y[1 - end] = old.y[end];
  }
  p->from = old.to;
  p->to = old.from;
  return 1;
}

/* Of a patch and its image one carries what is known of the original. */
static void part_with(adv_patch *p, adv_patch *image, adv_random *r) {
  (adv_chance(r, 0.5) ? p : image)->source = -1;
}

static void drop_mirror(adv_scene *scene, size_t mirror) {
  scene->mirror[mirror] = scene->mirror[--scene->mirrors];
}

static int is_periodic(const adv_scene *scene) {
  return scene->period[0] || scene->period[1];
}

/* Twice the way from one mirror to a parallel one. */
static int period_of(const adv_line *m, const adv_line *other, int64_t *period) {
  int64_t x = m->x[0], y = m->y[0];
  if (!reflect(other, &x, &y)) return 0;
  /* The foot is half way. */
  period[0] = x - m->x[0];
  period[1] = y - m->y[0];
  return 1;
}

/* A mirror is taken away, and the images drawn.  A parallel one remains with its own image, or
   both are replaced by a period. */
int adv_unfold(adv_scene *scene, adv_random *r) {
  if (!scene->mirrors || 2 * scene->count > ADV_PATCHES || adv_bits(scene) > BITS - 4) return 0;
  adv_scene old = *scene;
  const size_t mirror = (size_t)adv_int(r, 0, (int)scene->mirrors - 1),
               other = partner(scene, mirror);
  const adv_line line = scene->mirror[mirror];
  for (size_t k = 0; k < old.count; k++) {
    adv_patch *image = &scene->patch[scene->count++];
    *image = scene->patch[k];
    if (!reflect_patch(&line, image)) goto no;
    part_with(&scene->patch[k], image, r);
  }
  scene->unfolded = 1;
  if (other == ADV_MIRRORS) {
    drop_mirror(scene, mirror);
    return 1;
  }
  adv_line *m = &scene->mirror[mirror];
  if (adv_chance(r, 0.5)) {
    *m = scene->mirror[other];
    if (reflect(&line, &m->x[0], &m->y[0]) && reflect(&line, &m->x[1], &m->y[1])) return 1;
    goto no;
  }
  if (!period_of(m, &scene->mirror[other], scene->period)) goto no;
  drop_mirror(scene, mirror > other ? mirror : other);
  drop_mirror(scene, mirror > other ? other : mirror);
  return 1;
no:
  *scene = old;
  return 0;
}

/* One of two parallel mirrors becomes a period. */
int adv_fold(adv_scene *scene, adv_random *r) {
  if (!scene->mirrors) return 0;
  const size_t mirror = (size_t)adv_int(r, 0, (int)scene->mirrors - 1),
               other = partner(scene, mirror);
  if (other == ADV_MIRRORS ||
      !period_of(&scene->mirror[mirror], &scene->mirror[other], scene->period))
    return 0;
  drop_mirror(scene, mirror);
  return 1;
}

/* The least of what roundings are beside: the patches, and the distances of ends from mirrors
   that they are not on. */
static double smallest(const adv_scene *scene) {
  double min = INFINITY;
  for (size_t k = 0; k < scene->count; k++) {
    const adv_patch *p = &scene->patch[k];
    min = fmin(min, hypot((double)(p->x[1] - p->x[0]), (double)(p->y[1] - p->y[0])));
    for (size_t m = 0; m < 2 * scene->mirrors; m++) {
      int64_t u, v;
      const adv_line *line = &scene->mirror[m / 2];
      direction(line, &u, &v);
      const double off =
          fabs((double)(u * (p->y[m % 2] - line->y[0]) - v * (p->x[m % 2] - line->x[0]))) /
          hypot((double)u, (double)v);
      if (off > 0) min = fmin(min, off);
    }
  }
  return min;
}

/* A reflection has some eight roundings of coordinates and of a unit vector. */
void adv_allow_images(adv_scene *scene) {
  double max = 0, light = 0, part = ldexp(0x1p-48, adv_bits(scene)) / smallest(scene);
  int oblique = 0;
  for (size_t k = 0; k < scene->mirrors; k++)
    oblique |= scene->mirror[k].x[0] != scene->mirror[k].x[1] &&
               scene->mirror[k].y[0] != scene->mirror[k].y[1];
  for (size_t b = 0; b < scene->bands && oblique; b++) {
    light = fmax(light, adv_outside(scene, b));
    for (size_t k = 0; k < scene->count; k++) {
      max = fmax(max, adv_scattered(&scene->patch[k], b));
      light = fmax(light, scene->patch[k].emission[b]);
    }
  }
  scene->turned += part * light / (1 - max);
}

/* Whether the period takes a patch to the same side of all mirrors. */
static int is_free(const adv_scene *scene) {
  if (!is_periodic(scene)) return 0;
  for (size_t k = 0; k < scene->mirrors; k++) {
    int64_t u, v;
    direction(&scene->mirror[k], &u, &v);
    if (u * scene->period[1] != v * scene->period[0]) return 0;
  }
  return 1;
}

static void move(adv_scene *scene, adv_patch *p, int periods) {
  for (int end = 0; end < 2; end++) {
    p->x[end] += periods * scene->period[0];
    p->y[end] += periods * scene->period[1];
  }
}

/* Two or three cells, and as many periods. */
int adv_cells(adv_scene *scene, adv_random *r) {
  const int cells = adv_int(r, 2, 3);
  const size_t count = scene->count;
  if (!is_free(scene) || (size_t)cells * count > ADV_PATCHES || adv_bits(scene) > BITS - 4)
    return 0;
  for (size_t k = 0; k < count; k++) {
    const int known = adv_int(r, 0, cells - 1);
    for (int c = 0; c < cells; c++) {
      adv_patch *p = &scene->patch[c ? scene->count++ : k];
      if (c) *p = scene->patch[k];
    }
    for (int c = 0; c < cells; c++) {
      adv_patch *p = &scene->patch[c ? scene->count - (size_t)(cells - c) : k];
      move(scene, p, c);
      if (c != known) p->source = -1;
    }
  }
  for (int axis = 0; axis < 2; axis++) scene->period[axis] *= cells;
  scene->unfolded = 1;
  return 1;
}

int adv_negate(adv_scene *scene, adv_random *r) {
  (void)r;
  if (!is_periodic(scene)) return 0;
  for (int axis = 0; axis < 2; axis++) scene->period[axis] = -scene->period[axis];
  return 1;
}

/* Each mirror by two other points. */
int adv_redraw(adv_scene *scene, adv_random *r) {
  if (!scene->mirrors || adv_bits(scene) > BITS - 8) return 0;
  for (size_t k = 0; k < scene->mirrors; k++) {
    adv_line *m = &scene->mirror[k];
    const int64_t u = m->x[1] - m->x[0], v = m->y[1] - m->y[0];
    const int from = adv_int(r, -40, 40),
              by = adv_int(r, 1, 40) * (adv_chance(r, 0.5) ? 1 : -1);
    m->x[0] += from * u;
    m->y[0] += from * v;
    m->x[1] = m->x[0] + by * u;
    m->y[1] = m->y[0] + by * v;
  }
  return 1;
}

/* Each patch in another period. */
int adv_wander(adv_scene *scene, adv_random *r) {
  const int far = adv_chance(r, 0.2) ? 20 : 2;
  if (!is_free(scene) || adv_bits(scene) > BITS - 6) return 0;
  for (size_t k = 0; k < scene->count; k++)
    move(scene, &scene->patch[k], adv_int(r, -far, far));
  return 1;
}

/* The image of all patches in a mirror takes their place. */
int adv_flip(adv_scene *scene, adv_random *r) {
  if (!scene->mirrors || adv_bits(scene) > BITS - 4) return 0;
  adv_scene old = *scene;
  const size_t mirror = (size_t)adv_int(r, 0, (int)scene->mirrors - 1);
  if (partner(scene, mirror) != ADV_MIRRORS) return 0;
  for (size_t k = 0; k < scene->count; k++)
    if (!reflect_patch(&old.mirror[mirror], &scene->patch[k])) {
      *scene = old;
      return 0;
    }
  return 1;
}
