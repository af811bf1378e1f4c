/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solutions of groups of bands, see scene/band-groups.h: one for each, and one with all bands.
   Fields have order × bands coefficients on each of some elements. */
#ifndef HR2D_SRC_SOLUTION_BAND_SOLUTION_H
#define HR2D_SRC_SOLUTION_BAND_SOLUTION_H

#include "links/linkset-impl.h"
#include "scene/band-groups.h"
#include "solution/solution-impl.h"

/* Copies bands of a field of `items` × bands to one of a group, or back. */
void hr2di_band_field_take(const hr2d_scene *scene, size_t group, size_t items,
                           const double *field, double *of_group);
void hr2di_band_field_give(const hr2d_scene *scene, size_t group, size_t items,
                           const double *of_group, double *field);

/* The bands of a group of a solution, for links of the group; NULL of NULL.  HR2D_OK or
   HR2D_ENOMEM. */
hr2d_status hr2di_band_solution_take(const hr2d_solution *whole, const hr2d_linkset *links,
                                     size_t group, hr2d_solution **made);

/* Makes a solution of all bands from those of all groups.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_band_solution_join(hr2d_linkset *links, hr2d_solution *const *of_group,
                                     hr2d_solution **made);

#endif
