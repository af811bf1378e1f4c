/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders for qsort(). */
#ifndef HR2D_TESTS_SUPPORT_ORDER_H
#define HR2D_TESTS_SUPPORT_ORDER_H

/* Doubles, smallest first. */
static inline int order_doubles(const void *left, const void *right) {
  const double l = *(const double *)left, r = *(const double *)right;
  return (l > r) - (l < r);
}

/* Long doubles, smallest first. */
static inline int order_long_doubles(const void *left, const void *right) {
  const long double l = *(const long double *)left, r = *(const long double *)right;
  return (l > r) - (l < r);
}

#endif
