/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light that the gases of a scene send and take. */
#ifndef HR2D_SRC_SOLVE_GAS_LIGHT_H
#define HR2D_SRC_SOLVE_GAS_LIGHT_H

#include "solve/transport.h"

/* The length of a leaf in integrals over the patches: 0 on images. */
double hr2di_gas_light_area(const hr2di_transport *t, size_t leaf);

/* The part m of the light of leaves that is lost to gas, leaves × gas_order; NULL if nothing
   is, as there is no gas or all of it gives back what it takes. */
const double *hr2di_gas_light_lost(const hr2di_transport *t);

/* Adds the irradiance that comes from gas whatever B is, divided by 2^exponent of the band:
   Σ m E_g, with gases of given heat as hot as that heat and other gases make them. */
void hr2di_gas_light_add(const hr2di_transport *t, const int *exponent, double *irradiance);

/* Adds what gases of given heat give back of what patches send them.  Such a gas is one more
   patch that sees all others, and what it takes it gives. */
void hr2di_gas_light_return(const hr2di_transport *t, const double *radiosity,
                            double *irradiance);

/* E_g of a gas in a band, by 2^exponent as B is: given, or as it follows from the heat. */
double hr2di_gas_light_emission(const hr2di_transport *t, size_t gas, size_t band, int exponent,
                                const double *radiosity);

/* The heat of a gas in a band, likewise, in units of the scene: Q, or ∫m(E_g − B) and what it
   exchanges with other gases, which is no difference of powers. */
double hr2di_gas_light_heat(const hr2di_transport *t, size_t gas, size_t band, int exponent,
                            const double *radiosity);

#endif
