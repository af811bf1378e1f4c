/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "clusters/beams.h"

#include <math.h>

#include "base/alloc.h"
#include "clusters/occlusion.h"
#include "geometry/predicates.h"
#include "occlusion/wall-tree.h"
#include "scene/scene-impl.h"

/* A beam with so FEW walls in it is not halved, nor is one narrower than a part in NARROW of
   the shortest of them.  Walls are looked for from near to far, until there are ENOUGH. */
enum { FEW = 8, NARROW = 4, ENOUGH = 64, MOST_CUTS = 40, PATIENCE = 400 };

/* The scene lies in [-2,2]². */
#define SCREEN 2.5

static const hr2d_segment screen[4] = {{{-SCREEN, -SCREEN}, {SCREEN, -SCREEN}},
                                       {{SCREEN, -SCREEN}, {SCREEN, SCREEN}},
                                       {{SCREEN, SCREEN}, {-SCREEN, SCREEN}},
                                       {{-SCREEN, SCREEN}, {-SCREEN, -SCREEN}}};

/* What is at n·p > offset is hidden; `distance` is where, as a part of the beam's length. */
typedef struct cut {
  double nx, ny, offset, distance;
} cut;

struct hr2di_beam {
  double from[2], to[2]; /* parts of the patch and of a side of the screen */
  int side;
  unsigned cuts;
  cut hidden;
  size_t first, count;      /* of hr2di_beams::target */
  int known;                /* all its walls are known */
  size_t first_wall, walls; /* of hr2di_beams::wall */
};

hr2d_status hr2di_beams_init(hr2di_beams *b, const hr2d_scene *scene,
                             const hr2di_cluster_tree *tree, const hr2d_allocator *alloc,
                             hr2di_watch *watch) {
  *b = (hr2di_beams){.scene = scene, .tree = tree, .alloc = *alloc, .watch = watch};
  b->mark = hr2di_alloc_zero(alloc, scene->patches, sizeof *b->mark);
  return b->mark ? HR2D_OK : HR2D_ENOMEM;
}

void hr2di_beams_clear(hr2di_beams *b) {
  hr2di_alloc_free(&b->alloc, b->target);
  hr2di_alloc_free(&b->alloc, b->wall);
  hr2di_alloc_free(&b->alloc, b->beam);
  hr2di_alloc_free(&b->alloc, b->mark);
  hr2di_alloc_free(&b->alloc, b->seen);
}

static hr2d_point point_of(hr2d_segment s, double t) {
  return (hr2d_point){s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
}

static hr2d_segment part_of(hr2d_segment s, const double at[2]) {
  return (hr2d_segment){at[0] > 0 ? point_of(s, at[0]) : s.a,
                        at[1] < 1 ? point_of(s, at[1]) : s.b};
}

/* At least 0.7 of it. */
static double length_of(hr2d_segment s) {
  return fmax(fabs(s.b.x - s.a.x), fabs(s.b.y - s.a.y));
}

/* The middle of the nearer end of a shaft, and of the farther one. */
static void axis_of(const hr2di_shaft *s, hr2d_point *p, hr2d_point *q) {
  *p = (hr2d_point){0.5 * (s->a.at.x + s->b.at.x), 0.5 * (s->a.at.y + s->b.at.y)};
  *q = (hr2d_point){0.5 * (s->c.at.x + s->d.at.x), 0.5 * (s->c.at.y + s->d.at.y)};
}

/* The width of an end across the axis. */
static double width_of(const hr2di_shaft *s, hr2d_segment end) {
  hr2d_point p, q;
  axis_of(s, &p, &q);
  const double dx = q.x - p.x, dy = q.y - p.y;
  return fabs((end.b.x - end.a.x) * dy - (end.b.y - end.a.y) * dx) / hypot(dx, dy);
}

/* Whether all of a box is hidden.  Coordinates lie in [-2,2], of the screen in [-3,3]. */
static int hides(const cut *c, double x0, double x1, double y0, double y1) {
  const double min = c->nx * (c->nx > 0 ? x0 : x1) + c->ny * (c->ny > 0 ? y0 : y1);
  return min > c->offset + 0x1p-46 * (fabs(c->nx) + fabs(c->ny));
}

static void hide(cut *c, const hr2di_shaft *shaft, double nx, double ny, double offset) {
  hr2d_point p, q;
  axis_of(shaft, &p, &q);
  const double at_p = nx * p.x + ny * p.y - offset, at_q = nx * q.x + ny * q.y - offset;
  const double distance = at_p / (at_p - at_q);
  if (distance < c->distance) *c = (cut){nx, ny, offset, distance};
}

/* Behind a wall is what is beyond its line; a body hides what is beyond all of it. */
static void hide_by_wall(cut *c, const hr2di_shaft *shaft, hr2d_segment w) {
  const double nx = w.a.y - w.b.y, ny = w.b.x - w.a.x, offset = nx * w.a.x + ny * w.a.y;
  if (nx * shaft->a.at.x + ny * shaft->a.at.y + nx * shaft->b.at.x + ny * shaft->b.at.y <
      2 * offset)
    hide(c, shaft, nx, ny, offset);
  else
    hide(c, shaft, -nx, -ny, -offset);
}

static void hide_by_body(cut *c, const hr2di_shaft *shaft, const hr2di_box *b) {
  hr2d_point p, q;
  axis_of(shaft, &p, &q);
  const double nx = q.x - p.x, ny = q.y - p.y;
  hide(c, shaft, nx, ny, nx * (nx > 0 ? b->x1 : b->x0) + ny * (ny > 0 ? b->y1 : b->y0));
}

static double along(const hr2di_box *b, hr2d_point p, hr2d_point q) {
  return (q.x - p.x) * (b->x0 + b->x1) + (q.y - p.y) * (b->y0 + b->y1);
}

/* What was found in a beam. */
typedef struct finds {
  uint32_t wall[ENOUGH];
  size_t walls;
  int all;         /* before what is hidden there are no others */
  double shortest; /* of the walls */
} finds;

/* Tests a wall, and moves *hidden to it if it is across. */
static void test(const hr2di_walls *walls, uint32_t wall, const hr2di_shaft *shaft, cut *hidden,
                 finds *found) {
  const hr2d_segment w = walls->wall[wall].at;
  hr2di_obstacle obstacle;
  const hr2di_in_way way = hr2di_shaft_test(shaft, w, &obstacle);
  if (way == HR2DI_ASIDE) return;
  if (way == HR2DI_ACROSS) hide_by_wall(hidden, shaft, w);
  found->shortest = fmin(found->shortest, length_of(w));
  found->wall[found->walls++] = wall;
}

/* Looks for walls, from near to far and for the nearest one across. */
static void search(const hr2di_walls *walls, const hr2di_shaft *shaft, cut *hidden,
                   finds *found) {
  uint32_t stack[PATIENCE + 2], count = 0;
  hr2d_point p, q;
  axis_of(shaft, &p, &q);
  stack[count++] = 0;
  for (int turns = PATIENCE; count > 0 && turns > 0 && found->walls < ENOUGH; turns--) {
    const hr2di_box *box = &walls->box[stack[--count]];
    if (!hr2di_shaft_meets_box(shaft, box->x0, box->x1, box->y0, box->y1) ||
        hides(hidden, box->x0, box->x1, box->y0, box->y1))
      continue;
    if (box->wall != HR2DI_NO_WALL) {
      test(walls, box->wall, shaft, hidden, found);
      continue;
    }
    if (hr2di_clusters_body_across(walls, shaft, box)) hide_by_body(hidden, shaft, box);
    const hr2di_box *below = &walls->box[box->below];
    const uint32_t nearer = along(below, p, q) > along(below + 1, p, q);
    stack[count++] = box->below + !nearer;
    stack[count++] = box->below + nearer;
  }
  found->all = count == 0;
}

static int beyond(const cut *hidden, hr2d_segment w) {
  return hides(hidden, fmin(w.a.x, w.b.x), fmax(w.a.x, w.b.x), fmin(w.a.y, w.b.y),
               fmax(w.a.y, w.b.y));
}

/* The same among the walls of the parent, if these are all. */
static void look(const hr2di_beams *b, const hr2di_beam *beam, const hr2di_shaft *shaft,
                 cut *hidden, finds *found) {
  const hr2di_walls *walls = &b->scene->walls;
  found->shortest = HUGE_VAL;
  found->walls = 0;
  if (!beam->known) {
    search(walls, shaft, hidden, found);
    return;
  }
  found->all = 1;
  for (size_t k = 0; k < beam->walls; k++) {
    const uint32_t wall = b->wall[beam->first_wall + k];
    if (!beyond(hidden, walls->wall[wall].at)) test(walls, wall, shaft, hidden, found);
  }
}

static int may_meet(const hr2di_shaft *shaft, const cut *hidden, const hr2di_cluster *c) {
  return hr2di_shaft_meets_box(shaft, c->x0, c->x1, c->y0, c->y1) &&
         !hides(hidden, c->x0, c->x1, c->y0, c->y1);
}

static hr2d_status put_target(hr2di_beams *b, uint32_t cluster) {
  if (hr2di_alloc_reserve(&b->alloc, &b->target, &b->target_capacity, b->targets + 1,
                          sizeof *b->target))
    return HR2D_ENOMEM;
  b->target[b->targets++] = cluster;
  return HR2D_OK;
}

/* A cluster that is larger than the beam is wide is replaced by those of its halves that it
   may meet. */
static hr2d_status put_met(hr2di_beams *b, const hr2di_shaft *shaft, const cut *hidden,
                           double width, uint32_t cluster) {
  uint32_t stack[HR2DI_BOX_DEPTH], count = 0;
  stack[count++] = cluster;
  while (count > 0) {
    const uint32_t top = stack[--count];
    const hr2di_cluster *c = &b->tree->cluster[top];
    const hr2d_status status = hr2di_watch_work(b->watch, 1);
    if (status) return status;
    if (!may_meet(shaft, hidden, c)) continue;
    if (!c->child || (c->x1 - c->x0) + (c->y1 - c->y0) < width) {
      if (put_target(b, top)) return HR2D_ENOMEM;
      continue;
    }
    stack[count++] = c->child;
    stack[count++] = c->child + 1;
  }
  return HR2D_OK;
}

static hr2d_status see(hr2di_beams *b, uint32_t patch, uint32_t other) {
  if (b->mark[other] == patch + 1) return HR2D_OK;
  b->mark[other] = patch + 1;
  const hr2di_patch *p = b->scene->patch;
  if (hr2di_facing_of(&p[patch].scaled, &p[other].scaled) == HR2DI_FACING_NONE) return HR2D_OK;
  if (hr2di_alloc_reserve(&b->alloc, &b->seen, &b->seen_capacity, b->seen_count + 1,
                          sizeof *b->seen))
    return HR2D_ENOMEM;
  b->seen[b->seen_count++] = other;
  return HR2D_OK;
}

/* All that the targets from `first` on have in the beam may be seen. */
static hr2d_status see_targets(hr2di_beams *b, const hr2di_shaft *shaft, const cut *hidden,
                               uint32_t patch, size_t first) {
  const size_t last = b->targets;
  hr2d_status status = HR2D_OK;
  for (size_t k = first; k < last && !status; k++)
    status = put_met(b, shaft, hidden, 0, b->target[k]);
  for (size_t k = last; k < b->targets && !status; k++) {
    status = hr2di_watch_work(b->watch, 1);
    if (!status) status = see(b, patch, b->tree->patch[b->tree->cluster[b->target[k]].first]);
  }
  return status;
}

static hr2d_status push(hr2di_beams *b, hr2di_beam beam) {
  if (hr2di_alloc_reserve(&b->alloc, &b->beam, &b->capacity, b->count + 1, sizeof beam))
    return HR2D_ENOMEM;
  b->beam[b->count++] = beam;
  return HR2D_OK;
}

/* Halves the end that adds more to the width of the beam in the middle of what it sees. */
static hr2d_status halve(hr2di_beams *b, hr2di_beam beam, int near) {
  hr2di_beam half[2] = {beam, beam};
  double *at[2];
  for (int k = 0; k < 2; k++) {
    at[k] = near ? half[k].from : half[k].to;
    half[k].cuts++;
  }
  at[0][1] = at[1][0] = 0.5 * (at[0][0] + at[0][1]);
  const hr2d_status status = push(b, half[0]);
  return status ? status : push(b, half[1]);
}

static hr2d_status keep_walls(hr2di_beams *b, hr2di_beam *beam, const finds *found) {
  beam->known = found->all;
  beam->first_wall += beam->walls;
  beam->walls = found->all ? found->walls : 0;
  const size_t needed = beam->first_wall + beam->walls;
  if (hr2di_alloc_reserve(&b->alloc, &b->wall, &b->wall_capacity, needed, sizeof *b->wall))
    return HR2D_ENOMEM;
  for (size_t k = 0; k < beam->walls; k++) b->wall[beam->first_wall + k] = found->wall[k];
  return HR2D_OK;
}

/* Leaves to a beam what it may meet of its parent's targets, and of its walls. */
static hr2d_status follow(hr2di_beams *b, uint32_t patch, hr2di_beam beam) {
  const hr2d_segment line = b->scene->patch[patch].scaled;
  const hr2d_segment i = part_of(line, beam.from), j = part_of(screen[beam.side], beam.to);
  hr2di_shaft shaft;
  finds found;
  hr2d_status status =
      hr2di_watch_work(b->watch, beam.known ? 5 + beam.walls / 2 : PATIENCE / 4);
  if (status) return status;
  if (!hr2di_shaft_init(&shaft, hr2di_facing_of(&i, &j), i, j, line, screen[beam.side]))
    return HR2D_OK;
  look(b, &beam, &shaft, &beam.hidden, &found);
  const double middle = 0.5 * fmin(beam.hidden.distance, 0.25);
  const double near = (1 - middle) * width_of(&shaft, i), far = middle * width_of(&shaft, j);
  const size_t first = beam.first + beam.count;
  b->targets = first;
  for (size_t k = beam.first; k < first && !status; k++)
    status = put_met(b, &shaft, &beam.hidden, near + far, b->target[k]);
  if (status || b->targets == first) return status;
  beam.first = first;
  beam.count = b->targets - first;
  if ((found.all && found.walls <= FEW) || beam.cuts == MOST_CUTS ||
      NARROW * (near + far) < found.shortest)
    return see_targets(b, &shaft, &beam.hidden, patch, first);
  status = keep_walls(b, &beam, &found);
  return status ? status : halve(b, beam, near >= far);
}

hr2d_status hr2di_beams_cast(hr2di_beams *b, uint32_t patch, const uint32_t *cluster,
                             size_t count) {
  b->seen_count = b->targets = b->count = 0;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++) status = put_target(b, cluster[k]);
  for (int side = 0; side < 4 && !status; side++)
    status = push(b, (hr2di_beam){.from = {0, 1},
                                  .to = {0, 1},
                                  .side = side,
                                  .hidden = {.distance = HUGE_VAL},
                                  .count = count});
  while (b->count > 0 && !status) status = follow(b, patch, b->beam[--b->count]);
  return status;
}
