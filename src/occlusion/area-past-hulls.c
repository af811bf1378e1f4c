/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plane between i, j and the borders of hulls is triangulated, and beams from i add up
   what ends at j.

   Clumps stand on i and j at their feet, which may be rounded points: i and j are cut there.  A
   piece between two feet of one hull has an edge of the hull on it, and is hidden. */
#include "occlusion/area-past-hulls.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/neumaier-sum.h"
#include "base/sort.h"
#include "beams/walk.h"
#include "geometry/vector.h"
#include "triangulation/triangulation.h"

/* Rounds of cutting: each cuts one pair of pieces. */
enum { MOST_CUTS = 64 };

/* A piece of some roundings of scaled coordinates: nothing is seen through it. */
#define DUST 0x1p-48

typedef enum owner { OF_I, OF_J, OF_CLUMP } owner;

/* Those of i first, then those of j. */
typedef struct piece {
  hr2d_segment at;
  owner of;
} piece;

typedef struct passage {
  const hr2di_opening *opening;
  const hr2di_occluder_hulls *hulls;
  hr2d_allocator alloc;
  hr2di_watch *watch;
  piece *piece;
  size_t pieces, room;
  hr2di_triangulation plane;
  hr2di_sum sum;
  size_t classes;
  int clear; /* the last line class has all lines of its two sides */
} passage;

static hr2d_status add_piece(passage *p, hr2d_point a, hr2d_point b, owner of) {
  if (hr2di_point_same(a, b)) return HR2D_OK;
  if (hr2di_alloc_reserve(&p->alloc, &p->piece, &p->room, p->pieces + 1, sizeof *p->piece))
    return HR2D_ENOMEM;
  p->piece[p->pieces++] = (piece){{a, b}, of};
  return hr2di_watch_work(p->watch, 1);
}

typedef struct foot {
  double along, other; /* coordinates that grow along the line, the longer one first */
  hr2d_point at;
} foot;

static int by_place(const void *left, const void *right) {
  const foot *l = left, *r = right;
  if (l->along != r->along) return l->along < r->along ? -1 : 1;
  return (l->other > r->other) - (l->other < r->other);
}

/* The place of a point along a line. */
static foot foot_at(const hr2di_axis *line, hr2d_point at) {
  const double along = line->by_x ? at.x : at.y, other = line->by_x ? at.y : at.x;
  const int falls = line->by_x ? line->b.y < line->a.y : line->b.x < line->a.x;
  return (foot){line->direction * along, falls ? -other : other, at};
}

static hr2d_status find_feet(passage *p, int line, foot *feet, size_t *count) {
  *count = 0;
  for (size_t k = 0; k < p->hulls->points; k++) {
    const hr2d_point at = p->hulls->point[k];
    const hr2d_status status = hr2di_watch_work(p->watch, 1);
    if (status) return status;
    if (hr2di_opening_foot(p->opening, line, at))
      feet[(*count)++] = foot_at(&p->opening->line[line], at);
  }
  return hr2di_sort(feet, *count, sizeof *feet, by_place, p->watch);
}

/* Cuts i or j at the feet of hulls. */
static hr2d_status add_line(passage *p, int line) {
  const hr2d_segment s = p->opening->part[line];
  const owner of = line ? OF_J : OF_I;
  hr2d_point from = s.a;
  size_t count;
  foot *feet = hr2di_alloc(&p->alloc, p->hulls->points, sizeof *feet);
  if (!feet) return HR2D_ENOMEM;
  hr2d_status status = find_feet(p, line, feet, &count);
  for (size_t k = 0; k < count && !status; k++) {
    status = add_piece(p, from, feet[k].at, of);
    from = feet[k].at;
  }
  hr2di_alloc_free(&p->alloc, feet);
  return status ? status : add_piece(p, from, s.b, of);
}

static hr2d_status add_clumps(passage *p) {
  for (size_t k = 0; k < p->hulls->hulls; k++) {
    const hr2di_occluder_hull *c = &p->hulls->hull[k];
    const hr2d_point *at = p->hulls->point + c->first;
    const size_t edges = c->points > 2 ? c->points : c->points - 1;
    for (size_t m = 0; m < edges; m++) {
      const hr2d_status status =
          add_piece(p, at[m], at[m + 1 < c->points ? m + 1 : 0], OF_CLUMP);
      if (status) return status;
    }
  }
  return HR2D_OK;
}

static double length_of(hr2d_segment s) {
  return hypot(s.b.x - s.a.x, s.b.y - s.a.y);
}

/* Cuts a piece at a point; *cut is set if it has become two. */
static hr2d_status cut_at(passage *p, uint32_t number, hr2d_point at, int *cut) {
  const piece whole = p->piece[number];
  if (hr2di_point_same(at, whole.at.a) || hr2di_point_same(at, whole.at.b)) return HR2D_OK;
  *cut = 1;
  p->piece[number].at.b = at;
  return add_piece(p, at, whole.at.b, whole.of);
}

/* Feet are rounded, so that pieces of some roundings may cross.  The shorter of two becomes a
   point, if it is one of these; else both are cut where they cross. */
static hr2d_status settle(passage *p, const uint32_t wall[2], int may_cut) {
  const hr2d_segment one = p->piece[wall[0]].at, other = p->piece[wall[1]].at;
  const int shorter = length_of(other) < length_of(one);
  int cut = 0;
  hr2d_status status = HR2D_OK;
  if (may_cut && length_of(shorter ? other : one) > DUST) {
    const hr2d_point at = shorter ? hr2di_line_crossing_at(one, other.a, other.b)
                                  : hr2di_line_crossing_at(other, one.a, one.b);
    for (int k = 0; k < 2 && !status; k++) status = cut_at(p, wall[k], at, &cut);
  }
  if (!cut) p->piece[wall[shorter]].at.b = p->piece[wall[shorter]].at.a;
  return status;
}

static hr2d_status triangulate(passage *p) {
  hr2di_conflict conflict;
  hr2d_status status = HR2D_OK;
  for (int round = 0; !status; round++) {
    hr2di_triangulation_clear(&p->plane);
    status = hr2di_triangulation_init(&p->plane, &p->alloc, &p->piece[0].at, p->pieces,
                                      sizeof *p->piece, 0, &conflict, p->watch);
    if (!status || (status == HR2D_ESCENE && conflict.together)) return HR2D_OK;
    if (status == HR2D_ESCENE) status = settle(p, conflict.wall, round < MOST_CUTS);
  }
  return status;
}

/* What shares the edge of a piece of i: 1 for a piece of j, 2 for a hull. */
static int company(const passage *p, uint32_t edge) {
  const hr2di_wall_edge *all = p->plane.edge;
  int found = 0;
  for (uint32_t k = all[edge].same; k != edge; k = all[k].same)
    found |= p->piece[all[k].wall].of == OF_CLUMP ? 2 : 1;
  return found;
}

static hr2d_status take(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  passage *p = ctx;
  (void)j;
  hr2di_sum_add(&p->sum, hr2di_line_class_area(s));
  p->classes++;
  p->clear = hr2di_line_class_clear(s);
  return HR2D_OK;
}

/* Walks from an edge of i.  One that shares its place with j and nothing else sees that. */
static hr2d_status view_from(passage *p, hr2di_walk *w, uint32_t edge) {
  const hr2d_segment at = hr2di_wall_side_at(&p->plane, 2 * edge);
  const int with = company(p, edge);
  if (!with) return hr2di_walk_from(w, 2 * edge, NULL);
  if (with == 1) hr2di_sum_add(&p->sum, length_of(at));
  return hr2di_watch_work(p->watch, 1);
}

/* The fronts of i and j are side 0 of the edges of their pieces. */
static hr2d_status examine(passage *p) {
  const hr2di_triangulation *t = &p->plane;
  unsigned char *wanted = hr2di_alloc_zero(&p->alloc, t->edges, 2);
  if (!wanted) return HR2D_ENOMEM;
  hr2di_walk walk = {
      .in = t, .wanted = wanted, .take = take, .ctx = p, .alloc = p->alloc, .watch = p->watch};
  hr2d_status status = HR2D_OK;
  for (uint32_t k = 0; k < t->edges; k++)
    wanted[2 * k] = p->piece[t->edge[k].wall].of == OF_J && t->edge[k].same == k;
  for (uint32_t k = 0; k < t->edges && !status; k++)
    if (p->piece[t->edge[k].wall].of == OF_I) status = view_from(p, &walk, k);
  hr2di_walk_clear(&walk);
  hr2di_alloc_free(&p->alloc, wanted);
  return status;
}

/* Whether neither i nor j is in pieces. */
static int is_whole(const passage *p) {
  size_t edges = 0;
  for (size_t k = 0; k < p->plane.edges; k++)
    edges += p->piece[p->plane.edge[k].wall].of != OF_CLUMP;
  return edges == 2;
}

hr2d_status hr2di_past_clumps(const hr2di_opening *opening, const hr2di_occluder_hulls *hulls,
                              double *area, int *all) {
  passage p = {.opening = opening,
               .hulls = hulls,
               .alloc = hulls->alloc,
               .watch = hulls->watch,
               .plane = {.alloc = hulls->alloc}};
  hr2d_status status = add_line(&p, 0);
  if (!status) status = add_line(&p, 1);
  if (!status) status = add_clumps(&p);
  if (!status) status = triangulate(&p);
  if (!status) status = examine(&p);
  *area = hr2di_sum_total(&p.sum);
  *all = p.classes == 1 && p.clear && is_whole(&p);
  hr2di_triangulation_clear(&p.plane);
  hr2di_alloc_free(&p.alloc, p.piece);
  return status;
}
