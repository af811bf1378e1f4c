/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The temperature that a small black body would have at a point. */
#include <math.h>

#include "field/field.h"

double field_temperature(const field *f, size_t point) {
  double sum = 0;
  for (size_t b = 0; b < f->bands; b++) sum += f->mean[point * f->bands + b];
  return sqrt(sqrt(sum / HR2D_STEFAN_BOLTZMANN));
}
