/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/grid-plans.h"

#include <check.h>
#include <math.h>
#include <stdio.h>

#include "support/plane.h"
#include "support/support.h"

/* Walls are cut into pieces of which each has ends on integers. */
enum { GRID = 12, MOST_PIECES = 6, MOST_CUTS = 32, MOST_WALLS = 24 };

/* A wall, and where others cross it. */
typedef struct drawn {
  hr2d_segment at;
  hr2d_point cut[MOST_CUTS];
  int cuts;
} drawn;

/* Whether two walls have more in common than an end of one of them; coordinates are small
   integers, and nothing is rounded. */
static int collide(hr2d_segment s, hr2d_segment t) {
  if (plane_crosses(s, t.a, t.b)) return 1;
  if (plane_det(s.a, s.b, t.a) != 0 || plane_det(s.a, s.b, t.b) != 0) return 0;
  const hr2d_point u = {s.b.x - s.a.x, s.b.y - s.a.y};
  const double from = (t.a.x - s.a.x) * u.x + (t.a.y - s.a.y) * u.y;
  const double to = (t.b.x - s.a.x) * u.x + (t.b.y - s.a.y) * u.y;
  return fmax(from, to) > 0 && fmin(from, to) < u.x * u.x + u.y * u.y;
}

/* Whether the insides of two walls cross in an integer point. */
static int cross_on_grid(hr2d_segment s, hr2d_segment t, hr2d_point *at) {
  const double a = plane_det(t.a, t.b, s.a), b = plane_det(t.a, t.b, s.b);
  if (!plane_crosses(s, t.a, t.b) || !plane_crosses(t, s.a, s.b)) return 0;
  const double x = (s.b.x - s.a.x) * a, y = (s.b.y - s.a.y) * a;
  *at = (hr2d_point){s.a.x + x / (a - b), s.a.y + y / (a - b)};
  return fmod(x, a - b) == 0 && fmod(y, a - b) == 0;
}

static hr2d_point on_grid(randoms *r, int size) {
  return (hr2d_point){GRID * random_below(r, size + 1), GRID * random_below(r, size + 1)};
}

void plan_add_pieces(plan *p, hr2d_segment s, int pieces, hr2d_sides sides) {
  for (int k = 0; k < pieces; k++)
    plan_add(p, plane_along(s, (double)k / pieces), plane_along(s, (double)(k + 1) / pieces),
             sides);
}

static void add_cut(plan *p, const drawn *w, hr2d_sides sides) {
  hr2d_point from = w->at.a;
  for (;;) {
    hr2d_point to = w->at.b;
    for (int k = 0; k < w->cuts; k++) {
      const double off = plane_distance(w->at.a, w->cut[k]);
      if (off > plane_distance(w->at.a, from) && off < plane_distance(w->at.a, to))
        to = w->cut[k];
    }
    plan_add(p, from, to, sides);
    if (plane_same(to, w->at.b)) return;
    from = to;
  }
}

/* Adds a wall if it fits to those that are there. */
static void draw_wall(randoms *r, int size, drawn *wall, int *walls) {
  drawn w = {.at = {on_grid(r, size), on_grid(r, size)}};
  hr2d_point at[MOST_WALLS];
  int crosses[MOST_WALLS];
  if (plane_same(w.at.a, w.at.b)) return;
  for (int k = 0; k < *walls; k++) {
    crosses[k] = cross_on_grid(wall[k].at, w.at, &at[k]);
    if (!crosses[k] && (collide(wall[k].at, w.at) || collide(w.at, wall[k].at))) return;
  }
  for (int k = 0; k < *walls; k++) {
    if (!crosses[k]) continue;
    wall[k].cut[wall[k].cuts++] = at[k];
    w.cut[w.cuts++] = at[k];
  }
  wall[(*walls)++] = w;
}

/* A room with walls on a coarse grid, which meet in T-junctions, share ends, lie on one line,
   touch and cross; each cut into some patches.  In an open scene there is no room around
   them. */
plan grid_plan(randoms *r, int closed) {
  static const int pieces[MOST_PIECES] = {1, 1, 2, 3, 4, 6};
  drawn wall[MOST_WALLS];
  const int size = 2 + random_below(r, 5), count = 1 + random_below(r, 20);
  const double low = -GRID, high = GRID * (size + 1);
  const hr2d_point corner[] = {{low, low}, {high, low}, {high, high}, {low, high}};
  plan p = {.walls = 0};
  int walls = 0;
  for (int k = 0; k < 4; k++) {
    const hr2d_segment side = {corner[k], corner[(k + 1) % 4]};
    if (closed) plan_add_pieces(&p, side, 1 + random_below(r, 3), HR2D_SIDES_FRONT);
  }
  for (int k = 0; k < count; k++) draw_wall(r, size, wall, &walls);
  for (int k = 0; k < walls; k++) {
    const hr2d_sides sides = closed || random_below(r, 2) ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT;
    if (wall[k].cuts > 0)
      add_cut(&p, &wall[k], sides);
    else
      plan_add_pieces(&p, wall[k].at, pieces[random_below(r, MOST_PIECES)], sides);
  }
  if (p.walls == 0)
    plan_add_pieces(&p, (hr2d_segment){corner[0], corner[1]}, 1, HR2D_SIDES_BOTH);
  return p;
}

hr2d_scene *plan_try_scene(const plan *p, const hr2d_allocator *hooks) {
  hr2d_scene *scene = test_new_scene(hooks);
  for (size_t k = 0; k < p->walls; k++) {
    const hr2d_patch patch = {.a = p->wall[k].a, .b = p->wall[k].b, .sides = p->sides[k]};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  if (!hr2d_scene_commit(scene)) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

void plan_print(const plan *p) {
  for (size_t k = 0; k < p->walls; k++)
    fprintf(stderr, "  {{%a, %a}, {%a, %a}}, %s\n", p->wall[k].a.x, p->wall[k].a.y,
            p->wall[k].b.x, p->wall[k].b.y, p->sides[k] == HR2D_SIDES_BOTH ? "both" : "front");
}

void plan_jitter(randoms *r, plan *p, similarity s) {
  for (size_t k = 0; k < p->walls; k++) {
    p->wall[k] = similar_segment(s, p->wall[k]);
    hr2d_point *end[] = {&p->wall[k].a, &p->wall[k].b};
    for (int e = 0; e < 2; e++) {
      end[e]->x = random_nudge(r, end[e]->x, 1);
      end[e]->y = random_nudge(r, end[e]->y, 1);
    }
  }
}
