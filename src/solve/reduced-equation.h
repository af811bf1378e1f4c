/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equation for the first coefficients of each leaf, and of each element above it.  Trees,
   links and blocks of the whole have those of the part: a child's first coefficients make those
   of its parent.  What is left out is light that a link between elements with children spreads
   unevenly over these.  So the operator is nearly PKP, with P the projection on first
   coefficients, and symmetric like that; rows that closure makes 1 are nearly 1. */
#ifndef HR2D_SRC_SOLVE_REDUCED_EQUATION_H
#define HR2D_SRC_SOLVE_REDUCED_EQUATION_H

#include "solve/equation.h"

/* Makes the part of an equation with the first `order` coefficients, at least two of them and
   no more than there are, without light from the background.  It uses what the whole has, and
   its watch; the whole must outlive it.  HR2D_OK, HR2D_ENOMEM or the status of the watch; call
   hr2di_equation_part_clear() in any case. */
hr2d_status hr2di_equation_part(hr2di_equation *part, const hr2di_equation *whole,
                                size_t order);
void hr2di_equation_part_clear(hr2di_equation *part);

/* Copies the first coefficients of a field of the whole. */
void hr2di_equation_part_take(const hr2di_equation *part, const hr2di_equation *whole,
                              const double *from, double *to);

/* Sets the first coefficients of a field of the whole; the others stay. */
void hr2di_equation_part_give(const hr2di_equation *part, const hr2di_equation *whole,
                              const double *from, double *to);

#endif
