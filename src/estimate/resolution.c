/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "estimate/resolution.h"

#include <math.h>

/* The order has to tell, and clusters of another accuracy. */
hr2di_resolution hr2di_resolution_finer(const hr2di_resolution *f) {
  hr2di_resolution finer = *f;
  const unsigned order = f->order + HR2DI_FINER_ORDERS;
  finer.order = order < HR2D_MAX_ORDER ? order : HR2D_MAX_ORDER;
  finer.cluster_accuracy = fmax(0.1 * f->cluster_accuracy, HR2DI_FINEST_CLUSTERS);
  return finer;
}
