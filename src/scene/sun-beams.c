/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A beam is what comes in between two parallel lines through vertices, which are its borders.
   Light comes in through all edges of the box around the plane that it leads inwards.

   A point p is on the left of the line through q if way × (p − q) > 0.  These signs are exact,
   so that beams have the borders that the walls of the plane cast, and no light passes between
   walls that meet. */
#include "scene/sun-beams.h"

#include <math.h>

#include "geometry/determinant.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* The larger component comes into [1,2): exactly, if the other is not smaller by 2^1000. */
static hr2d_point scaled(hr2d_point direction) {
  const int e = ilogb(fmax(fabs(direction.x), fabs(direction.y)));
  return (hr2d_point){ldexp(direction.x, -e), ldexp(direction.y, -e)};
}

static hr2di_vector vector_of(hr2d_point direction) {
  return hr2di_vector_difference_scaled(direction, (hr2d_point){0, 0});
}

/* The sign of way × (p − q).  The rounding of det is below 3·2^-53·(|s| + |t|), as in
   orient-sign.h. */
static int sign_across(hr2d_point direction, hr2d_point p, hr2d_point q) {
  const double s = direction.x * (p.y - q.y), t = direction.y * (p.x - q.x);
  const double det = s - t, doubt = 0x1p-50 * (fabs(s) + fabs(t)) + 0x1p-900;
  if (det > doubt) return 1;
  if (det < -doubt) return -1;
  if (hr2di_point_same(p, q)) return 0;
  const hr2di_vector u = vector_of(direction), v = hr2di_vector_difference_scaled(p, q);
  const double exact = hr2di_det(&u, &v);
  return (exact > 0) - (exact < 0);
}

/* Where the line through p meets the line of a segment, as a fraction of it. */
static double fraction_at(hr2d_point direction, hr2d_segment s, hr2d_point p) {
  if (hr2di_point_same(p, s.a)) return 0;
  if (hr2di_point_same(p, s.b)) return 1;
  const hr2di_vector u = vector_of(direction), v = hr2di_vector_difference_scaled(p, s.a),
                     w = hr2di_vector_difference_scaled(s.b, s.a);
  return hr2di_scaled_value(
      hr2di_scaled_div(hr2di_det_scaled(&u, &v), hr2di_det_scaled(&u, &w)));
}

double hr2di_sun_cosine(hr2d_point direction, hr2d_segment s) {
  const hr2d_point unit = scaled(direction);
  const hr2di_vector u = vector_of(unit), w = hr2di_vector_difference_scaled(s.b, s.a);
  const hr2di_scaled lengths =
      hr2di_scaled_mul(hr2di_vector_length_scaled(&u), hr2di_vector_length_scaled(&w));
  return hr2di_scaled_value(hr2di_scaled_div(hr2di_det_scaled(&u, &w), lengths));
}

static hr2d_point at(const hr2di_sun_beams *b, uint32_t vertex) {
  return b->scene->plane.triangulation.at[vertex];
}

static int side_of(const hr2di_sun_beams *b, uint32_t vertex, uint32_t border) {
  return sign_across(b->direction, at(b, vertex), at(b, border));
}

static int side_of_beam(void *ctx, void *right, void *left, uint32_t vertex, void *split) {
  const hr2di_sun_beams *b = ctx;
  const uint32_t *r = right, *l = left;
  *(uint32_t *)split = vertex;
  if (side_of(b, vertex, *r) <= 0) return -1;
  return side_of(b, vertex, *l) < 0 ? 0 : 1;
}

/* A border of a beam. */
typedef struct line {
  const hr2di_sun_beams *b;
  uint32_t vertex;
} line;

static int is_on_left(const void *of, hr2d_point end) {
  const line *l = of;
  return sign_across(l->b->direction, end, at(l->b, l->vertex)) > 0;
}

/* Lights what a beam meets of a part, a patch's. */
static hr2d_status light(hr2di_sun_beams *b, const hr2di_side_part *part, uint32_t right,
                         uint32_t left) {
  const hr2d_segment s = b->scene->patch[part->patch].scaled;
  if (!(hr2di_sun_cosine(b->direction, s) > 0)) return HR2D_OK;
  const double from = fmax(fraction_at(b->direction, s, at(b, right)),
                           fraction_at(b->direction, s, part->at.a)),
               to = fmin(fraction_at(b->direction, s, at(b, left)),
                         fraction_at(b->direction, s, part->at.b));
  if (!(fmax(from, 0) < fmin(to, 1))) return HR2D_OK;
  return b->take(b->ctx, part->patch, fmax(from, 0), fmin(to, 1));
}

/* A beam ends at something. */
static hr2d_status end_at(void *ctx, int32_t what, const void *right, void *left) {
  hr2di_sun_beams *b = ctx;
  const uint32_t *r = right, *l = left;
  if (what == HR2DI_SKY || !b->scene->parts.wanted[(hr2di_wall_side)~what]) return HR2D_OK;
  const line first = {b, *r};
  const hr2di_side_part *part = b->scene->parts.part;
  const hr2di_parts among = b->scene->parts.of_side[(hr2di_wall_side)~what].parts;
  hr2d_status status = HR2D_OK;
  uint32_t m = hr2di_side_parts_find(&b->scene->parts, among, is_on_left, &first);
  for (; m < among.last && !status; m++) {
    if (part[m].patch != HR2DI_NOBODY) status = light(b, &part[m], *r, *l);
    if (!status) status = hr2di_watch_work(b->watch, 4);
    if (sign_across(b->direction, part[m].at.b, at(b, *l)) >= 0) break;
  }
  return status;
}

/* Walks the beam that enters by half-edge h. */
static hr2d_status walk_from(hr2di_sun_beams *b, int32_t h) {
  const hr2di_triangle *t = &b->scene->plane.triangulation.triangle[h >> 2];
  return hr2di_triangular_expansion_walk(&b->between, h, &t->corner[hr2di_corner_after(h & 3)],
                                         &t->corner[h & 3]);
}

hr2d_status hr2di_sun_beams_walk(hr2di_sun_beams *b, hr2d_point direction) {
  const hr2di_triangulation *in = &b->scene->plane.triangulation;
  hr2d_status status = HR2D_OK;
  b->direction = scaled(direction);
  b->between.in = in;
  b->between.watch = b->watch;
  b->between.alloc = b->alloc;
  b->between.border = sizeof(uint32_t);
  b->between.outside = 1;
  b->between.side = side_of_beam;
  b->between.end = end_at;
  b->between.ctx = b;
  for (size_t k = 0; k < in->triangles && !status; k++) {
    const hr2di_triangle *t = &in->triangle[k];
    for (int e = 0; e < 3 && !status; e++)
      if (t->across[e] == HR2DI_SKY &&
          side_of(b, t->corner[e], t->corner[hr2di_corner_after(e)]) > 0)
        status = walk_from(b, (int32_t)(4 * k) + e);
    if (k % 64 == 0 && !status) status = hr2di_watch_work(b->watch, 8);
  }
  /* A walk that the watch has stopped ends nowhere. */
  return status ? status : hr2di_watch_status(b->watch);
}

void hr2di_sun_beams_clear(hr2di_sun_beams *b) {
  hr2di_triangular_expansion_clear(&b->between);
}
