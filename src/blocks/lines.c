/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trapezoids of one class of lines.

   As the direction e turns left, the vertex of the left chain with the largest offset z × e
   moves on along that chain, and the vertex of the right chain with the smallest offset moves
   back. Events are the directions of the edges of both chains, which come in their order. */
#include "blocks/lines.h"

#include "blocks/line-vector.h"

/* A direction where trapezoids begin or end; |e| is between 1 and 3. */
typedef struct ray {
  hr2di_vector e;
  double across_i, across_j, length;
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
  const hr2di_vector way = direction(f, p, q);
  ray r = {.e = hr2di_vector_times(&way, hr2di_vector_scale(&way))};
  if (!(both & HR2DI_ON_I)) r.across_i = not_negative(hr2di_vector_cross(&f->u, &r.e));
  if (!(both & HR2DI_ON_J)) r.across_j = not_negative(hr2di_vector_cross(&r.e, &f->v));
  r.length = hr2di_vector_length(&r.e);
  return r;
}

/* Sets what belongs to end k of a trapezoid.  With a vertex on i the place there is known, and
   the other place is off by gap / across_i; the same on j. */
static void set_end(const hr2di_line_frame *f, const hr2di_vertex *low,
                    const hr2di_vertex *high, const ray *r, size_t k, hr2di_trapezoid *t) {
  const hr2di_vector between = hr2di_vector_minus(&high->at, &low->at);
  double gap = not_negative(hr2di_vector_cross(&between, &r->e)), start;
  t->e[k] = r->e;
  t->across_i[k] = r->across_i;
  t->across_j[k] = r->across_j;
  if (!t->turns_i) gap = (high->s - low->s) * r->across_i;
  if (!t->turns_j) gap = (low->t - high->t) * r->across_j;
  gap = fmin(not_negative(gap), fmin(r->across_i, r->across_j));
  t->gap[k] = gap;
  if (low->on & HR2DI_ON_I) {
    start = low->s * r->across_i;
  } else if (high->on & HR2DI_ON_I) {
    start = high->s * r->across_i - gap;
  } else {
    const hr2di_vector from = hr2di_vector_minus(&low->at, &f->a);
    start = hr2di_vector_cross(&from, &r->e);
  }
  t->start_i[k] = fmin(not_negative(start), r->across_i - gap);
  if (high->on & HR2DI_ON_J) {
    start = high->t * r->across_j;
  } else if (low->on & HR2DI_ON_J) {
    start = low->t * r->across_j - gap;
  } else {
    const hr2di_vector from = hr2di_vector_minus(&high->at, &f->c);
    start = hr2di_vector_cross(&r->e, &from);
  }
  t->start_j[k] = fmin(not_negative(start), r->across_j - gap);
}

/* Makes the trapezoid between two rays; returns 0 if they do not differ, or not that way. */
static int make_trapezoid(const hr2di_line_frame *f, const hr2di_vertex *low,
                          const hr2di_vertex *high, const ray *from, const ray *to,
                          hr2di_trapezoid *t) {
  t->turn = hr2di_vector_cross(&from->e, &to->e);
  if (!(t->turn > 0)) return 0;
  t->turns_i = !(low->on & high->on & HR2DI_ON_I);
  t->turns_j = !(low->on & high->on & HR2DI_ON_J);
  set_end(f, low, high, from, 0, t);
  set_end(f, low, high, to, 1, t);
  /* ∫ z × e dθ = z·(e0 − e1) for unit vectors. */
  const hr2di_vector z = hr2di_vector_minus(&high->at, &low->at);
  const double x = from->e.x / from->length - to->e.x / to->length;
  const double y = from->e.y / from->length - to->e.y / to->length;
  t->area = not_negative(0.5 * (z.x * x + z.y * y));
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

void hr2di_trapezoid_divide(const hr2di_trapezoid *t, const double m[2],
                            hr2di_trapezoid part[2]) {
  part[0] = part[1] = *t;
  part[0].e[1] = part[1].e[0] = combine(m, t->e);
  part[0].turn = m[1] * t->turn;
  part[1].turn = m[0] * t->turn;
  divide(m, t->across_i, part[0].across_i, part[1].across_i);
  divide(m, t->across_j, part[0].across_j, part[1].across_j);
  divide(m, t->gap, part[0].gap, part[1].gap);
  divide(m, t->start_i, part[0].start_i, part[1].start_i);
  divide(m, t->start_j, part[0].start_j, part[1].start_j);
}
