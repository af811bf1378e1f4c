/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of an average is Σ A ⟨r, Z⟩ over leaves, with its importance Z (see
   unsigned-error.c). The importance of all averages that are too far off is that of the sum of
   their sources: one solve.  Of r and Z the coefficients from p on tell what halves of the leaf
   would get right:

     share = A Σ_l |r_l Z_l|, p ≤ l < p + 2.

   Where views change there are kinks in r and in Z, and a half of a leaf has 1/2³ of its share
   on either side or on both; a smooth share falls faster.  So a halving leaves a HALVED_SHARE
   part. */
#include "estimate/error-indicators.h"

#include <math.h>

#include "base/choices.h"
#include "estimate/importance.h"
#include "estimate/unsigned-error.h"
#include "scene/scene-impl.h"

/* The part of a share that two halves have together. */
#define HALVED_SHARE 0.2

/* Sets the source to the sum of 1/(A H̄) of the averages that are too far off. */
static void set_source(hr2di_estimator *e, double off) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = 0;
  for (size_t leaf = 0; leaf < t->leaves; leaf++) {
    const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
    for (size_t b = 0; b < t->bands && hr2di_is_important(e->target, patch); b++) {
      const double min = hr2di_estimator_min(e, 1, patch, b);
      if (min > 0 && fabs(e->average[1][patch * t->bands + b]) > off * min)
        eq->source[leaf * t->width + b] = 1 / min / t->hierarchy->element[patch].length;
    }
  }
}

/* Shares of the leaves, of all bands. */
static void measure(const hr2di_estimator *e, double *share) {
  const hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  for (size_t leaf = 0; leaf < t->leaves && !hr2di_estimator_stopped(e); leaf++) {
    share[leaf] = 0;
    for (size_t l = e->coarse->order; l < t->order; l++)
      for (size_t b = 0; b < t->bands; b++) {
        const size_t k = leaf * t->width + l * t->bands + b;
        share[leaf] += eq->weight[leaf * t->order] * fabs(eq->irradiance[k] * e->residual[k]);
      }
  }
}

/* How often a leaf is halved so that no part has more than `max`. */
static unsigned char depth_for(double share, double max) {
  unsigned char depth = 0;
  for (; share > max && depth < HR2DI_CHOICE_INDICATORS_DEEP; depth++)
    share *= HALVED_SHARE / 2;
  return depth;
}

static double sum_left(const double *share, size_t leaves, double max) {
  double sum = 0;
  for (size_t k = 0; k < leaves; k++)
    sum += share[k] * pow(HALVED_SHARE, share[k] > max ? depth_for(share[k], max) : 0);
  return sum;
}

/* The largest part that may be left, so that all parts together are at most `part` of the
   shares. */
static double find_max(const double *share, size_t leaves, double part, hr2di_watch *watch) {
  double max = 0;
  for (size_t k = 0; k < leaves; k++) max = fmax(max, share[k]);
  const double min = max * pow(HALVED_SHARE / 2, HR2DI_CHOICE_INDICATORS_DEEP),
               all = sum_left(share, leaves, max);
  while (max > min && sum_left(share, leaves, max) > part * all &&
         !hr2di_watch_work(watch, leaves / 16))
    max *= HR2DI_CHOICE_INDICATORS_STEP;
  return max;
}

hr2d_status hr2di_error_indicators(hr2di_estimator *e, double target, double worst,
                                   unsigned char *depth) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  double *share = e->rest; /* no longer needed */
  set_source(e, HR2DI_CHOICE_INDICATORS_OFF * target);
  const hr2d_status status = hr2di_unsigned_row(e);
  if (status) return status;
  measure(e, share);
  const double max = find_max(share, t->leaves,
                              fmin(HR2DI_CHOICE_INDICATORS_AIM * target / worst, 1), t->watch);
  for (size_t k = 0; k < t->leaves; k++) depth[t->leaf[k]] = depth_for(share[k], max);
  return hr2di_estimator_stopped(e) ? hr2di_watch_status(t->watch) : HR2D_OK;
}
