/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exponent of radiosity at a corner, where two patches touch. */
#ifndef HR2D_SRC_MESH_CORNER_EXPONENT_H
#define HR2D_SRC_MESH_CORNER_EXPONENT_H

/* The exponent γ of B ~ x^γ at distance x from a corner of angle α in (0,π): the root of
   √(ρ1ρ2) K̂(γ) = 1 in [0,1), with K̂(γ) = ∫₀^∞ k(1,t) t^γ dt and
   k(s,t) = ½ s t sin²α/(s²+t²−2st cosα)^{3/2}.  It is 1 where no light is reflected to and fro
   (ρ1ρ2 = 0).  Accurate to 1e-13: a root that close to 1 may become 1.  Takes 1.3 µs. */
double hr2di_corner_exponent(double angle, double rho1, double rho2);

#endif
