/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Legendre polynomials, normalised to a mean square of 1: φ_l(ξ) = √(2l+1) P_l(ξ) on [-1,1],
   and the Gauss rules that go with them. */
#ifndef HR2D_SRC_BASE_LEGENDRE_H
#define HR2D_SRC_BASE_LEGENDRE_H

#include <hr2d/hierarchy.h>
#include <stddef.h>

enum { HR2DI_RULE_POINTS = 64 };

/* A mean over [-1,1], exact for polynomials of degree 2·points − 1. */
typedef struct hr2di_rule {
  size_t points;
  double at[HR2DI_RULE_POINTS];     /* in rising order */
  double weight[HR2DI_RULE_POINTS]; /* their sum is 1 */
} hr2di_rule;

/* 1 ≤ points ≤ HR2DI_RULE_POINTS. */
void hr2di_rule_init(hr2di_rule *rule, size_t points);

/* The recurrence φ_{l+1} = ahead_l ξ φ_l − behind_l φ_{l−1}. */
typedef struct hr2di_basis {
  size_t order;
  double ahead[HR2D_MAX_ORDER], behind[HR2D_MAX_ORDER];
} hr2di_basis;

void hr2di_basis_init(hr2di_basis *basis, size_t order);

/* φ_0 … φ_{order−1} at ξ. */
static inline void hr2di_basis_at(const hr2di_basis *basis, double xi, double *phi) {
  double before = 0, here = 1;
  for (size_t l = 0; l < basis->order; l++) {
    phi[l] = here;
    const double next = basis->ahead[l] * xi * here - basis->behind[l] * before;
    before = here;
    here = next;
  }
}

/* Σ coefficient_l φ_l(ξ); the coefficients lie `stride` apart. */
static inline double hr2di_basis_sum(const hr2di_basis *basis, double xi,
                                     const double *coefficient, size_t stride) {
  double before = 0, here = 1, sum = 0;
  for (size_t l = 0; l < basis->order; l++) {
    sum += coefficient[l * stride] * here;
    const double next = basis->ahead[l] * xi * here - basis->behind[l] * before;
    before = here;
    here = next;
  }
  return sum;
}

/* The two-scale relation: for a child that spans [low, high] of its parent's [-1,1],
   φ_l(parent) = Σ_k relation[l·order + k] φ_k(child). */
void hr2di_legendre_two_scale(double low, double high, size_t order, double *relation);

#endif
