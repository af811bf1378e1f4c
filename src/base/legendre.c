/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss rules by Newton's method on the three-term recurrence.  GSL has Gauss rules, too, but
   it allocates their tables by malloc(), and its error handler aborts if there is no memory. */
#include "base/legendre.h"

#include <math.h>
#include <string.h>

#include "base/pi.h"

enum { HALF = HR2DI_RULE_POINTS / 2 };

/* P_n and its derivative at `count` points of (-1,1), side by side: one point after the other
   would wait for each step of its recurrence. */
static void evaluate(size_t n, size_t count, const double *x, double *value, double *slope) {
  double before[HALF];
  for (size_t k = 0; k < count; k++) {
    before[k] = 1;
    value[k] = x[k];
  }
  for (size_t l = 2; l <= n; l++) {
    const double part = 1 - 1 / (double)l;
    for (size_t k = 0; k < count; k++) {
      const double here = value[k];
      value[k] = x[k] * here + part * (x[k] * here - before[k]);
      before[k] = here;
    }
  }
  for (size_t k = 0; k < count; k++)
    slope[k] = (double)n * (before[k] - x[k] * value[k]) / (1 - x[k] * x[k]);
}

/* Newton's method converges from the asymptotic nodes, x ≈ cos(π(k + 3/4)/(n + 1/2)), which are
   off by less than 0.01/n²; three steps are enough, and one is for rounding.  The weights
   2/((1−x²)P'²) are insensitive to the error that is left, as their derivative is 0. */
void hr2di_rule_init(hr2di_rule *rule, size_t points) {
  const size_t n = points, count = (n + 1) / 2;
  double x[HALF], value[HALF], slope[HALF];
  rule->points = n;
  for (size_t k = 0; k < count; k++)
    x[k] = 2 * k + 1 == n ? 0 : cos(HR2DI_PI * ((double)k + 0.75) / ((double)n + 0.5));
  for (int step = 0; step < 4; step++) {
    evaluate(n, count, x, value, slope);
    for (size_t k = 0; 2 * k + 1 < n; k++) x[k] -= value[k] / slope[k];
  }
  evaluate(n, count, x, value, slope);
  for (size_t k = 0; k < count; k++) {
    const double weight = n > 1 ? 1 / ((1 - x[k] * x[k]) * slope[k] * slope[k]) : 1;
    rule->at[n - 1 - k] = x[k];
    rule->at[k] = -x[k];
    rule->weight[k] = rule->weight[n - 1 - k] = weight;
  }
}

void hr2di_basis_init(hr2di_basis *basis, size_t order) {
  basis->order = order;
  for (size_t k = 0; k < order; k++) {
    const double l = (double)k;
    basis->ahead[k] = sqrt((2 * l + 1) * (2 * l + 3)) / (l + 1);
    basis->behind[k] = k > 0 ? l / (l + 1) * sqrt((2 * l + 3) / (2 * l - 1)) : 0;
  }
}

/* The means of φ_l(parent) φ_k(child) over the child, by a rule that is exact: the degree is
   l + k ≤ 2·order − 2. */
void hr2di_legendre_two_scale(double low, double high, size_t order, double *relation) {
  hr2di_rule rule;
  hr2di_basis basis;
  double phi[HR2D_MAX_ORDER], parent_phi[HR2D_MAX_ORDER];
  hr2di_rule_init(&rule, order);
  hr2di_basis_init(&basis, order);
  memset(relation, 0, order * order * sizeof *relation);
  for (size_t q = 0; q < order; q++) {
    hr2di_basis_at(&basis, rule.at[q], phi);
    hr2di_basis_at(&basis, 0.5 * ((1 - rule.at[q]) * low + (1 + rule.at[q]) * high),
                   parent_phi);
    for (size_t l = 0; l < order; l++)
      for (size_t k = 0; k <= l; k++)
        relation[l * order + k] += rule.weight[q] * parent_phi[l] * phi[k];
  }
}
