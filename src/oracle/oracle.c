/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oracles size, size2 and bf, and all by name. */
#include <hr2d/oracle.h>
#include <math.h>
#include <string.h>

#include "geometry/exchange-area.h"
#include "oracle/built-in.h"
#include "oracle/squares.h"

/* Below this a sum of two squares, or its product with another such number, may have
   lost digits to underflow. */
#define SMALL_SQUARE 1e-140

static double larger(double p, double q) {
  return p > q ? p : q;
}

static double smaller(double p, double q) {
  return p < q ? p : q;
}

static double centre_distance2(const hr2d_element *i, const hr2d_element *j) {
  const double dx = j->centre.x - i->centre.x, dy = j->centre.y - i->centre.y;
  return dx * dx + dy * dy;
}

/* max(A_x, A_y)/r, with r good to 3 roundings. */
static double size_of_pair(const hr2d_element *i, const hr2d_element *j) {
  const double r2 = centre_distance2(i, j);
  const double r = r2 > SMALL_SQUARE
                       ? sqrt(r2)
                       : hypot(j->centre.x - i->centre.x, j->centre.y - i->centre.y);
  return larger(i->length, j->length) / r;
}

static double size2_of_pair(const hr2d_element *i, const hr2d_element *j) {
  const double r2 = centre_distance2(i, j), a = larger(i->length, j->length);
  if (r2 > SMALL_SQUARE && a * a > SMALL_SQUARE) return a * a / r2;
  const double size = size_of_pair(i, j);
  return size * size;
}

/* In a pair that is only partly visible the kernel jumps at the shadow's border instead
   of changing smoothly: its elements must be half as long. */
static double weight(const hr2d_batch *batch, size_t k) {
  return batch->partial && batch->partial[k] ? 2 : 1;
}

static hr2d_status estimate_size(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++)
    error[k] = weight(batch, k) * size_of_pair(&batch->elements[batch->pairs[k].first],
                                               &batch->elements[batch->pairs[k].second]);
  return HR2D_OK;
}

static hr2d_status estimate_size2(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++)
    error[k] = weight(batch, k) * weight(batch, k) *
               size2_of_pair(&batch->elements[batch->pairs[k].first],
                             &batch->elements[batch->pairs[k].second]);
  return HR2D_OK;
}

/* The estimate also decides where underflow may have lost digits: with 1e-300 < ε² < 1e20 this
   shows in a difference below 1e-280. */
static int doubtful(double margin) {
  return !(margin > 1e-280);
}

static hr2d_status accept_squares(const hr2d_batch *batch, double epsilon2, double epsilon,
                                  double (*estimate)(const hr2d_element *,
                                                     const hr2d_element *),
                                  unsigned char *accepted) {
  const int in_range = epsilon2 > 1e-300 && epsilon2 < 1e20;
  if (!doubtful(hr2di_squares_accept(batch, epsilon2, accepted)) && in_range) return HR2D_OK;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_element *i = &batch->elements[batch->pairs[k].first];
    const hr2d_element *j = &batch->elements[batch->pairs[k].second];
    double a2;
    const double excess = hr2di_squares_excess(i, j, epsilon2, &a2);
    if (!in_range || doubtful(hr2di_squares_margin(excess, a2)))
      accepted[k] = estimate(i, j) <= epsilon;
  }
  return HR2D_OK;
}

static hr2d_status accept_partial(const hr2d_batch *batch, double epsilon, double factor,
                                  double (*estimate)(const hr2d_element *,
                                                     const hr2d_element *),
                                  unsigned char *accepted) {
  for (size_t k = 0; k < batch->count; k++)
    accepted[k] =
        (batch->partial[k] ? factor : 1) * estimate(&batch->elements[batch->pairs[k].first],
                                                    &batch->elements[batch->pairs[k].second]) <=
        epsilon;
  return HR2D_OK;
}

static hr2d_status accept_size(void *ctx, const hr2d_batch *batch, double epsilon,
                               unsigned char *accepted) {
  (void)ctx;
  if (batch->partial) return accept_partial(batch, epsilon, 2, size_of_pair, accepted);
  return accept_squares(batch, epsilon * epsilon, epsilon, size_of_pair, accepted);
}

static hr2d_status accept_size2(void *ctx, const hr2d_batch *batch, double epsilon,
                                unsigned char *accepted) {
  (void)ctx;
  if (batch->partial) return accept_partial(batch, epsilon, 4, size2_of_pair, accepted);
  return accept_squares(batch, epsilon, epsilon, size2_of_pair, accepted);
}

/* AF/min(A_x,A_y)·B_y, the larger of the form factors of the two elements times brightness. */
static hr2d_status estimate_bf(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  hr2di_exchange_areas(batch->elements, batch->pairs, batch->count, error);
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_pair pair = batch->pairs[k];
    const double factor = error[k] / smaller(batch->elements[pair.first].length,
                                             batch->elements[pair.second].length);
    const double brightness = batch->brightness ? batch->brightness[pair.second] : 1;
    error[k] = error[k] > 0 ? weight(batch, k) * factor * brightness : 0;
  }
  return HR2D_OK;
}

static const hr2d_oracle oracle_size = {HR2DI_BUILT_IN("size", HR2D_ORACLE_SYMMETRIC),
                                        .estimate = estimate_size, .accept = accept_size};

static const hr2d_oracle oracle_size2 = {HR2DI_BUILT_IN("size2", HR2D_ORACLE_SYMMETRIC),
                                         .estimate = estimate_size2, .accept = accept_size2};

static const hr2d_oracle oracle_bf = {HR2DI_BUILT_IN("bf", HR2D_ORACLE_NEEDS_BRIGHTNESS),
                                      .estimate = estimate_bf};

const hr2d_oracle *hr2d_oracle_size(void) {
  return &oracle_size;
}

const hr2d_oracle *hr2d_oracle_size2(void) {
  return &oracle_size2;
}

const hr2d_oracle *hr2d_oracle_bf(void) {
  return &oracle_bf;
}

const hr2d_oracle *hr2d_oracle_find(const char *name) {
  if (!name) return NULL;
  const hr2d_oracle *const known[] = {
      &oracle_size,     &oracle_size2,         &oracle_bf,
      hr2d_oracle_l1(), hr2d_oracle_l1_grid(), hr2d_oracle_bounds()};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (strcmp(known[k]->name, name) == 0) return known[k];
  return NULL;
}
