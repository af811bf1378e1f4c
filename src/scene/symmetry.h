/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mirrors and the period of a scene.

   The symmetries of the plane that they generate are motions g = T^k f: f reflects at some of
   at most two mirrors, which are perpendicular, and T is the translation by the period.  Commit
   adds the image gP of each patch P to the patches, motion by motion: image g of patch k is
   patch g·cell + k.  Images are patches for everything that looks at geometry.  They have no
   light of their own: B on gP is that of P.

   Of the pairs of patches that a motion maps to each other one is linked.  With B = Σ over
   links as on any scene, what arrives on gP arrives on P: H on P is the sum of H over all gP,
   see solve/image-map.h.

   There are infinitely many T^k.  Those with |k| ≤ K are taken.  Behind them stand black ends
   across the scene, which show how much is cut off. */
#ifndef HR2D_SRC_SCENE_SYMMETRY_H
#define HR2D_SRC_SCENE_SYMMETRY_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stddef.h>
#include <stdint.h>

#include "base/alloc.h"
#include "base/watch.h"

enum { HR2DI_MIRRORS = 3 /* at most: two are parallel, the third is across them */ };

/* How terms f(k) of a series in 1/k stand for those with k > K: Σ weight[k] f(k), for k ≤ K.
   Two checks: Σ check[c][k] f(k) is what that differs by from the sum without the last power of
   1/k, and from the sum by some terms up to ¾K. */
enum { HR2DI_MOST_COPIES = 256 };
enum { HR2DI_CHECK_LAST, HR2DI_CHECK_PART, HR2DI_TAIL_CHECKS };

/* With more images than that the series is much better than nothing. */
enum { HR2DI_FEW_COPIES = 8 };

/* In the place of a check: all that is extrapolated. */
enum { HR2DI_CHECK_ALL = HR2DI_TAIL_CHECKS };

/* g = T^k f. */
typedef struct hr2di_motion {
  unsigned mirrors; /* f: bit m for mirror m of hr2di_generators */
  int periods;      /* k */
  int turned;       /* left becomes right: an image runs from the image of b to that of a */
  uint32_t inverse; /* the number of g⁻¹ */
  double weight;    /* of exchange areas with images by g: 1, or more where they stand for those
                       that are cut off as well */
  double check[HR2DI_TAIL_CHECKS]; /* how much of this checks of the extrapolation leave */
} hr2di_motion;

typedef struct hr2di_tail {
  double weight[HR2DI_MOST_COPIES + 1];
  double check[HR2DI_TAIL_CHECKS][HR2DI_MOST_COPIES + 1];
  double half[HR2DI_MOST_COPIES + 1]; /* from terms up to ½K, less those from there to K */
} hr2di_tail;

/* For series that begin with k^−power. */
void hr2di_tail_set(hr2di_tail *t, unsigned copies, int power);

/* How many times the larger one of both checks an extrapolation may be off, if a vertex hides
   some of the images, see scene/period-weights.c. */
#define HR2DI_TAIL_BOUND 32

/* The powers with which the series begin: that of an exchange area of two patches, and that of
   the angle under which a point sees a patch. */
enum { HR2DI_TAIL_OF_PATCHES = 3, HR2DI_TAIL_OF_POINTS = 2 };

/* What generates the motions, in scene lengths. */
typedef struct hr2di_generators {
  size_t mirrors;             /* at most 2 */
  hr2d_point at[2], along[2]; /* a point of each, and its unit direction */
  int periodic;
  hr2d_point period;
} hr2di_generators;

typedef struct hr2di_symmetry {
  hr2d_segment mirror[HR2DI_MIRRORS]; /* as given */
  size_t mirrors;
  hr2d_point period; /* as given; 0 without one */
  /* Made by commit: */
  hr2di_generators by;
  hr2di_motion *motion; /* number 0 maps each patch to itself; NULL: no images */
  size_t motions;
  size_t cell;         /* patches that were given */
  hr2d_segment *added; /* where they were drawn, if some were moved by periods; else NULL */
  size_t ends;         /* black patches behind all images */
  unsigned copies;     /* K */
  double low, high;    /* the extent of the patches across the period, see below */
  double line[2]; /* how far the ends are from the origin, against the period and along it, in
                     scene lengths */
  hr2di_tail points;        /* of what a point sees past the ends, if there is a period, */
  hr2di_tail patches;       /* and of its integral along a patch */
  size_t low_suns, low_sun; /* suns that shine past the ends, and the first of them */
  double rest; /* the largest part of the directions of a patch that the ends take */
} hr2di_symmetry;

static inline int hr2di_symmetry_wanted(const hr2di_symmetry *s) {
  return s->mirrors > 0 || s->period.x != 0 || s->period.y != 0;
}

/* Whether images go on for ever, and some of those that are cut off can be seen. */
static inline int hr2di_symmetry_cuts(const hr2di_symmetry *s) {
  return s->motion && s->rest > 0;
}

/* The patches of which no other is an image. */
static inline size_t hr2di_symmetry_cell(const hr2di_symmetry *s, size_t patches) {
  return s->motion ? s->cell : patches;
}

/* Whether commit has added the patch: as an image of another, or as an end. */
static inline int hr2di_symmetry_is_image(const hr2di_symmetry *s, size_t patch) {
  return s->motion && patch >= s->cell;
}

/* The patch of which another one is an image; itself, if it is none. */
static inline size_t hr2di_symmetry_original(const hr2di_symmetry *s, size_t patch) {
  return s->motion && patch < s->motions * s->cell ? patch % s->cell : patch;
}

/* The part of its exchange area with which the pair of two patches is linked; 0: it is not, as
   the pair is the image of another one, or none of them counts.  Of a patch and its image both
   ends of a link receive for the same patch: if g = g⁻¹ they receive half each, otherwise one
   of g and g⁻¹ is linked.  A directed link receives at its first end alone. */
double hr2di_symmetry_weight(const hr2di_symmetry *s, size_t first, size_t second,
                             int directed);

/* What a check of the extrapolation, or all of it, leaves of the weight of a pair, as a part of
   that. */
double hr2di_symmetry_check(const hr2di_symmetry *s, size_t first, size_t second, int check);

/* The largest weight, or what a check leaves of it, up to its sign; 1 without images.  Exchange
   areas of an element, with their weights, add up to this many times its length at most. */
double hr2di_symmetry_max(const hr2di_symmetry *s);

/* How many periods away a patch is whose image stands for others; 0 if it is none. */
static inline unsigned hr2di_symmetry_term(const hr2di_symmetry *s, size_t patch) {
  const size_t number = patch / s->cell;
  if (!s->by.periodic || number >= s->motions) return 0;
  const int k = s->motion[number].periods;
  return (unsigned)(k < 0 ? -k : k);
}

static inline int hr2di_symmetry_is_end(const hr2di_symmetry *s, size_t patch) {
  return s->motion && patch >= s->motions * s->cell;
}

struct hr2d_scene;

/* What a point sees of the strip that the period sweeps, past one of the ends and above or
   below: seen from there, the sky that shows in period k of that end is left through the upper
   or lower border of the strip at distances from line − (K − k + 1) D on, over D. */
typedef struct hr2di_quadrant {
  hr2d_point out, up; /* unit vectors: towards the end, and across */
  double line;        /* the distance of the end, along `out` */
  double border; /* that of the border, along `up`; not above 0: rays are out of the strip */
  double period; /* D */
} hr2di_quadrant;

/* As seen from a point in scene lengths; `end` is 1 for the one along the period. */
hr2di_quadrant hr2di_symmetry_quadrant(const hr2di_symmetry *s, hr2d_point x, int end,
                                       int above);

/* The distances between which period k shows the sky; 0 for what is past the end, up to
   HUGE_VAL. */
void hr2di_quadrant_of(const hr2di_symmetry *s, const hr2di_quadrant *q, unsigned k,
                       double distance[2]);

/* The bearing of the sky past an end. */
double hr2di_quadrant_bearing(const hr2di_quadrant *q);

/* Whether a bearing is that of the period or its opposite, about. */
int hr2di_symmetry_is_along(const hr2di_symmetry *s, double bearing);

/* Whether a piece of the sky ends where patches see it past an end only, and at which bearing.
 */
int hr2di_sky_changes_past_ends(const struct hr2d_scene *scene, double *bearing);

/* Whether a continuous sky is not constant there. */
int hr2di_sky_varies_past_ends(const struct hr2d_scene *scene);

/* The point, moved by periods to between the patches themselves. */
hr2d_point hr2di_symmetry_home(const hr2di_symmetry *s, hr2d_point x);

/* Finds the generators of the mirrors and the period, or fails with a message. */
hr2d_status hr2di_symmetry_find(struct hr2d_scene *scene, hr2di_watch *watch);

/* Where a motion takes a point.  Points within `touch` of a mirror stay where they are. */
hr2d_point hr2di_symmetry_move(const hr2di_generators *by, const hr2di_motion *g, hr2d_point p,
                               double touch);

/* What is within so much of a line of the scene lies on it, in scene lengths. */
double hr2di_symmetry_touch(const struct hr2d_scene *scene);

/* The form factor of the ends from a point that sees none of them but by roundings, as where
   all images are in a line with it; 0 without ends. */
double hr2di_symmetry_sliver(const struct hr2d_scene *scene);

/* Moves patches that were drawn more than a period apart, and back to where they were. HR2D_OK,
   or a status with a message. */
hr2d_status hr2di_scene_make_one_cell(struct hr2d_scene *scene, hr2di_watch *watch);

/* Adds the images of all patches for K = `copies`, and the ends.  HR2D_OK, or a status with a
   message. */
hr2d_status hr2di_scene_unfold(struct hr2d_scene *scene, unsigned copies, hr2di_watch *watch);

/* Adds the ends behind all images.  HR2D_OK, or a status with a message. */
hr2d_status hr2di_scene_add_ends(struct hr2d_scene *scene, hr2di_watch *watch);

/* The least K with which sunlight on the patches comes past none of the ends, and the most that
   are tried; 0 without a period.  Suns for which no K is enough are counted in `low_suns`. */
void hr2di_symmetry_copies(struct hr2d_scene *scene, unsigned *min, unsigned *max);

/* Whether no K is enough for a sun; also when images are made. */
int hr2di_symmetry_is_low(const struct hr2d_scene *scene, size_t sun);

/* Measures what the ends take, in a scene with a plane if there can be one. */
hr2d_status hr2di_scene_measure_ends(struct hr2d_scene *scene, hr2di_watch *watch);

/* Sets the weights of motions for K = `copies`; or all to 1, if nothing that is cut off can be
   seen. */
void hr2di_symmetry_set_weights(hr2di_symmetry *s);
void hr2di_symmetry_forget_weights(hr2di_symmetry *s);

/* Forgets what commit has made. */
static inline void hr2di_symmetry_clear(hr2di_symmetry *s, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, s->motion);
  s->motion = NULL;
  s->motions = s->cell = s->ends = 0;
  s->rest = 0;
}

#endif
