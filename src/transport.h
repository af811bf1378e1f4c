/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The transport operator: irradiance from radiosity, over the links of all levels.

   Fields on leaves are arrays of leaves × bands; the operator takes them up the
   trees as averages, gathers over the links, and brings what is gathered down. */
#ifndef HR2D_SRC_TRANSPORT_H
#define HR2D_SRC_TRANSPORT_H

#include "linkset-impl.h"

typedef struct hr2di_transport {
  const hr2d_linkset *links;
  const hr2d_hierarchy *hierarchy;
  hr2d_allocator alloc;
  size_t bands, elements, leaves;
  uint32_t *leaf;   /* the element of each leaf */
  double *up;       /* elements × bands: averages */
  double *down;     /* slices × elements × bands: power received, then irradiance */
  double *closure;  /* added to the diagonal, per leaf; NULL for none */
  double *sky;      /* how much of all directions each leaf sees the background in; NULL:
                       none does */
  size_t slices;    /* the links are cut into so many parts, whatever the threads */
  unsigned threads; /* 0 for all */
  uint64_t sweeps;  /* gathers so far */
} hr2di_transport;

/* HR2D_OK or HR2D_ENOMEM; to be cleared in either case. */
hr2d_status hr2di_transport_init(hr2di_transport *t, const hr2d_linkset *links,
                                 unsigned threads);

void hr2di_transport_clear(hr2di_transport *t);

/* Averages of a leaf field on every element, into t->up. */
void hr2di_pull(hr2di_transport *t, const double *leaf_field);

/* irradiance = K radiosity: H_i = Σ_j AF_ij B_j / A_i on leaves. */
void hr2di_gather(hr2di_transport *t, const double *radiosity, double *irradiance);

/* Adds what arrives from the background. */
void hr2di_add_background(const hr2di_transport *t, double *irradiance);

#endif
