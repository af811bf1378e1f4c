/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trapezoids of one class of lines.

   As the direction e turns left, the vertex of the left chain with the largest offset z × e
   moves on along that chain, and the vertex of the right chain with the smallest offset moves
   back. Events are the directions of the edges of both chains, which come in their order. */
#include "blocks/lines.h"

#include "blocks/line-vector.h"

/* A direction where trapezoids begin or end; |e| is between 1 and 3. */
typedef struct ray {
  const hr2di_vertex *from, *to; /* it passes through */
  hr2di_vector e;
  double across[2], length; /* u × e and e × v */
} ray;

static double not_negative(double x) {
  return x > 0 ? x : 0;
}

/* Two points on the line of an element have exactly its direction. */
static hr2di_vector direction(const hr2di_line_frame *f, const hr2di_vertex *p,
                              const hr2di_vertex *q) {
  const unsigned both = p->on & q->on;
  if (both & HR2DI_ON_I) return q->s > p->s ? f->u : hr2di_vector_reversed(&f->u);
  if (both & HR2DI_ON_J) return q->t > p->t ? f->v : hr2di_vector_reversed(&f->v);
  return hr2di_vector_minus(&q->at, &p->at);
}

static ray ray_through(const hr2di_line_frame *f, const hr2di_vertex *p,
                       const hr2di_vertex *q) {
  const unsigned both = p->on & q->on;
  const hr2di_vector offset = direction(f, p, q);
  ray r = {.from = p, .to = q, .e = hr2di_vector_scaled(&offset, hr2di_vector_scale(&offset))};
  if (!(both & HR2DI_ON_I)) r.across[0] = not_negative(hr2di_vector_cross(&f->u, &r.e));
  if (!(both & HR2DI_ON_J)) r.across[1] = not_negative(hr2di_vector_cross(&r.e, &f->v));
  r.length = hr2di_vector_length(&r.e);
  return r;
}

/* Which places on the line of an element do not depend on the direction; `bit` is that line's.
 */
static void set_places(unsigned bit, const hr2di_vertex *first, const hr2di_vertex *last,
                       hr2di_meeting *m) {
  m->fixed = (first->on & bit ? 1 : 0) | (last->on & bit ? 2 : 0);
  m->place[0] = bit == HR2DI_ON_I ? first->s : first->t;
  m->place[1] = bit == HR2DI_ON_I ? last->s : last->t;
}

/* (at − from) × e */
static double offset(const hr2di_vector *at, const hr2di_vector *from, const hr2di_vector *e) {
  const hr2di_vector offset = hr2di_vector_minus(at, from);
  return hr2di_vector_cross(&offset, e);
}

/* Sets what belongs to end k of a trapezoid.  With one place known the other is off by
   gap/across, and with both the gap is known. */
static void set_end(const hr2di_line_frame *f, const hr2di_vertex *low,
                    const hr2di_vertex *high, const ray *r, size_t k, hr2di_trapezoid *t) {
  const int through = (r->from == low && r->to == high) || (r->from == high && r->to == low);
  double gap = through ? 0 : offset(&high->at, &low->at, &r->e);
  t->e[k] = r->e;
  for (size_t side = 0; side < 2; side++) {
    const hr2di_meeting *m = &t->on[side];
    if (m->fixed == 3 && !through) gap = (m->place[1] - m->place[0]) * r->across[side];
  }
  t->gap[k] = gap = fmin(not_negative(gap), fmin(r->across[0], r->across[1]));
  for (size_t side = 0; side < 2; side++) {
    hr2di_meeting *m = &t->on[side];
    double start;
    if (m->fixed & 1)
      start = m->place[0] * r->across[side];
    else if (m->fixed & 2)
      start = m->place[1] * r->across[side] - gap;
    else
      start = side ? -offset(&high->at, &f->c, &r->e) : offset(&low->at, &f->a, &r->e);
    m->across[k] = r->across[side];
    m->start[k] = fmin(not_negative(start), r->across[side] - gap);
  }
}

/* ½∫ z × e dθ = ½ z·(e0 − e1) for unit vectors, z from low to high.  Between narrow rays that
   would be but roundings; there it is the turn times the mean of the gaps, to a thousandth. */
static double area_of(const hr2di_vertex *low, const hr2di_vertex *high, const ray *from,
                      const ray *to, const hr2di_trapezoid *t) {
  const double turn = t->turn / (from->length * to->length);
  if (turn < 0x1p-5 && hr2di_vector_dot(&from->e, &to->e) > 0)
    return 0.25 * turn * (t->gap[0] / from->length + t->gap[1] / to->length);
  const hr2di_vector z = hr2di_vector_minus(&high->at, &low->at);
  const double x = from->e.x / from->length - to->e.x / to->length;
  const double y = from->e.y / from->length - to->e.y / to->length;
  return not_negative(0.5 * (z.x * x + z.y * y));
}

void hr2di_line_above(const hr2di_line_frame *f, const hr2di_vertex *z, double above[2]) {
  const hr2di_vector from_a = hr2di_vector_minus(&z->at, &f->a);
  const hr2di_vector from_c = hr2di_vector_minus(&z->at, &f->c);
  above[0] = z->on & HR2DI_ON_I ? 0 : hr2di_vector_cross(&f->u, &from_a);
  above[1] = z->on & HR2DI_ON_J ? 0 : hr2di_vector_cross(&f->v, &from_c);
}

/* The same of a vertex that bounds lines, which is behind neither. */
static void set_above(const hr2di_line_frame *f, const hr2di_vertex *z, double above[2]) {
  hr2di_line_above(f, z, above);
  above[0] = not_negative(above[0]);
  above[1] = not_negative(above[1]);
}

/* Makes the trapezoid between two rays; returns 0 if they do not differ, or not that way. */
static int make_trapezoid(const hr2di_line_frame *f, const hr2di_vertex *low,
                          const hr2di_vertex *high, const ray *from, const ray *to,
                          hr2di_trapezoid *t) {
  t->turn = hr2di_vector_cross(&from->e, &to->e);
  if (!(t->turn > 0)) return 0;
  set_places(HR2DI_ON_I, low, high, &t->on[0]);
  set_places(HR2DI_ON_J, high, low, &t->on[1]);
  set_end(f, low, high, from, 0, t);
  set_end(f, low, high, to, 1, t);
  t->area = area_of(low, high, from, to, t);
  if (f->has_gas) {
    set_above(f, low, t->above[0]);
    set_above(f, high, t->above[1]);
    t->bound[0] = low;
    t->bound[1] = high;
  }
  return 1;
}

static int coincide(const hr2di_vertex *p, const hr2di_vertex *q) {
  return (p->on & q->on) == HR2DI_ON_BOTH || (p->at.x == q->at.x && p->at.y == q->at.y);
}

size_t hr2di_line_trapezoids(const hr2di_line_frame *f, const hr2di_vertex *right,
                             size_t rights, const hr2di_vertex *left, size_t lefts,
                             hr2di_trapezoid *trapezoid) {
  size_t r = rights - 1, l = 0, count = 0;
  const ray end = ray_through(f, &right[0], &left[lefts - 1]);
  ray here = ray_through(f, &left[0], &right[r]), edge[2];
  int known[2] = {0, 0};
  while (r > 0 || l + 1 < lefts) {
    const int can_right = r > 0, can_left = l + 1 < lefts;
    if (can_right && coincide(&right[r - 1], &right[r])) {
      r--;
      continue;
    }
    if (can_left && coincide(&left[l], &left[l + 1])) {
      l++;
      continue;
    }
    if (can_right && !known[0]) edge[0] = ray_through(f, &right[r - 1], &right[r]);
    if (can_left && !known[1]) edge[1] = ray_through(f, &left[l], &left[l + 1]);
    const int by_left =
        !can_right || (can_left && hr2di_vector_cross(&edge[1].e, &edge[0].e) > 0);
    known[0] = can_right && by_left;
    known[1] = can_left && !by_left;
    const ray *next = &edge[by_left];
    if (make_trapezoid(f, &left[l], &right[r], &here, next, &trapezoid[count])) {
      count++;
      here = *next;
    }
    if (by_left)
      l++;
    else
      r--;
  }
  return count + (size_t)make_trapezoid(f, &left[l], &right[r], &here, &end, &trapezoid[count]);
}

/* m[0] p + m[1] q */
static hr2di_vector combine(const double m[2], const hr2di_vector e[2]) {
  const hr2di_vector p = hr2di_vector_times(&e[0], m[0]), q = hr2di_vector_times(&e[1], m[1]);
  return hr2di_vector_plus(&p, &q);
}

static void divide(const double m[2], const double whole[2], double left[2], double right[2]) {
  left[0] = whole[0];
  left[1] = right[0] = m[0] * whole[0] + m[1] * whole[1];
  right[1] = whole[1];
}

/* Between directions that are nearly opposite e is short: it is scaled by a power of two. */
void hr2di_trapezoid_divide(const hr2di_trapezoid *t, const double weight[2],
                            hr2di_trapezoid part[2]) {
  const hr2di_vector middle = combine(weight, t->e);
  const double scale = hr2di_vector_scale(&middle);
  const double m[2] = {scale * weight[0], scale * weight[1]};
  part[0] = part[1] = *t;
  part[0].e[1] = part[1].e[0] = hr2di_vector_scaled(&middle, scale);
  part[0].turn = m[1] * t->turn;
  part[1].turn = m[0] * t->turn;
  divide(m, t->gap, part[0].gap, part[1].gap);
  for (size_t k = 0; k < 2; k++) {
    hr2di_meeting *left = &part[0].on[k], *right = &part[1].on[k];
    divide(m, t->on[k].across, left->across, right->across);
    divide(m, t->on[k].start, left->start, right->start);
  }
}
