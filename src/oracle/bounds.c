/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oracle `bounds`: the range of the kernel over a pair, times its lengths (Lischinski,
   Smits and Greenberg, 1994).

   In the frame of l1-frame.h

     G/Gc = (1 + κs)(1 + λt)/r³

   with s and t along the elements and r the distance of their points.  G has no extreme inside
   of the rectangle of s and t: it is homogeneous of degree −1 about the point where the lines
   of the elements meet, so that its derivative along the way there is not 0 where G is not; if
   the lines are parallel, G is a function of s and t along which it is constant, and takes each
   value on an edge, too.  On an edge, with t fixed and p from y to the place s = 0,

     r² = p² + 2qs + s²,   q = p·u,   dG/ds = 0  ⟺  2κs² + (3 + κq)s + 3q − κp² = 0,

   whose discriminant is at least 9(1 − κq)². */
#include <hr2d/oracle.h>
#include <math.h>

#include "oracle/built-in.h"
#include "oracle/l1-frame.h"

/* Where r is below a tenth of the distances that it is a sum of, it has lost digits; the kernel
   is large there, and the other bound is the lower one. */
#define NEAR2 0.01

#define SLACK 1e-11 /* of the largest kernel, above the rounding errors of the range */

/* G/Gc */
typedef struct range {
  double low, high;
} range;

/* One of the points is fixed: `px, py` leads from it to the middle of the other's element, or
   back, `ux, uy` along that element. */
typedef struct edge {
  const hr2di_l1_side *side;
  double px, py, ux, uy;
  double height; /* 1 + κs of the fixed point */
  double size2;  /* 1 + t² */
} edge;

static void add_place(const edge *e, double s, range *r) {
  const double x = e->px + s * e->ux, y = e->py + s * e->uy, r2 = x * x + y * y;
  const double height = fmax(1 + e->side->slope * s, 0);
  const double value = r2 > NEAR2 * (e->size2 + s * s)
                           ? fmax(e->height, 0) * height / (r2 * sqrt(r2))
                           : INFINITY;
  r->low = fmin(r->low, value);
  r->high = fmax(r->high, value);
}

static void add_inside(const edge *e, double s, range *r) {
  if (s > e->side->low && s < e->side->high) add_place(e, s, r);
}

static void add_edge(const edge *e, range *r) {
  const double k = e->side->slope, p2 = e->px * e->px + e->py * e->py;
  const double q = e->px * e->ux + e->py * e->uy;
  const double b = 3 + k * q, c = 3 * q - k * p2, root = sqrt(fmax(b * b - 8 * k * c, 0));
  const double w = -0.5 * (b + copysign(root, b));
  add_place(e, e->side->low, r);
  add_place(e, e->side->high, r);
  add_inside(e, w / (2 * k), r);
  add_inside(e, c / w, r);
}

/* The line from y at t to x at s is (1 + s·along_x − t·along_y, s·cos_x + t·cos_y). */
static range range_of(const hr2di_l1_frame *f) {
  const hr2di_l1_side *x = &f->x, *y = &f->y;
  range r = {1, 1};
  for (int k = 0; k < 2; k++) {
    const double s = k ? x->high : x->low, t = k ? y->high : y->low;
    const edge along_x = {x,         1 - t * y->along, t * y->cosine, x->along,
                          x->cosine, 1 + y->slope * t, 1 + t * t};
    const edge along_y = {y,         1 + s * x->along, s * x->cosine, -y->along,
                          y->cosine, 1 + x->slope * s, 1 + s * s};
    add_edge(&along_x, &r);
    add_edge(&along_y, &r);
  }
  return r;
}

/* What is hidden has the kernel 0.  Gc and G are between the ends of the range, and
   ∫∫ |Gc − G V| is at most the sum of both integrals. */
static double bound_of(const hr2d_segment *i, const hr2d_segment *j, int partial) {
  hr2di_l1_frame f;
  if (!hr2di_l1_in_order(i, j)) {
    const hr2d_segment *other = i;
    i = j;
    j = other;
  }
  if (!hr2di_l1_frame_init(i, j, &f)) {
    const double area = hr2d_exchange_area(i, j);
    return f.distance == 0 && area > 0 ? INFINITY : area;
  }
  const double spread = 0.5 * f.x.cosine * f.y.cosine * f.length_x * (f.length_y * f.distance);
  const range r = range_of(&f);
  const double ranged = spread * (r.high * (1 + SLACK) - (partial ? 0 : r.low));
  if (ranged <= spread) return ranged;
  const double both = (hr2d_exchange_area(i, j) + spread) * (1 + SLACK);
  return ranged < both ? ranged : both;
}

static hr2d_status estimate_bounds(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_element *x = &batch->elements[batch->pairs[k].first];
    const hr2d_element *y = &batch->elements[batch->pairs[k].second];
    const hr2d_segment i = {x->a, x->b}, j = {y->a, y->b};
    const double bound = bound_of(&i, &j, batch->partial && batch->partial[k]);
    error[k] = bound >= 0 ? batch->unit * bound : INFINITY; /* beyond the range of a double */
  }
  return HR2D_OK;
}

static const hr2d_oracle oracle_bounds = {HR2DI_BUILT_IN("bounds", HR2D_ORACLE_SYMMETRIC),
                                          .estimate = estimate_bounds};

const hr2d_oracle *hr2d_oracle_bounds(void) {
  return &oracle_bounds;
}
