/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Up to 1 Ki_n is the n-fold integral of the series of K₀, beyond it e^−x/√(x+1) times a
   polynomial.  GSL has no Ki_n. */
#include "base/bickley.h"

#include <math.h>

#include "base/bickley-tables.h"

#define QUARTER_PI   0.78539816339744830962
#define FOUR_OVER_PI 1.27323954473516268615

/* e^−x is 0 beyond. */
#define BLACK 745

static double polynomial(const double *c, int degree, double x) {
  double sum = c[degree];
  for (int k = degree - 1; k >= 0; k--) sum = sum * x + c[k];
  return sum;
}

/* Ki_n beyond 1 */
static double far(const double table[PIECES][DEGREE + 1], double x) {
  if (x > BLACK) return 0;
  const int k = x < 4 ? (x < 2 ? 0 : 1) : x < 16 ? (x < 8 ? 2 : 3) : x < 64 ? 4 : 5;
  const double s = 1 / (x + 1);
  return exp(-x) * sqrt(s) * polynomial(table[k], DEGREE, (s - middle[k]) * scale[k]);
}

/* What Ki_n has up to 1 beyond its polynomial of degree n − 1, without its factor (−x)^n. */
static double near(const double *logs, const double *rest, double x) {
  const double square = x * x;
  return polynomial(rest, SERIES - 1, square) - log(x) * polynomial(logs, SERIES - 1, square);
}

double hr2di_bickley_2(double x) {
  if (x > 1) return far(far_2, x);
  return x > 0 ? 1 - x * (2 * QUARTER_PI - x * near(log_2, rest_2, x)) : 1;
}

/* π/4 − Ki₃, for 0 < x ≤ 1. */
static double lost_3(double x) {
  return x * (1 - x * (QUARTER_PI - x * near(log_3, rest_3, x)));
}

double hr2di_bickley_3(double x) {
  if (x > 1) return far(far_3, x);
  return x > 0 ? QUARTER_PI - lost_3(x) : QUARTER_PI;
}

double hr2di_bickley_4(double x) {
  if (x > 1) return far(far_4, x);
  if (!(x > 0)) return 2. / 3;
  return 2. / 3 -
         x * (QUARTER_PI - x * (0.5 - x * (QUARTER_PI / 3 - x * near(log_4, rest_4, x))));
}

static hr2di_passage arriving(double part) {
  return (hr2di_passage){part, 1 - part};
}

static hr2di_passage absorbing(double part) {
  return (hr2di_passage){1 - part, part};
}

hr2di_passage hr2di_passage_at(hr2d_section section, double x) {
  if (!(x > 0)) return arriving(1);
  if (section == HR2D_SECTION_FLAT) return x < 0.5 ? absorbing(-expm1(-x)) : arriving(exp(-x));
  return x > 1 ? arriving(FOUR_OVER_PI * far(far_3, x)) : absorbing(FOUR_OVER_PI * lost_3(x));
}

hr2di_passage hr2di_passage_of_mean(hr2d_section section, double x) {
  if (section == HR2D_SECTION_FLAT || !(x > 0)) return hr2di_passage_at(section, x);
  if (x > 1) return arriving(far(far_2, x));
  return absorbing(x * (2 * QUARTER_PI - x * near(log_2, rest_2, x)));
}

/* Gauss rules of 2, 3, 4 and 6 points on [0,1]. */
static const double node[4][6] = {{0.21132486540518711775, 0.78867513459481288225},
                                  {0.11270166537925831148, 0.5, 0.88729833462074168852},
                                  {0.069431844202973712388, 0.33000947820757186760,
                                   0.66999052179242813240, 0.93056815579702628761},
                                  {0.033765242898423986094, 0.16939530676686774317,
                                   0.38069040695840154568, 0.61930959304159845432,
                                   0.83060469323313225683, 0.96623475710157601391}};
static const double weight[4][6] = {
    {0.5, 0.5},
    {0.27777777777777777778, 0.44444444444444444444, 0.27777777777777777778},
    {0.17392742256872692869, 0.32607257743127307131, 0.32607257743127307131,
     0.17392742256872692869},
    {0.085662246189585172520, 0.18038078652406930378, 0.23395696728634552369,
     0.23395696728634552369, 0.18038078652406930378, 0.085662246189585172520}};
static const int nodes[4] = {2, 3, 4, 6};

/* By the width, and as a part of the distance from the x³ ln x at 0. */
static int rule_for(double width, double part) {
  return width < 2e-4 && part < 1e-3   ? 0
         : width < 0.01 && part < 0.02 ? 1
         : width < 0.1 && part < 0.08  ? 2
                                       : 3;
}

/* Narrow means: differences would cancel. */
static hr2di_passage mean_by_rule(hr2d_section section, double low, double width, int rule) {
  hr2di_passage sum = {0, 0};
  for (int k = 0; k < nodes[rule]; k++) {
    const hr2di_passage p = hr2di_passage_at(section, low + width * node[rule][k]);
    sum.arrives += weight[rule][k] * p.arrives;
    sum.absorbed += weight[rule][k] * p.absorbed;
  }
  return sum;
}

/* x⁴ times what Ki₄ has beyond its cubic. */
static double quartic(double x) {
  return x > 0 ? x * x * (x * x * near(log_4, rest_4, x)) : 0;
}

/* Wide means up to 1: the polynomials of Ki₄ are divided by the width by hand. */
static hr2di_passage mean_near(double low, double high) {
  const double squares = low * low + low * high + high * high;
  const double rest = (quartic(high) - quartic(low)) / (high - low);
  return absorbing(FOUR_OVER_PI * (0.5 * (low + high) - QUARTER_PI / 3 * squares + rest));
}

hr2di_passage hr2di_passage_mean(hr2d_section section, double x, double y) {
  const double low = fmin(x, y), high = fmax(x, y), width = high - low;
  if (section == HR2D_SECTION_FLAT)
    return width < 0.5 ? mean_by_rule(section, low, width, rule_for(width, 0))
                       : arriving(exp(-low) * (-expm1(-width) / width));
  if (high <= 1 && 4 * width >= high && high > 0) return mean_near(low, high);
  if (width < 0.5 && 3 * width < low)
    return mean_by_rule(section, low, width, rule_for(width, width / low));
  if (!(width > 0)) return hr2di_passage_at(section, low);
  return arriving(FOUR_OVER_PI * (hr2di_bickley_4(low) - hr2di_bickley_4(high)) / width);
}
