/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chart of a study, by gnuplot. */
#ifndef HR2D_TOOLS_STUDY_CHART_H
#define HR2D_TOOLS_STUDY_CHART_H

#include <hr2d/hr2d.h>
#include <stddef.h>

#include "cli/options.h"

/* Dots of L against N, with the fitted curve unless fit is NULL; on logarithmic axes the
   curve is the power law of the fitted slope. */
int chart_study(const options *o, const hr2d_study_row *rows, size_t count,
                const hr2d_study_fit *fit);

#endif
