/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plans.h"

#include <math.h>
#include <stdlib.h>

#include "bars.h"

enum { BLOCKERS = 16 };

#define PI   3.14159265358979323846
#define SIDE 0.1 /* of a blocker */

static void add(plan *p, hr2d_point a, hr2d_point b) {
  if (p->count == p->capacity) {
    p->capacity = 2 * p->capacity + 64;
    p->segment = realloc(p->segment, p->capacity * sizeof *p->segment);
    if (!p->segment) bars_fail("out of memory");
  }
  p->segment[p->count++] = (hr2d_segment){a, b};
}

/* Scene files have nine decimals. */
static double decimal(double x) {
  return nearbyint(x * 1e9) / 1e9;
}

static hr2d_point along(hr2d_point a, hr2d_point b, int k, int pieces) {
  if (k == 0 || k == pieces) return k == 0 ? a : b;
  return (hr2d_point){decimal(a.x + (b.x - a.x) * k / pieces),
                      decimal(a.y + (b.y - a.y) * k / pieces)};
}

/* A closed polygon with its edges in equal pieces. */
static void add_polygon(plan *p, const hr2d_point *corner, int corners, int pieces) {
  for (int k = 0; k < corners; k++)
    for (int m = 0; m < pieces; m++) {
      const hr2d_point a = corner[k], b = corner[(k + 1) % corners];
      add(p, along(a, b, m, pieces), along(a, b, m + 1, pieces));
    }
}

/* The unit square, seen from inside. */
static void add_room(plan *p, int pieces) {
  const hr2d_point corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  add_polygon(p, corner, 4, pieces);
}

/* The lower left corners of the blockers in examples/scenes/occ128.vs2. */
static const hr2d_point blocker[BLOCKERS] = {
    {0.075, 0.085},
    {0.0764112, 0.320838532},
    {0.072205845, 0.568463564},
    {0.079121185, 0.834601703},
    {0.331569866, 0.077836622},
    {0.319559789, 0.315100075},
    {0.32920167, 0.580403023},
    {0.322120967, 0.830403023},
    {0.584906074, 0.066609285},
    {0.565386025, 0.323545},
    {0.584129453, 0.584601703},
    {0.566537796, 0.818463564},
    {0.833366556, 0.067403121},
    {0.815944216, 0.334074468},
    {0.834563759, 0.575044257},
    {0.815119684, 0.815888697},
};

/* Half of the patches on the room, half on the blockers: occN. */
void plan_occ(plan *p, int n) {
  add_room(p, n / 8);
  for (int k = 0; k < BLOCKERS; k++) {
    const hr2d_point c = blocker[k];
    const double x = decimal(c.x + SIDE), y = decimal(c.y + SIDE);
    const hr2d_point corner[] = {c, {c.x, y}, {x, y}, {x, c.y}};
    add_polygon(p, corner, 4, n / (8 * BLOCKERS));
  }
}

/* A regular polygon; counter-clockwise its front is inside, else outside. */
static void add_round(plan *p, hr2d_point centre, double radius, int corners, int hand) {
  hr2d_point last = {centre.x + radius, centre.y};
  for (int k = 1; k <= corners; k++) {
    const double angle = hand * 2 * PI * (k % corners) / corners;
    const hr2d_point next = {centre.x + radius * cos(angle), centre.y + radius * sin(angle)};
    add(p, last, next);
    last = next;
  }
}

/* The same arrangement with everything round, so that no two patches lie on one line. */
void plan_round(plan *p, int n) {
  add_round(p, (hr2d_point){0.5, 0.5}, 0.75, n / 2, 1);
  for (int k = 0; k < BLOCKERS; k++)
    add_round(p, (hr2d_point){blocker[k].x + SIDE / 2, blocker[k].y + SIDE / 2}, SIDE / 2,
              n / (2 * BLOCKERS), -1);
}

static uint64_t state;

void plan_random_start(uint64_t seed) {
  state = seed;
}

double plan_random(double min, double max) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return min + (max - min) * ((double)(state >> 11) * 0x1p-53);
}

/* `count` discs in the unit square that do not meet. */
static void draw_discs(int count, double min, double max, hr2d_point *centre, double *radius) {
  for (int k = 0; k < count;) {
    const double r = radius[k] = plan_random(min, max);
    const hr2d_point c = centre[k] = (hr2d_point){plan_random(r, 1 - r), plan_random(r, 1 - r)};
    int m = 0;
    while (m < k) {
      const double dx = c.x - centre[m].x, dy = c.y - centre[m].y, apart = r + radius[m];
      if (dx * dx + dy * dy <= 1.01 * apart * apart) break;
      m++;
    }
    k += m == k;
  }
}

/* Calls `put` for each of `count` discs. */
static void scatter(plan *p, int count, double min, double max,
                    void (*put)(plan *, hr2d_point, double)) {
  hr2d_point *centre = malloc(((size_t)count + 1) * sizeof *centre);
  double *radius = malloc(((size_t)count + 1) * sizeof *radius);
  if (!centre || !radius) bars_fail("out of memory");
  state = 20250101;
  draw_discs(count, min / sqrt(count), max / sqrt(count), centre, radius);
  for (int k = 0; k < count; k++) put(p, centre[k], radius[k]);
  free(centre);
  free(radius);
}

static void put_square(plan *p, hr2d_point c, double radius) {
  const double angle = plan_random(0, 2 * PI), u = radius * cos(angle), v = radius * sin(angle);
  const hr2d_point corner[] = {
      {c.x + u, c.y + v}, {c.x + v, c.y - u}, {c.x - u, c.y - v}, {c.x - v, c.y + u}};
  add_polygon(p, corner, 4, 1);
}

/* n/8 squares with diagonals of 0.35/√(n/8) to 0.7/√(n/8), any way round. */
void plan_squares(plan *p, int n) {
  add_room(p, n / 8);
  scatter(p, n / 8, 0.175, 0.35, put_square);
}

static void put_segment(plan *p, hr2d_point c, double radius) {
  const double angle = plan_random(0, 2 * PI), u = radius * cos(angle), v = radius * sin(angle);
  add(p, (hr2d_point){c.x - u, c.y - v}, (hr2d_point){c.x + u, c.y + v});
}

static void put_octagon(plan *p, hr2d_point c, double radius) {
  add_round(p, c, radius, 8, -1);
}

/* Sections of n/8 fibres. */
void plan_fibres(plan *p, int n) {
  add_room(p, 1);
  scatter(p, n / 8, 0.15, 0.3, put_octagon);
}

/* n/4 houses between streets that are not quite straight. */
void plan_city(plan *p, int n) {
  const int blocks = (int)sqrt(n / 4.), side = blocks > 0 ? blocks : 1;
  add_room(p, 1);
  state = 20250102;
  for (int k = 0; k < side * side; k++) {
    const double x = (k % side + .5) / side, y = (k / side + .5) / side;
    const double w = plan_random(.3, .45) / side, e = plan_random(.3, .45) / side,
                 south = plan_random(.3, .45) / side, north = plan_random(.3, .45) / side;
    const hr2d_point corner[] = {
        {x - w, y - south}, {x - w, y + north}, {x + e, y + north}, {x + e, y - south}};
    add_polygon(p, corner, 4, 1);
  }
}

/* Squares that are small beside the space between them. */
void plan_thin(plan *p, int n) {
  add_room(p, 1);
  scatter(p, n / 4, 0.025, 0.03, put_square);
}

void plan_tiny(plan *p, int n) {
  add_room(p, 1);
  scatter(p, n / 4, 0.0005, 0.0005, put_square);
}

/* A round room with nothing in it. */
void plan_open(plan *p, int n) {
  add_round(p, (hr2d_point){0.5, 0.5}, 0.75, n, 1);
}

/* n segments of length 0.3/√n, each with one front and any way round. */
void plan_segments(plan *p, int n) {
  add_room(p, 1);
  if (n > 0) scatter(p, n, 0.15, 0.15, put_segment);
}

hr2d_scene *plan_patches(plan_fn draw, int n, int lamps) {
  plan p = {0};
  hr2d_scene *scene = NULL;
  draw(&p, n);
  if (hr2d_scene_create(NULL, &scene)) bars_fail("no scene");
  for (size_t k = 0; k < p.count; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    const double one = 1;
    patch.a = p.segment[k].a;
    patch.b = p.segment[k].b;
    patch.emission = &one;
    patch.emission_bands = !lamps || k < (size_t)lamps;
    if (hr2d_scene_add(scene, &patch, NULL)) bars_fail(hr2d_scene_message(scene));
  }
  free(p.segment);
  return scene;
}

hr2d_scene *plan_scene(plan_fn draw, int n, int forced) {
  hr2d_scene *scene = plan_patches(draw, n, 0);
  if (forced && hr2d_scene_force(scene, HR2D_EFFECT_OCCLUSION)) bars_fail("not forced");
  if (hr2d_scene_commit(scene)) bars_fail(hr2d_scene_message(scene));
  return scene;
}

const plan_family plan_families[PLAN_FAMILIES] = {{"squares", plan_squares, 5120, .5, 1.15},
                                                  {"fibres", plan_fibres, 5120, .5, 1.15},
                                                  {"city", plan_city, 3960, .5, 1.15},
                                                  {"occ", plan_occ, 5120, 1, 0},
                                                  {"round", plan_round, 5120, 3, 0}};
