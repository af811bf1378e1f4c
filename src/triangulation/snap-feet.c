/* SPDX-License-Identifier: GPL-3.0-or-later */
/* As triangles are Delaunay, a vertex a rounding in front of a wall is opposite to it in a
   triangle.  The wall then takes the two other edges of the triangle, and the triangle, a
   sliver, is behind it. */
#include "triangulation/snap-feet.h"

#include "triangulation/cavity.h"
#include "triangulation/pieces.h"

/* Whether the apex is farther from the edge of h than any wall reaches, in plain doubles: the
   error of the determinant is below 2^-50 of its terms. */
static int surely_far(const hr2di_mesh *m, int32_t h) {
  const hr2d_point p = m->at[hr2di_mesh_from(m, h)], q = m->at[hr2di_mesh_to(m, h)],
                   v = m->at[hr2di_mesh_apex(m, h)];
  const double ux = q.x - p.x, uy = q.y - p.y, wx = v.x - p.x, wy = v.y - p.y;
  const double a = ux * wy, b = uy * wx;
  return a - b > 4 * m->tolerance * (fabs(ux) + fabs(uy)) + 0x1p-50 * (fabs(a) + fabs(b));
}

/* Whether the wall along h is to be led through the apex. */
static int is_foot(const hr2di_mesh *m, int32_t h) {
  const int32_t across = hr2di_mesh_across(m, h);
  if (across >= 0 || across == HR2DI_SKY || surely_far(m, h)) return 0;
  return hr2di_piece_distance(m, hr2di_mesh_piece(across), hr2di_mesh_apex(m, h)) < INFINITY;
}

/* Leads the wall along h through the apex, and all walls that share this stretch. */
static hr2d_status lead_through_apex(hr2di_mesh *m, int32_t h) {
  const uint32_t v = hr2di_mesh_apex(m, h), from = hr2di_mesh_from(m, h);
  const uint32_t first = hr2di_mesh_piece(hr2di_mesh_across(m, h));
  hr2di_piece_take(m, first);
  for (uint32_t k = first, next, rest; k != HR2DI_NO_PIECE; k = next) {
    next = hr2di_piece_part(m, k);
    const hr2d_status status = hr2di_piece_cut(m, k, v, &rest);
    if (status) return status;
    const int forward = from == m->piece[k].edge.from;
    hr2di_piece_put(m, forward ? rest : k, hr2di_mesh_next(h));
    hr2di_piece_put(m, forward ? k : rest, hr2di_mesh_before(h));
  }
  return HR2D_OK;
}

/* The triangle behind h, in which something changed, unless a wall was there before. */
static hr2d_status touch_behind(const hr2di_mesh *m, hr2di_cavity *c, int32_t h) {
  const int32_t back = hr2di_mesh_across(m, h);
  return back < 0 ? HR2D_OK : hr2di_cavity_touch(m, c, back >> 2);
}

/* *joined is whether a wall beside triangle t was led through a corner of it; the triangles to
   be looked at again are in the cavity then. */
static hr2d_status join(hr2di_mesh *m, hr2di_cavity *c, int32_t t, int *joined) {
  int32_t h = 4 * t;
  while (h < 4 * t + 3 && !is_foot(m, h)) h++;
  *joined = h < 4 * t + 3;
  if (!*joined) return HR2D_OK;
  hr2d_status status = touch_behind(m, c, hr2di_mesh_next(h));
  if (!status) status = touch_behind(m, c, hr2di_mesh_before(h));
  if (!status) status = lead_through_apex(m, h);
  if (!status) status = hr2di_cavity_look(m, c, h);
  return status ? status : hr2di_cavity_settle(m, c);
}

hr2d_status hr2di_feet_snap(hr2di_mesh *m) {
  hr2di_cavity c = {0};
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < m->triangles && !status; k++) {
    status = hr2di_cavity_touch(m, &c, (int32_t)k);
    while (c.triangles > 0 && !status) {
      const int32_t t = c.triangle[--c.triangles];
      int joined;
      status = join(m, &c, t, &joined);
      if (joined && !status) status = hr2di_cavity_touch(m, &c, t);
    }
  }
  hr2di_cavity_clear(m, &c);
  return status;
}
