/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The black body: σT⁴, and its part between two wavelengths.

   With x = c₂/(λT) the part below λ is tail(x) = (15/π⁴) ∫_x^∞ g, g = u³/(eᵘ − 1), and that
   above it is head(x) = (15/π⁴) ∫_0^x g = (5/π⁴) x³ D₃(x), with Debye's function.  Expanding
   1/(eᵘ − 1) in powers of e⁻ᵘ gives

     tail(x) = (15/π⁴) Σ_{n≥1} e^{-nx} (x³/n + 3x²/n² + 6x/n³ + 6/n⁴),

   whose terms are positive and fall by e^{-x} at least.

   Errors.  x has three roundings, which e^{-x} raises to 3x/2 units of 2^-52; sums of positive
   terms, D₃ and powers add some units.  Differences of tails above 4, or of heads below 4, lose
   no more than a factor of 8, since they are taken over widths above 1 only.  Over a width
   h ≤ 1 a Gauss rule of 12 points integrates g itself, which is analytic but at 2πin, n ≠ 0.
   The Bernstein ellipse of parameter 11/h has half axes below 3: it stays away from those
   poles, and g is at most some 1000/h² times its mean there.  The rule misses (11/h)^-24 <
   1e-24 of that. */
#include "base/black-body.h"

#include <gsl/gsl_sf_debye.h>
#include <hr2d/thermal.h>
#include <math.h>

#include "base/legendre.h"

/* 15/π⁴, rounded. */
#define SCALE 0.15398973382026504

/* Above this x the part is summed by its tail. */
#define MIDDLE 4

enum { POINTS = 12 };

double hr2d_black_body(double kelvin) {
  const double square = kelvin * kelvin;
  return HR2D_STEFAN_BOLTZMANN * (square * square);
}

/* x ≥ 4: ten terms leave less than e^{-40}. */
static double tail(double x) {
  double sum = 0;
  if (!(x < HUGE_VAL)) return 0;
  for (int n = 10; n > 0; n--)
    sum += exp(-n * x) * (x * (x * (x + 3. / n) + 6. / (n * n)) + 6. / (n * n * n)) / n;
  return SCALE * sum;
}

/* 0 ≤ x ≤ 4, where no call of gsl_sf_debye_3() fails. */
static double head(double x) {
  return SCALE / 3 * (x * x * x * gsl_sf_debye_3(x));
}

/* u³/(eᵘ − 1) = u³ e⁻ᵘ/(1 − e⁻ᵘ), which stays finite. */
static double spectrum(double u) {
  return u > 0 ? u * u * u * exp(-u) / -expm1(-u) : 0;
}

static double narrow(double x, double width) {
  hr2di_rule rule;
  double mean = 0;
  hr2di_rule_init(&rule, POINTS);
  for (size_t q = 0; q < rule.points; q++)
    mean += rule.weight[q] * spectrum(x + width * (0.5 + 0.5 * rule.at[q]));
  return SCALE * width * mean;
}

double hr2d_black_body_part(double kelvin, double from, double to) {
  if (!(kelvin >= 0 && kelvin < HUGE_VAL && from >= 0 && from <= to)) return NAN;
  if (from == to) return 0;
  const double x = HR2D_SECOND_RADIATION_CONSTANT * 1e6 / kelvin; /* at 1 µm */
  const double low = to < HUGE_VAL ? x / to : 0, high = from > 0 ? x / from : HUGE_VAL;
  const double width = high < HUGE_VAL && to < HUGE_VAL ? high * ((to - from) / to) : high;
  if (!(low < HUGE_VAL)) return 0;
  if (width <= 1) return narrow(low, width);
  if (low >= MIDDLE) return tail(low) - tail(high);
  if (high <= MIDDLE) return head(high) - head(low);
  return 1 - head(low) - tail(high);
}

double hr2di_black_body_kelvin(double emitted) {
  return sqrt(sqrt(emitted / HR2D_STEFAN_BOLTZMANN));
}

/* x⁴/(eˣ − 1) */
static double rise(double x) {
  return x < 700 ? x * spectrum(x) : 0;
}

/* As f depends on x = c₂/(λT) alone, d(fT⁴)/d(T⁴) = f + ¼ T df/dT, and T df/dT of the part
   below λ is (15/π⁴) x⁴/(eˣ − 1). */
double hr2di_black_body_rise(double kelvin, double from, double to) {
  const double part = hr2d_black_body_part(kelvin, from, to);
  const double x = HR2D_SECOND_RADIATION_CONSTANT * 1e6 / kelvin;
  const double low = to < HUGE_VAL ? x / to : 0, high = from > 0 ? x / from : HUGE_VAL;
  return fmin(fmax(part + SCALE / 4 * (rise(low) - rise(high)), 0), 1);
}
