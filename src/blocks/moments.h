/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Integrals over the lines of one direction, summed over many directions. */
#ifndef HR2D_SRC_BLOCKS_MOMENTS_H
#define HR2D_SRC_BLOCKS_MOMENTS_H

#include <hr2d/memory.h>
#include <hr2d/status.h>

#include "base/legendre.h"

/* Directions are summed in batches of LANES, and wait until there are as many. */
enum { HR2DI_MOMENT_LANES = 8, HR2DI_MOMENT_ROOM = HR2DI_RULE_POINTS + HR2DI_MOMENT_LANES };

/* Which elements the lines of a direction cover from end to end.  Their number is that of the
   element that they do not. */
typedef enum hr2di_cover { HR2DI_COVERS_J, HR2DI_COVERS_I, HR2DI_COVERS_NEITHER } hr2di_cover;

/* Directions that wait.  Their outermost lines meet element k, i or j, at ξ = centre ± half, in
   [-1,1].  The line that meets i at centre + σ half meets j at centre − σ half. */
typedef struct hr2di_directions {
  size_t count;
  double weight[HR2DI_MOMENT_ROOM];
  double centre[2][HR2DI_MOMENT_ROOM], half[2][HR2DI_MOMENT_ROOM];
} hr2di_directions;

typedef struct hr2di_moments {
  size_t order;
  hr2di_directions waiting[3];   /* by hr2di_cover */
  double square[HR2D_MAX_ORDER]; /* of the recurrence of monic Legendre polynomials */
  double norm[HR2D_MAX_ORDER];   /* mean squares of these */
  double scale[HR2D_MAX_ORDER];  /* 1/√ of that */
  double *row[2];                /* order × order × LANES, order rounded up to even */
} hr2di_moments;

/* HR2D_OK or HR2D_ENOMEM; call hr2di_moments_clear() in either case. */
hr2d_status hr2di_moments_init(hr2di_moments *moments, size_t order,
                               const hr2d_allocator *alloc);
void hr2di_moments_clear(hr2di_moments *moments, const hr2d_allocator *alloc);

/* Forgets the directions that wait. */
void hr2di_moments_begin(hr2di_moments *moments);

/* Makes room for HR2DI_RULE_POINTS more directions: adds Σ weight · mean over σ of φ_l φ_m to
   block_lm, order × order numbers, for full batches. */
hr2di_directions *hr2di_moments_room(hr2di_moments *moments, hr2di_cover cover, double *block);

/* Adds all directions that wait. */
void hr2di_moments_end(hr2di_moments *moments, double *block);

#endif
