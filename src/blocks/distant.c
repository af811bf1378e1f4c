/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of distant pairs. */
#include <math.h>
#include <string.h>

#include "blocks/block.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* The vector b − a of an element, from the vector of its patch, which has more digits. */
static hr2d_point along(const hr2di_patch *p, const hr2d_element *e) {
  const double part = e->length / p->length;
  return (hr2d_point){part * (p->scaled.b.x - p->scaled.a.x),
                      part * (p->scaled.b.y - p->scaled.a.y)};
}

static void make_frame(hr2di_pair_frame *f, const hr2d_scene *scene, const hr2d_element *i,
                       const hr2d_element *j) {
  f->along_i = along(&scene->patch[i->patch], i);
  f->along_j = along(&scene->patch[j->patch], j);
  f->apart = (hr2d_point){j->a.x - i->a.x, j->a.y - i->a.y};
  f->length_i = i->length;
  f->length_j = j->length;
  f->above_i[0] = hr2di_orient(i->a, i->b, j->a) / i->length;
  f->above_i[1] = hr2di_orient(i->a, i->b, j->b) / i->length;
  f->above_j[0] = hr2di_orient(j->a, j->b, i->a) / j->length;
  f->above_j[1] = hr2di_orient(j->a, j->b, i->b) / j->length;
}

/* Elements next to a corner of their patches may be so small that their coordinates are equal.
   Their distances from the corner, as fractions of the patches, are exact and differ. */
static void measure_from_corner(hr2di_pair_frame *f, const hr2d_hierarchy *h, hr2d_pair pair,
                                int at_end) {
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  const hr2di_patch *p = &h->scene->patch[i->patch], *q = &h->scene->patch[j->patch];
  const double from_i = hr2di_element_start(h, pair.first), size_i = i->length / p->length;
  const double from_j = hr2di_element_start(h, pair.second), size_j = j->length / q->length;
  const hr2d_point u = {p->scaled.b.x - p->scaled.a.x, p->scaled.b.y - p->scaled.a.y};
  const hr2d_point v = {q->scaled.b.x - q->scaled.a.x, q->scaled.b.y - q->scaled.a.y};
  const double sine =
      hr2di_orient(p->scaled.a, p->scaled.b, at_end ? q->scaled.b : q->scaled.a);
  /* Fractions of the patches, with the corner at 0. */
  const double a = at_end ? from_i - 1 : from_i, c = at_end ? from_j : from_j - 1;
  f->apart = (hr2d_point){c * v.x - a * u.x, c * v.y - a * u.y};
  f->above_i[0] = fabs(c) * sine / p->length;
  f->above_i[1] = fabs(c + size_j) * sine / p->length;
  f->above_j[0] = fabs(a) * sine / q->length;
  f->above_j[1] = fabs(a + size_i) * sine / q->length;
}

void hr2di_pair_frame_init(hr2di_pair_frame *f, const hr2d_hierarchy *h, hr2d_pair pair) {
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  const hr2d_segment p = h->scene->patch[i->patch].scaled, q = h->scene->patch[j->patch].scaled;
  make_frame(f, h->scene, i, j);
  if (hr2di_point_same(p.b, q.a) || hr2di_point_same(p.a, q.b))
    measure_from_corner(f, h, pair, hr2di_point_same(p.b, q.a));
}

/* One tensor rule is enough, because G is smooth on both elements. */
void hr2di_block_add_distant(hr2di_integrator *w, const hr2di_pair_frame *f, double *block) {
  const size_t p = w->order, n = w->far.points;
  const double scale = 0.5 * f->length_i * f->length_j;
  double moment[HR2D_MAX_ORDER];
  w->kernels += n * n;
  if (hr2di_watch_work(w->watch, 1 + n * n * (8 + p) / 64)) return;
  for (size_t k = 0; k < n; k++) {
    const double s = 0.5 + 0.5 * w->far.at[k];
    const double x = f->apart.x - s * f->along_i.x, y = f->apart.y - s * f->along_i.y;
    const double outer = scale * w->far.weight[k] * hr2di_block_mix(f->above_j, s);
    memset(moment, 0, p * sizeof *moment);
    for (size_t q = 0; q < n; q++) {
      const double t = 0.5 + 0.5 * w->far.at[q];
      const double rx = x + t * f->along_j.x, ry = y + t * f->along_j.y;
      const double square = rx * rx + ry * ry;
      const double g =
          w->far.weight[q] * hr2di_block_mix(f->above_i, t) / (square * sqrt(square));
      const double *phi = w->phi_far + q * p;
      for (size_t m = 0; m < p; m++) moment[m] += g * phi[m];
    }
    const double *phi = w->phi_far + k * p;
    for (size_t l = 0; l < p; l++)
      for (size_t m = 0; m < p; m++) block[l * p + m] += outer * phi[l] * moment[m];
  }
}
