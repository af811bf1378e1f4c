/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light that a point gets through gas. */
#ifndef HR2D_SRC_FIELD_LIGHT_IN_GAS_H
#define HR2D_SRC_FIELD_LIGHT_IN_GAS_H

#include "field/light-strip.h"

/* Adds what comes from a part of a strip and from the gas on the way: T B + D E_g in the flux,
   and with Ki₂ for (4/π) Ki₃ in the mean.  It takes an angle, and ∫ω dω of it is `vector`. */
void hr2di_light_add_in_gas(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span part,
                            double angle, hr2d_point vector);

/* Adds a part that a rule may take as a whole. */
void hr2di_light_add_far_in_gas(hr2di_light_sum *sum, const hr2di_strip *s, hr2di_span part,
                                const hr2di_rule *rule);

#endif
