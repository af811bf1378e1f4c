/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Let y be at the height h over the line of i, t the place on i from the foot of y, and p + q t
   the height of x over the line of j.  Then

     G = h (p + q t) / (2 (t² + h²)^(3/2)),   ∫ G dt = (p t/h − q h) / (2 √(t² + h²)),

   and G has its extremes at the roots of 2q t² + 3p t − q h². */
#include "independent/mpfr-l1.h"

#include <gsl/gsl_integration.h>
#include <math.h>
#include <mpfr.h>

#define RN MPFR_RNDN

enum { PIECES = 8, GRADING = 4, DEPTH = 60, MOST = 20000, STEPS = 200 };

typedef struct real2 {
  mpfr_t x, y;
} real2;

/* i in the frame that starts at its a; j from its b to its a, so that places near a common
   corner are small numbers. */
typedef struct work {
  real2 u, v, from;                           /* directions of i and j; from i.a to j.b */
  mpfr_t length_i, length_j;                  /* |u|, |v| */
  mpfr_t cross, centre;                       /* u × v, G at the centres */
  mpfr_t h, foot, p, q;                       /* of the present y */
  mpfr_t low, high;                           /* the part of i, in t, that sees it */
  mpfr_t a, b, c, d, e, f, g, middle, excess; /* scratch */
  mpfr_prec_t precision;
} work;

static mpfr_ptr *numbers_of(work *w, mpfr_ptr *number) {
  mpfr_ptr all[] = {w->u.x,    w->u.y,      w->v.x,      w->v.y,    w->from.x,
                    w->from.y, w->length_i, w->length_j, w->cross,  w->centre,
                    w->h,      w->foot,     w->p,        w->q,      w->low,
                    w->high,   w->a,        w->b,        w->c,      w->d,
                    w->e,      w->f,        w->g,        w->middle, w->excess};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) number[k] = all[k];
  number[sizeof all / sizeof *all] = NULL;
  return number;
}

static void set_difference(real2 *v, hr2d_point to, hr2d_point from) {
  mpfr_set_d(v->x, to.x, RN);
  mpfr_sub_d(v->x, v->x, from.x, RN);
  mpfr_set_d(v->y, to.y, RN);
  mpfr_sub_d(v->y, v->y, from.y, RN);
}

static void set_cross(mpfr_t z, const real2 *u, const real2 *v) {
  mpfr_fmms(z, u->x, v->y, u->y, v->x, RN);
}

/* y at the fraction t of j: h, foot, p and q. */
static void set_place(work *w, double t) {
  real2 *const v = &w->v, *const u = &w->u;
  mpfr_mul_d(w->a, v->x, t, RN);
  mpfr_add(w->a, w->a, w->from.x, RN);
  mpfr_mul_d(w->b, v->y, t, RN);
  mpfr_add(w->b, w->b, w->from.y, RN);
  mpfr_fmms(w->h, u->x, w->b, u->y, w->a, RN);
  mpfr_div(w->h, w->h, w->length_i, RN);
  mpfr_fmma(w->foot, u->x, w->a, u->y, w->b, RN);
  mpfr_div(w->foot, w->foot, w->length_i, RN);
  /* x − j.b = foot/|u| u − from + t u/|u|; its height over a ← b is −v × that. */
  mpfr_div(w->q, w->cross, w->length_i, RN);
  mpfr_div(w->q, w->q, w->length_j, RN);
  mpfr_mul(w->p, w->q, w->foot, RN);
  mpfr_fmms(w->c, w->from.x, v->y, w->from.y, v->x, RN);
  mpfr_div(w->c, w->c, w->length_j, RN);
  mpfr_sub(w->p, w->p, w->c, RN);
  mpfr_neg(w->low, w->foot, RN);
  mpfr_sub(w->high, w->length_i, w->foot, RN);
}

/* z = G(t); for t² + h² > 0 */
static void set_kernel(work *w, mpfr_t z, const mpfr_t t) {
  mpfr_fmma(w->a, t, t, w->h, w->h, RN);
  mpfr_sqrt(w->b, w->a, RN);
  mpfr_mul(w->a, w->a, w->b, RN);
  mpfr_mul(z, w->q, t, RN);
  mpfr_add(z, z, w->p, RN);
  mpfr_mul(z, z, w->h, RN);
  mpfr_div(z, z, w->a, RN);
  mpfr_div_2ui(z, z, 1, RN);
}

/* z = ∫ G − Gc up to t */
static void set_integral(work *w, mpfr_t z, const mpfr_t t) {
  mpfr_fmma(w->a, t, t, w->h, w->h, RN);
  mpfr_sqrt(w->a, w->a, RN);
  mpfr_mul_2ui(w->a, w->a, 1, RN);
  mpfr_div(w->b, t, w->h, RN);
  mpfr_fmms(z, w->p, w->b, w->q, w->h, RN);
  mpfr_div(z, z, w->a, RN);
  mpfr_mul(w->a, w->centre, t, RN);
  mpfr_sub(z, z, w->a, RN);
}

/* z = G(t) − Gc */
static void set_excess(work *w, mpfr_t z, const mpfr_t t) {
  set_kernel(w, z, t);
  mpfr_sub(z, z, w->centre, RN);
}

/* at[0] ≤ at[1] ≤ …: the ends of the visible part, and the extremes and roots between them. */
typedef struct places {
  mpfr_t at[8];
  int count;
} places;

static void insert(work *w, places *s, const mpfr_t t) {
  if (!mpfr_number_p(t) || mpfr_lessequal_p(t, w->low) || mpfr_greaterequal_p(t, w->high))
    return;
  int k = s->count++;
  for (; k > 0 && mpfr_greater_p(s->at[k - 1], t); k--) mpfr_set(s->at[k], s->at[k - 1], RN);
  mpfr_set(s->at[k], t, RN);
}

static void insert_extremes(work *w, places *s) {
  mpfr_mul_ui(w->d, w->p, 3, RN);
  mpfr_mul(w->e, w->q, w->h, RN);
  mpfr_sqr(w->e, w->e, RN);
  mpfr_mul_2ui(w->e, w->e, 3, RN);
  mpfr_sqr(w->f, w->d, RN);
  mpfr_add(w->e, w->e, w->f, RN);
  mpfr_sqrt(w->e, w->e, RN);
  if (mpfr_sgn(w->d) < 0) mpfr_neg(w->e, w->e, RN);
  mpfr_add(w->d, w->d, w->e, RN); /* 3p ± root, without cancellation */
  mpfr_sqr(w->f, w->h, RN);
  mpfr_mul(w->f, w->f, w->q, RN);
  mpfr_mul_2ui(w->f, w->f, 1, RN);
  mpfr_div(w->f, w->f, w->d, RN);
  insert(w, s, w->f);
  mpfr_div(w->f, w->d, w->q, RN);
  mpfr_div_2ui(w->f, w->f, 2, RN);
  mpfr_neg(w->f, w->f, RN);
  insert(w, s, w->f);
}

/* A root between two places, by regula falsi with the Illinois rule.  It stops where |G −
   Gc| is 2^-30 of its smaller value at the two places; the integral feels the square of
   this. */
static void insert_root(work *w, places *s, const mpfr_t from, const mpfr_t to) {
  mpfr_ptr low = w->d, high = w->e, at_low = w->f, at_high = w->g;
  mpfr_set(low, from, RN);
  mpfr_set(high, to, RN);
  set_excess(w, at_low, low);
  set_excess(w, at_high, high);
  if ((mpfr_sgn(at_low) > 0) == (mpfr_sgn(at_high) > 0)) return;
  const mpfr_exp_t enough =
      mpfr_cmpabs(at_low, at_high) < 0 ? mpfr_get_exp(at_low) : mpfr_get_exp(at_high);
  for (int k = 0; k < STEPS; k++) {
    mpfr_fmms(w->middle, at_low, high, at_high, low, RN);
    mpfr_sub(w->a, at_low, at_high, RN);
    mpfr_div(w->middle, w->middle, w->a, RN);
    set_excess(w, w->excess, w->middle);
    if (mpfr_zero_p(w->excess) || mpfr_get_exp(w->excess) < enough - 30) break;
    if ((mpfr_sgn(w->excess) > 0) == (mpfr_sgn(at_high) > 0)) {
      mpfr_div_2ui(at_low, at_low, 1, RN);
    } else {
      mpfr_swap(low, high);
      mpfr_swap(at_low, at_high);
    }
    mpfr_set(high, w->middle, RN);
    mpfr_set(at_high, w->excess, RN);
  }
  insert(w, s, w->middle);
}

/* Cuts low or high to where p + q t > 0; 0 if nothing is left. */
static int clip(work *w) {
  if (mpfr_zero_p(w->q)) return mpfr_sgn(w->p) > 0;
  mpfr_div(w->a, w->p, w->q, RN);
  mpfr_neg(w->a, w->a, RN);
  if (mpfr_sgn(w->q) > 0)
    mpfr_max(w->low, w->low, w->a, RN);
  else
    mpfr_min(w->high, w->high, w->a, RN);
  return mpfr_less_p(w->low, w->high);
}

/* ∫ |G − Gc| dx over i, relative to Gc |i|. */
static double inner(double t, void *params) {
  work *w = params;
  places s = {.count = 2};
  set_place(w, t);
  if (mpfr_sgn(w->h) <= 0 || !clip(w)) return 1;
  for (int k = 0; k < 8; k++) mpfr_init2(s.at[k], w->precision);
  mpfr_set(s.at[0], w->low, RN);
  mpfr_set(s.at[1], w->high, RN);
  insert_extremes(w, &s);
  const int pieces = s.count - 1;
  mpfr_t border[5], last, next, sum;
  mpfr_inits2(w->precision, last, next, sum, (mpfr_ptr)0);
  for (int k = 0; k <= pieces; k++) {
    mpfr_init2(border[k], w->precision);
    mpfr_set(border[k], s.at[k], RN);
  }
  for (int k = 0; k < pieces; k++) insert_root(w, &s, border[k], border[k + 1]);
  /* what i has behind the horizon of j */
  mpfr_sub(sum, w->length_i, w->high, RN);
  mpfr_add(sum, sum, w->low, RN);
  mpfr_mul(sum, sum, w->centre, RN);
  set_integral(w, last, s.at[0]);
  for (int k = 1; k < s.count; k++) {
    set_integral(w, next, s.at[k]);
    mpfr_sub(last, next, last, RN);
    mpfr_abs(last, last, RN);
    mpfr_add(sum, sum, last, RN);
    mpfr_swap(last, next);
  }
  mpfr_div(sum, sum, w->centre, RN);
  mpfr_div(sum, sum, w->length_i, RN);
  const double value = mpfr_get_d(sum, RN);
  for (int k = 0; k < 8; k++) mpfr_clear(s.at[k]);
  for (int k = 0; k <= pieces; k++) mpfr_clear(border[k]);
  mpfr_clears(last, next, sum, (mpfr_ptr)0);
  return value;
}

/* Directions, and G at the centres; 0 if that is 0. */
static int prepare(work *w, const hr2d_segment *i, const hr2d_segment *j) {
  set_difference(&w->u, i->b, i->a);
  set_difference(&w->v, j->a, j->b);
  set_difference(&w->from, j->b, i->a);
  mpfr_hypot(w->length_i, w->u.x, w->u.y, RN);
  mpfr_hypot(w->length_j, w->v.x, w->v.y, RN);
  set_cross(w->cross, &w->u, &w->v);
  set_place(w, 0.5);
  mpfr_add(w->d, w->low, w->high, RN);
  mpfr_div_2ui(w->d, w->d, 1, RN);
  mpfr_mul(w->e, w->q, w->d, RN);
  mpfr_add(w->e, w->e, w->p, RN);
  if (mpfr_sgn(w->h) <= 0 || mpfr_sgn(w->e) <= 0) return 0;
  set_kernel(w, w->centre, w->d);
  return 1;
}

/* Where y is on the line of i, or ½. */
static double horizon(work *w) {
  set_cross(w->a, &w->from, &w->u);
  mpfr_div(w->a, w->a, w->cross, RN);
  const double t = mpfr_get_d(w->a, RN);
  return t > 0 && t < 1 ? t : 0.5;
}

typedef struct interval {
  double low, high, value;
} interval;

static interval measure(work *w, double low, double high) {
  const gsl_function f = {inner, w};
  interval s = {.low = low, .high = high};
  double error, absolute, deviation;
  gsl_integration_qk21(&f, low, high, &s.value, &error, &absolute, &deviation);
  return s;
}

/* Halves until the halves agree with the whole: GSL's estimates of the error are for smooth
   functions, and fall below it where there are kinks. */
static double refine(work *w, interval whole, double tolerance) {
  interval stack[DEPTH];
  int count = 0, left = MOST;
  double sum = 0;
  stack[count++] = whole;
  while (count > 0) {
    const interval s = stack[--count];
    const double middle = 0.5 * (s.low + s.high);
    const interval low = measure(w, s.low, middle), high = measure(w, middle, s.high);
    const double halves = low.value + high.value;
    if (left-- < 0) return NAN;
    if (fabs(halves - s.value) <= tolerance || count > DEPTH - 3) {
      sum += halves;
      continue;
    }
    stack[count++] = low;
    stack[count++] = high;
  }
  return sum;
}

/* Pieces shrink towards both ends and the horizon, where corners, kinks and poles are. */
static double outer(work *w, double tolerance) {
  const double middle = horizon(w), border[4] = {0, middle, middle, 1};
  interval piece[4 * PIECES];
  double rough = 0, sum = 0;
  for (int k = 0; k < 4 * PIECES; k++) {
    const int part = k / PIECES, step = k % PIECES;
    const double from = border[part], half = 0.5 * (part < 2 ? middle : 1 - middle);
    const double near = step ? ldexp(half, GRADING * (step - PIECES)) : 0;
    const double far = ldexp(half, GRADING * (step + 1 - PIECES));
    piece[k] =
        part % 2 ? measure(w, from - far, from - near) : measure(w, from + near, from + far);
    rough += piece[k].value;
  }
  for (int k = 0; k < 4 * PIECES; k++) sum += refine(w, piece[k], 0.02 * tolerance * rough);
  return sum;
}

/* From the largest coordinate to the smallest, in bits. */
static int spread_of(const hr2d_segment *i, const hr2d_segment *j) {
  const double x[8] = {i->a.x, i->a.y, i->b.x, i->b.y, j->a.x, j->a.y, j->b.x, j->b.y};
  int top = -1100, last = 1100;
  for (int k = 0; k < 8; k++) {
    if (x[k] == 0) continue;
    top = ilogb(x[k]) > top ? ilogb(x[k]) : top;
    last = ilogb(x[k]) < last ? ilogb(x[k]) : last;
  }
  return top > last ? top - last : 0;
}

static double length(const hr2d_segment *s) {
  return hypot(s->b.x - s->a.x, s->b.y - s->a.y);
}

/* y lies on the shorter segment, so that the view of y changes on the scale of its own
   segment. */
double mpfr_l1(const hr2d_segment *i, const hr2d_segment *j, double tolerance) {
  if (length(j) > length(i)) return mpfr_l1(j, i, tolerance);
  work w;
  mpfr_ptr number[32];
  double value = NAN;
  w.precision = 256 + spread_of(i, j);
  for (mpfr_ptr *n = numbers_of(&w, number); *n; n++) mpfr_init2(*n, w.precision);
  if (prepare(&w, i, j)) {
    const double part = outer(&w, tolerance);
    mpfr_mul(w.a, w.centre, w.length_i, RN);
    mpfr_mul(w.a, w.a, w.length_j, RN);
    mpfr_mul_d(w.a, w.a, part, RN);
    value = mpfr_get_d(w.a, RN);
  }
  for (mpfr_ptr *n = numbers_of(&w, number); *n; n++) mpfr_clear(*n);
  return value;
}
