/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Doubles are integers in a common unit.  With as many digits as these integers have,
   orientations are exact, and crossed strings keep enough digits after cancellation. */
#include "independent/mpfr-exchange.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>

#define RN MPFR_RNDN

typedef struct vector {
  mpfr_t x, y;
} vector;

static void vector_init(vector *v, mpfr_prec_t precision) {
  mpfr_init2(v->x, precision);
  mpfr_init2(v->y, precision);
}

static void vector_clear(vector *v) {
  mpfr_clear(v->x);
  mpfr_clear(v->y);
}

static void vector_set(vector *v, hr2d_point p) {
  mpfr_set_d(v->x, p.x, RN);
  mpfr_set_d(v->y, p.y, RN);
}

/* The exponent of the last bit of x ≠ 0 that is 1. */
static int last_bit(double x) {
  const int top = ilogb(x);
  uint64_t digits = (uint64_t)ldexp(fabs(x), 52 - top);
  int bit = top - 52;
  for (; (digits & 1) == 0; digits >>= 1) bit++;
  return bit;
}

/* All coordinates are integers below 2^n in some common unit: returns n + 1. */
static mpfr_prec_t digits_of(const hr2d_point *points, int count) {
  int top = INT_MIN, last = INT_MAX;
  for (int k = 0; k < 2 * count; k++) {
    const double x = k & 1 ? points[k / 2].y : points[k / 2].x;
    if (x == 0) continue;
    if (ilogb(x) > top) top = ilogb(x);
    if (last_bit(x) < last) last = last_bit(x);
  }
  return top < last ? 2 : (mpfr_prec_t)(top - last) + 3;
}

/* d = (b−a)×(c−a) */
static void orient(mpfr_t d, const vector *a, const vector *b, const vector *c) {
  mpfr_t p, q, r;
  mpfr_inits2(mpfr_get_prec(d), p, q, r, (mpfr_ptr)0);
  mpfr_sub(p, b->x, a->x, RN);
  mpfr_sub(q, c->y, a->y, RN);
  mpfr_mul(r, p, q, RN);
  mpfr_sub(p, b->y, a->y, RN);
  mpfr_sub(q, c->x, a->x, RN);
  mpfr_mul(p, p, q, RN);
  mpfr_sub(d, r, p, RN);
  mpfr_clears(p, q, r, (mpfr_ptr)0);
}

static void distance(mpfr_t d, const vector *a, const vector *b) {
  mpfr_t p, q;
  mpfr_inits2(mpfr_get_prec(d), p, q, (mpfr_ptr)0);
  mpfr_sub(p, b->x, a->x, RN);
  mpfr_sub(q, b->y, a->y, RN);
  mpfr_sqr(p, p, RN);
  mpfr_sqr(q, q, RN);
  mpfr_add(p, p, q, RN);
  mpfr_sqrt(d, p, RN);
  mpfr_clears(p, q, (mpfr_ptr)0);
}

/* The point of ab where the height, ha at a and hb at b, is 0. */
static void horizon(vector *at, const vector *a, const vector *b, const mpfr_t ha,
                    const mpfr_t hb) {
  mpfr_t t, s;
  mpfr_inits2(mpfr_get_prec(at->x), t, s, (mpfr_ptr)0);
  mpfr_sub(t, ha, hb, RN);
  mpfr_div(t, ha, t, RN);
  mpfr_sub(s, b->x, a->x, RN);
  mpfr_mul(s, s, t, RN);
  mpfr_add(at->x, a->x, s, RN);
  mpfr_sub(s, b->y, a->y, RN);
  mpfr_mul(s, s, t, RN);
  mpfr_add(at->y, a->y, s, RN);
  mpfr_clears(t, s, (mpfr_ptr)0);
}

/* Cuts ab to the part of positive height; 0 if there is none. */
static int clip(vector *a, vector *b, const mpfr_t ha, const mpfr_t hb) {
  if (mpfr_sgn(ha) <= 0 && mpfr_sgn(hb) <= 0) return 0;
  if (mpfr_sgn(ha) < 0)
    horizon(a, a, b, ha, hb);
  else if (mpfr_sgn(hb) < 0)
    horizon(b, a, b, ha, hb);
  return 1;
}

static void strings(mpfr_t area, const vector p[4]) {
  mpfr_t s;
  mpfr_init2(s, mpfr_get_prec(area));
  distance(area, &p[0], &p[2]);
  distance(s, &p[1], &p[3]);
  mpfr_add(area, area, s, RN);
  distance(s, &p[0], &p[3]);
  mpfr_sub(area, area, s, RN);
  distance(s, &p[1], &p[2]);
  mpfr_sub(area, area, s, RN);
  mpfr_div_2ui(area, area, 1, RN);
  mpfr_clear(s);
}

void mpfr_exchange_area(mpfr_t area, const hr2d_segment *i, const hr2d_segment *j) {
  const hr2d_point points[4] = {i->a, i->b, j->a, j->b};
  /* In the common unit the determinants are integers and lengths are below 2^n,
     and AF is at least a product of two determinants over a few lengths cubed: it
     lies at most 4n + 6 bits below the strings. */
  const mpfr_prec_t precision = 4 * digits_of(points, 4) + 128;
  vector p[4];
  mpfr_t h[4];
  for (int k = 0; k < 4; k++) {
    vector_init(&p[k], precision);
    vector_set(&p[k], points[k]);
    mpfr_init2(h[k], precision);
  }
  mpfr_set_prec(area, precision);
  orient(h[0], &p[2], &p[3], &p[0]);
  orient(h[1], &p[2], &p[3], &p[1]);
  orient(h[2], &p[0], &p[1], &p[2]);
  orient(h[3], &p[0], &p[1], &p[3]);
  if (clip(&p[0], &p[1], h[0], h[1]) && clip(&p[2], &p[3], h[2], h[3]))
    strings(area, p);
  else
    mpfr_set_zero(area, 1);
  for (int k = 0; k < 4; k++) {
    vector_clear(&p[k]);
    mpfr_clear(h[k]);
  }
}

void mpfr_orient(mpfr_t det, hr2d_point a, hr2d_point b, hr2d_point c) {
  const hr2d_point points[3] = {a, b, c};
  vector p[3];
  mpfr_set_prec(det, 2 * digits_of(points, 3) + 8);
  for (int k = 0; k < 3; k++) {
    vector_init(&p[k], mpfr_get_prec(det));
    vector_set(&p[k], points[k]);
  }
  orient(det, &p[0], &p[1], &p[2]);
  for (int k = 0; k < 3; k++) vector_clear(&p[k]);
}

/* cos = n·(q−p)/(|n| r) with n the left normal of s, r = |pq|; 0 where negative. */
static void cosine(mpfr_t cos, const hr2d_segment *s, const vector *p, const vector *q,
                   const mpfr_t r) {
  vector a, b;
  mpfr_t t, length;
  const mpfr_prec_t precision = mpfr_get_prec(cos);
  vector_init(&a, precision);
  vector_init(&b, precision);
  mpfr_inits2(precision, t, length, (mpfr_ptr)0);
  vector_set(&a, s->a);
  vector_set(&b, s->b);
  distance(length, &a, &b);
  mpfr_sub(b.x, b.x, a.x, RN);
  mpfr_sub(b.y, b.y, a.y, RN);
  mpfr_sub(cos, q->y, p->y, RN);
  mpfr_mul(cos, cos, b.x, RN);
  mpfr_sub(t, q->x, p->x, RN);
  mpfr_mul(t, t, b.y, RN);
  mpfr_sub(cos, cos, t, RN);
  mpfr_div(cos, cos, length, RN);
  mpfr_div(cos, cos, r, RN);
  if (mpfr_sgn(cos) < 0) mpfr_set_zero(cos, 1);
  mpfr_clears(t, length, (mpfr_ptr)0);
  vector_clear(&a);
  vector_clear(&b);
}

void mpfr_kernel(mpfr_t kernel, const hr2d_segment *i, hr2d_point x, const hr2d_segment *j,
                 hr2d_point y) {
  const hr2d_point points[6] = {i->a, i->b, j->a, j->b, x, y};
  const mpfr_prec_t precision = 2 * digits_of(points, 6) + 128;
  vector p, q;
  mpfr_t r, cos;
  vector_init(&p, precision);
  vector_init(&q, precision);
  mpfr_inits2(precision, r, cos, (mpfr_ptr)0);
  mpfr_set_prec(kernel, precision);
  vector_set(&p, x);
  vector_set(&q, y);
  distance(r, &p, &q);
  cosine(kernel, i, &p, &q, r);
  cosine(cos, j, &q, &p, r);
  mpfr_mul(kernel, kernel, cos, RN);
  mpfr_div(kernel, kernel, r, RN);
  mpfr_div_2ui(kernel, kernel, 1, RN);
  mpfr_clears(r, cos, (mpfr_ptr)0);
  vector_clear(&p);
  vector_clear(&q);
}

void mpfr_distance(mpfr_t d, hr2d_point a, hr2d_point b) {
  const hr2d_point points[2] = {a, b};
  const mpfr_prec_t precision = digits_of(points, 2) + 128;
  vector p, q;
  vector_init(&p, precision);
  vector_init(&q, precision);
  mpfr_set_prec(d, precision);
  vector_set(&p, a);
  vector_set(&q, b);
  distance(d, &p, &q);
  vector_clear(&p);
  vector_clear(&q);
}

/* kernel ← kernel · (distance of p from the line of s, 0 behind it) */
static void times_height(mpfr_t kernel, const hr2d_segment *s, hr2d_point p) {
  mpfr_t det, length;
  mpfr_inits2(MPFR_PREC_MIN, det, length, (mpfr_ptr)0);
  mpfr_orient(det, s->a, s->b, p);
  mpfr_distance(length, s->a, s->b);
  if (mpfr_sgn(det) <= 0)
    mpfr_set_zero(kernel, 1);
  else {
    mpfr_mul(kernel, kernel, det, RN);
    mpfr_div(kernel, kernel, length, RN);
  }
  mpfr_clears(det, length, (mpfr_ptr)0);
}

void mpfr_kernel_of_lines(mpfr_t kernel, const hr2d_segment *i, hr2d_point x,
                          const hr2d_segment *j, hr2d_point y) {
  mpfr_t r;
  mpfr_init2(r, MPFR_PREC_MIN);
  mpfr_distance(r, x, y);
  mpfr_set_prec(kernel, 200);
  mpfr_set_d(kernel, 0.5, RN);
  for (int k = 0; k < 3; k++) mpfr_div(kernel, kernel, r, RN);
  times_height(kernel, i, y);
  times_height(kernel, j, x);
  mpfr_clear(r);
}

double mpfr_relative_error(double value, const mpfr_t reference) {
  mpfr_t e;
  mpfr_init2(e, mpfr_get_prec(reference));
  mpfr_sub_d(e, reference, value, RN);
  mpfr_div(e, e, reference, RN);
  const double error = fabs(mpfr_get_d(e, RN));
  mpfr_clear(e);
  return error;
}

double mpfr_double_error(double value, const mpfr_t reference) {
  const double size = mpfr_get_d(reference, RN);
  if (isnan(value)) return INFINITY;
  if (mpfr_zero_p(reference) || isinf(size)) return value == size ? 0 : INFINITY;
  if (fabs(size) < DBL_MIN) return fmax(fabs(value - size) - DBL_TRUE_MIN, 0) / DBL_MIN;
  return isinf(value) ? INFINITY : mpfr_relative_error(value, reference);
}
