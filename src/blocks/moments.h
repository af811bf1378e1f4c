/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Integrals over the lines of one direction, summed over many directions. */
#ifndef HR2D_SRC_BLOCKS_MOMENTS_H
#define HR2D_SRC_BLOCKS_MOMENTS_H

#include <hr2d/memory.h>
#include <hr2d/status.h>

#include "base/legendre.h"

/* Directions are taken in batches of LANES; at most ROOM of them wait. */
enum { HR2DI_MOMENT_LANES = 8, HR2DI_MOMENT_ROOM = 128 };

/* Lines of one direction, of which the outermost meet i and j at ξ = centre ± half, in [-1,1].
   The line that meets i at centre_i + σ half_i meets j at centre_j − σ half_j. */
typedef struct hr2di_moments {
  size_t order, count;
  double weight[HR2DI_MOMENT_ROOM];
  double centre_i[HR2DI_MOMENT_ROOM], half_i[HR2DI_MOMENT_ROOM];
  double centre_j[HR2DI_MOMENT_ROOM], half_j[HR2DI_MOMENT_ROOM];
  double square[HR2D_MAX_ORDER]; /* of the recurrence of monic Legendre polynomials */
  double norm[HR2D_MAX_ORDER];   /* mean squares of these */
  double scale[HR2D_MAX_ORDER];  /* 1/√ of that */
  double *on_i, *on_j;           /* order × order × LANES, order rounded up to even */
} hr2di_moments;

/* HR2D_OK or HR2D_ENOMEM; call hr2di_moments_clear() in either case. */
hr2d_status hr2di_moments_init(hr2di_moments *moments, size_t order,
                               const hr2d_allocator *alloc);
void hr2di_moments_clear(hr2di_moments *moments, const hr2d_allocator *alloc);

/* block_lm += Σ weight · mean over σ of φ_l φ_m, for the directions that wait; order × order
   numbers.  Unless `all` is set, less than LANES directions go on waiting. */
void hr2di_moments_add(hr2di_moments *moments, int all, double *block);

#endif
