/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oracles of the paper's experiments (section 4): l1 and l1-grid. */
#include <hr2d/oracle.h>
#include <math.h>

#include "geometry/exchange-area.h"
#include "oracle/built-in.h"
#include "oracle/l1-grid.h"
#include "oracle/l1.h"

static hr2d_segment segment_of(const hr2d_element *e) {
  return (hr2d_segment){e->a, e->b};
}

/* A bound on the error that occluders add: |G(x_c,y_c) − G V| ≤ |G(x_c,y_c) − G| + (1 − V) G,
   and the integral of the last term is at most the unoccluded exchange area. */
static double shadow(const hr2d_batch *batch, size_t k) {
  double area = 0;
  if (batch->partial && batch->partial[k])
    hr2di_exchange_areas(batch->elements, &batch->pairs[k], 1, &area);
  return area;
}

static hr2d_status estimate_l1(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_segment i = segment_of(&batch->elements[batch->pairs[k].first]);
    const hr2d_segment j = segment_of(&batch->elements[batch->pairs[k].second]);
    error[k] = batch->unit * (hr2di_l1(&i, &j) + shadow(batch, k));
  }
  return HR2D_OK;
}

static hr2d_status accept_l1(void *ctx, const hr2d_batch *batch, double epsilon,
                             unsigned char *accepted) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_segment i = segment_of(&batch->elements[batch->pairs[k].first]);
    const hr2d_segment j = segment_of(&batch->elements[batch->pairs[k].second]);
    const double more = shadow(batch, k);
    accepted[k] = more > 0 ? batch->unit * more <= epsilon &&
                                 batch->unit * (hr2di_l1(&i, &j) + more) <= epsilon
                           : (unsigned char)hr2di_l1_accept(&i, &j, batch->unit, epsilon);
  }
  return HR2D_OK;
}

static hr2d_status estimate_grid(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++)
    error[k] =
        batch->unit * (hr2di_l1_grid(batch, batch->pairs[k], HUGE_VAL) + shadow(batch, k));
  return HR2D_OK;
}

static hr2d_status accept_grid(void *ctx, const hr2d_batch *batch, double epsilon,
                               unsigned char *accepted) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_pair pair = batch->pairs[k];
    const hr2d_segment i = segment_of(&batch->elements[pair.first]);
    const hr2d_segment j = segment_of(&batch->elements[pair.second]);
    const double more = shadow(batch, k);
    if (more > 0) {
      accepted[k] = batch->unit * more <= epsilon &&
                    batch->unit * (hr2di_l1_grid(batch, pair, HUGE_VAL) + more) <= epsilon;
      continue;
    }
    accepted[k] = batch->unit * hr2di_l1_bounds(&i, &j).high <= epsilon ||
                  batch->unit * hr2di_l1_grid(batch, pair, epsilon / batch->unit) <= epsilon;
  }
  return HR2D_OK;
}

static const hr2d_oracle oracle_l1 = {HR2DI_BUILT_IN("l1", HR2D_ORACLE_SYMMETRIC),
                                      .estimate = estimate_l1, .accept = accept_l1};

static const hr2d_oracle oracle_l1_grid = {HR2DI_BUILT_IN("l1-grid", HR2D_ORACLE_SYMMETRIC),
                                           .estimate = estimate_grid, .accept = accept_grid};

const hr2d_oracle *hr2d_oracle_l1(void) {
  return &oracle_l1;
}

const hr2d_oracle *hr2d_oracle_l1_grid(void) {
  return &oracle_l1_grid;
}

uint64_t hr2di_oracle_work(const hr2d_oracle *oracle, const hr2d_batch *batch, size_t pair) {
  if (oracle->estimate == estimate_l1) return 100;
  if (oracle->estimate != estimate_grid) return 0;
  return 1 + hr2di_l1_grid_samples(batch, batch->pairs[pair]) / 48;
}
