/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums that keep their rounding errors (Neumaier 1974): the relative error of a sum
   of n terms of one sign is 2⁻⁵³ + O(n²2⁻¹⁰⁶). */
#ifndef HR2D_SRC_BASE_NEUMAIER_SUM_H
#define HR2D_SRC_BASE_NEUMAIER_SUM_H

#include <math.h>

typedef struct hr2di_sum {
  double head, tail;
} hr2di_sum;

static inline void hr2di_sum_add(hr2di_sum *sum, double term) {
  const double head = sum->head + term;
  sum->tail +=
      fabs(sum->head) >= fabs(term) ? (sum->head - head) + term : (term - head) + sum->head;
  sum->head = head;
}

static inline double hr2di_sum_total(const hr2di_sum *sum) {
  return sum->head + sum->tail;
}

#endif
