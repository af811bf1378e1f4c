/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Least squares.  The cost of a method is a power of the error; the cost of an automatic method
   is a linear function of the digits. */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <math.h>

#include "cost/cost.h"

enum { MOST = 64, LEAST = 3 };

/* The rows whose error is clearly above that of the reference. */
static size_t collect(const cost *c, const cost_method *m, against quantity, double *digits,
                      double *value) {
  size_t count = 0;
  for (size_t k = 0; k < c->count && count < MOST; k++) {
    const cost_row *row = &c->rows[k];
    if (row->method != m || !(row->error > 2 * cost_floor(c)) || !(row->error < 1)) continue;
    digits[count] = -log10(row->error);
    value[count++] = cost_quantity(row, quantity);
  }
  return count;
}

/* Keeps the finer half of the digits, a decade of error at least: coarse runs take as long as
   any run takes at least. */
static size_t keep_fine(double *digits, double *value, size_t count) {
  double max = 0, min = INFINITY, from = -INFINITY;
  size_t kept = 0;
  for (size_t k = 0; k < count; k++) {
    max = fmax(max, digits[k]);
    min = fmin(min, digits[k]);
  }
  for (size_t k = 0; k < count; k++)
    if (digits[k] <= max - 1) from = fmax(from, digits[k]);
  from = fmin(from, 0.5 * (max + min));
  for (size_t k = 0; k < count; k++) kept += digits[k] >= from;
  if (kept < LEAST) return count;
  kept = 0;
  for (size_t k = 0; k < count; k++)
    if (digits[k] >= from) {
      digits[kept] = digits[k];
      value[kept++] = value[k];
    }
  return kept;
}

/* A slope over less than a decade of error means nothing. */
static int is_wide(const double *digits, size_t count) {
  double max = -INFINITY, min = INFINITY;
  for (size_t k = 0; k < count; k++) {
    max = fmax(max, digits[k]);
    min = fmin(min, digits[k]);
  }
  return max - min >= 1;
}

/* The slope and half of its interval of 95 %, as if the deviations were independent. */
static double line(const double *x, const double *y, size_t count, double *range) {
  double c0 = 0, c1 = 0, cov00 = 0, cov01 = 0, cov11 = 0, rest = 0;
  gsl_fit_linear(x, 1, y, 1, count, &c0, &c1, &cov00, &cov01, &cov11, &rest);
  *range = gsl_cdf_tdist_Pinv(0.975, (double)count - 2) * sqrt(fmax(cov11, 0));
  return c1;
}

int cost_fit_rows(const cost *c, const cost_method *m, against quantity, cost_fit *fit) {
  double digits[MOST], value[MOST];
  size_t count = collect(c, m, quantity, digits, value);
  fit->is_digital = !m->oracle && m->id != METHOD_FACTORS;
  if (!fit->is_digital) count = keep_fine(digits, value, count);
  if (count < LEAST || !is_wide(digits, count)) return -1;
  fit->digit = line(digits, value, count, &fit->range);
  for (size_t k = 0; k < count; k++) value[k] = log10(value[k]);
  fit->slope = line(digits, value, count, &fit->range);
  return isfinite(fit->slope) ? 0 : -1;
}
