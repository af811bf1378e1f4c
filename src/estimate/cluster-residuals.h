/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much of the error of averages is what links of clusters lack. */
#ifndef HR2D_SRC_ESTIMATE_CLUSTER_RESIDUALS_H
#define HR2D_SRC_ESTIMATE_CLUSTER_RESIDUALS_H

#include "estimate/estimator.h"

/* Sets *part to the largest ρ|ΔH|/B of a patch, for the irradiance that the clusters of the
   finer operator add to that of `coarser`.  Returns HR2D_OK, HR2D_ENOMEM or the status of the
   watch. */
hr2d_status hr2di_cluster_residuals(hr2di_estimator *e, hr2di_clusters *coarser, double *part);

#endif
