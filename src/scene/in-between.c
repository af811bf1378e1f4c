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
   a front.  A wall that has all of the scene on one side stands between nothing. */
#include "scene/in-between.h"

#include "base/alloc.h"
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
  hr2di_walk out, beyond, back; /* from that side, through what it sees, through the wall */
  hr2d_point *room;
  size_t points;
  int found;      /* something in between, or that it takes too long to know */
  uint64_t steps; /* that are left */
} search;

/* Ends a walk. */
static hr2d_status find(void *ctx, const hr2di_sight *s, hr2di_wall_side j) {
  search *f = ctx;
  (void)s;
  (void)j;
  f->found = 1;
  return HR2D_ESTATE;
}

/* Pays for the steps of a walk since `before`. */
static hr2d_status pay(search *f, const hr2di_walk *w, uint64_t before) {
  const uint64_t steps = 1 + w->steps - before;
  f->found |= steps > f->steps;
  f->steps -= f->found ? 0 : steps;
  return f->found ? HR2D_ESTATE : HR2D_OK;
}

/* A sight from the wall to a front: is there a front behind the wall? */
static hr2d_status turn_back(void *ctx, const hr2di_sight *s, hr2di_wall_side j) {
  search *f = ctx;
  const uint64_t before = f->back.steps;
  hr2di_sight turned;
  (void)j;
  if (hr2di_alloc_reserve(&f->scene->alloc, &f->room, &f->points, s->lefts + s->rights,
                          sizeof *f->room))
    return HR2D_ENOMEM;
  hr2di_sight_turn(s, f->room, &turned);
  const hr2d_status status = hr2di_walk_on(&f->back, f->from ^ 1, &turned);
  return status ? status : pay(f, &f->back, before);
}

/* A sight from the wall to any side. */
static hr2d_status look_at(void *ctx, const hr2di_sight *s, hr2di_wall_side j) {
  search *f = ctx;
  const uint64_t before = f->beyond.steps;
  hr2d_status status = HR2D_OK;
  if (f->side[j] & FRONT) status = turn_back(ctx, s, j);
  if (status || !(f->side[j] & GAPS) || f->side[j] & HULL || !(f->side[f->from] & GAPS))
    return status;
  status = hr2di_walk_on(&f->beyond, j ^ 1, s);
  return status ? status : pay(f, &f->beyond, before);
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
static hr2d_status look_from(search *f, hr2di_wall_side side) {
  if (f->side[side] & HULL) return HR2D_OK;
  if (!(f->side[side] & GAPS) && (side & 1 || f->side[side ^ 1] & GAPS)) return HR2D_OK;
  const uint64_t first = f->back.steps, second = f->out.steps;
  hr2d_status status = hr2di_walk_from(&f->back, side ^ 1, NULL);
  if (!f->found) return status ? status : pay(f, &f->back, first);
  f->found = 0;
  f->from = side;
  status = hr2di_walk_from(&f->out, side, NULL);
  return status ? status : pay(f, &f->out, second);
}

static hr2di_walk walk_of(search *f, const unsigned char *wanted, hr2di_sight_fn take,
                          hr2di_watch *watch) {
  return (hr2di_walk){.in = &f->scene->plane.triangulation,
                      .wanted = wanted,
                      .take = take,
                      .ctx = f,
                      .alloc = f->scene->alloc,
                      .watch = watch};
}

hr2d_status hr2di_in_between(const hr2d_scene *scene, const hr2di_hull *hull, int *possible,
                             hr2di_watch *watch) {
  const size_t sides = 2 * scene->plane.triangulation.edges;
  search f = {.scene = scene};
  f.steps = (1 << 18) + (uint64_t)scene->patches * scene->patches / 8;
  f.side = hr2di_alloc_zero(&scene->alloc, sides, 1);
  f.any = hr2di_alloc(&scene->alloc, sides, 1);
  f.out = walk_of(&f, f.any, look_at, watch);
  f.beyond = walk_of(&f, scene->parts.wanted, turn_back, watch);
  f.back = walk_of(&f, scene->parts.wanted, find, watch);
  hr2d_status status = f.side && f.any ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < sides && !status; k++) f.any[k] = 1;
  if (!status) status = learn_sides(&f, hull);
  for (hr2di_wall_side k = 0; k < sides && !status; k++) {
    status = hr2di_watch_work(watch, 1);
    if (!status) status = look_from(&f, k);
  }
  *possible = f.found;
  hr2di_walk_clear(&f.out);
  hr2di_walk_clear(&f.beyond);
  hr2di_walk_clear(&f.back);
  hr2di_alloc_free(&scene->alloc, f.room);
  hr2di_alloc_free(&scene->alloc, f.side);
  hr2di_alloc_free(&scene->alloc, f.any);
  return f.found ? HR2D_OK : status;
}
