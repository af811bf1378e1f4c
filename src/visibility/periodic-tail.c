/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Along the period a patch that is oblique to it sees its own next image, so that only patches
   along the period see the ends but from their tips.  Their form factors are those angles,
   which are series from 1/k² on, times sines from 1/k on: they begin with 1/k³, as exchange
   areas do, see scene/period-weights.c.  Fronts count by their images, the sky by where it
   shows; backs have what is left of the ends. */
#include "visibility/periodic-tail.h"

#include <math.h>

#include "geometry/vector.h"
#include "scene/scene-impl.h"

double hr2di_periodic_tail_weight(const hr2d_scene *scene, size_t patch) {
  const hr2di_symmetry *s = &scene->symmetry;
  if (!hr2di_symmetry_cuts(s) || hr2di_symmetry_is_end(s, patch)) return 1;
  return s->motion[patch / s->cell].weight;
}

static int has_checks(const double *check) {
  for (int c = 0; c < HR2DI_TAIL_CHECKS; c++)
    if (check[c] != 0) return 1;
  return 0;
}

const double *hr2di_periodic_tail_checks(const hr2d_scene *scene, size_t patch) {
  const hr2di_symmetry *s = &scene->symmetry;
  if (!hr2di_symmetry_cuts(s) || hr2di_symmetry_is_end(s, patch)) return NULL;
  const double *check = s->motion[patch / s->cell].check;
  return has_checks(check) ? check : NULL;
}

/* The sine towards the end of a patch, of a direction in front of it, or of the horizon that is
   next to one behind. */
static double sine_of(hr2d_point along, hr2d_point v, int front) {
  const double sine = hr2di_point_dot(along, v);
  if (front) return fmin(fmax(sine / hypot(v.x, v.y), -1), 1);
  return sine > 0 ? 1 : -1;
}

/* The form factor of the sky that a period shows.  Of a period behind the patch it is 0, though
   the horizons next to its ends may be two. */
static double sky_of(const hr2di_quadrant *q, const double distance[2], hr2d_point along,
                     const hr2di_view_from *seen) {
  double sine[2], sum = 0;
  int fronts = 0;
  for (int k = 0; k < 2; k++) {
    const hr2d_point v = {distance[k] * q->out.x + q->border * q->up.x,
                          distance[k] * q->out.y + q->border * q->up.y};
    const int front = hr2di_point_cross(along, v) > 0;
    sine[k] = sine_of(along, v, front);
    fronts += front;
  }
  if (fronts == 0) return 0;
  const double low = fmin(sine[0], sine[1]), high = fmax(sine[0], sine[1]);
  for (size_t m = 0; m < seen->arcs; m++)
    sum += fmax(fmin(seen->arc[m][1], high) - fmax(seen->arc[m][0], low), 0);
  return 0.5 * sum;
}

static void add_skies(const hr2d_scene *scene, hr2d_point x, hr2d_point along,
                      const hr2di_view_from *seen, hr2di_periodic_tail *tail) {
  const hr2di_symmetry *s = &scene->symmetry;
  const hr2di_tail *series = &s->patches;
  for (int k = 0; k < HR2DI_SKIES; k++) {
    const hr2di_quadrant q = hr2di_symmetry_quadrant(s, x, k % 2, k / 2);
    tail->bearing[k] = hr2di_quadrant_bearing(&q);
    for (unsigned n = 1; n <= s->copies && q.border > 0; n++) {
      double distance[2];
      const double check[] = {series->check[0][n], series->check[1][n]};
      if (series->weight[n] == 0 && !has_checks(check)) continue;
      hr2di_quadrant_of(s, &q, n, distance);
      const double factor = sky_of(&q, distance, along, seen);
      tail->sky[k] += series->weight[n] * factor;
      for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) tail->check[c][k] += check[c] * factor;
    }
  }
}

/* The place of a fraction of a patch, in scene lengths. */
static hr2d_point place_of(hr2d_segment at, double t) {
  return (hr2d_point){at.a.x + t * (at.b.x - at.a.x), at.a.y + t * (at.b.y - at.a.y)};
}

void hr2di_periodic_tail_of(const hr2d_scene *scene, size_t patch, double t,
                            const hr2di_view_from *seen, hr2di_periodic_tail *tail) {
  const hr2di_symmetry *s = &scene->symmetry;
  *tail = (hr2di_periodic_tail){0};
  if (!hr2di_symmetry_cuts(s)) return;
  double front = 0, sky = 0;
  for (size_t k = 0; k < seen->count; k++) {
    const hr2di_visible_interval *g = &seen->interval[k];
    if (hr2di_symmetry_is_end(s, g->patch)) tail->ends += g->sine;
    front += (hr2di_periodic_tail_weight(scene, g->patch) - 1) * g->sine;
  }
  if (!(tail->ends > 0)) {
    *tail = (hr2di_periodic_tail){0};
    return;
  }
  const hr2d_segment at = scene->patch[patch].given;
  const hr2d_point d = hr2di_point_minus(at.b, at.a);
  const double length = hypot(d.x, d.y);
  add_skies(scene, place_of(at, t), (hr2d_point){d.x / length, d.y / length}, seen, tail);
  for (int k = 0; k < HR2DI_SKIES; k++) sky += tail->sky[k];
  tail->back = tail->ends - front - sky;
}
