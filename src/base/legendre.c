/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss rules by Newton's method on the three-term recurrence.  GSL has Gauss rules, too, but
   it allocates their tables by malloc(), and its error handler aborts if there is no memory. */
#include "base/legendre.h"

#include <math.h>
#include <string.h>

/* P_n and its derivative at x in (-1,1). */
static void evaluate(size_t n, double x, double *value, double *slope) {
  double before = 1, here = x;
  for (size_t k = 2; k <= n; k++) {
    const double next = x * here + (1 - 1 / (double)k) * (x * here - before);
    before = here;
    here = next;
  }
  *value = here;
  *slope = (double)n * (before - x * here) / (1 - x * x);
}

/* Newton's method converges from the asymptotic nodes, x ≈ cos(π(k + 3/4)/(n + 1/2)).  The
   weights 2/((1−x²)P'²) are insensitive to the error that is left, as their derivative is 0. */
void hr2di_rule_init(hr2di_rule *rule, size_t points) {
  const double pi = 3.14159265358979323846;
  const size_t n = points;
  rule->points = n;
  for (size_t k = 0; 2 * k < n; k++) {
    double x = cos(pi * ((double)k + 0.75) / ((double)n + 0.5)), value, slope;
    if (2 * k + 1 == n) x = 0;
    for (int step = 0; step < 6 && n > 1; step++) {
      evaluate(n, x, &value, &slope);
      x -= value / slope;
    }
    if (2 * k + 1 == n) x = 0;
    evaluate(n, x, &value, &slope);
    const double weight = n > 1 ? 1 / ((1 - x * x) * slope * slope) : 1;
    rule->at[n - 1 - k] = x;
    rule->at[k] = -x;
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
