/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cosines, tangents and slopes of a pair, each from exact determinants, so that pairs
   which are tiny, far or flat keep all their digits. */
#include "oracle/l1-frame.h"

#include <math.h>

#include "geometry/determinant.h"

static hr2di_vector turned(hr2di_vector v) {
  return (hr2di_vector){-v.y, v.x, -v.ty, v.tx, v.e};
}

/* The same vector with exponent e; its components are scaled. */
static hr2di_vector shifted(hr2di_vector v, int e) {
  const int by = v.e - e;
  return (hr2di_vector){ldexp(v.x, by), ldexp(v.y, by), ldexp(v.tx, by), ldexp(v.ty, by), e};
}

/* p + q + tail as *head + *rest. */
static void add_exactly(double p, double q, double tail, double *head, double *rest) {
  const double sum = p + q, error = hr2di_tail_of_difference(p, -q, sum) + tail;
  *head = sum + error;
  *rest = error - (*head - sum);
}

static hr2di_vector sum_of(hr2di_vector p, hr2di_vector q) {
  if (p.e != q.e) {
    const int e = p.e > q.e ? p.e : q.e;
    p = shifted(p, e);
    q = shifted(q, e);
  }
  hr2di_vector r = {.e = p.e};
  add_exactly(p.x, q.x, p.tx + q.tx, &r.x, &r.tx);
  add_exactly(p.y, q.y, p.ty + q.ty, &r.y, &r.ty);
  return r;
}

static double extent(const hr2d_segment *s) {
  return fabs(s->b.x - s->a.x) + fabs(s->b.y - s->a.y);
}

int hr2di_l1_in_order(const hr2d_segment *i, const hr2d_segment *j) {
  const double p[] = {extent(j), i->a.x, i->a.y, i->b.x, i->b.y};
  const double q[] = {extent(i), j->a.x, j->a.y, j->b.x, j->b.y};
  for (int k = 0; k < 5; k++)
    if (p[k] != q[k]) return p[k] < q[k];
  return 1;
}

static void clip(hr2di_l1_side *s, double half) {
  s->low = -half;
  s->high = half;
  /* low < 0 < high, since the centre is in front of the other segment. */
  if (s->slope * half > 1) s->low = -1 / s->slope;
  if (s->slope * half < -1) s->high = -1 / s->slope;
}

/* Twice the difference of the centres is the sum of two differences of end points, which are
   nearly equal where the segments face each other squarely. */
int hr2di_l1_frame_init(const hr2d_segment *i, const hr2d_segment *j, hr2di_l1_frame *f) {
  const int plain = hr2di_point_plain(i->a) && hr2di_point_plain(i->b) &&
                    hr2di_point_plain(j->a) && hr2di_point_plain(j->b);
  hr2di_vector (*difference)(hr2d_point, hr2d_point) =
      plain ? hr2di_vector_difference : hr2di_vector_difference_scaled;
  const hr2di_vector u = difference(i->b, i->a), v = difference(j->b, j->a);
  const hr2di_vector r = sum_of(difference(i->a, j->b), difference(i->b, j->a));
  const hr2di_vector across = turned(r);
  const double lu = hr2di_vector_length(&u), lv = hr2di_vector_length(&v),
               lr = hr2di_vector_length(&r);
  const double hx = -hr2di_det(&u, &r), hy = hr2di_det(&v, &r);
  f->distance = ldexp(lr, r.e - 1);
  if (!(hx > 0 && hy > 0)) return 0;
  const double rx = hr2di_det(&u, &across), ry = hr2di_det(&v, &across);
  const double cross = hr2di_det(&u, &v);
  f->x = (hr2di_l1_side){.cosine = hx / (lu * lr), .tangent = rx / hx, .along = rx / (lu * lr)};
  f->y =
      (hr2di_l1_side){.cosine = hy / (lv * lr), .tangent = -ry / hy, .along = ry / (lv * lr)};
  f->x.slope = -cross / lu * (lr / hy);
  f->y.slope = cross / lv * (lr / hx);
  f->length_x = ldexp(lu / lr, u.e - r.e + 1);
  f->length_y = ldexp(lv / lr, v.e - r.e + 1);
  clip(&f->x, 0.5 * f->length_x);
  clip(&f->y, 0.5 * f->length_y);
  f->per_length = f->per_range = 1;
  f->origin = (hr2di_l1_origin){.cosine = 1,
                                .above_a = 1,
                                .above_b = 1,
                                .derivative_a = -f->x.tangent,
                                .derivative_b = -f->y.tangent};
  return 1;
}

/* The vector from y at t to x at s: along the line of the centres, across it, its length. */
typedef struct line {
  double ahead, aside, r;
} line;

static line line_through(const hr2di_l1_frame *f, double s, double t) {
  line v = {1 + s * f->x.along - t * f->y.along, s * f->x.cosine + t * f->y.cosine, 0};
  v.r = sqrt(v.ahead * v.ahead + v.aside * v.aside);
  return v;
}

static hr2di_l1_origin origin_at(const hr2di_l1_frame *f, double sine, double cosine) {
  hr2di_l1_origin o = {.sine = sine, .cosine = cosine};
  o.above_a = cosine - f->x.tangent * sine;
  o.above_b = cosine - f->y.tangent * sine;
  o.derivative_a = -(sine + f->x.tangent * cosine);
  o.derivative_b = -(sine + f->y.tangent * cosine);
  o.a = o.above_a - 1;
  o.b = o.above_b - 1;
  return o;
}

/* 1+α is the distance of y from the line of i, divided by the distance of y_c from it and by r.
   Near a horizon the slope gives it more accurately than the angle does. */
void hr2di_l1_turn_to_line(hr2di_l1_frame *f, double s, double t) {
  const line v = line_through(f, s, t);
  if (!(v.r > 0)) return;
  f->origin = origin_at(f, v.aside / v.r, v.ahead / v.r);
  f->origin.above_a = fmax(1 + f->y.slope * t, 0) / v.r;
  f->origin.above_b = fmax(1 + f->x.slope * s, 0) / v.r;
  f->origin.a = f->origin.above_a - 1;
  f->origin.b = f->origin.above_b - 1;
}

void hr2di_l1_turn_to_angle(hr2di_l1_frame *f, double delta) {
  f->origin = origin_at(f, sin(delta), cos(delta));
}

double hr2di_l1_tau(const hr2di_l1_frame *f, double s, double t) {
  const line v = line_through(f, s, t);
  const double ahead = v.ahead * f->origin.cosine + v.aside * f->origin.sine;
  const double aside = v.aside * f->origin.cosine - v.ahead * f->origin.sine;
  if (ahead > 0) return aside / (v.r + ahead);
  return aside != 0 ? (v.r - ahead) / aside : 0;
}
