/* SPDX-License-Identifier: GPL-3.0-or-later */
/* B = E + SH on the leaves of panes, see scene/panes.h: what leaves do elsewhere by ρ, or by
   its root, those of a pane do by a matrix for both sides.  Coefficient l of the other side has
   a factor (−1)^l, as the sides run against each other.

   With S = Lσ L for σ = ±1 on its eigenvectors, L = √|S|, the equation of equation.h has L in
   the place of the first √ρ, and σL in the place of the second.  Where ρρ′ ≥ τ² that is L
   again, and the system stays symmetric. */
#ifndef HR2D_SRC_SOLVE_SCATTERING_H
#define HR2D_SRC_SOLVE_SCATTERING_H

#include "scene/panes.h"
#include "solve/transport.h"

/* Functions of S: itself, L, σL, and the inverse of L where it has one, else 0. */
typedef enum hr2di_scattering_part {
  HR2DI_SCATTERING,
  HR2DI_SCATTERING_ROOT,
  HR2DI_SCATTERING_SIGNED_ROOT,
  HR2DI_SCATTERING_INVERSE_ROOT,
  HR2DI_SCATTERING_PARTS
} hr2di_scattering_part;

/* Leaves on both sides of a pane. */
typedef struct hr2di_leaf_pair {
  uint32_t front, back;
} hr2di_leaf_pair;

typedef struct hr2di_scattering {
  hr2di_leaf_pair *pair;
  hr2di_pane_matrix *matrix; /* pairs × parts × bands, as seen from the front */
  size_t pairs;
  int indefinite; /* some S has an eigenvalue below 0 */
} hr2di_scattering;

/* Finds the pairs of leaves; nothing without panes.  HR2D_OK or HR2D_ENOMEM; to be cleared in
   any case. */
hr2d_status hr2di_scattering_init(hr2di_scattering *s, const hr2di_transport *t);
void hr2di_scattering_clear(hr2di_scattering *s, const hr2d_allocator *alloc);

/* Takes ρ and τ of the scene of the transport.  HR2D_OK or the status of the watch. */
hr2d_status hr2di_scattering_set(hr2di_scattering *s, const hr2di_transport *t);

/* field = the part times field on the leaves of panes, order × bands coefficients each; other
   leaves keep theirs. */
void hr2di_scattering_apply(const hr2di_scattering *s, hr2di_scattering_part part, size_t order,
                            size_t bands, double *field);

/* Coefficient l in a band of SH on a leaf, of a field of H. */
double hr2di_scattered_at(const hr2di_transport *t, size_t leaf, size_t l, size_t band,
                          const double *irradiance);

#endif
