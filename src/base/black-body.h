/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the library needs of the black body besides its public functions. */
#ifndef HR2D_SRC_BASE_BLACK_BODY_H
#define HR2D_SRC_BASE_BLACK_BODY_H

/* The temperature of a black body that emits `emitted` ≥ 0, in W/m². */
double hr2di_black_body_kelvin(double emitted);

/* d(fσT⁴)/d(σT⁴) of the part f between two wavelengths in micrometres, in [0,1], to 1e-14: over
   all bands the sum is 1. */
double hr2di_black_body_rise(double kelvin, double from, double to);

#endif
