/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From places in a cluster to its points, and back.  A cluster has a value per point in each of
   some planes. */
#ifndef HR2D_SRC_CLUSTERS_INTERPOLATION_H
#define HR2D_SRC_CLUSTERS_INTERPOLATION_H

#include "clusters/clusters-impl.h"

/* Adds what is sent from a place, a strength per plane, to the moments of a cluster. */
void hr2di_interpolation_send(const hr2di_expansion *f, hr2d_point place, size_t planes,
                              const double *strength, double *moment);

/* Sets a value per plane to what is received at a place, from coefficients. */
void hr2di_interpolation_receive(const hr2di_expansion *f, hr2d_point place, size_t planes,
                                 const double *coefficient, double *value);

/* Turns moments into strengths at the points or, not transposed, values at the points into
   coefficients. */
void hr2di_interpolation_turn(const hr2di_clusters *c, const hr2di_expansion *f, size_t planes,
                              int transposed, double *plane);

#endif
