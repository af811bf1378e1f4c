/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks: C_lm = ∫∫ G V φ_l(x) φ_m(y) dy dx over a pair of elements, a length; C_00 is their
   exchange area.  Blocks of near, touching, clipped and occluded pairs are exact to rounding;
   blocks of distant pairs are as accurate as the order needs. */
#ifndef HR2D_SRC_BLOCKS_BLOCK_H
#define HR2D_SRC_BLOCKS_BLOCK_H

#include <hr2d/oracle.h>

#include "base/legendre.h"
#include "base/watch.h"
#include "hierarchy/hierarchy-impl.h"
#include "occlusion/pair-visibility.h"

/* A pair i = ab, j = cd seen from x = a + s(b−a) and y = c + t(d−c). */
typedef struct hr2di_pair_frame {
  hr2d_segment i, j;
  hr2d_point along_i, along_j; /* b − a, d − c */
  hr2d_point apart;            /* c − a */
  double length_i, length_j;
  double above_i[2]; /* how far c and d are in front of the line of i */
  double above_j[2]; /* how far a and b are in front of the line of j */
  struct hr2di_span {
    double from, to;
  } front_i, front_j; /* the part of each that is in front of the other */
} hr2di_pair_frame;

typedef struct hr2di_span hr2di_span;

/* The part of a wall that is in the way: its ends, as indices into hr2di_integrator::point. */
typedef struct hr2di_screen {
  uint32_t end[2];
} hr2di_screen;

/* Work space of one thread. */
typedef struct hr2di_integrator {
  const hr2d_hierarchy *hierarchy;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  size_t order;
  hr2di_basis basis;
  hr2di_rule far, near, exact;  /* `exact` integrates φ_l φ_m exactly */
  double *phi_far, *phi_exact;  /* φ_0 … at the points of these rules */
  double *work;                 /* 2 × HR2DI_RULE_POINTS² */
  hr2di_visibility *visibility; /* NULL if the scene needs no occlusion */
  hr2di_wall_list found;
  hr2di_screen *screen;
  size_t screen_capacity;
  hr2d_point *point;
  size_t point_capacity;
  double *cut; /* fractions of i where the visible parts of j may change */
  size_t cut_capacity;
  struct hr2di_shadow *shadow;
  size_t shadow_capacity;
  uint64_t kernels; /* evaluations of G so far */
} hr2di_integrator;

/* Returns HR2D_OK or HR2D_ENOMEM.  Call hr2di_integrator_clear() in either case. */
hr2d_status hr2di_integrator_init(hr2di_integrator *work, const hr2d_hierarchy *hierarchy,
                                  const hr2d_allocator *alloc, size_t order,
                                  hr2di_watch *watch);
void hr2di_integrator_clear(hr2di_integrator *work);

/* Integrates the block of a pair: order × order numbers, row l for the first element.
   `distant` receives 1 if one tensor rule was enough, else 0.  Returns HR2D_OK, HR2D_ENOMEM or
   the status of the watch. */
hr2d_status hr2di_block(hr2di_integrator *work, hr2d_pair pair, double *block, int *distant);

/* Sets up the frame of a pair whose elements face each other as `facing` says.  Where the
   patches have a common end, the frame has more digits than the coordinates. */
void hr2di_pair_frame_init(hr2di_pair_frame *frame, const hr2d_hierarchy *hierarchy,
                           hr2d_pair pair, hr2di_facing facing);

/* One function per kind of pair.  Each adds to the block, which has no meaning once the watch
   has stopped. */
void hr2di_block_distant(hr2di_integrator *work, const hr2di_pair_frame *f, double *block);
void hr2di_block_touching(hr2di_integrator *work, const hr2di_pair_frame *f, int at_end,
                          double *block);
void hr2di_block_near(hr2di_integrator *work, const hr2di_pair_frame *f, double *block);
hr2d_status hr2di_block_occluded(hr2di_integrator *work, const hr2di_pair_frame *f,
                                 const hr2di_shaft *shaft, double *block);

/* moment_m += ∫ G(x,y) φ_m(y) dy over a part of j, at x = a + s(b−a). */
void hr2di_block_add_moments(hr2di_integrator *work, const hr2di_pair_frame *f, double s,
                             hr2di_span part, double *moment);

/* A part of i to integrate over.  seen() writes the parts of j that the point at s sees, and
   returns their number.  The integrand over x is smooth except near the points `singular`. */
typedef struct hr2di_strip {
  hr2di_span across; /* of i */
  const hr2d_point *singular;
  size_t singulars;
  size_t (*seen)(const void *ctx, double s, hr2di_span *part);
  const void *ctx;
} hr2di_strip;

/* The largest number that seen() may return. */
enum { HR2DI_PARTS = 64 };

void hr2di_block_add_strip(hr2di_integrator *work, const hr2di_pair_frame *f,
                           const hr2di_strip *strip, double *block);

static inline hr2d_point hr2di_block_along(hr2d_point from, hr2d_point direction, double part) {
  return (hr2d_point){from.x + part * direction.x, from.y + part * direction.y};
}

static inline double hr2di_block_mix(const double end[2], double part) {
  return end[0] + part * (end[1] - end[0]);
}

#endif
