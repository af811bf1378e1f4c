/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Residuals beside corners, where polynomials converge slowly.

   At a corner B ~ x^γ, and an operator of order q > p on the same elements has part of the
   error itself: of what the residual of a last element does to averages, coefficients p to q−1
   show θ = 1 − (p/q)^(2(1+2γ)). What it does to points is not to be seen in coefficients at
   all. For that the residual is gathered just beside the vertex, exactly. */
#ifndef HR2D_SRC_ESTIMATE_CORNER_RESIDUALS_H
#define HR2D_SRC_ESTIMATE_CORNER_RESIDUALS_H

#include "solution/solution-impl.h"
#include "solve/equation.h"

/* Two leaves with a common end that see each other. */
typedef struct hr2di_contact {
  uint32_t leaf[2]; /* their numbers; the first one ends at the vertex, the second begins */
  double view;      /* ½(1 + cos α): how much of all directions either sees the other in */
  double key;       /* to choose by where there are too many */
} hr2di_contact;

typedef struct hr2di_contacts {
  hr2d_allocator alloc;
  hr2di_contact *contact; /* those that were gathered at come first */
  size_t count, capacity;
  size_t gathered;
  double *residual; /* gathered × 2 × bands: B − B_h at the vertex, on either leaf */
} hr2di_contacts;

/* All contacts of the leaves of an operator; HR2D_OK, HR2D_ENOMEM or the status of the watch.
   To be cleared in any case. */
hr2d_status hr2di_contacts_init(hr2di_contacts *contacts, const hr2di_transport *t);
void hr2di_contacts_clear(hr2di_contacts *contacts);

/* Divides the coefficients from `order` on of a residual by θ, on leaves with contacts;
   HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_contacts_saturate(const hr2di_contacts *contacts, const hr2di_transport *t,
                                    size_t order, double exponent, double *residual);

/* Gathers the residuals of a solution at contacts, at those with the largest `residual` where
   there are many. `residual` and `field`, which is B, are in the unit of the equation. HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_contacts_gather(hr2di_contacts *contacts, const hr2di_equation *eq,
                                  const hr2d_solution *solution, const double *residual,
                                  const double *field);

/* How many points an account gathers at, for a set with these links. */
uint64_t hr2di_contacts_points(const hr2d_linkset *links);

#endif
