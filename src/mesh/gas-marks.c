/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where borders of gases make H less smooth.

   A point from which a border is seen end on sees one gas on one side of it and another gas on
   the other side: there the slope of H jumps.  Where a border meets a patch H has x ln x times
   the depth, as at a corner in gas.  Beside a knot H changes as fast as it is near. */
#include <math.h>

#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "mesh/grader.h"
#include "scene/regions.h"

/* The part of a ray at which it meets a segment, and where it does; HUGE_VAL if it does not. */
static double meets(hr2d_point from, hr2d_point ray, hr2d_segment s, double *at) {
  const hr2d_point along = hr2di_point_minus(s.b, s.a), to = hr2di_point_minus(s.a, from);
  const double turn = hr2di_point_cross(ray, along);
  const double far = hr2di_point_cross(to, along) / turn;
  *at = hr2di_point_cross(to, ray) / turn;
  return turn != 0 && *at >= 0 && *at <= 1 ? far : HUGE_VAL;
}

/* Whether a ray comes to a place through no other patch. */
static int is_first(const hr2d_scene *scene, uint32_t patch, hr2d_point from, hr2d_point ray,
                    double far) {
  for (size_t k = 0; k < scene->patches; k++) {
    double at;
    const double there = meets(from, ray, scene->patch[k].scaled, &at);
    if (k != patch && there > 0 && there < far) return 0;
  }
  return 1;
}

/* Marks where the line of a border, from one of its ends on, meets the front of a patch. */
static hr2d_status mark_end(hr2di_grader *g, uint32_t patch, hr2d_point from, hr2d_point end) {
  const hr2d_scene *scene = g->h->scene;
  const hr2d_segment s = scene->patch[patch].scaled;
  const hr2d_point ray = hr2di_point_minus(end, from);
  double at;
  const double far = meets(end, ray, s, &at);
  if (!(far > 0 && far < HUGE_VAL)) return HR2D_OK;
  if (hr2di_point_cross(hr2di_point_minus(s.b, s.a), ray) >= 0) return HR2D_OK;
  const hr2d_status status = hr2di_watch_work(g->grading->watch, scene->patches / 4);
  if (status || !is_first(scene, patch, end, ray, far)) return status;
  return hr2di_grading_add_mark(g, at, hr2di_point_at(s, at), (hr2di_grading_mark){.depth = 0});
}

/* Marks where a border meets a patch. */
static hr2d_status mark_foot(hr2di_grader *g, uint32_t patch, hr2d_segment border) {
  const hr2di_patch *p = &g->h->scene->patch[patch];
  const double own = hr2di_grading_reflectance(g->h->scene, patch);
  const double depth = hr2di_scene_scaled_range(g->h->scene).most * p->length;
  double at;
  const double far = meets(border.a, hr2di_point_minus(border.b, border.a), p->scaled, &at);
  if (!(far >= 0 && far <= 1)) return HR2D_OK;
  return hr2di_grading_add_mark(g, at, hr2di_point_at(p->scaled, at),
                                hr2di_grading_in_gas(g, 0, own, depth));
}

hr2d_status hr2di_grading_mark_gas(hr2di_grader *g, uint32_t patch) {
  const hr2di_regions *r = hr2di_scene_regions(g->h->scene);
  const hr2d_segment s = g->h->scene->patch[patch].scaled;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; r && k < r->borders && !status; k++) {
    const hr2d_segment border = r->border[k].at;
    status = hr2di_watch_work(g->grading->watch, 2);
    if (!status) status = mark_foot(g, patch, border);
    if (!status) status = mark_end(g, patch, border.a, border.b);
    if (!status) status = mark_end(g, patch, border.b, border.a);
  }
  for (size_t k = 0; r && k < r->knots && !status; k++)
    if (hr2di_orient(s.a, s.b, r->knot[k]) > 0)
      status = hr2di_grading_add_near(g, s, r->knot[k]);
  return status;
}
