/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How radiosity behaves where two patches touch. */
#ifndef HR2D_SRC_ACCURACY_CORNER_EXPONENT_H
#define HR2D_SRC_ACCURACY_CORNER_EXPONENT_H

/* The exponent γ of B ~ x^γ at distance x from a corner of angle α in (0,π): the root of
   √(ρ1ρ2) K̂(γ) = 1 in [0,1), with K̂(γ) = ∫₀^∞ k(1,t) t^γ dt and
   k(s,t) = ½ s t sin²α/(s²+t²−2st cosα)^{3/2}.  1 where no light goes to and fro (ρ1ρ2 = 0).
   Good to 1e-13, for which a root close to 1 may be 1; 1.3 µs. */
double hr2di_corner_exponent(double angle, double rho1, double rho2);

#endif
