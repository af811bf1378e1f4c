/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light of gas, of which leaves get the part m that gas takes of theirs: t->gas. */
#ifndef HR2D_SRC_SOLVE_GAS_LIGHT_H
#define HR2D_SRC_SOLVE_GAS_LIGHT_H

#include "solve/transport.h"

/* The length of a leaf in integrals over the patches: 0 on images. */
double hr2di_gas_light_area(const hr2di_transport *t, size_t leaf);

/* Adds the irradiance that comes from gas whatever B is, divided by 2^exponent of the band:
   m E_g, or m Q/∫m of a gas of the heat Q. */
void hr2di_gas_light_add(const hr2di_transport *t, const int *exponent, double *irradiance);

/* Adds what gas of given heat gives back: m∫mB/∫m.  It is one more patch that sees all others,
   and what it takes it gives. */
void hr2di_gas_light_return(const hr2di_transport *t, const double *radiosity,
                            double *irradiance);

/* E_g of a band, by 2^exponent as B is: given, or (Q + ∫mB)/∫m. */
double hr2di_gas_light_emission(const hr2di_transport *t, size_t band, int exponent,
                                const double *radiosity);

/* The heat of the gas in a band, likewise, in units of the scene: Q, or ∫m(E_g − B), which is
   no difference of powers. */
double hr2di_gas_light_heat(const hr2di_transport *t, size_t band, int exponent,
                            const double *radiosity);

#endif
