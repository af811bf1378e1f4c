/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line passes walls.  Write − where it arrives at a front and + where it leaves one; a wall
   with two fronts is − and then +.  Something stands between two fronts iff a + comes before a
   − that is not the next sign.  Take such a pair of the fewest signs between them.  The sign
   behind its + is − (else that one would begin a shorter pair, unless it is the only one
   between), and by symmetry the sign before its − is +.  What is left is

       + + −,   + − −,   + − + −.

   In the first two, and in the last if its middle is one wall, a wall has a front that looks at
   it before and one behind, and nothing between them but this wall.  In the last, otherwise,
   two walls turn their backs to each other.

   So beams are sent from the backs of walls only.  (In a closed room, fronts see fronts: n²
   pairs that need no look.)  A beam that ends at a front is turned, and goes on through the
   wall that it came from; so does one that ends at a back, when it has gone on through that to
   a front.  A wall that has all of the scene on one side stands between nothing.

   A side may have patches in some places only.  So what a beam has found is restricted to each
   patch at its two ends; all of a wall between them has patches, on one side or the other. */
#include "scene/in-between.h"

#include "base/alloc.h"
#include "beams/line-class-list.h"
#include "geometry/vector.h"
#include "occlusion/clipped-occluders.h"
#include "scene/scene-impl.h"

/* What is known of a side of a wall edge. */
enum {
  FRONT = HR2DI_HAS_FRONT,
  GAPS = HR2DI_HAS_BACK,
  HULL = 4 /* the scene is on one side of the wall */
};

typedef struct search {
  const hr2d_scene *scene;
  unsigned char *side;          /* bits, per side */
  unsigned char *any;           /* 1 per side */
  hr2di_wall_side from;         /* of the wall that may stand between */
  hr2di_wall_side to;           /* where `back` comes from */
  hr2di_walk out, beyond, back; /* from that side, through what it sees, through the wall */
  hr2di_walk ray_filter;        /* from the other side of the wall */
  hr2d_point *room;
  size_t points;
  hr2di_line_class_list whole, near, both; /* restricted to nothing, to one patch, to two */
  hr2di_occlusion *found;
  int seen; /* there is a front behind the wall */
} search;

/* Ends a walk. */
static hr2d_status see(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  (void)s;
  (void)j;
  ((search *)ctx)->seen = 1;
  return HR2D_ESTATE;
}

/* Whether a patch is in the hull of two others and in front of both: exactly, without the
   plane, in which ends within roundings of each other are one. */
static int hides(const hr2d_scene *scene, size_t patch, size_t i, size_t j) {
  const hr2d_segment p = scene->patch[i].scaled, q = scene->patch[j].scaled;
  hr2di_opening opening;
  hr2di_clipped_occluder screen;
  return patch != i && patch != j &&
         hr2di_opening_init(&opening, hr2di_facing_of(&p, &q), p, q) &&
         hr2di_clipped_occluder_of(&screen, &opening, scene->patch[patch].scaled);
}

/* The first patch on either side of the wall between that hides i and j from each other. */
static hr2d_status name(search *f, size_t i, size_t j) {
  const hr2di_side_parts *all = &f->scene->parts;
  hr2d_status status = HR2D_OK;
  for (hr2di_wall_side turned = 0; turned < 2 && !f->found->exists; turned++) {
    const hr2di_parts parts = all->of_side[f->from ^ turned].parts;
    for (uint32_t k = parts.first; k < parts.last && !f->found->exists && !status; k++) {
      const uint32_t patch = all->part[k].patch;
      status = hr2di_watch_work(f->out.watch, 1);
      if (patch != HR2DI_NOBODY && hides(f->scene, patch, i, j))
        *f->found = (hr2di_occlusion){1, i < j ? i : j, i < j ? j : i, patch};
    }
  }
  return f->found->exists ? HR2D_ESTATE : status;
}

/* Looks for a patch on side `to` that has lines of the near patch. */
static hr2d_status examine_parts(search *f, hr2di_wall_side to, size_t near) {
  const hr2di_side_parts *all = &f->scene->parts;
  const hr2di_stored_line_class kept = f->near.line_class[0];
  for (uint32_t k = all->of_side[to].parts.first; k < all->of_side[to].parts.last; k++) {
    hr2d_status status = hr2di_watch_work(f->out.watch, 4);
    if (all->part[k].patch == HR2DI_NOBODY) continue;
    if (!status)
      status = hr2di_line_class_list_restrict(&f->both, &f->near, 0, 1, kept.near,
                                              all->part[k].at, NULL);
    if (status) return status;
    if (f->both.count == 0) continue;
    status = name(f, near, all->part[k].patch);
    if (status) return status;
  }
  return HR2D_OK;
}

/* A line class from side `to` through the wall to side k: between patches?  Ends a walk if so.
 */
static hr2d_status find(void *ctx, const hr2di_line_class *s, hr2di_wall_side k) {
  search *f = ctx;
  const hr2di_side_parts *all = &f->scene->parts;
  const hr2d_segment near = hr2di_wall_side_at(f->out.in, f->to),
                     far = hr2di_wall_side_at(f->out.in, k);
  const hr2di_parts parts = all->of_side[f->to].parts;
  hr2di_line_class known = *s;
  known.ends = (hr2di_point_same(s->left[0], near.a) ? HR2DI_LINE_CLASS_A : 0u) |
               (hr2di_point_same(s->right[0], near.b) ? HR2DI_LINE_CLASS_B : 0u) |
               (hr2di_point_same(s->right[s->rights - 1], far.a) ? HR2DI_LINE_CLASS_C : 0u) |
               (hr2di_point_same(s->left[s->lefts - 1], far.b) ? HR2DI_LINE_CLASS_D : 0u);
  hr2di_line_class_list_cut(&f->whole, 0);
  hr2d_status status = hr2di_line_class_list_add(&f->whole, &known, near, far);
  for (uint32_t p = parts.first; p < parts.last && !status; p++) {
    if (all->part[p].patch == HR2DI_NOBODY) continue;
    hr2di_line_class_list_cut(&f->near, 0);
    hr2di_line_class_list_cut(&f->both, 0);
    status = hr2di_watch_work(f->out.watch, 4);
    if (!status)
      status =
          hr2di_line_class_list_restrict(&f->near, &f->whole, 0, 1, all->part[p].at, far, NULL);
    if (!status && f->near.count > 0) status = examine_parts(f, k, all->part[p].patch);
  }
  return status;
}

/* A line class from the wall to a front: is there a front behind the wall? */
static hr2d_status turn_back(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  search *f = ctx;
  hr2di_line_class turned;
  if (hr2di_alloc_reserve(&f->scene->alloc, &f->room, &f->points, s->lefts + s->rights,
                          sizeof *f->room))
    return HR2D_ENOMEM;
  hr2di_line_class_turn(s, f->room, &turned);
  f->to = j;
  return hr2di_walk_on(&f->back, f->from ^ 1, &turned);
}

/* A line class from the wall to any side. */
static hr2d_status examine(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  search *f = ctx;
  hr2d_status status = HR2D_OK;
  if (f->side[j] & FRONT) status = turn_back(ctx, s, j);
  if (status || !(f->side[j] & GAPS) || f->side[j] & HULL || !(f->side[f->from] & GAPS))
    return status;
  return hr2di_walk_on(&f->beyond, j ^ 1, s);
}

static hr2d_status learn_sides(search *f, const hr2di_hull *hull) {
  const hr2di_wall_pieces *pieces = &f->scene->plane.pieces;
  const hr2di_triangulation *t = &f->scene->plane.triangulation;
  hr2d_status status = HR2D_OK;
  for (uint32_t w = 0; w < pieces->walls && !status; w++) {
    const unsigned char outer =
        hr2di_hull_sides(hull, f->scene->walls.wall[w].at) == 3 ? 0 : HULL;
    const uint32_t first = t->edge_of[pieces->of_wall[w]],
                   last = t->edge_of[pieces->of_wall[w + 1]];
    for (hr2di_wall_side s = 2 * first; s < 2 * last && !status; s++) {
      const hr2di_parts parts = f->scene->parts.of_side[s].parts;
      status = hr2di_watch_work(f->out.watch, 2 + (parts.last - parts.first) / 8);
      f->side[s] = (unsigned char)(hr2di_side_kind(&f->scene->parts, s) | outer);
    }
  }
  return status;
}

/* From the back, or, if both sides have fronts everywhere, from either side. */
static hr2d_status view_from(search *f, hr2di_wall_side side) {
  if (f->side[side] & HULL) return HR2D_OK;
  if (!(f->side[side] & GAPS) && (side & 1 || f->side[side ^ 1] & GAPS)) return HR2D_OK;
  f->seen = 0;
  const hr2d_status status = hr2di_walk_from(&f->ray_filter, side ^ 1, NULL);
  if (!f->seen) return status;
  f->from = side;
  return hr2di_walk_from(&f->out, side, NULL);
}

static hr2di_walk walk_of(search *f, const unsigned char *wanted, hr2di_line_class_fn take,
                          hr2di_watch *watch) {
  return (hr2di_walk){.in = &f->scene->plane.triangulation,
                      .wanted = wanted,
                      .take = take,
                      .ctx = f,
                      .alloc = f->scene->alloc,
                      .watch = watch};
}

/* A number without a common factor with n, near the golden section of it. */
static size_t stride_of(size_t n) {
  size_t stride = (size_t)(0.618 * (double)n) | 1;
  for (;; stride += 2) {
    size_t a = n, b = stride;
    while (b > 0) {
      const size_t rest = a % b;
      a = b;
      b = rest;
    }
    if (a == 1) return stride;
  }
}

/* Sides by the stride: neighbours mostly find alike, that is nothing, or the same. */
static hr2d_status view_from_all(search *f, size_t sides) {
  const size_t stride = stride_of(sides);
  hr2d_status status = HR2D_OK;
  for (size_t k = 0, side = 0; k < sides && !status; k++, side = (side + stride) % sides) {
    status = hr2di_watch_work(f->out.watch, 1);
    if (!status) status = view_from(f, (hr2di_wall_side)side);
  }
  return status;
}

static void end(search *f) {
  hr2di_walk_clear(&f->out);
  hr2di_walk_clear(&f->beyond);
  hr2di_walk_clear(&f->back);
  hr2di_walk_clear(&f->ray_filter);
  hr2di_line_class_list_clear(&f->whole);
  hr2di_line_class_list_clear(&f->near);
  hr2di_line_class_list_clear(&f->both);
  hr2di_alloc_free(&f->scene->alloc, f->room);
  hr2di_alloc_free(&f->scene->alloc, f->side);
  hr2di_alloc_free(&f->scene->alloc, f->any);
}

hr2d_status hr2di_in_between(const hr2d_scene *scene, const hr2di_hull *hull,
                             hr2di_occlusion *found, hr2di_watch *watch) {
  const size_t sides = 2 * scene->plane.triangulation.edges;
  const hr2di_line_class_list list = {.alloc = scene->alloc};
  search f = {.scene = scene, .whole = list, .near = list, .both = list, .found = found};
  *found = (hr2di_occlusion){0};
  f.side = hr2di_alloc_zero(&scene->alloc, sides, 1);
  f.any = hr2di_alloc(&scene->alloc, sides, 1);
  f.out = walk_of(&f, f.any, examine, watch);
  f.beyond = walk_of(&f, scene->parts.wanted, turn_back, watch);
  f.back = walk_of(&f, scene->parts.wanted, find, watch);
  f.ray_filter = walk_of(&f, scene->parts.wanted, see, watch);
  hr2d_status status = f.side && f.any ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < sides && !status; k++) f.any[k] = 1;
  if (!status) status = learn_sides(&f, hull);
  if (!status) status = view_from_all(&f, sides);
  end(&f);
  return found->exists ? HR2D_OK : status;
}
