/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which rows of pairs a rank has, where patches are not cut. */
#ifndef HR2D_PETSC_DEAL_H
#define HR2D_PETSC_DEAL_H

#include "hr2dp-impl.h"

/* Sets p->units.rows so that each rank has about the same part of the links and of the tests of
   visibility; `weight` has both of each row, is the same on all ranks, and becomes parts of
   all. HR2D_OK or HR2D_ENOMEM; not collective. */
hr2d_status hr2dpi_deal_rows(hr2dp *p, double *weight);

#endif
