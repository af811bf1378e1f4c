/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oracles size, size2 and bf, and all by name. */
#include <hr2d/oracle.h>
#include <math.h>
#include <string.h>

#include "geometry/determinant.h"
#include "oracle/built-in.h"
#include "oracle/squares.h"

/* Below this a sum of two squares, or its product with another such number, may have
   lost digits to underflow. */
#define SMALL_SQUARE 1e-140

static double larger(double p, double q) {
  return p > q ? p : q;
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

/* The cosine at an element's centre towards another's, by absolute value; they are d apart. */
static hr2di_scaled scaled_cosine(const hr2d_element *e, const hr2di_vector *d,
                                  hr2di_scaled r) {
  const hr2di_vector along = hr2di_vector_difference_scaled(e->b, e->a);
  hr2di_scaled det = hr2di_det_scaled(&along, d);
  det.m = fabs(det.m);
  return hr2di_scaled_div(hr2di_scaled_div(det, hr2di_scaled_of(e->length, 0)), r);
}

static double scaled_bf(const hr2d_element *i, const hr2d_element *j, double brightness) {
  const hr2di_vector d = hr2di_vector_difference_scaled(j->centre, i->centre);
  const hr2di_scaled r = hr2di_vector_length_scaled(&d);
  if (r.m == 0) return HUGE_VAL;
  const hr2di_scaled cosines =
      hr2di_scaled_mul(scaled_cosine(i, &d, r), scaled_cosine(j, &d, r));
  const hr2di_scaled size =
      hr2di_scaled_div(hr2di_scaled_of(larger(i->length, j->length), -1), r);
  return hr2di_scaled_value(
      hr2di_scaled_mul(hr2di_scaled_mul(cosines, size), hr2di_scaled_of(brightness, 0)));
}

/* G(x_c,y_c)·max(A_x,A_y)·B_y; lengths cancel, so that only ratios are formed.  Determinants
   have 2 roundings, r has 3, a cosine 7 and the product 21.  Pairs that could lose bits of a
   difference, or leave the range of a double on the way, go to scaled_bf(). */
static double bf_of_pair(const hr2d_element *i, const hr2d_element *j, double brightness) {
  if (!(brightness > 0)) return 0;
  if (!hr2di_point_plain(i->a) || !hr2di_point_plain(i->b) || !hr2di_point_plain(i->centre) ||
      !hr2di_point_plain(j->a) || !hr2di_point_plain(j->b) || !hr2di_point_plain(j->centre))
    return scaled_bf(i, j, brightness);
  const hr2di_vector along_i = hr2di_vector_difference(i->b, i->a);
  const hr2di_vector along_j = hr2di_vector_difference(j->b, j->a);
  const hr2di_vector d = hr2di_vector_difference(j->centre, i->centre);
  const double r = hr2di_vector_length(&d);
  if (!(r > 0)) return HUGE_VAL;
  const double cos_i = fabs(hr2di_det(&along_i, &d)) / (i->length * r);
  const double cos_j = fabs(hr2di_det(&along_j, &d)) / (j->length * r);
  const double cosines = 0.5 * cos_i * cos_j;
  if (!(cosines > 1e-250 && cosines < 1e250)) return scaled_bf(i, j, brightness);
  return cosines * (larger(i->length, j->length) / r) * brightness;
}

static hr2d_status estimate_bf(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_pair pair = batch->pairs[k];
    error[k] = weight(batch, k) *
               bf_of_pair(&batch->elements[pair.first], &batch->elements[pair.second],
                          batch->brightness ? batch->brightness[pair.second] : 1);
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
  const hr2d_oracle *const known[] = {&oracle_size, &oracle_size2, &oracle_bf, hr2d_oracle_l1(),
                                      hr2d_oracle_l1_grid()};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (strcmp(known[k]->name, name) == 0) return known[k];
  return NULL;
}
