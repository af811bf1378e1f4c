/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The transport operator on own leaves: pulls up the trees, gathers over the links of all ranks
   and pushes down.  A field on own leaves has `bands` values for each. */
#ifndef HR2D_PETSC_TRANSPORT_H
#define HR2D_PETSC_TRANSPORT_H

#include "hr2dp-impl.h"

typedef struct hr2dpi_transport {
  hr2dp *p;
  double *up;                /* elements × bands: radiosity, then irradiance */
  hr2dpi_bin *bin;           /* elements × bands: power received */
  hr2dpi_bin *above;         /* those of elements above the cut, in their order */
  double *scale;             /* per element: σ of bins for a radiosity of 1 */
  double *sigma;             /* per element: σ of this sweep */
  const uint32_t *component; /* per patch: of the exchange */
  double *size;              /* per component: a bound of its radiosity in this sweep */
  size_t components;
  double *receive; /* closure: factors per element for the push; NULL: light spreads evenly */
  double *send;    /* the same for the pull; equal to `receive` unless links are directed */
  double *closure; /* per own leaf: what roundings leave of its row sum; NULL for none */
  double *sky;     /* per own leaf: form factor of the background; NULL for none */
  double *mean;    /* per patch: this mean; NULL for none */
  uint64_t sweeps;
  uint64_t row_sums; /* leaves of this rank whose sums were integrated */
} hr2dpi_transport;

/* Not collective: HR2D_OK or HR2D_ENOMEM.  Call hr2dpi_transport_clear() in any case. */
hr2d_status hr2dpi_transport_init(hr2dpi_transport *t, hr2dp *p);
void hr2dpi_transport_clear(hr2dpi_transport *t);

/* Takes the components of an exchange, which must outlive the transport; before any gather.
   HR2D_OK or HR2D_ENOMEM; not collective. */
hr2d_status hr2dpi_transport_join(hr2dpi_transport *t, const uint32_t *component, size_t count);

/* Collective: irradiance = K radiosity. */
PetscErrorCode hr2dpi_transport_apply(hr2dpi_transport *t, const double *radiosity,
                                      double *irradiance);

/* Collective: per element that is own or above the cut, the sum of the form factors of its own
   links: of those over which it receives, or over which it sends. */
PetscErrorCode hr2dpi_transport_link_rows(hr2dpi_transport *t, int sends, double *factor);

/* Collective: averages of a field on own leaves over all own elements and those above the cut,
   in t->up. */
PetscErrorCode hr2dpi_transport_average(hr2dpi_transport *t, const double *field);

/* Collective: the same for patches, on every rank: patches × bands. */
PetscErrorCode hr2dpi_transport_patch_averages(hr2dpi_transport *t, const double *field,
                                               double *average);

/* Collective: one number per element of own leaves becomes the mean of elements above. */
PetscErrorCode hr2dpi_transport_means(hr2dpi_transport *t, double *value);

/* Whether this rank speaks for a patch whose root is an own element, or, above the cut, for a
   patch of all ranks. */
int hr2dpi_transport_has_root(const hr2dpi_transport *t, size_t patch);

#endif
