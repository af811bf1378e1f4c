/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adaptive quadrature of several functions at once, by GSL's 15-point rule. */
#ifndef HR2D_SRC_REFINE_LAW_QUADRATURE_H
#define HR2D_SRC_REFINE_LAW_QUADRATURE_H

#include <hr2d/status.h>
#include <stddef.h>

enum { HR2DI_LAW_PARTS = 5 /* functions at most */, HR2DI_LAW_PIECES = 8 };

/* Writes the functions at t.  A status other than HR2D_OK ends the quadrature. */
typedef hr2d_status (*hr2di_law_fn)(void *ctx, double t, double *value);

typedef struct hr2di_law_integral {
  hr2di_law_fn at;
  void *ctx;
  size_t parts;     /* the number of functions */
  size_t pieces;    /* of equal length, to begin with; up to HR2DI_LAW_PIECES */
  size_t most;      /* bisections, where the tolerance is out of reach */
  double tolerance; /* of one interval, relative to the integral of the function */
} hr2di_law_integral;

/* Adds the integrals over [low, high] to `sum`, and the sums of GSL's estimates of their errors
   to `error`.  Jumps are found by bisection.  Returns HR2D_OK or the status of a function. */
hr2d_status hr2di_law_integrate(const hr2di_law_integral *integral, double low, double high,
                                double *sum, double *error);

#endif
