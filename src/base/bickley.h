/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a grey gas lets through along a line.

   A line of a plane section stands for all lines above it.  In the section of a long enclosure
   they are longer by 1/cos β, and at an optical depth x in the section
     T(x) = (4/π) Ki₃(x),   Ki_n(x) = ∫₀^{π/2} cos^{n−1} β e^{−x/cos β} dβ
   of the light arrives (Bickley and Nayler 1935; Abramowitz and Stegun 11.2).  In a flat world
   T(x) = e^{−x}.  D = 1 − T is absorbed.

   Ki_2 to Ki_4 are within 1e-15 of themselves for depths up to 700, and so are T and D.  Means
   over chords are within 5e-16 of 1 and 1e-14 of themselves.  Thin gas keeps all digits of D.
 */
#ifndef HR2D_SRC_BASE_BICKLEY_H
#define HR2D_SRC_BASE_BICKLEY_H

#include <hr2d/gas.h>

/* Less than a rounding arrives at this depth. */
#define HR2DI_GAS_DARK 44

double hr2di_bickley_2(double x);
double hr2di_bickley_3(double x);
double hr2di_bickley_4(double x);

/* The parts of the light that arrive and that are absorbed. */
typedef struct hr2di_passage {
  double arrives, absorbed;
} hr2di_passage;

/* At a depth x ≥ 0. */
hr2di_passage hr2di_passage_at(hr2d_section section, double x);

/* The same of the mean over all directions around a point, at a depth x: Ki₂, or e^−x. */
hr2di_passage hr2di_passage_of_mean(hr2d_section section, double x);

/* The mean over depths that vary linearly from x to y. */
hr2di_passage hr2di_passage_mean(hr2d_section section, double x, double y);

#endif
