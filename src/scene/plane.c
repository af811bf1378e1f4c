/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/plane.h"

#include <math.h>

#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Rounds of cutting: each cuts one pair of pieces. */
enum { MOST_CUTS = 256 };

/* A wall of some roundings of scaled coordinates. */
#define DUST 0x1p-48

static double length_of(const hr2d_segment *s) {
  return hypot(s->b.x - s->a.x, s->b.y - s->a.y);
}

/* Makes the shorter of two pieces a point, if it is dust: nothing is seen of it. */
static int leave_out(hr2di_wall_pieces *p, const hr2di_conflict *conflict) {
  hr2d_segment *one = &p->piece[conflict->wall[0]], *other = &p->piece[conflict->wall[1]];
  hr2d_segment *shorter = length_of(one) < length_of(other) ? one : other;
  if (length_of(shorter) > DUST || hr2di_point_same(shorter->a, shorter->b)) return 0;
  shorter->b = shorter->a;
  return 1;
}

/* Cuts both pieces where they cross; *cut is whether one of them has become two. */
static hr2d_status cut_both(hr2di_wall_pieces *p, const hr2di_conflict *conflict, int *cut) {
  const hr2d_segment one = p->piece[conflict->wall[0]], other = p->piece[conflict->wall[1]];
  /* On the longer of them: the rounding of a place grows with the length of what it is measured
     along, and that of the longer wall is what commit has forgiven. */
  const hr2d_point at = length_of(&one) < length_of(&other)
                            ? hr2di_line_crossing_at(other, one.a, one.b)
                            : hr2di_line_crossing_at(one, other.a, other.b);
  *cut = 0;
  for (int k = 1; k >= 0; k--) { /* the one behind first: numbers before it stay */
    const hr2d_segment s = p->piece[conflict->wall[k]];
    if (hr2di_point_same(at, s.a) || hr2di_point_same(at, s.b)) continue;
    *cut = 1;
    const hr2d_status status = hr2di_wall_pieces_cut(p, conflict->wall[k], at);
    if (status) return status;
  }
  return HR2D_OK;
}

/* After this the pieces can be triangulated, or there is a next conflict; else HR2D_ESCENE. */
static hr2d_status settle(hr2di_wall_pieces *p, const hr2di_conflict *conflict) {
  int cut;
  if (leave_out(p, conflict)) return HR2D_OK;
  const hr2d_status status = cut_both(p, conflict, &cut);
  return status || cut ? status : HR2D_ESCENE;
}

static uint32_t wall_of(const hr2di_wall_pieces *p, uint32_t piece) {
  uint32_t low = 0, high = (uint32_t)p->walls;
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    if (p->of_wall[middle] <= piece)
      low = middle;
    else
      high = middle;
  }
  return low;
}

hr2d_status hr2di_plane_init(hr2di_plane *plane, const hr2d_scene *scene, uint32_t wall[2],
                             hr2di_watch *watch) {
  hr2di_wall_pieces *p = &plane->pieces;
  hr2di_conflict conflict;
  *plane = (hr2di_plane){.triangulation = {.alloc = scene->alloc}};
  hr2d_status status = hr2di_wall_pieces_init(p, scene, watch);
  for (int round = 0; !status; round++) {
    hr2di_triangulation_clear(&plane->triangulation);
    status = hr2di_triangulation_init(&plane->triangulation, &scene->alloc, p->piece, p->pieces,
                                      sizeof *p->piece, HR2DI_UNITS, &conflict, watch);
    if (!status || (status == HR2D_ESCENE && conflict.together)) return HR2D_OK;
    if (status == HR2D_ESCENE && round < MOST_CUTS) status = settle(p, &conflict);
  }
  if (status == HR2D_ESCENE)
    for (int k = 0; k < 2; k++) wall[k] = wall_of(p, conflict.wall[k]);
  return status;
}

void hr2di_plane_clear(hr2di_plane *plane) {
  hr2di_triangulation_clear(&plane->triangulation);
  hr2di_wall_pieces_clear(&plane->pieces);
}
