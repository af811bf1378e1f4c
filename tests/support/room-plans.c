/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Most plans have integer coordinates, so that where a wall ends on another it does so
   exactly. */
#include "support/room-plans.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "support/order.h"
#include "support/plane.h"

#define PI 3.14159265358979323846

void plan_add(plan *p, hr2d_point a, hr2d_point b, hr2d_sides sides) {
  if (p->walls == p->capacity) {
    p->capacity = 2 * p->capacity + 16;
    p->wall = realloc(p->wall, p->capacity * sizeof *p->wall);
    p->sides = realloc(p->sides, p->capacity * sizeof *p->sides);
    ck_assert(p->wall != NULL && p->sides != NULL);
  }
  p->wall[p->walls] = (hr2d_segment){a, b};
  p->sides[p->walls++] = sides;
}

void plan_free(plan *p) {
  free(p->wall);
  free(p->sides);
  *p = (plan){.walls = 0};
}

static int orientation(hr2d_segment w, hr2d_point p) {
  return hr2d_orientation(w.a, w.b, p);
}

static int cross(hr2d_segment s, hr2d_segment t) {
  return orientation(s, t.a) * orientation(s, t.b) < 0 &&
         orientation(t, s.a) * orientation(t, s.b) < 0;
}

static double distance_to_line(hr2d_segment w, hr2d_point p) {
  const double x = w.b.x - w.a.x, y = w.b.y - w.a.y;
  return fabs(x * (p.y - w.a.y) - y * (p.x - w.a.x)) / hypot(x, y);
}

/* Shortens s until it does not pass through w. */
static void pull_back(hr2d_segment *s, hr2d_segment w) {
  const int at_a = distance_to_line(w, s->a) < distance_to_line(w, s->b);
  hr2d_point *end = at_a ? &s->a : &s->b;
  const hr2d_point from = *end, to = at_a ? s->b : s->a;
  for (double t = 0x1p-52; cross(*s, w); t *= 2) {
    ck_assert_double_lt(t, 1e-6);
    *end = (hr2d_point){from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
  }
}

void plan_transform(plan *p, similarity s) {
  for (size_t k = 0; k < p->walls; k++) p->wall[k] = similar_segment(s, p->wall[k]);
  if (p->crossing) return;
  for (size_t k = 0; k < p->walls; k++)
    for (size_t m = 0; m < p->walls; m++) {
      hr2d_segment *one = &p->wall[k], *other = &p->wall[m];
      if (m == k || !cross(*one, *other)) continue;
      const double at_one =
          fmin(distance_to_line(*other, one->a), distance_to_line(*other, one->b));
      const double at_other =
          fmin(distance_to_line(*one, other->a), distance_to_line(*one, other->b));
      if (at_one < at_other)
        pull_back(one, *other);
      else
        pull_back(other, *one);
    }
}

typedef enum meeting { APART, TOUCH, CROSS } meeting;

static int in_box(hr2d_segment w, hr2d_point p) {
  return fmin(w.a.x, w.b.x) <= p.x && p.x <= fmax(w.a.x, w.b.x) && fmin(w.a.y, w.b.y) <= p.y &&
         p.y <= fmax(w.a.y, w.b.y);
}

static int touches(hr2d_segment w, hr2d_point p) {
  return orientation(w, p) == 0 && in_box(w, p);
}

/* CROSS also where the two share more than a point. */
static meeting meet(hr2d_segment s, hr2d_segment t) {
  if (cross(s, t)) return CROSS;
  const int ends = touches(s, t.a) + touches(s, t.b) + touches(t, s.a) + touches(t, s.b);
  if (ends == 0) return APART;
  const int joined = plane_same(s.a, t.a) || plane_same(s.a, t.b) || plane_same(s.b, t.a) ||
                     plane_same(s.b, t.b);
  const int parallel = orientation(s, t.a) == 0 && orientation(s, t.b) == 0;
  return parallel && !(joined && ends == 2) ? CROSS : TOUCH;
}

/* Adds a two-sided wall if it meets the others as `allowed` at most. */
static int put(plan *p, hr2d_point a, hr2d_point b, meeting allowed) {
  if (a.x == b.x && a.y == b.y) return 0;
  for (size_t k = 0; k < p->walls; k++)
    if (meet(p->wall[k], (hr2d_segment){a, b}) > allowed) return 0;
  plan_add(p, a, b, HR2D_SIDES_BOTH);
  return 1;
}

static void polygon(plan *p, const hr2d_point *corner, int corners) {
  for (int k = 0; k < corners; k++)
    plan_add(p, corner[k], corner[(k + 1) % corners], HR2D_SIDES_FRONT);
}

void plan_room(plan *p, double width, double height) {
  polygon(p, (hr2d_point[]){{0, 0}, {width, 0}, {width, height}, {0, height}}, 4);
}

void plan_fan(plan *p, int spokes) {
  const hr2d_point hub = {.4375, .5625};
  plan_room(p, 1, 1);
  for (int k = 0; k < spokes; k++) {
    const double angle = 2 * PI * k / spokes, reach = .3 + .1 * (k % 7) / 7;
    plan_add(p, hub, plane_polar(hub, reach, angle), HR2D_SIDES_BOTH);
  }
}

/* Corners on a circle, or nearer to its centre. */
static int round_room(randoms *r, plan *p, hr2d_point *corner, double min) {
  double angle[12];
  const int corners = 3 + random_below(r, 10);
  for (int k = 0; k < corners; k++) angle[k] = 2 * PI * (k + .8 * random_unit(r)) / corners;
  qsort(angle, (size_t)corners, sizeof *angle, order_doubles);
  for (int k = 0; k < corners; k++) {
    const double radius = random_between(r, min, 1);
    corner[k] = (hr2d_point){radius * cos(angle[k]), radius * sin(angle[k])};
  }
  polygon(p, corner, corners);
  return corners;
}

/* A point in a convex room, whose walls come first. */
static hr2d_point inside(randoms *r, const plan *p, int corners) {
  for (;;) {
    const hr2d_point at = {random_between(r, -1, 1), random_between(r, -1, 1)};
    int k = 0;
    while (k < corners && orientation(p->wall[k], at) > 0) k++;
    if (k == corners) return at;
  }
}

static void empty(randoms *r, int size, plan *p) {
  hr2d_point corner[12];
  (void)size;
  round_room(r, p, corner, 1);
}

/* The room itself is in the way. */
static void star(randoms *r, int size, plan *p) {
  hr2d_point corner[12];
  (void)size;
  round_room(r, p, corner, .1);
}

/* Walls that do not fit are left out. */
static void short_walls(randoms *r, int size, plan *p) {
  hr2d_point corner[12];
  const int corners = round_room(r, p, corner, 1);
  for (int k = 0; k < size; k++) {
    const hr2d_point a = inside(r, p, corners);
    const double length = random_power(r, -2, -.3), angle = random_between(r, 0, 2 * PI);
    put(p, a, (hr2d_point){a.x + length * cos(angle), a.y + length * sin(angle)}, APART);
  }
}

/* Regular polygons with their fronts out. */
static void obstacles(randoms *r, int size, plan *p, int sides, int max) {
  double at[64][3];
  int placed = 0;
  plan_room(p, 1, 1);
  for (int k = 0; k < 10 * size && placed < size && placed < 64; k++) {
    const double radius = random_between(r, .1, .5) / sqrt(size);
    const double x = random_between(r, radius, 1 - radius),
                 y = random_between(r, radius, 1 - radius);
    int m = 0;
    while (m < placed && hypot(x - at[m][0], y - at[m][1]) > radius + at[m][2]) m++;
    if (m < placed) continue;
    at[placed][0] = x, at[placed][1] = y, at[placed++][2] = radius;
    hr2d_point corner[64];
    const int corners = sides + random_below(r, max - sides + 1);
    const double first = random_between(r, 0, 2 * PI);
    for (int c = 0; c < corners; c++) {
      const double angle = first - 2 * PI * c / corners;
      corner[c] = (hr2d_point){x + radius * cos(angle), y + radius * sin(angle)};
    }
    polygon(p, corner, corners);
  }
}

static void squares(randoms *r, int size, plan *p) {
  obstacles(r, 1 + size / 4, p, 4, 4);
}

static void round_obstacles(randoms *r, int size, plan *p) {
  obstacles(r, 1 + size / 16, p, 16, 64);
}

static hr2d_point at_point(double x, double y) {
  return (hr2d_point){x, y};
}

/* Courses of bricks: a T at each joint. */
static void bricks(randoms *r, int size, plan *p) {
  const int courses = 1 + (int)sqrt(size), width = 2 * courses;
  plan_room(p, width, courses);
  for (int y = 0; y < courses; y++) {
    for (int x = 1 + y % 2; x < width; x += 2)
      if (random_below(r, 4)) put(p, at_point(x, y), at_point(x, y + 1), TOUCH);
    int from = 0;
    if (y == 0) continue;
    for (int x = 1; x <= width; x++) {
      if (x < width && random_below(r, 3)) continue;
      if (random_below(r, 4)) put(p, at_point(from, y), at_point(x, y), TOUCH);
      from = x;
    }
  }
}

/* Edges of a lattice, with the diagonals or without: up to eight meet in a point. */
static void lattice_edges(randoms *r, int size, plan *p, int directions) {
  static const int dx[] = {1, 0, 1}, dy[] = {0, 1, 1};
  const int cells = 1 + (int)sqrt(size / directions);
  const double part = random_between(r, .2, 1);
  plan_room(p, cells, cells);
  for (int y = 0; y < cells; y++)
    for (int x = 0; x < cells; x++)
      for (int k = 0; k < directions; k++)
        if (random_unit(r) < part)
          put(p, at_point(x, y), at_point(x + dx[k], y + dy[k]), TOUCH);
}

static void grid(randoms *r, int size, plan *p) {
  lattice_edges(r, size, p, 2);
}

static void triangles(randoms *r, int size, plan *p) {
  lattice_edges(r, size, p, 3);
}

/* A flight of stairs for a floor, and another one in mid-air. */
static void stairs(randoms *r, int size, plan *p) {
  const int steps = 2 + size / 8;
  hr2d_point corner[64];
  int corners = 0;
  for (int k = 0; k < steps && corners < 60; k++) {
    corner[corners++] = at_point(k, k);
    corner[corners++] = at_point(k + 1, k);
  }
  const double end = corner[corners - 1].x, top = end + 4;
  corner[corners++] = at_point(end, top);
  corner[corners++] = at_point(0, top);
  polygon(p, corner, corners);
  for (int k = 0; k < end; k++) {
    if (random_below(r, 5)) put(p, at_point(k, k + 2), at_point(k + 1, k + 2), TOUCH);
    if (random_below(r, 5)) put(p, at_point(k + 1, k + 2), at_point(k + 1, k + 3), TOUCH);
  }
}

/* Rooms in rooms, some with doors; each stands free or reaches the next by a wall. */
static void nested(randoms *r, int size, plan *p) {
  const int rooms = 1 + size / 8, width = 4 * rooms + 8;
  plan_room(p, width, width);
  for (int k = 1; k <= rooms; k++) {
    const double low = 2 * k, high = width - low;
    const hr2d_point corner[] = {{low, low}, {high, low}, {high, high}, {low, high}};
    const int door = random_below(r, 5);
    for (int side = 0; side < 4; side++) {
      const hr2d_point a = corner[side], b = corner[(side + 1) % 4];
      const hr2d_point c = {a.x + (b.x - a.x) / 4, a.y + (b.y - a.y) / 4};
      put(p, side == door ? c : a, b, TOUCH);
    }
    if (random_below(r, 2))
      put(p, at_point(width / 2, low), at_point(width / 2 + 1, low - 2), TOUCH);
  }
}

static void divide(randoms *r, plan *p, double x0, double y0, double x1, double y1, int size) {
  const int upright = x1 - x0 > y1 - y0 || (x1 - x0 == y1 - y0 && random_below(r, 2));
  const double from = upright ? x0 : y0, length = upright ? x1 - x0 : y1 - y0;
  if (size < 1 || length < 4) return;
  const double at = from + 1 + random_below(r, (int)length - 1);
  const hr2d_point a = upright ? (hr2d_point){at, y0} : (hr2d_point){x0, at};
  const hr2d_point b = upright ? (hr2d_point){at, y1} : (hr2d_point){x1, at};
  if (random_below(r, 2)) {
    const hr2d_point c = {a.x + (b.x - a.x) / 4, a.y + (b.y - a.y) / 4};
    const hr2d_point d = {a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2};
    put(p, a, c, TOUCH);
    put(p, d, b, TOUCH);
  } else
    put(p, a, b, TOUCH);
  divide(r, p, x0, y0, upright ? at : x1, upright ? y1 : at, size / 2);
  divide(r, p, upright ? at : x0, upright ? y0 : at, x1, y1, size / 2);
}

/* Partitions from wall to wall; half of them have a door. */
static void partitions(randoms *r, int size, plan *p) {
  plan_room(p, 64, 32);
  divide(r, p, 0, 0, 64, 32, size);
}

/* Partitions from corner to corner of the room, with others that end on them. */
static void chords(randoms *r, int size, plan *p) {
  hr2d_point corner[12];
  const int corners = round_room(r, p, corner, 1);
  for (int k = 0; k < size; k++) {
    const hr2d_point a = corner[random_below(r, corners)];
    if (k % 2 == 0)
      put(p, a, corner[random_below(r, corners)], TOUCH);
    else {
      const hr2d_segment w = p->wall[random_below(r, (int)p->walls)];
      const double t = random_unit(r);
      put(p, inside(r, p, corners),
          (hr2d_point){w.a.x + t * (w.b.x - w.a.x), w.a.y + t * (w.b.y - w.a.y)}, TOUCH);
    }
  }
}

/* Branches from ends, and from sixteenths of the length, of other walls. */
static void trees(randoms *r, int size, plan *p) {
  plan_room(p, 1024, 1024);
  put(p, at_point(512, 512), at_point(512 + 16 * random_below(r, 9), 640), TOUCH);
  for (int k = 0; k < 3 * size && p->walls < (size_t)size + 4; k++) {
    const hr2d_segment w = p->wall[random_below(r, (int)p->walls)];
    const int t = random_below(r, 17), reach = 1 + random_below(r, 16);
    const hr2d_point a = {w.a.x + t * (w.b.x - w.a.x) / 16, w.a.y + t * (w.b.y - w.a.y) / 16};
    const hr2d_point b = {16 * rint((a.x + random_between(r, -16, 16) * reach) / 16),
                          16 * rint((a.y + random_between(r, -16, 16) * reach) / 16)};
    if (b.x > 0 && b.x < 1024 && b.y > 0 && b.y < 1024) put(p, a, b, TOUCH);
  }
}

/* Teeth from the floor and from the ceiling. */
static void comb(randoms *r, int size, plan *p) {
  const int teeth = 1 + size / 2, height = 2 + random_below(r, 16);
  plan_room(p, teeth + 1, height);
  for (int x = 1; x <= teeth; x++) {
    const int length = 1 + random_below(r, height - 1);
    if (random_below(r, 2))
      put(p, at_point(x, 0), at_point(x, length), TOUCH);
    else
      put(p, at_point(x, height), at_point(x, height - length), TOUCH);
  }
}

/* Spokes from one hub, some of which reach the walls. */
static void fan(randoms *r, int size, plan *p) {
  const hr2d_point hub = {4 + random_below(r, 8), 4 + random_below(r, 8)};
  plan_room(p, 16, 16);
  for (int k = 0; k < size; k++) {
    const double angle = random_between(r, 0, 2 * PI), length = random_between(r, .5, 4);
    hr2d_point end = {hub.x + length * cos(angle), hub.y + length * sin(angle)};
    if (random_below(r, 3) == 0) end = at_point(random_below(r, 17), random_below(r, 2) * 16.0);
    put(p, hub, end, TOUCH);
  }
}

static void crossings(randoms *r, int size, plan *p) {
  plan_room(p, 1, 1);
  for (int k = 0; k < size / 4 + 1; k++) {
    const hr2d_point a = {random_between(r, .01, .99), random_between(r, .01, .99)};
    const hr2d_point b = {random_between(r, .01, .99), random_between(r, .01, .99)};
    plan_add(p, a, b, HR2D_SIDES_BOTH);
  }
  p->crossing = 1;
}

const plan_class plan_classes[] = {{"empty", empty},
                                   {"star", star},
                                   {"short walls", short_walls},
                                   {"squares", squares},
                                   {"round obstacles", round_obstacles},
                                   {"bricks", bricks},
                                   {"grid", grid},
                                   {"triangles", triangles},
                                   {"stairs", stairs},
                                   {"nested", nested},
                                   {"partitions", partitions},
                                   {"chords", chords},
                                   {"trees", trees},
                                   {"comb", comb},
                                   {"fan", fan},
                                   {"crossings", crossings}};
const int plan_class_count = sizeof plan_classes / sizeof *plan_classes;
