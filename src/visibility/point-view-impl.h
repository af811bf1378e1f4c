/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of a point's view: the eye, rays from it, and what is seen between two rays. */
#ifndef HR2D_SRC_VISIBILITY_POINT_VIEW_IMPL_H
#define HR2D_SRC_VISIBILITY_POINT_VIEW_IMPL_H

#include "base/neumaier-sum.h"
#include "beams/triangular-expansion.h"
#include "geometry/determinant.h"
#include "scene/side-parts.h"
#include "visibility/point-view.h"

/* Coordinates are at most 2; times this, they neither overflow nor underflow. */
#define HR2DI_VIEW_SCALE 0x1p+400

/* A place that a ray goes to and that is no vertex of the triangulation. */
#define HR2DI_VIEW_NO_VERTEX UINT32_MAX

/* A ray from the eye to a place, or along the line of the patch. */
typedef struct hr2di_ray {
  hr2d_point at;       /* times HR2DI_VIEW_SCALE */
  hr2di_vector to;     /* from the eye, to 2^-104 of its length */
  double height;       /* over the line of the patch, its sign exact */
  double distance;     /* |to| */
  double sine, cosine; /* of the angle to the normal; the sine grows towards the patch's b */
  uint32_t vertex;     /* or HR2DI_VIEW_NO_VERTEX */
  int horizon;         /* 1: to the right, towards b; -1: to the left; else 0 */
} hr2di_ray;

/* Fraction t of a patch. */
typedef struct hr2di_viewpoint {
  size_t patch;
  double t;
  hr2d_point a, b;   /* the ends of the patch, times HR2DI_VIEW_SCALE */
  hr2d_point base;   /* the one that is nearer */
  hr2di_vector x;    /* from there to the eye */
  hr2di_vector axis; /* b − a, times a power of 2 */
  double length;     /* of the axis */
} hr2di_viewpoint;

void hr2di_viewpoint_init(hr2di_viewpoint *e, hr2d_segment patch, size_t number, double t);

/* A ray to a place; sets `at`, `to`, `vertex` and `horizon` only. */
void hr2di_ray_aim(const hr2di_viewpoint *e, hr2d_point place, uint32_t vertex, hr2di_ray *ray);

static inline hr2di_ray hr2di_ray_to(const hr2di_viewpoint *e, hr2d_point place) {
  hr2di_ray ray;
  hr2di_ray_aim(e, place, HR2DI_VIEW_NO_VERTEX, &ray);
  return ray;
}

/* Sets the rest; where the height is not positive, that is 0. */
void hr2di_ray_measure(const hr2di_viewpoint *e, hr2di_ray *ray);

/* The ray along the line of the patch, which a vertex may stand for. */
hr2di_ray hr2di_ray_horizon(int hand, uint32_t vertex);

/* Whether a ray turns left against another one that was measured: 1; right: −1; exact for the
   vectors `to`. */
int hr2di_ray_turn(const hr2di_viewpoint *e, const hr2di_ray *from, const hr2di_ray *to);

/* A place in plain doubles: from the base of the eye, and from the eye; the latter is off by up
   to 2^-51 of `size`, by component. */
typedef struct hr2di_ray_filter {
  hr2d_point from_base, to, size;
} hr2di_ray_filter;

static inline hr2di_ray_filter hr2di_ray_filter_at(const hr2di_viewpoint *e, hr2d_point place) {
  const double x = HR2DI_VIEW_SCALE * place.x - e->base.x;
  const double y = HR2DI_VIEW_SCALE * place.y - e->base.y;
  return (hr2di_ray_filter){
      {x, y}, {x - e->x.x, y - e->x.y}, {fabs(x) + fabs(e->x.x), fabs(y) + fabs(e->x.y)}};
}

/* hr2di_ray_turn() to that place, or 0 if roundings leave the sign in doubt. */
static inline int hr2di_ray_filter_turn(const hr2di_viewpoint *e, const hr2di_ray *from,
                                        const hr2di_ray_filter *g) {
  const hr2di_vector *u = from->horizon ? &e->axis : &from->to;
  const hr2d_point v = from->horizon ? g->from_base : g->to;
  const double det = u->x * v.y - u->y * v.x;
  const double doubt = 0x1p-49 * (fabs(u->x) * g->size.y + fabs(u->y) * g->size.x);
  const int sign = (det > doubt) - (det < -doubt);
  return from->horizon < 0 ? -sign : sign;
}

/* ½ |sin θ| between two rays that were measured; positive if `left` is on the left. */
double hr2di_ray_half_sine(const hr2di_ray *right, const hr2di_ray *left);

/* Where a ray meets a patch that shows its front, with rays to its ends. */
double hr2di_ray_fraction(const hr2di_ray *ray, const hr2di_ray *a, const hr2di_ray *b);

/* What is seen, if it is not a patch's front. */
#define HR2DI_SEEN_NOBODY  HR2DI_NOBODY /* a back: black */
#define HR2DI_SEEN_SKY     (HR2DI_NOBODY - 1)
#define HR2DI_SEEN_NOTHING (HR2DI_NOBODY - 2)

/* What is seen from the right ray to the left one. */
typedef struct hr2di_visible_arc {
  uint32_t patch; /* or what else it is */
  hr2di_ray right, left;
  int starts, ends;     /* with the patch's own start, on the right, and end */
  hr2di_wall_side side; /* of a back; HR2DI_HIDDEN: it lies at the eye.  Set by walks only */
} hr2di_visible_arc;

/* Takes a stretch with its visible interval, which has a part only of a patch.  HR2D_OK, or a
   status that ends the view. */
typedef hr2d_status (*hr2di_show_fn)(void *ctx, const hr2di_visible_arc *s,
                                     const hr2di_visible_interval *g);

struct hr2di_point_viewer {
  hr2d_allocator alloc;
  hr2di_watch *watch;
  const hr2d_scene *scene;
  hr2di_viewpoint viewpoint;
  hr2di_visible_arc seeing;           /* what may go on to the left */
  hr2di_triangular_expansion between; /* two rays */
  uint32_t own[2];   /* the edges of the wall of the eye are [own[0], own[1]) */
  double (*span)[2]; /* sines that something covers */
  size_t spans, span_room;
  hr2di_visible_interval *interval, *sorted;
  size_t intervals, interval_room, sorted_room;
  uint64_t *order; /* of visible intervals: their patches and their places */
  size_t order_room;
  hr2di_sum back;
  int sines_only;   /* fractions of visible intervals are not asked for */
  double (*arc)[2]; /* of the sky, if that has pieces */
  size_t arcs, arc_room;
  hr2di_show_fn show; /* takes what a walk sees, from the right to the left; or NULL */
  void *ctx;
};

/* Adds what a stretch shows.  HR2D_OK, HR2D_ENOMEM or the status of `show`. */
hr2d_status hr2di_view_add(hr2di_point_viewer *w, const hr2di_visible_arc *s);

/* Adds all that the eye sees: in the order of directions, between two rays that were measured,
   or between the horizons for NULL; or in the order of patches.  HR2D_OK, HR2D_ENOMEM or the
   status of the watch. */
hr2d_status hr2di_view_walk(hr2di_point_viewer *w, const hr2di_ray border[2]);
hr2d_status hr2di_view_all(hr2di_point_viewer *w);

#endif
