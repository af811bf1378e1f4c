/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of the table, and their errors. */
#include <math.h>
#include <stdlib.h>

#include "cost/cost.h"

double cost_floor(const cost *c) {
  return fmax(c->reference.average.bound, 1e-15);
}

double cost_error(const cost *c, double (*get)(const void *ctx, size_t patch, size_t band),
                  const void *ctx) {
  const size_t patches = hr2d_scene_patches(c->scene), bands = hr2d_scene_bands(c->scene);
  double worst = 0;
  for (size_t k = 0; k < patches; k++)
    for (size_t b = 0; b < bands; b++) {
      const double exact = c->average[k * bands + b];
      const double difference = fabs(get(ctx, k, b) - exact);
      if (difference > 0) worst = fmax(worst, difference / fabs(exact));
    }
  return worst;
}

hr2d_status cost_add(cost *c, const cost_row *row) {
  if (c->count == c->capacity) {
    const size_t capacity = c->capacity ? 2 * c->capacity : 64;
    cost_row *grown = realloc(c->rows, capacity * sizeof *grown);
    if (!grown) return HR2D_ENOMEM;
    c->rows = grown;
    c->capacity = capacity;
  }
  c->rows[c->count++] = *row;
  return HR2D_OK;
}

double cost_quantity(const cost_row *row, against quantity) {
  switch (quantity) {
  case AGAINST_LINKS:
    return (double)row->links;
  case AGAINST_BYTES:
    return (double)row->bytes;
  default:
    return row->seconds;
  }
}
