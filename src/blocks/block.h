/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks: C_lm = ∫∫ G V φ_l(x) φ_m(y) dy dx over a pair of elements, a length; C_00 is their
   exchange area.  Exact to rounding for near and for touching pairs, for such as a horizon
   cuts or that things stand between; for distant ones as good as the order calls for. */
#ifndef HR2D_SRC_BLOCKS_BLOCK_H
#define HR2D_SRC_BLOCKS_BLOCK_H

#include <hr2d/oracle.h>

#include "base/legendre.h"
#include "hierarchy/hierarchy-impl.h"
#include "occlusion/pair-visibility.h"

/* A pair i = ab, j = cd seen from x = a + s(b−a) and y = c + t(d−c). */
typedef struct hr2di_pair_frame {
  hr2d_segment i, j;
  hr2d_point along_i, along_j; /* b − a, d − c */
  hr2d_point apart;            /* c − a */
  double length_i, length_j;
  double above_i[2]; /* how far c and d are in front of the line of i */
  double above_j[2]; /* a and b of the line of j */
  struct hr2di_span {
    double from, to;
  } front_i, front_j; /* what of each is in front of the other */
} hr2di_pair_frame;

typedef struct hr2di_span hr2di_span;

/* What of a wall is in the way: two of the points in hr2di_integrator::point. */
typedef struct hr2di_screen {
  uint32_t end[2];
} hr2di_screen;

/* Work space of one thread. */
typedef struct hr2di_integrator {
  const hr2d_hierarchy *hierarchy;
  hr2d_allocator alloc;
  size_t order;
  hr2di_basis basis;
  hr2di_rule far, near, exact;  /* the last integrates φ_l φ_m */
  double *phi_far, *phi_exact;  /* of the rules' points */
  double *work;                 /* 2 × HR2DI_RULE_POINTS × order, and more */
  hr2di_visibility *visibility; /* NULL where nothing is in the way */
  hr2di_wall_list found;
  hr2di_screen *screen;
  size_t screen_capacity;
  hr2d_point *point;
  size_t point_capacity;
  double *cut; /* where the view of j may change */
  size_t cut_capacity;
  struct hr2di_shadow *shadow;
  size_t shadow_capacity;
  uint64_t kernels; /* evaluations of G so far */
} hr2di_integrator;

/* HR2D_OK or HR2D_ENOMEM; to be ended by hr2di_integrator_clear() in either case. */
hr2d_status hr2di_integrator_init(hr2di_integrator *work, const hr2d_hierarchy *hierarchy,
                                  const hr2d_allocator *alloc, size_t order);
void hr2di_integrator_clear(hr2di_integrator *work);

/* The block of a pair, order × order, l for the first element, and whether it was integrated
   as that of a distant pair; HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_block(hr2di_integrator *work, hr2d_pair pair, double *block, int *distant);

/* How a pair lies that faces each other so, with more digits than coordinates have where their
   patches have a common end. */
void hr2di_pair_frame_init(hr2di_pair_frame *frame, const hr2d_hierarchy *hierarchy,
                           hr2d_pair pair, hr2di_facing facing);

/* The parts of the job; each adds to a block.  */
void hr2di_block_distant(hr2di_integrator *work, const hr2di_pair_frame *f, double *block);
void hr2di_block_touching(hr2di_integrator *work, const hr2di_pair_frame *f, int at_end,
                          double *block);
void hr2di_block_near(hr2di_integrator *work, const hr2di_pair_frame *f, double *block);
hr2d_status hr2di_block_occluded(hr2di_integrator *work, const hr2di_pair_frame *f,
                                 const hr2di_shaft *shaft, double *block);

/* moment_m += ∫ G(x,y) φ_m(y) dy over a part of j, at x = a + s(b−a). */
void hr2di_block_add_moments(hr2di_integrator *work, const hr2di_pair_frame *f, double s,
                             hr2di_span part, double *moment);

/* The parts of j that x sees; their number.  The integrand over x is smooth but near some
   points. */
typedef struct hr2di_strip {
  hr2di_span across; /* of i */
  const hr2d_point *singular;
  size_t singulars;
  size_t (*seen)(const void *ctx, double s, hr2di_span *part);
  const void *ctx;
} hr2di_strip;

/* The most parts that `seen` may return. */
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
