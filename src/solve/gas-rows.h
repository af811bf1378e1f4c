/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What gas takes of the light of leaves. */
#ifndef HR2D_SRC_SOLVE_GAS_ROWS_H
#define HR2D_SRC_SOLVE_GAS_ROWS_H

#include "solve/transport.h"

/* Sets t->gas, and closure to make K1 + m = 1 on patches that see patches in every direction;
   elsewhere m = 1 − K1: what meets no patch is absorbed in the end.  Without `closed` there is
   no closure.  Fields have one band.  Returns HR2D_OK, HR2D_ENOMEM, the status of the watch, or
   HR2D_EUNSUPPORTED with a message if a patch sees backs: their emission is not that of gas. */
hr2d_status hr2di_gas_rows_set(hr2di_transport *t, int closed, hr2di_message *message);

/* Adds the irradiance m E_g from gas, with E_g of each band divided by 2^exponent. */
void hr2di_gas_rows_add(const hr2di_transport *t, const int *exponent, double *irradiance);

/* The heat of the gas in a band, ∫m(E_g − B) in units of the scene: no difference of powers. */
double hr2di_gas_rows_heat(const hr2di_transport *t, size_t band, double emission,
                           const double *radiosity);

#endif
