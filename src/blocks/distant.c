/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of distant pairs. */
#include <math.h>
#include <string.h>

#include "base/bickley.h"
#include "blocks/block.h"
#include "blocks/line-vector.h"
#include "geometry/exchange-area.h"

static hr2d_point rounded(const hr2di_vector *v, double scale) {
  return (hr2d_point){v->x * scale, v->y * scale};
}

/* Vectors are scaled, so that no product underflows. */
static hr2di_between vectors_between(const hr2di_line_frame *f, double scale) {
  const hr2di_vector a = hr2di_vector_scaled(&f->a, scale);
  const hr2di_vector b = hr2di_vector_scaled(&f->b, scale);
  const hr2di_vector c = hr2di_vector_scaled(&f->c, scale);
  const hr2di_vector d = hr2di_vector_scaled(&f->d, scale);
  return (hr2di_between){hr2di_vector_scaled(&f->u, scale), hr2di_vector_scaled(&f->v, scale),
                         hr2di_vector_minus(&c, &a),        hr2di_vector_minus(&d, &b),
                         hr2di_vector_minus(&d, &a),        hr2di_vector_minus(&c, &b)};
}

/* How far ends are above the line along a vector, which may be much shorter.  Larger factors
   overflow in products with all digits. */
static void set_heights(const hr2di_vector *along, double length, const hr2di_vector *first,
                        const hr2di_vector *second, double back, double height[2]) {
  const double scale = ldexp(1, -ilogb(fmax(length, 0x1p-990)));
  const hr2di_vector u = hr2di_vector_scaled(along, scale);
  const double unit = back / (scale * length);
  height[0] = hr2di_det(&u, first) * unit;
  height[1] = hr2di_det(&u, second) * unit;
}

/* The frame of lines has more digits than coordinates of small elements. */
void hr2di_pair_frame_init(hr2di_pair_frame *f, const hr2d_hierarchy *h, hr2d_pair pair) {
  hr2di_line_frame lines;
  hr2di_line_frame_init(&lines, h, pair);
  const hr2di_vector separation = hr2di_vector_minus(&lines.c, &lines.a);
  const double scale = hr2di_vector_scale(&separation), back = 1 / scale;
  const hr2di_between z = vectors_between(&lines, scale);
  const hr2di_vector ca = hr2di_vector_reversed(&z.ac), db = hr2di_vector_reversed(&z.bd);
  f->along_i = rounded(&z.ab, back);
  f->along_j = rounded(&z.cd, back);
  f->separation = rounded(&z.ac, back);
  f->length_i = h->element[pair.first].length;
  f->length_j = h->element[pair.second].length;
  set_heights(&z.ab, scale * f->length_i, &z.ac, &z.bd, back, f->above_i);
  set_heights(&z.cd, scale * f->length_j, &ca, &db, back, f->above_j);
  f->area = hr2di_exchange_area_of_vectors(&z) * back;
}

/* The points for an element that sees the other one on the ellipse m. */
static size_t points_for(const hr2di_integrator *w, double m, double length) {
  size_t n = w->points;
  while (n > 1 && m >= w->separation[n - 2]) n--;
  n += (size_t)fmin(ceil(0.5 * w->absorption * length), HR2DI_GAS_POINTS);
  return n < HR2DI_RULE_POINTS ? n : HR2DI_RULE_POINTS;
}

/* φ_0 … at the points of a rule. */
static const double *table(hr2di_integrator *w, const hr2di_rule *rule) {
  const size_t n = rule->points;
  double *phi = w->phi + n * (n - 1) / 2 * w->order;
  for (size_t q = 0; q < n && !w->tabled[n - 1]; q++)
    hr2di_basis_at(&w->basis, rule->at[q], phi + q * w->order);
  w->tabled[n - 1] = 1;
  return phi;
}

/* A point of the rule on i, and the pair seen from there. */
typedef struct from {
  const hr2di_pair_frame *f;
  double x, y; /* from the point to the start of j */
} from;

/* G/½ without what depends on the point of i alone, at fraction t of j; sets the distance. */
static double kernel(const from *at, double t, double *distance) {
  const hr2di_pair_frame *f = at->f;
  const double rx = at->x + t * f->along_j.x, ry = at->y + t * f->along_j.y;
  const double square = rx * rx + ry * ry;
  *distance = sqrt(square);
  return hr2di_block_mix(f->above_i, t) / (square * *distance);
}

/* The part of one point of i with gas between, as the loops below; adds to work->lost. */
static void add_through_gas(hr2di_integrator *w, const from *at, const hr2di_rule *on_j,
                            const double *phi_i, const double *phi_j, double outer,
                            double *block) {
  const size_t p = w->order;
  double moment[HR2D_MAX_ORDER] = {0}, absorbed = 0;
  for (size_t q = 0; q < on_j->points; q++) {
    double distance;
    const double g = on_j->weight[q] * kernel(at, 0.5 + 0.5 * on_j->at[q], &distance);
    const hr2di_passage pass = hr2di_passage_at(w->section, w->absorption * distance);
    const double *phi = phi_j + q * p;
    for (size_t l = 0; l < p; l++) moment[l] += g * pass.arrives * phi[l];
    for (size_t l = 0; l < p; l++) w->lost[1][l] += outer * (g * pass.absorbed) * phi[l];
    absorbed += g * pass.absorbed;
  }
  for (size_t l = 0; l < p; l++) w->lost[0][l] += outer * absorbed * phi_i[l];
  for (size_t l = 0; l < p; l++)
    for (size_t n = 0; n < p; n++) block[l * p + n] += outer * phi_i[l] * moment[n];
}

/* What arrives and what is absorbed make the exchange area, which is known exactly: so thin
   gas keeps the digits of both. */
static void scale_to(hr2di_integrator *w, double area, double *block) {
  const size_t p = w->order;
  const double factor = area / (block[0] + w->lost[0][0]);
  for (size_t k = 0; k < p * p; k++) block[k] *= factor;
  for (size_t l = 0; l < p; l++) w->lost[0][l] *= factor;
  for (size_t l = 0; l < p; l++) w->lost[1][l] *= factor;
}

/* One tensor rule is enough, because G is smooth on both elements.  The first coefficient,
   which is the exchange area, is known without it. */
void hr2di_block_distant(hr2di_integrator *w, const hr2di_pair_frame *f, const double m[2],
                         double *block) {
  const size_t p = w->order;
  const hr2di_rule *on_i = hr2di_integrator_rule(w, points_for(w, m[0], f->length_i));
  const hr2di_rule *on_j = hr2di_integrator_rule(w, points_for(w, m[1], f->length_j));
  const double *phi_i = table(w, on_i), *phi_j = table(w, on_j);
  const double scale = 0.5 * f->length_i * f->length_j;
  double moment[HR2D_MAX_ORDER];
  w->kernels += on_i->points * on_j->points;
  if (hr2di_watch_work(w->watch, 1 + on_i->points * on_j->points * (8 + p) / 64)) return;
  for (size_t k = 0; k < on_i->points; k++) {
    const double s = 0.5 + 0.5 * on_i->at[k];
    const double x = f->separation.x - s * f->along_i.x, y = f->separation.y - s * f->along_i.y;
    const double outer = scale * on_i->weight[k] * hr2di_block_mix(f->above_j, s);
    if (w->absorption > 0) {
      const from at = {f, x, y};
      add_through_gas(w, &at, on_j, phi_i + k * p, phi_j, outer, block);
      continue;
    }
    memset(moment, 0, p * sizeof *moment);
    for (size_t q = 0; q < on_j->points; q++) {
      const double t = 0.5 + 0.5 * on_j->at[q];
      const double rx = x + t * f->along_j.x, ry = y + t * f->along_j.y;
      const double square = rx * rx + ry * ry;
      const double g =
          on_j->weight[q] * hr2di_block_mix(f->above_i, t) / (square * sqrt(square));
      const double *phi = phi_j + q * p;
      for (size_t l = 0; l < p; l++) moment[l] += g * phi[l];
    }
    const double *phi = phi_i + k * p;
    for (size_t l = 0; l < p; l++)
      for (size_t n = 0; n < p; n++) block[l * p + n] += outer * phi[l] * moment[n];
  }
  if (w->absorption > 0)
    scale_to(w, f->area, block);
  else
    block[0] = f->area;
}
