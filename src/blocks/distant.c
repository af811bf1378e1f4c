/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of distant pairs. */
#include <math.h>
#include <string.h>

#include "blocks/block.h"
#include "blocks/line-vector.h"
#include "geometry/exchange-area.h"

static hr2d_point rounded(const hr2di_vector *v, double scale) {
  return (hr2d_point){v->x * scale, v->y * scale};
}

/* Vectors are scaled, so that no product underflows. */
static hr2di_between vectors_between(const hr2di_line_frame *f, double scale) {
  const hr2di_vector a = hr2di_vector_times(&f->a, scale), b = hr2di_vector_times(&f->b, scale);
  const hr2di_vector c = hr2di_vector_times(&f->c, scale), d = hr2di_vector_times(&f->d, scale);
  return (hr2di_between){hr2di_vector_times(&f->u, scale), hr2di_vector_times(&f->v, scale),
                         hr2di_vector_minus(&c, &a),       hr2di_vector_minus(&d, &b),
                         hr2di_vector_minus(&d, &a),       hr2di_vector_minus(&c, &b)};
}

/* How far ends are above the line along a vector, which may be much shorter.  Larger factors
   overflow in products with all digits. */
static void set_heights(const hr2di_vector *along, double length, const hr2di_vector *first,
                        const hr2di_vector *second, double back, double height[2]) {
  const double scale = ldexp(1, -ilogb(fmax(length, 0x1p-990)));
  const hr2di_vector u = hr2di_vector_times(along, scale);
  const double unit = back / (scale * length);
  height[0] = hr2di_det(&u, first) * unit;
  height[1] = hr2di_det(&u, second) * unit;
}

/* The frame of lines has more digits than coordinates of small elements. */
void hr2di_pair_frame_init(hr2di_pair_frame *f, const hr2d_hierarchy *h, hr2d_pair pair) {
  hr2di_line_frame lines;
  hr2di_line_frame_init(&lines, h, pair);
  const hr2di_vector apart = hr2di_vector_minus(&lines.c, &lines.a);
  const double scale = hr2di_vector_scale(&apart), back = 1 / scale;
  const hr2di_between z = vectors_between(&lines, scale);
  const hr2di_vector ca = hr2di_vector_reversed(&z.ac), db = hr2di_vector_reversed(&z.bd);
  f->along_i = rounded(&z.ab, back);
  f->along_j = rounded(&z.cd, back);
  f->apart = rounded(&z.ac, back);
  f->length_i = h->element[pair.first].length;
  f->length_j = h->element[pair.second].length;
  set_heights(&z.ab, scale * f->length_i, &z.ac, &z.bd, back, f->above_i);
  set_heights(&z.cd, scale * f->length_j, &ca, &db, back, f->above_j);
  f->area = hr2di_exchange_area_of_vectors(&z) * back;
}

/* One tensor rule is enough, because G is smooth on both elements.  The first coefficient,
   which is the exchange area, is known without it. */
void hr2di_block_distant(hr2di_integrator *w, const hr2di_pair_frame *f, double *block) {
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
  block[0] = f->area;
}
