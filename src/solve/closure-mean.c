/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each link has its exact exchange, so that the mean d̄ of d over a patch is 0 but for roundings
   of the row sum: of 1, on a patch that sees patches in every direction.  In d̄B they are
   roundings of the patch's own light, and a lamp that gets back 1e-8 of what it sends would
   have a part of 1e-8 of its H from there.  With d̄H in the place of d̄B,

     H' = H − d̄(B − H),   H̄' = (1 + d̄) Σ K̄_ij B_j + the mean of (d − d̄)B,

   roundings of K are roundings of H.  Where B = H, as in an isothermal room, nothing changes.
   The equation keeps d̄B, which is symmetric: in B it is a rounding, and powers are balanced.

   Links of clusters exchange less accurately, and d̄ is what they lack on patches that see
   patches in every direction.  It is to be a part of H there just as well, and in no way one of
   the light of a lamp.  There all H take one factor, so that what is absorbed stays as it was:
   it is within d̄ of 1. */
#include <math.h>

#include "base/alloc.h"
#include "base/neumaier-sum.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/patch-defect.h"
#include "solve/closure.h"

/* A mean above this part of 1 is no rounding: the links of a caller may lack pairs. */
static double rounding(const hr2di_transport *t) {
  return fmax(HR2DI_DEFECT_CLOSED, hr2di_closure_noise(t));
}

/* Roots are the first elements.  The parts of children are those of averages of H. */
hr2d_status hr2di_closure_set_mean(hr2di_transport *t) {
  const hr2d_element *element = t->hierarchy->element;
  const size_t square = t->order * t->order;
  double *mean = hr2di_alloc(&t->alloc, t->elements, sizeof *mean);
  if (!mean) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves; k++) mean[t->leaf[k]] = t->closure[k * square];
  for (size_t k = t->elements; k-- > 0;) {
    const uint32_t c = element[k].child;
    if (!c) continue;
    const double part = hr2di_element_left_part(element, (uint32_t)k);
    mean[k] = mean[c + 1] + part * (mean[c] - mean[c + 1]);
  }
  t->mean = mean;
  return hr2di_watch_work(t->watch, t->elements / 16);
}

static int lacks_clusters(const hr2di_transport *t, size_t patch) {
  const hr2di_clusters *clusters = t->roots->clusters;
  return clusters && hr2di_clusters_links(clusters) > 0 && t->closed && t->closed[patch];
}

int hr2di_closure_is_error(const hr2di_transport *t, size_t patch) {
  return fabs(t->mean[patch]) <= rounding(t) || lacks_clusters(t, patch);
}

/* By what all H of a band are too small where links of clusters lack a part: H = (H' +
   d̄B)/(1+d̄) was in balance. */
static double find_factor(const hr2di_transport *t, size_t band, const double *radiosity,
                          const double *irradiance) {
  hr2di_sum before = {0}, after = {0};
  for (size_t k = 0; k < t->leaves; k++) {
    const hr2d_element *e = &t->hierarchy->element[t->leaf[k]];
    if (!lacks_clusters(t, e->patch)) continue;
    const double d = t->mean[e->patch], h = irradiance[k * t->width + band];
    const double part = e->length * hr2di_scene_absorptance(t->scene, e->patch, band);
    hr2di_sum_add(&before, part * (h + d * radiosity[k * t->width + band]) / (1 + d));
    hr2di_sum_add(&after, part * h);
  }
  const double factor = hr2di_sum_total(&before) / hr2di_sum_total(&after);
  return factor > 0 && isfinite(factor) ? factor : 1;
}

static void balance(const hr2di_transport *t, const double *radiosity, double *irradiance) {
  for (size_t b = 0; b < t->bands; b++) {
    const double factor = find_factor(t, b, radiosity, irradiance);
    for (size_t k = 0; k < t->leaves; k++)
      if (lacks_clusters(t, t->hierarchy->element[t->leaf[k]].patch))
        for (size_t m = b; m < t->width; m += t->bands) irradiance[k * t->width + m] *= factor;
  }
}

void hr2di_closure_move_mean(const hr2di_transport *t, const double *radiosity,
                             double *irradiance) {
  for (size_t k = 0; k < t->leaves * t->width && t->mean; k++) {
    const size_t patch = t->hierarchy->element[t->leaf[k / t->width]].patch;
    if (hr2di_closure_is_error(t, patch))
      irradiance[k] -= t->mean[patch] * (radiosity[k] - irradiance[k]);
  }
  if (t->mean && t->roots->clusters) balance(t, radiosity, irradiance);
}
