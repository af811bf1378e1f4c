/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The L¹ error of a pair as one integral over directions.

   Lengths are in units of the distance ρ of the centres.  Let x = x_c + s u and
   y = y_c + t v, and let the line from y to x make the angle δ with the line from y_c to
   x_c.  With θx, θy the angles at x and y, which only depend on δ,

     s cosθx + t cosθy = sin δ,   r dδ = cosθx ds  at fixed t,

   and r = h(t)/cosθx with h(t) the distance of y from the line of i.  Hence

     |G − Gc| ds dt = |½ cosθy − Gc h(t)/cos²θx| dδ dt
                    = ½ cosθy_c |γ(δ) − κ t| / (1+α)² dδ dt,

   where 1+α = cosθx/cosθx_c, 1+β = cosθy/cosθy_c, γ = (1+α)²(1+β) − 1 and
   h(t)/h(0) = 1 + κt.  For fixed δ the integrand is the absolute value of a linear
   function of t, so that no root has to be found inside; and with τ = tan(δ/2) the
   integral over t is a rational function of τ between few breakpoints.  There is no
   singularity at a shared corner, and nothing cancels for small or distant pairs:

     sin δ = 2τ/(1+τ²),   α = −(τ + tanθx_c) sin δ,   β = −(τ + tanθy_c) sin δ.

   Where directions are far from the line of the centres or a pole is close to an end of the
   range, the range is split in two and τ is measured from the end of each half: an integrand
   with a pole close to an end needs nodes close to it. */
#include "oracle/l1.h"

#include <gsl/gsl_integration.h>
#include <math.h>

#include "geometry/exchange-area-scaled.h"
#include "geometry/predicates.h"
#include "oracle/l1-frame.h"

enum {
  PIECES = 80,
  GRADING = 5, /* growth of pieces away from a pole; a 15-point rule is then good to 1e-11 */
  DEPTH = 60,  /* of bisection */
  MOST_INTERVALS = 2000 /* intervals of one piece, where noise keeps the error estimates high */
};

#define TOLERANCE 1e-12  /* of one interval, relative to the whole */
#define NEAREST   1e-15  /* a nearer pole cannot be distinguished from the end */
#define NEAR      0.05   /* of AF + Gc A_x A_y; an error above it is not small */
#define FLAT      1e-140 /* a pair with a cosine below it gets the bound AF + Gc A_x A_y */

/* The mean of |f| over an interval, where f is linear with values p and q at the ends. */
static inline double mean_absolute(double p, double q) {
  if ((p >= 0) == (q >= 0)) return 0.5 * fabs(p + q);
  const double part = p / (p - q);
  return 0.5 * fabs(p * part + q * (part - 1));
}

/* The mean of max(−f, 0) for the same f. */
static inline double mean_below(double p, double q) {
  if (p >= 0 && q >= 0) return 0;
  if (p <= 0 && q <= 0) return -0.5 * (p + q);
  return p < 0 ? 0.5 * p * (p / (q - p)) : 0.5 * q * (q / (p - q));
}

/* The integral over t of |G − Gc| (mean_absolute) or of (Gc − G)⁺ (mean_below). */
static inline double integral_over_t(const hr2di_l1_frame *f, double tau,
                                     double (*mean_of)(double, double)) {
  const hr2di_l1_direction d = hr2di_l1_direction_at(f, tau);
  const double cos_x = f->x.cosine * d.above_a, cos_y = f->y.cosine * d.above_b;
  if (!(cos_x > 0 && cos_y > 0)) return 0;
  const double first = (d.sine - f->x.high * cos_x) / cos_y;
  const double last = (d.sine - f->x.low * cos_x) / cos_y;
  const double low = first > f->y.low ? first : f->y.low;
  const double high = last < f->y.high ? last : f->y.high;
  if (!(low < high)) return 0;
  const double gamma = hr2di_l1_cubic(d.a, d.b), slope = f->y.slope;
  const double mean = mean_of(gamma - slope * low, gamma - slope * high);
  return d.weight * ((high - low) * f->per_length) * (mean * f->per_range) /
         (d.above_a * d.above_a);
}

static double integrand(double tau, void *params) {
  return integral_over_t(params, tau, mean_absolute);
}

static double integrand_below(double tau, void *params) {
  return integral_over_t(params, tau, mean_below);
}

typedef struct interval {
  double low, high, value, error;
} interval;

static interval measure(const gsl_function *function, double low, double high) {
  interval s = {.low = low, .high = high};
  double absolute, deviation;
  gsl_integration_qk15(function, low, high, &s.value, &s.error, &absolute, &deviation);
  return s;
}

/* Bisects until each interval is good to the tolerance. */
static double refine(gsl_function function, interval whole, double tolerance) {
  interval stack[DEPTH + 1];
  int count = 1, measured = 1;
  double sum = 0;
  stack[0] = whole;
  while (count > 0) {
    const interval s = stack[--count];
    const double middle = 0.5 * (s.low + s.high);
    if (!(s.error > tolerance) || count == DEPTH - 1 || measured >= MOST_INTERVALS) {
      sum += s.value;
      continue;
    }
    stack[count++] = measure(&function, s.low, middle);
    stack[count++] = measure(&function, middle, s.high);
    measured += 2;
  }
  return sum;
}

/* Whether a sum of 15-point rules decides on which side of epsilon the integral is.  GSL's
   estimate of the error of these rules is a generous one. */
static int decided(double value, double error, double epsilon) {
  return fabs(value - epsilon) > 10 * error + 1e-10 * value;
}

/* The pieces between the breaks of one or two ranges; each range has its own origin. */
typedef struct pieces {
  hr2di_l1_frame frame[2];
  interval piece[PIECES];
  hr2di_l1_frame *owner[PIECES];
  int count;
  double sum, error;
} pieces;

static void add_piece(pieces *p, hr2di_l1_frame *f, double low, double high) {
  const gsl_function function = {integrand, f};
  const interval s = measure(&function, low, high);
  p->piece[p->count] = s;
  p->owner[p->count++] = f;
  p->sum += s.value;
  p->error += s.error;
}

/* The distance, in τ, from the end of the range to the next pole of the integrand beyond it.  0
   if none is near, and at a horizon, where the integrand vanishes with the range of t. */
static double pole_beyond(const hr2di_l1_origin *o) {
  const double a = 0.5 * o->above_a / fabs(o->derivative_a);
  const double b = 0.5 * o->above_b / fabs(o->derivative_b);
  const double far_a = a > NEAREST ? a : 1, far_b = b > NEAREST ? b : 1;
  const double pole = far_a < far_b ? far_a : far_b;
  return pole < 0.25 ? pole : 0;
}

/* Adds pieces that grow with their distance from the pole, away from the end at τ = 0. */
static void add_graded(pieces *p, hr2di_l1_frame *f, double low, double high) {
  const double pole = pole_beyond(&f->origin), sign = high > 0 ? 1 : -1;
  double near = sign > 0 ? low : -high, far = sign > 0 ? high : -low;
  while (near < far) {
    const double grown = pole > 0 ? GRADING * fmax(near, pole) : far;
    const double next = grown < far && p->count < PIECES - HR2DI_L1_BREAKS ? grown : far;
    add_piece(p, f, sign > 0 ? near : -next, sign > 0 ? next : -near);
    near = next;
  }
}

/* Splits the range at its middle and measures τ from the end of each half. */
static void split_range(pieces *p, double low, double high) {
  hr2di_l1_frame *f = p->frame, middle = p->frame[0];
  hr2di_l1_turn_to_angle(&middle, atan(low) + atan(high));
  f[0] = f[1] = middle;
  hr2di_l1_turn_to_line(&f[0], f->x.low, f->y.low);
  hr2di_l1_turn_to_line(&f[1], f->x.high, f->y.high);
  double at[HR2DI_L1_BREAKS];
  const int last = hr2di_l1_breaks(&middle, at) - 1;
  const double first = at[0], end = at[last];
  for (int k = 0; k < last; k++) {
    const double from = at[k], to = at[k + 1], stop = fmin(to, 0), start = fmax(from, 0);
    if (from < 0)
      add_graded(p, &f[0], (from - first) / (1 + from * first),
                 (stop - first) / (1 + stop * first));
    if (to > 0)
      add_graded(p, &f[1], (start - end) / (1 + start * end), (to - end) / (1 + to * end));
  }
}

/* Whether a pole is close to an end of the range. */
static int is_steep(const hr2di_l1_frame *f, double tau, double range) {
  const hr2di_l1_direction d = hr2di_l1_direction_at(f, tau);
  const double min = NEAREST * range, max = 0.1 * range;
  const double a = d.above_a / (1 + fabs(f->x.tangent)),
               b = d.above_b / (1 + fabs(f->y.tangent));
  return (a > min && a < max) || (b > min && b < max);
}

static void measure_pieces(pieces *p) {
  hr2di_l1_frame *f = p->frame;
  const double low = hr2di_l1_tau(f, f->x.low, f->y.low);
  const double high = hr2di_l1_tau(f, f->x.high, f->y.high), range = high - low;
  f->per_length = fmin(1 / f->length_y, 1e300);
  if (low < -0.5 || high > 0.5 || is_steep(f, low, range) || is_steep(f, high, range)) {
    split_range(p, low, high);
    return;
  }
  f->per_range = fmin(1 / range, 1e300);
  double at[HR2DI_L1_BREAKS];
  const int count = hr2di_l1_breaks(f, at);
  for (int k = 0; k + 1 < count; k++) add_piece(p, f, at[k], at[k + 1]);
}

/* Where x is much longer than y, or the angles are flat, places near a corner are seen at all
   angles, between bounds of t that come from s and cancel.  There G is above Gc.  Since
   ∫∫ G = AF is known to all its digits,

     ∫∫ |G − Gc| = AF − Gc A_x A_y + 2 ∫∫ (Gc − G)⁺,

   and such places add nothing to the last term.  Nothing cancels in the sum unless the error is
   small beside AF + Gc A_x A_y, as it is for small and distant pairs. */
static double from_area(pieces *p, double area, double outside, double factor, double spread,
                        double tolerance) {
  double below = outside;
  for (int k = 0; k < p->count; k++) {
    const gsl_function function = {integrand_below, p->owner[k]};
    const interval s = measure(&function, p->piece[k].low, p->piece[k].high);
    below += refine(function, s, tolerance);
  }
  return (area - spread) + 2 * factor * below;
}

/* Whether bounds of t that come from s keep their digits. */
static int is_square(const hr2di_l1_frame *f) {
  return f->length_x < 64 * f->length_y && f->x.cosine > 0.05 && f->y.cosine > 0.05;
}

/* Whether the error is not small beside AF + Gc A_x A_y.  If so, *area becomes AF, by formulas
   whose bits do not depend on the scale. */
static int is_large(const hr2d_segment *i, const hr2d_segment *j, const hr2di_l1_frame *f,
                    double rough, double spread, double *area) {
  if (is_square(f) && !(rough > 2 * NEAR * spread)) return 0;
  *area = hr2di_exchange_area_scaled(i, j);
  return fmax(rough, fabs(*area - spread)) > NEAR * (*area + spread);
}

/* The error; with epsilon ≥ 0, any value on the same side of epsilon as the error. */
static double integrate(pieces *p, const hr2d_segment *i, const hr2d_segment *j,
                        double epsilon) {
  const hr2di_l1_frame *f = p->frame;
  const double unit = 0.5 * f->y.cosine * f->distance, whole = f->length_x * f->length_y;
  const double spread = unit * f->x.cosine * whole;
  measure_pieces(p);
  /* Where one point is behind the other segment, |G − Gc| = Gc. */
  const double hidden = whole - (f->x.high - f->x.low) * (f->y.high - f->y.low);
  const double outside = f->x.cosine * hidden * f->per_length * f->per_range;
  const double factor = unit / f->per_length / f->per_range, max = epsilon / factor;
  const double rough = outside + p->sum;
  if (epsilon >= 0 && is_square(f) && decided(rough, p->error, max)) return factor * rough;
  double area;
  if (is_large(i, j, f, factor * rough, spread, &area))
    return from_area(p, area, outside, factor, spread,
                     TOLERANCE * fmax(rough, fabs(area - spread) / factor));
  double total = outside;
  for (int k = 0; k < p->count; k++) {
    const gsl_function function = {integrand, p->owner[k]};
    total += refine(function, p->piece[k], TOLERANCE * rough);
  }
  return factor * total;
}

static double value_of(const hr2d_segment *i, const hr2d_segment *j, double epsilon) {
  pieces p;
  hr2di_l1_frame *f = p.frame;
  p.count = 0;
  p.sum = p.error = 0;
  if (!hr2di_l1_in_order(i, j)) {
    const hr2d_segment *other = i;
    i = j;
    j = other;
  }
  if (!hr2di_l1_frame_init(i, j, f)) {
    if (f->distance == 0 && hr2di_facing_of(i, j) != HR2DI_FACING_NONE) return INFINITY;
    return hr2d_exchange_area(i, j);
  }
  if (f->x.cosine < FLAT || f->y.cosine < FLAT)
    return hr2d_exchange_area(i, j) +
           0.5 * f->x.cosine * f->y.cosine * f->length_x * (f->length_y * f->distance);
  return integrate(&p, i, j, epsilon);
}

double hr2di_l1(const hr2d_segment *i, const hr2d_segment *j) {
  const double value = value_of(i, j, -1);
  return value >= 0 ? value : INFINITY; /* beyond the range of a double */
}

int hr2di_l1_accept(const hr2d_segment *i, const hr2d_segment *j, double scale,
                    double epsilon) {
  const hr2di_l1_range range = hr2di_l1_bounds(i, j);
  if (scale * range.high <= epsilon) return 1;
  if (scale * range.low > epsilon) return 0;
  return scale * value_of(i, j, epsilon / scale) <= epsilon;
}
