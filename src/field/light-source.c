/* SPDX-License-Identifier: GPL-3.0-or-later */
/* If an error is allowed, a rule takes a leaf that is far as a whole.  With the point at ξ₀ in
   the complex plane of the leaf's [−1,1], dω = Im dξ/(ξ − ξ₀), and a rule of n points is exact
   for (B(ξ) − B(ξ₀))/(ξ − ξ₀), a polynomial of degree below 2n.  What is left is that of
   B(ξ₀)/(ξ − ξ₀), which is 2 B(ξ₀) Q_n(ξ₀)/P_n(ξ₀) with the second Legendre function Q_n: about
   2π B(ξ₀) ρ^−(2n+1), and (2n + 1) times that, at most, as a part of the angle. With |P_l(ξ₀)|
   ≤ ρ^l this gives 4 (2n + 1) (c₀ ρ^−2n + Σ |c_l| √(2l+1) ρ^(p−1−2n)), in which 4 has a factor
   of 2 to spare.

   So does an element that is far take the place of all leaves below it, which may differ much
   more from its polynomial: what is left of B is orthogonal to polynomials of degree below p,
   and of dω/dξ counts what these leave.  Im 1/(ξ − ξ₀) is the harder to approximate, as a part
   of its integral, the nearer ξ₀ is to the line of the element, where it is
   y/(ξ − x)² with the integral 2y/(x² − 1).  Polynomials leave 4 ρ^−(p+1) of 1/(ξ − x) in the
   mean of |·|, so that they leave 4 (p + 1) ρ^−(p+1)/√(x² − 1) of its derivative: (p + 1) ρ^−p
   of the angle.  Twice that is taken, times the largest difference. */
#include "field/light-source.h"

#include <math.h>

#include "base/alloc.h"
#include "solution/panels.h"

static const unsigned char rule_points[HR2DI_LIGHT_RULES] = {2,  3,  4,  5,  6,  7,  8, 9,
                                                             10, 12, 14, 17, 21, 27, 36};

/* Variations below this part of the largest B are roundings. */
#define ROUNDING 0x1p-54

/* Of the allowed error, what takes the merging of leaves, and what the rules. */
#define MERGED 0.75
#define RULED  0.25

/* Of what the rules take, the part for leaves that an element stands for. */
#define ORTHOGONAL 0.5

hr2d_status hr2di_light_source_init(hr2di_light_source *of, const hr2d_solution *solution,
                                    hr2di_watch *watch) {
  *of = (hr2di_light_source){.solution = solution,
                             .allowed = ROUNDING,
                             .has_gas = hr2di_scene_has_gas(solution->hierarchy->scene)};
  hr2di_basis_init(&of->basis, solution->order);
  for (int k = 0; k < HR2DI_LIGHT_RULES; k++) hr2di_rule_init(&of->rule[k], rule_points[k]);
  return hr2di_leaves_init(&of->leaves, solution, NULL, watch);
}

void hr2di_light_source_clear(hr2di_light_source *of) {
  hr2di_alloc_free(&of->leaves.alloc, of->far);
  hr2di_alloc_free(&of->leaves.alloc, of->element_error);
  hr2di_alloc_free(&of->leaves.alloc, of->gas_error);
  hr2di_leaves_clear(&of->leaves);
}

/* The size m of an ellipse with ρ^power = value. */
static double ellipse_of(double value, double power) {
  const double rho = value > 1 ? pow(value, 1 / power) : 1;
  return (rho + 1 / rho) / 2;
}

/* Gas makes E_g + T(B − E_g) of B, where |T| ≤ 1 within the ellipse, as Re r ≥ 0 there. */
static hr2di_light_far far_of(const hr2di_light_source *of, uint32_t element) {
  const double order = (double)of->leaves.order, degree = order - 1;
  const double differs = of->leaves.difference[element] * (MERGED / (RULED * ORTHOGONAL));
  const double smooth = ellipse_of(2 * (order + 1) * differs, order);
  hr2di_light_far far;
  float level, varies;
  hr2di_leaves_measure(&of->leaves, of->solution->bands, element, &level, &varies);
  if (of->has_gas) level += 2; /* E_g is at most 1 of the scale */
  for (int k = 0; k < HR2DI_LIGHT_FAR; k++) {
    const double n = rule_points[k];
    const double max = 4 * (2 * n + 1) / (of->allowed * (1 - ORTHOGONAL));
    const double from = 2 * n > degree ? fmax(ellipse_of(2 * max * level, 2 * n),
                                              ellipse_of(2 * max * varies, 2 * n - degree))
                                       : HUGE_VAL;
    far.from[k] = (float)fmax(fmax(from, smooth), HR2DI_NEAR_ELLIPSE);
  }
  return far;
}

hr2d_status hr2di_light_source_relax(hr2di_light_source *of, const double *max,
                                     hr2di_watch *watch) {
  const size_t bands = of->solution->bands;
  const hr2d_allocator alloc = of->leaves.alloc;
  double *merged = hr2di_alloc(&alloc, bands, sizeof *merged);
  if (!merged) return HR2D_ENOMEM;
  double min = 1;
  for (size_t b = 0; b < bands; b++) {
    merged[b] = MERGED * max[b];
    if (of->leaves.scale[b] > 0) min = fmin(min, max[b] / of->leaves.scale[b]);
  }
  hr2di_leaves_clear(&of->leaves);
  hr2d_status status = hr2di_leaves_init(&of->leaves, of->solution, merged, watch);
  hr2di_alloc_free(&alloc, merged);
  of->allowed = fmax(RULED * min, ROUNDING);
  if (status) return status;
  const size_t elements = of->solution->elements;
  hr2di_basis_init(&of->basis, of->leaves.order);
  of->far = hr2di_alloc(&alloc, elements, sizeof *of->far);
  if (!of->far) return HR2D_ENOMEM;
  for (size_t k = 0; k < elements && !status; k++) {
    of->far[k] = far_of(of, (uint32_t)k);
    status = hr2di_watch_work(watch, 10);
  }
  return status;
}

const hr2di_rule *hr2di_light_rule(const hr2di_light_source *of, double points) {
  int k = 0;
  while (k + 1 < HR2DI_LIGHT_RULES && rule_points[k] < points) k++;
  return &of->rule[k];
}
