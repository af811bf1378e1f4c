/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the walls near a patch in the tree of boxes, and of many points those in front of or
   behind a wall in a grid. */
#include "mesh/mirror-images.h"

#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "geometry/bernstein-ellipse.h"
#include "geometry/predicates.h"
#include "mesh/point-grid.h"
#include "occlusion/wall-tree.h"
#include "scene/scene-impl.h"

/* So many points are worth a grid. */
enum { GRID_POINTS = 64 };

typedef struct mirror {
  const hr2d_scene *scene;
  const hr2di_patch *patch;
  double max;
  hr2di_image_points *points;
  size_t count;
  hr2di_point_grid grid; /* of the points, if there are many */
  hr2di_watch *watch;
  const hr2di_sun_border *border; /* on the patch */
  size_t borders;
} mirror;

/* Whether a box is nearer to the patch than the patch is long. */
static int is_near(const hr2di_patch *p, const hr2di_box *box) {
  const hr2d_segment s = p->scaled;
  const double reach = p->length;
  return box->x0 <= fmax(s.a.x, s.b.x) + reach && box->x1 >= fmin(s.a.x, s.b.x) - reach &&
         box->y0 <= fmax(s.a.y, s.b.y) + reach && box->y1 >= fmin(s.a.y, s.b.y) - reach;
}

/* Images that roundings alone keep off the patch are on the patch itself, behind a wall that
   stands on it.  Scaled coordinates are at most 1. */
#define ON_PATCH (16 * DBL_EPSILON)

static int is_on_patch(const hr2di_patch *p, hr2d_point v) {
  const hr2d_segment s = p->scaled;
  const double above = fabs(hr2di_orient(s.a, s.b, v)) / p->length;
  return above <= ON_PATCH && hr2di_ellipse(s, v) <= 1 + ON_PATCH;
}

/* Adds the image of v in a wall if
   - the foot of v is on the wall; if not, the wall's own end is the near point;
   - the patch reaches to v's side of the wall; `side` is how far it reaches to the left and to
     the right.
   A part of the wall is in front of the patch; the image itself need not be. */
static hr2d_status add_image(mirror *m, hr2d_segment wall, const double side[2], hr2d_point v) {
  const hr2d_segment s = m->patch->scaled;
  const double ux = wall.b.x - wall.a.x, uy = wall.b.y - wall.a.y, square = ux * ux + uy * uy;
  const double at = ((v.x - wall.a.x) * ux + (v.y - wall.a.y) * uy) / square;
  if (!(at > 0 && at < 1)) return HR2D_OK;
  const double off = hr2di_orient(wall.a, wall.b, v) / square;
  if (!(off > 0 ? side[0] > 0 : off < 0 && side[1] < 0)) return HR2D_OK;
  const hr2d_point image = {v.x + 2 * off * uy, v.y - 2 * off * ux};
  if (hr2di_ellipse(s, image) >= m->max || is_on_patch(m->patch, image)) return HR2D_OK;
  hr2di_image_points *points = m->points;
  if (hr2di_alloc_reserve(&m->scene->alloc, &points->point, &points->capacity,
                          points->count + 1, sizeof *points->point))
    return HR2D_ENOMEM;
  points->point[points->count++] = image;
  return HR2D_OK;
}

/* The images of the points whose foot may be on the wall. */
static hr2d_status add_strip(mirror *m, hr2d_segment wall, const double side[2]) {
  const hr2di_point_grid *g = &m->grid;
  hr2d_status status = HR2D_OK;
  for (uint32_t row = 0; row < g->rows && !status; row++) {
    const hr2di_grid_span span = hr2di_point_grid_strip(g, row, wall);
    const size_t start = (size_t)row * g->columns;
    const uint32_t last = g->first[start + span.to];
    status = hr2di_watch_work(m->watch, 1);
    for (uint32_t k = g->first[start + span.from]; k < last && !status; k++)
      status = add_image(m, wall, side, m->points->point[g->number[k]]);
  }
  return status;
}

static int is_in_front(const hr2di_patch *p, hr2d_segment wall) {
  const hr2d_segment s = p->scaled;
  const double min = 1e-13 * p->length * p->length;
  return !(hr2di_orient(s.a, s.b, wall.a) <= min && hr2di_orient(s.a, s.b, wall.b) <= min);
}

static hr2d_status add_wall(mirror *m, hr2d_segment wall) {
  const hr2d_segment s = m->patch->scaled;
  if (!is_in_front(m->patch, wall)) return HR2D_OK;
  const double of_a = hr2di_orient(wall.a, wall.b, s.a),
               of_b = hr2di_orient(wall.a, wall.b, s.b);
  const double side[] = {fmax(of_a, of_b), fmin(of_a, of_b)};
  hr2d_status status = add_image(m, wall, side, s.a);
  if (!status) status = add_image(m, wall, side, s.b);
  for (size_t k = 0; k < m->borders && !status; k++)
    status = add_image(m, wall, side, m->border[k].point);
  if (m->grid.rows > 0) return status ? status : add_strip(m, wall, side);
  for (size_t k = 0; k < m->count && !status; k++) {
    status = hr2di_watch_work(m->watch, 1);
    if (!status) status = add_image(m, wall, side, m->points->point[k]);
  }
  return status;
}

static hr2d_status examine_walls(mirror *m, uint32_t patch,
                                 const hr2di_visible_vertices *seen) {
  const hr2d_scene *scene = m->scene;
  uint32_t stack[2 * HR2DI_BOX_DEPTH];
  size_t waiting = 0;
  hr2d_status status = HR2D_OK;
  stack[waiting++] = 0;
  while (waiting > 0 && !status) {
    const uint32_t number = stack[--waiting];
    const hr2di_box *box = &scene->walls.box[number];
    status = hr2di_watch_work(m->watch, 1);
    if (status || !is_near(m->patch, box)) continue;
    if (box->wall == HR2DI_NO_WALL) {
      stack[waiting++] = box->below;
      stack[waiting++] = box->below + 1;
    } else if (box->wall != scene->walls.of_segment[patch] &&
               (!seen || hr2di_visible_vertices_has_wall(seen, box->wall))) {
      status = add_wall(m, scene->walls.wall[box->wall].at);
    }
  }
  return status;
}

hr2d_status hr2di_images_add(const hr2d_scene *scene, uint32_t patch, double max,
                             const hr2di_visible_vertices *seen, hr2di_image_points *points,
                             hr2di_watch *watch) {
  mirror m = {.scene = scene,
              .patch = &scene->patch[patch],
              .max = max,
              .points = points,
              .count = points->count,
              .watch = watch};
  hr2d_status status = HR2D_OK;
  m.border = hr2di_sunlight_borders(scene, patch, &m.borders);
  if (m.count >= GRID_POINTS)
    status = hr2di_point_grid_init(&m.grid, points->point, m.count, &scene->alloc, watch);
  if (!status) status = examine_walls(&m, patch, seen);
  hr2di_point_grid_clear(&m.grid, &scene->alloc);
  return status;
}
