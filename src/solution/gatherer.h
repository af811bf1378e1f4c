/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a point of a patch sees of a solution: the work space of a gather. */
#ifndef HR2D_SRC_SOLUTION_GATHERER_H
#define HR2D_SRC_SOLUTION_GATHERER_H

#include "base/legendre.h"
#include "blocks/line-vector.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "visibility/point-view.h"

enum { HR2DI_GATHER_POINTS = 32 /* of the longest rule */ };

/* Of hr2di_gatherer::surface. */
enum { HR2DI_SURFACE_ARRAYS = 10 };

typedef struct hr2di_gatherer {
  const hr2d_solution *solution;
  hr2di_point_viewer *viewer;
  hr2di_watch *watch;
  hr2di_basis basis;
  hr2di_rule rule[HR2DI_GATHER_POINTS]; /* of 1, 2, … points; none yet where there are 0 */
  double enough[HR2DI_GATHER_POINTS];   /* the least ellipse for which they are enough */
  hr2d_point x, normal;
  hr2d_point base;     /* the end of its patch that is nearer to x */
  hr2di_vector offset; /* from there to x */
  double *value;       /* per band: H */
  double factor; /* the form factor that panels have found of the visible interval under way */
  double *edge;  /* per band: the irradiance of the other patch of a wedge */
  double *far;   /* per band: the irradiance at the farther one of two points */
  double *current; /* per band: that from one visible interval */
  double *place;   /* per band: B at a place that is seen */
  double *surface; /* E and ρ of both sides of a wedge, the same behind a pane, what is passed,
                      and how it grows; per band */
  int behind;      /* a wedge behind a pane is looked at */
  int has_gas;     /* between the patches */
  int past;        /* the point sees what is past the ends of a period */
} hr2di_gatherer;

/* A patch that touches the point, as one side of a wedge. */
typedef struct hr2di_edge {
  size_t patch;
  double at, step; /* fraction of the patch where the edge is, and how exactly that is known */
  double inside;   /* 1 if that is ahead along the patch, −1 if behind */
} hr2di_edge;

/* Clear it even after a failure. */
hr2d_status hr2di_gatherer_init(hr2di_gatherer *g, const hr2d_solution *solution,
                                hr2di_watch *watch);
void hr2di_gatherer_clear(hr2di_gatherer *g);

/* Sets the point at fraction t of a patch. */
void hr2di_gatherer_set_point(hr2di_gatherer *g, const hr2di_patch *patch, double t);

/* Where a patch is nearest to the point, as a fraction of it within a range; *distance may be
   NULL. */
double hr2di_gatherer_nearest(const hr2di_gatherer *g, size_t patch, double from, double to,
                              double *distance);

/* Sets the irradiance from everything but the patch that makes a wedge, which may be NULL.
 *wedge is the form factor of that patch, and *others that of everything else. */
hr2d_status hr2di_gatherer_look(hr2di_gatherer *g, size_t patch, double t,
                                const hr2di_edge *without, double *irradiance, double *wedge,
                                double *others);

/* What a point sees past the ends of a period, see hr2di_solution_gather_past(). */
hr2d_status hr2di_gatherer_look_past(hr2di_gatherer *g, size_t patch, double t, double *past,
                                     double *ends);

/* Looks for a patch that makes a wedge with the point's own one, and if so sets *closed and the
   limit of the irradiance (wedge-limit.c). */
hr2d_status hr2di_gatherer_close_wedge(hr2di_gatherer *g, size_t patch, double t,
                                       double *irradiance, int *closed);

#endif
