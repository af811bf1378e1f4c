/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of a solution, from the residual that a finer operator gives it. */
#ifndef HR2D_SRC_ESTIMATE_RESIDUAL_SERIES_H
#define HR2D_SRC_ESTIMATE_RESIDUAL_SERIES_H

#include "estimate/estimator.h"

/* Sets e->residual, and the largest B and H. */
void hr2di_residual_set(hr2di_estimator *e);

/* Sets e->error to B − B_h.  Returns HR2D_OK or the status of a solve or a gather. */
hr2d_status hr2di_residual_solve(hr2di_estimator *e);

/* field = ρK field, through eq->irradiance. */
void hr2di_residual_reflect(hr2di_equation *eq, double *field);

/* Sets the errors of averages from e->error, and those at points if the target asks for them.
   HR2D_OK or the status of a share. */
hr2d_status hr2di_residual_measure(hr2di_estimator *e);

#endif
