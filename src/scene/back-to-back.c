/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/back-to-back.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/orient-sign.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

static hr2d_status add_step(hr2di_steps *steps, const hr2d_scene *scene, hr2d_point from,
                            hr2d_point to) {
  if (hr2di_alloc_reserve(&scene->alloc, &steps->step, &steps->capacity, steps->count + 1,
                          sizeof *steps->step))
    return HR2D_ENOMEM;
  steps->step[steps->count++] = (hr2di_step){from, to};
  return HR2D_OK;
}

/* By `far` to the left of s. */
static hr2d_point left_by(hr2d_point p, double far, const hr2d_segment *s) {
  const double ux = s->b.x - s->a.x, uy = s->b.y - s->a.y, size = hypot(ux, uy);
  return (hr2d_point){p.x - far * (uy / size), p.y + far * (ux / size)};
}

/* The end p of patch i is in front of j: it goes behind, or j before it. */
static hr2d_status part(hr2di_steps *steps, const hr2d_scene *scene, size_t i, size_t j,
                        hr2d_point p) {
  const hr2d_segment *s = &scene->patch[i].scaled, *t = &scene->patch[j].scaled;
  if (!(hr2di_point_same(p, s->a) || hr2di_point_same(p, s->b)) ||
      hr2di_orient_sign(t->a, t->b, p) <= 0)
    return HR2D_OK;
  /* And a unit in the last place, so that roundings do not eat it. */
  const double far = hr2di_crossings_distance(p, t) + 0x1p-52;
  if (hr2di_symmetry_is_image(&scene->symmetry, i))
    return add_step(steps, scene, p, left_by(p, -far, t));
  hr2d_status status = add_step(steps, scene, t->a, left_by(t->a, far, t));
  return status ? status : add_step(steps, scene, t->b, left_by(t->b, far, t));
}

hr2d_status hr2di_steps_add(hr2di_steps *steps, const hr2d_scene *scene, size_t i, size_t j,
                            const hr2di_meeting *m) {
  hr2d_status status = part(steps, scene, i, j, m->from);
  if (!status) status = part(steps, scene, j, i, m->from);
  if (!status) status = part(steps, scene, i, j, m->to);
  return status ? status : part(steps, scene, j, i, m->to);
}

static int by_place(const void *a, const void *b) {
  const hr2d_point p = ((const hr2di_step *)a)->from, q = ((const hr2di_step *)b)->from;
  if (p.x != q.x) return p.x < q.x ? -1 : 1;
  if (p.y != q.y) return p.y < q.y ? -1 : 1;
  const hr2d_point v = ((const hr2di_step *)a)->to, w = ((const hr2di_step *)b)->to;
  if (v.x != w.x) return v.x < w.x ? -1 : 1;
  return (v.y > w.y) - (v.y < w.y);
}

/* The first step from p, or NULL. */
static const hr2di_step *step_from(const hr2di_steps *steps, hr2d_point p) {
  size_t low = 0, high = steps->count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    const hr2d_point q = steps->step[middle].from;
    if (q.x < p.x || (q.x == p.x && q.y < p.y))
      low = middle + 1;
    else
      high = middle;
  }
  return low < steps->count && hr2di_point_same(steps->step[low].from, p) ? &steps->step[low]
                                                                          : NULL;
}

static void move(const hr2di_steps *steps, const hr2d_scene *scene, hr2d_point *scaled,
                 hr2d_point *given) {
  const hr2di_step *step = step_from(steps, *scaled);
  if (!step) return;
  *scaled = step->to;
  *given = (hr2d_point){ldexp(step->to.x, scene->exponent), ldexp(step->to.y, scene->exponent)};
}

hr2d_status hr2di_steps_take(hr2di_steps *steps, hr2d_scene *scene, hr2di_watch *watch) {
  hr2d_status status =
      hr2di_sort(steps->step, steps->count, sizeof *steps->step, by_place, watch);
  for (size_t k = scene->symmetry.cell; k < scene->patches && !status; k++) {
    hr2di_patch *p = &scene->patch[k];
    status = hr2di_watch_work(watch, 1);
    move(steps, scene, &p->scaled.a, &p->given.a);
    move(steps, scene, &p->scaled.b, &p->given.b);
  }
  steps->count = 0;
  return status;
}
