/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the calls for the field have in common: a scene with a plane, and threads that take
   points in groups. */
#ifndef HR2D_SRC_FIELD_FIELD_IMPL_H
#define HR2D_SRC_FIELD_FIELD_IMPL_H

#include <hr2d/field.h>
#include <math.h>

#include "field/visibility-polygon.h"
#include "scene/with-plane.h"

/* A scene with a plane, or HR2D_ESCENE if nobody knows how its walls cross; otherwise as
   hr2di_with_plane_init(). */
hr2d_status hr2di_field_scene_init(hr2di_with_plane *s, const hr2d_scene *scene,
                                   hr2di_watch *watch);

/* A point in scaled coordinates. */
static inline hr2d_point hr2di_field_scaled(const hr2d_scene *scene, hr2d_point at) {
  return (hr2d_point){ldexp(at.x, -scene->exponent), ldexp(at.y, -scene->exponent)};
}

/* Whether all coordinates are finite. */
int hr2di_field_finite(const hr2d_point *at, size_t count);

/* Whether there is light where nothing stands. */
int hr2di_field_lit_sky(const hr2d_scene *scene);

/* Where a point is that sees fronts and sky under these angles. */
hr2d_place hr2di_field_place(const hr2d_scene *scene, double front, double sky, int touches);

/* Does one task.  Returns HR2D_OK, or a status that ends the call. */
typedef struct hr2di_field_worker hr2di_field_worker;
typedef hr2d_status (*hr2di_field_fn)(void *ctx, hr2di_field_worker *w, size_t task);

/* One thread. */
struct hr2di_field_worker {
  hr2di_watch own, *watch;
  hr2di_visibility_polygon view;
  double *room; /* of `needs` doubles */
  hr2d_status status;
};

/* Runs tasks in threads, each of which has room for so many doubles, and looks round at this
   scene.  Adds the triangles that were looked through to *steps.  HR2D_OK, HR2D_ENOMEM, the
   status of the watch, or that of a task. */
typedef struct hr2di_field_team {
  const hr2d_scene *scene;
  hr2di_watch *watch;
  unsigned threads;
  size_t needs;
  hr2di_field_fn run;
  void *ctx;
} hr2di_field_team;

hr2d_status hr2di_field_team_run(const hr2di_field_team *team, size_t tasks, uint64_t *steps);

#endif
