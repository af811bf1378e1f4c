/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas in numbers whose exponent is an int, see base/scaled-double.h.

   The formulas are derived in exchange-area.c.  Every difference vector and every
   determinant has an exponent of its own, so that a denormal segment beside one of
   1e150 keeps its digits. */
#include "geometry/exchange-area-scaled.h"

#include <math.h>

#include "geometry/determinant.h"
#include "geometry/orient-exact.h"

#define ADD hr2di_scaled_add
#define SUB hr2di_scaled_sub
#define MUL hr2di_scaled_mul
#define DIV hr2di_scaled_div
#define NEG hr2di_scaled_neg

typedef hr2di_scaled scaled;

typedef struct pair {
  hr2di_vector ab, cd, ac, bd, ad, bc;
  scaled abc, abd, cda, cdb;
} pair;

static scaled corner_area(scaled length_y, scaled length_z, scaled dot, scaled det,
                          scaled opposite) {
  const scaled product = MUL(length_y, length_z);
  const scaled sum = ADD(ADD(length_y, length_z), opposite);
  if (dot.m >= 0) return DIV(ADD(product, dot), sum);
  return MUL(DIV(det, sum), DIV(det, SUB(product, dot)));
}

static scaled crossing_area(const pair *s, scaled on_i, scaled on_j, scaled m,
                            scaled opposite) {
  const scaled u = hr2di_vector_length_scaled(&s->ab), v = hr2di_vector_length_scaled(&s->cd);
  const scaled dot = hr2di_vector_dot_scaled(&s->ab, &s->cd), product = MUL(u, v);
  const scaled part_i = MUL(u, DIV(on_i, m)), part_j = MUL(v, DIV(on_j, m));
  const scaled sum = ADD(ADD(part_i, part_j), opposite);
  if (dot.m > 0) return DIV(MUL(on_i, on_j), MUL(sum, ADD(product, dot)));
  return MUL(DIV(MUL(part_i, part_j), sum), DIV(SUB(product, dot), product));
}

static scaled clipped_area(const pair *s) {
  const scaled u = hr2di_vector_length_scaled(&s->ab), v = hr2di_vector_length_scaled(&s->cd);
  const scaled ac = hr2di_vector_length_scaled(&s->ac), bd = hr2di_vector_length_scaled(&s->bd);
  const scaled ad = hr2di_vector_length_scaled(&s->ad), bc = hr2di_vector_length_scaled(&s->bc);
  if (s->abd.m < 0 && s->cda.m < 0)
    return crossing_area(s, s->cdb, s->abc, SUB(s->abc, s->abd), bc);
  if (s->abc.m < 0 && s->cdb.m < 0)
    return crossing_area(s, s->cda, s->abd, SUB(s->cda, s->cdb), ad);
  if (s->abd.m < 0)
    return corner_area(u, ac, hr2di_vector_dot_scaled(&s->ab, &s->ac), s->abc, bc);
  if (s->abc.m < 0)
    return corner_area(u, bd, NEG(hr2di_vector_dot_scaled(&s->ab, &s->bd)), s->abd, ad);
  if (s->cda.m < 0)
    return corner_area(v, bd, hr2di_vector_dot_scaled(&s->bd, &s->cd), s->cdb, bc);
  return corner_area(v, ac, NEG(hr2di_vector_dot_scaled(&s->ac, &s->cd)), s->cda, ad);
}

static scaled facing_area(const pair *s) {
  const scaled p = hr2di_vector_length_scaled(&s->ac), q = hr2di_vector_length_scaled(&s->bd);
  const scaled k = ADD(s->abc, s->cda), pq = MUL(p, q),
               e = hr2di_vector_dot_scaled(&s->ac, &s->bd);
  const scaled at_ad =
      ADD(ADD(MUL(p, s->abd), MUL(q, s->cda)), MUL(k, hr2di_vector_length_scaled(&s->ad)));
  const scaled at_bc =
      ADD(ADD(MUL(q, s->abc), MUL(p, s->cdb)), MUL(k, hr2di_vector_length_scaled(&s->bc)));
  scaled t = {0, 0};
  if (at_ad.m > 0) t = DIV(MUL(s->abd, s->cda), at_ad);
  if (at_bc.m > 0) t = ADD(t, DIV(MUL(s->abc, s->cdb), at_bc));
  return MUL(t, e.m >= 0 ? DIV(k, ADD(pq, e)) : DIV(SUB(pq, e), k));
}

static void set_determinants(pair *s, const hr2d_segment *i, const hr2d_segment *j) {
  if (hr2di_points_near_in_scale((const hr2d_point[]){i->a, i->b, j->a, j->b}, 4)) {
    s->abc = hr2di_det_scaled(&s->ab, &s->ac);
    s->abd = hr2di_det_scaled(&s->ab, &s->bd);
    s->cda = NEG(hr2di_det_scaled(&s->cd, &s->ac));
    s->cdb = NEG(hr2di_det_scaled(&s->cd, &s->bd));
  } else {
    s->abc = hr2di_orient_exact(i->a, i->b, j->a);
    s->abd = hr2di_orient_exact(i->a, i->b, j->b);
    s->cda = hr2di_orient_exact(j->a, j->b, i->a);
    s->cdb = hr2di_orient_exact(j->a, j->b, i->b);
  }
}

double hr2di_exchange_area_scaled(const hr2d_segment *i, const hr2d_segment *j) {
  if (!hr2di_point_finite(i->a) || !hr2di_point_finite(i->b) || !hr2di_point_finite(j->a) ||
      !hr2di_point_finite(j->b))
    return NAN;
  pair s;
  s.ab = hr2di_vector_difference_scaled(i->b, i->a);
  s.cd = hr2di_vector_difference_scaled(j->b, j->a);
  s.ac = hr2di_vector_difference_scaled(j->a, i->a);
  s.bd = hr2di_vector_difference_scaled(j->b, i->b);
  s.ad = hr2di_vector_difference_scaled(j->b, i->a);
  s.bc = hr2di_vector_difference_scaled(j->a, i->b);
  set_determinants(&s, i, j);
  if ((s.abc.m <= 0 && s.abd.m <= 0) || (s.cda.m <= 0 && s.cdb.m <= 0)) return 0;
  const int clipped = s.abc.m < 0 || s.abd.m < 0 || s.cda.m < 0 || s.cdb.m < 0;
  return hr2di_scaled_value(clipped ? clipped_area(&s) : facing_area(&s));
}
