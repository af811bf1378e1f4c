/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/elements.h"

#include <check.h>
#include <float.h>
#include <math.h>

#include "support/plane.h"

hr2d_element element_of(hr2d_segment s) {
  return (hr2d_element){
      .a = s.a, .b = s.b, .centre = plane_middle(s), .length = plane_length(s)};
}

hr2d_batch element_batch(const element_pair *p) {
  static const hr2d_pair asked = {0, 1};
  return (hr2d_batch){.struct_size = sizeof(hr2d_batch),
                      .elements = p->element,
                      .pairs = &asked,
                      .count = 1,
                      .unit = 1,
                      .brightness = p->brightness};
}

double element_estimate(const hr2d_oracle *oracle, const hr2d_batch *batch) {
  double error;
  ck_assert_int_eq(oracle->estimate(NULL, batch, &error), HR2D_OK);
  ck_assert(!isnan(error));
  return error;
}

int element_accepted(const hr2d_oracle *oracle, const hr2d_batch *batch, double epsilon) {
  unsigned char accepted = 7;
  ck_assert_int_eq(oracle->accept(NULL, batch, epsilon, &accepted), HR2D_OK);
  return accepted;
}

void element_draw(const pair_class *class, randoms *r, double x[8]) {
  const pair p = draw_pair(class, r);
  const hr2d_point point[4] = {p.i.a, p.i.b, p.j.a, p.j.b};
  double max = DBL_TRUE_MIN;
  for (int k = 0; k < 4; k++) max = fmax(max, fmax(fabs(point[k].x), fabs(point[k].y)));
  for (int k = 0; k < 4; k++) {
    x[2 * k] = ldexp(point[k].x, -ilogb(max));
    x[2 * k + 1] = ldexp(point[k].y, -ilogb(max));
  }
}

int element_in_range(const double *x, int count, int bits) {
  double min = INFINITY, max = 0;
  for (int k = 0; k < count; k++) {
    const double size = fabs(x[k]);
    max = fmax(max, size);
    if (size > 0) min = fmin(min, size);
  }
  return max < 2 && min >= ldexp(max, -bits);
}
