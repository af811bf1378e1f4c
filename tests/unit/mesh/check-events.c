/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Visibility events: in rooms where they can be computed by hand; and in random rooms, where
   a point between two events must see the same patches in the same order. */
#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "mesh/events.h"
#include "support/room-plans.h"
#include "support/support.h"

static hr2di_events events_of(const hr2d_scene *scene, unsigned generations) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_events found;
  ck_assert_int_eq(hr2di_events_init(&found, scene, &alloc, generations, SIZE_MAX, NULL, NULL),
                   HR2D_OK);
  for (size_t k = 0; k < found.count; k++) {
    const hr2di_event *e = &found.event[k];
    ck_assert(e->at > 0 && e->at < 1 && e->generation >= 1 && e->generation <= generations);
    if (k == 0 || e[-1].patch < e->patch) continue;
    ck_assert_uint_eq(e[-1].patch, e->patch);
    ck_assert(e->at - e[-1].at >= 1e-12);
  }
  return found;
}

/* The view of a point, found from all patches at once. */

enum { BLACK = -1, SKY = -2 };

/* A point nearer than this to a line, in a room of about 1, counts as lying on it. */
#define TOUCH 1e-11

typedef struct room {
  size_t patches, vertices;
  hr2d_segment *patch;
  hr2d_point *vertex;
} room;

/* Some ends are a rounding apart. */
static int same(hr2d_point p, hr2d_point q) {
  return fabs(p.x - q.x) < TOUCH && fabs(p.y - q.y) < TOUCH;
}

static room room_of(const hr2d_scene *scene) {
  room r = {.patches = hr2d_scene_patches(scene)};
  r.patch = calloc(r.patches, sizeof *r.patch);
  r.vertex = calloc(2 * r.patches, sizeof *r.vertex);
  const double unit = hr2d_scene_unit(scene);
  for (size_t k = 0; k < r.patches; k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    r.patch[k] = (hr2d_segment){{s.a.x / unit, s.a.y / unit}, {s.b.x / unit, s.b.y / unit}};
    for (int e = 0; e < 2; e++) {
      const hr2d_point p = e ? r.patch[k].b : r.patch[k].a;
      size_t v = 0;
      while (v < r.vertices && !same(r.vertex[v], p)) v++;
      r.vertex[v] = p;
      r.vertices += v == r.vertices;
    }
  }
  return r;
}

static void free_room(room *r) {
  free(r->patch);
  free(r->vertex);
}

static hr2d_point minus(hr2d_point p, hr2d_point q) {
  return (hr2d_point){p.x - q.x, p.y - q.y};
}

static double cross(hr2d_point p, hr2d_point q) {
  return p.x * q.y - p.y * q.x;
}

static double dot(hr2d_point p, hr2d_point q) {
  return p.x * q.x + p.y * q.y;
}

static double height(hr2d_segment s, hr2d_point p) {
  const hr2d_point d = minus(s.b, s.a);
  return cross(d, minus(p, s.a)) / sqrt(dot(d, d));
}

static int lies_on(hr2d_segment s, hr2d_point p) {
  return fabs(height(s, p)) < TOUCH && dot(minus(p, s.a), minus(p, s.b)) <= TOUCH;
}

static int sides_differ(hr2d_segment s, hr2d_point p, hr2d_point q) {
  return hr2d_orientation(s.a, s.b, p) * hr2d_orientation(s.a, s.b, q) < 0;
}

/* An eye on a patch. */
typedef struct viewpoint {
  const room *r;
  hr2d_segment own;
  hr2d_point at;
} viewpoint;

static int is_own_line(const viewpoint *e, hr2d_segment s) {
  return fabs(height(e->own, s.a)) < TOUCH && fabs(height(e->own, s.b)) < TOUCH;
}

static int sees(const viewpoint *e, hr2d_point v) {
  if (height(e->own, v) < TOUCH) return 0;
  for (size_t k = 0; k < e->r->patches; k++) {
    const hr2d_segment s = e->r->patch[k], look = {e->at, v};
    if (sides_differ(look, s.a, s.b) && sides_differ(s, e->at, v) && !is_own_line(e, s) &&
        !lies_on(s, v))
      return 0;
  }
  return 1;
}

/* The front that the eye sees in a direction; BLACK for a back. */
static int face_towards(const viewpoint *e, hr2d_point direction) {
  double nearest = HUGE_VAL;
  int face = SKY;
  for (size_t k = 0; k < e->r->patches; k++) {
    const hr2d_segment s = e->r->patch[k];
    const hr2d_point a = minus(s.a, e->at), b = minus(s.b, e->at);
    const double at_a = cross(direction, a), at_b = cross(direction, b);
    if (at_a * at_b >= 0 || is_own_line(e, s)) continue;
    const double distance = cross(a, b) / (at_b - at_a);
    if (!(distance > 0) || distance > nearest + TOUCH) continue;
    /* Of two patches back to back it is the front one. */
    const int is_front = hr2d_orientation(s.a, s.b, e->at) > 0;
    if (distance > nearest - TOUCH && !is_front) continue;
    nearest = distance;
    face = is_front ? (int)k : BLACK;
  }
  return face;
}

/* Faces and the numbers of the vertices between them, from the right to the left; one and
   the same face on either side hides a vertex on its back. */
typedef struct view {
  int *item;
  size_t count;
} view;

static const viewpoint *sorting_eye;

static int by_direction(const void *left, const void *right) {
  const room *r = sorting_eye->r;
  return -hr2d_orientation(sorting_eye->at, r->vertex[*(const int *)left],
                           r->vertex[*(const int *)right]);
}

static hr2d_point unit_towards(const viewpoint *e, const int *seen, size_t count, size_t k) {
  const hr2d_point to = k == 0 ? e->own.b : k <= count ? e->r->vertex[seen[k - 1]] : e->own.a;
  const hr2d_point d = minus(to, e->at);
  const double length = sqrt(dot(d, d));
  return (hr2d_point){d.x / length, d.y / length};
}

static view look(const room *r, size_t patch, double t) {
  const hr2d_segment s = r->patch[patch];
  const viewpoint e = {r, s, {(1 - t) * s.a.x + t * s.b.x, (1 - t) * s.a.y + t * s.b.y}};
  int *seen = calloc(r->vertices + 1, sizeof *seen);
  view v = {.item = calloc(2 * r->vertices + 1, sizeof *v.item)};
  size_t count = 0;
  for (size_t k = 0; k < r->vertices; k++)
    if (sees(&e, r->vertex[k])) seen[count++] = (int)k;
  sorting_eye = &e;
  qsort(seen, count, sizeof *seen, by_direction);
  for (size_t k = 0; k <= count; k++) {
    const hr2d_point p = unit_towards(&e, seen, count, k);
    const hr2d_point q = unit_towards(&e, seen, count, k + 1);
    /* Between a straight line's two directions there is only the normal. */
    const hr2d_point normal = {s.a.y - s.b.y, s.b.x - s.a.x};
    const int face = face_towards(&e, count == 0 ? normal : (hr2d_point){p.x + q.x, p.y + q.y});
    if (k > 0 && face == v.item[v.count - 1]) continue;
    if (k > 0) v.item[v.count++] = seen[k - 1];
    v.item[v.count++] = face;
  }
  free(seen);
  return v;
}

static int views_differ(const room *r, size_t patch, double t, double u) {
  const view p = look(r, patch, t), q = look(r, patch, u);
  int differ = p.count != q.count;
  for (size_t k = 0; k < p.count && !differ; k++) differ = p.item[k] != q.item[k];
  free(p.item);
  free(q.item);
  return differ;
}

/* Shorter intervals have places that rounding cannot tell apart. */
#define SHORTEST 1e-6

/* Whether the view changes between two events of a patch: from places that no line through
   points of a lattice meets. */
static int changes_between(const room *r, size_t patch, double from, double to) {
  static const double part[] = {.0427183, .3618034, .5123106, .7236068, .9571068};
  if (to - from < SHORTEST) return 0;
  for (int k = 1; k < 5; k++)
    if (views_differ(r, patch, from + part[0] * (to - from), from + part[k] * (to - from)))
      return 1;
  return 0;
}

/* From the event before number k, or from the start of the patch. */
static double before(const hr2di_events *e, size_t k) {
  return k > 0 && e->event[k - 1].patch == e->event[k].patch ? e->event[k - 1].at : 0;
}

static double behind(const hr2di_events *e, size_t k) {
  const int last = k + 1 == e->count || e->event[k + 1].patch != e->event[k].patch;
  return last ? 1 : e->event[k + 1].at;
}

static double last_of(const hr2di_events *e, size_t patch) {
  double at = 0;
  for (size_t k = 0; k < e->count; k++)
    if (e->event[k].patch == patch) at = e->event[k].at;
  return at;
}

static void assert_same(const room *r, size_t patch, double from, double to, const char *name) {
  ck_assert_msg(!changes_between(r, patch, from, to),
                "%s: the view from patch %zu changes between %.17g and %.17g", name, patch,
                from, to);
}

static void assert_complete(const hr2d_scene *scene, const hr2di_events *e, const char *name) {
  room r = room_of(scene);
  for (size_t k = 0; k < e->count; k++)
    assert_same(&r, e->event[k].patch, before(e, k), e->event[k].at, name);
  for (size_t k = 0; k < r.patches; k++) assert_same(&r, k, last_of(e, k), 1, name);
  free_room(&r);
}

/* How many of the events are such that without each of them that would fail. */
static size_t needed(const hr2d_scene *scene, const hr2di_events *e) {
  room r = room_of(scene);
  size_t count = 0;
  for (size_t k = 0; k < e->count; k++)
    count += (size_t)changes_between(&r, e->event[k].patch, before(e, k), behind(e, k));
  free_room(&r);
  return count;
}

/* Rooms whose events can be computed by hand. */

typedef struct known {
  uint32_t patch;
  double at;
  unsigned generation;
} known;

static const double square[][6] = {{0, 0, 1, 0, 1, .5},     {1, 0, 1, 1, 0, .5},
                                   {1, 1, 0, 1, 0, .5},     {0, 1, 0, 0, 0, .5},
                                   {.3, .5, .7, .5, 0, .5}, {.7, .5, .3, .5, 0, .5}};

/* From the corners past the occluder, along it, and from its ends' shadows past it. */
static const known square_events[] = {
    {0, .2, 2},       {0, .4, 1},       {0, .6, 1},       {0, .8, 2},     {1, 2 / 7., 1},
    {1, 20 / 49., 2}, {1, .5, 1},       {1, 29 / 49., 2}, {1, 5 / 7., 1}, {2, .2, 2},
    {2, .4, 1},       {2, .6, 1},       {2, .8, 2},       {3, 2 / 7., 1}, {3, 20 / 49., 2},
    {3, .5, 1},       {3, 29 / 49., 2}, {3, 5 / 7., 1}};

/* Horizons of both walls at the re-entrant corner (1,1), and lines to the far corners. */
static const double angle[][6] = {{0, 0, 3, 0, 1, .5}, {3, 0, 3, 1, 0, .5},
                                  {3, 1, 1, 1, 0, .5}, {1, 1, 1, 2, 0, .5},
                                  {1, 2, 0, 2, 0, .5}, {0, 2, 0, 0, 0, .5}};
static const known angle_events[] = {{0, 1 / 3., 1}, {0, 2 / 3., 1}, {5, .25, 1}, {5, .5, 1}};

/* A screen that stands on the floor. */
static const double screen[][6] = {{0, 0, 1, 0, 1, .5},    {1, 0, 1, 1, 0, .5},
                                   {1, 1, 0, 1, 0, .5},    {0, 1, 0, 0, 0, .5},
                                   {.5, 0, .5, .4, 0, .5}, {.5, .4, .5, 0, 0, .5}};
static const known screen_events[] = {{0, 1 / 6., 1}, {0, .5, 1}, {0, 5 / 6., 1},
                                      {1, .8, 1},     {2, .5, 1}, {3, .2, 1}};

/* A slab that ends on either wall: below and above are two rooms. */
static const double storeys[][6] = {{0, 0, 1, 0, 1, .5},     {1, 0, 1, 1, 0, .5},
                                    {1, 1, 0, 1, 0, .5},     {0, 1, 0, 0, 0, .5},
                                    {0, .25, 1, .25, 0, .5}, {1, .25, 0, .25, 0, .5}};
static const known storey_events[] = {{1, .25, 1}, {3, .75, 1}};

/* A wall across the horizon of another one; nothing hides anything. */
static const double facing[][6] = {{0, 0, 1, 0, 1, .5}, {1.5, -1, 1.5, 1, 0, .5}};
static const known facing_events[] = {{1, .5, 1}};

#define ROWS(table) (sizeof(table) / sizeof *(table))

/* The events of patches turned by (u + iv), which moves none along its patch. */
static void expect(const double patch[][6], size_t patches, double u, double v,
                   const known *expected, size_t count, unsigned generations) {
  double turned[8][6];
  for (size_t k = 0; k < patches; k++) {
    const double *p = patch[k];
    const double row[] = {u * p[0] - v * p[1],
                          v * p[0] + u * p[1],
                          u * p[2] - v * p[3],
                          v * p[2] + u * p[3],
                          p[4],
                          p[5]};
    for (int m = 0; m < 6; m++) turned[k][m] = row[m];
  }
  hr2d_scene *scene = test_scene((const double(*)[6])turned, patches);
  hr2di_events found = events_of(scene, generations);
  size_t next = 0;
  for (size_t k = 0; k < count; k++) {
    if (expected[k].generation > generations) continue;
    ck_assert_uint_lt(next, found.count);
    const hr2di_event *e = &found.event[next++];
    ck_assert_uint_eq(e->patch, expected[k].patch);
    ck_assert_double_eq_tol(e->at, expected[k].at, 4e-16 * (v == 0 && u == 1 ? 1 : 8));
    ck_assert_uint_eq(e->generation, expected[k].generation);
  }
  ck_assert_uint_eq(next, found.count);
  if (generations == 1) {
    assert_complete(scene, &found, "known");
    ck_assert_uint_eq(needed(scene, &found), found.count);
  }
  hr2di_events_clear(&found);
  hr2d_scene_destroy(scene);
}

START_TEST(test_known) {
  static const double turn[][2] = {{1, 0}, {0, 1}, {.75, .5}, {.1, 1.3}, {-.7, .3}, {1e5, 3e4}};
  for (size_t k = 0; k < ROWS(turn); k++) {
    const double u = turn[k][0], v = turn[k][1];
    for (unsigned g = 1; g <= 2; g++)
      expect(square, ROWS(square), u, v, square_events, ROWS(square_events), g);
    expect(angle, ROWS(angle), u, v, angle_events, ROWS(angle_events), 1);
    expect(screen, ROWS(screen), u, v, screen_events, ROWS(screen_events), 1);
    expect(storeys, ROWS(storeys), u, v, storey_events, ROWS(storey_events), 3);
    expect(facing, ROWS(facing), u, v, facing_events, ROWS(facing_events), 1);
  }
}
END_TEST

/* A convex room has no events, whatever is forced. */
START_TEST(test_none) {
  randoms r = randoms_stream(test_seed(), 1);
  for (int k = 0; k < 50; k++) {
    plan p = {.walls = 0};
    plan_classes[0].draw(&r, 8, &p);
    const unsigned all = (1u << HR2D_EFFECT_COUNT) - 1;
    hr2d_scene *scene =
        test_painted_scene(&p, &(test_paint){.reflectance = .5, .emission = 1, .forced = all});
    hr2di_events found = events_of(scene, 3);
    ck_assert_uint_eq(found.count, 0);
    hr2di_events_clear(&found);
    hr2d_scene_destroy(scene);
    plan_free(&p);
  }
}
END_TEST

/* Patches that no light reaches have no events. */
START_TEST(test_unlit) {
  double patch[ROWS(square)][6];
  for (size_t k = 0; k < ROWS(square); k++)
    for (int m = 0; m < 6; m++) patch[k][m] = m == 4 ? 0 : square[k][m];
  hr2d_scene *scene = test_scene((const double(*)[6])patch, ROWS(square));
  hr2di_events found = events_of(scene, 2);
  ck_assert_uint_eq(found.count, 0);
  hr2di_events_clear(&found);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Patches that do not reflect hand no event on. */
START_TEST(test_black) {
  double patch[ROWS(square)][6];
  for (size_t k = 0; k < ROWS(square); k++) {
    for (int m = 0; m < 6; m++) patch[k][m] = square[k][m];
    patch[k][5] = k == 0 ? .5 : 0;
  }
  hr2d_scene *scene = test_scene((const double(*)[6])patch, ROWS(square));
  hr2di_events found = events_of(scene, 9);
  /* Only the floor reflects: 0.2 and 0.8 are gone from it, and those on the walls. */
  ck_assert_uint_eq(found.count, 12);
  for (size_t k = 0; k < found.count; k++)
    ck_assert(found.event[k].generation == 1 || found.event[k].patch == 2);
  hr2di_events_clear(&found);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Random rooms. */

static hr2d_scene *draw(randoms *r, const plan_class *class, int size, int turned) {
  plan p = {.walls = 0};
  class->draw(r, size, &p);
  if (turned)
    plan_transform(&p, (similarity){random_between(r, -1, 1), random_between(r, -1, 1),
                                    random_between(r, -3, 3), random_between(r, -3, 3)});
  hr2d_scene *scene =
      test_painted_scene(&p, &(test_paint){.reflectance = .5, .emission = 1, .background = 1});
  plan_free(&p);
  return scene;
}

/* And if one of the events is taken away that shows, as a rule. */
START_TEST(test_complete) {
  randoms r = randoms_stream(test_seed(), 100 + _i);
  const int count = test_count(12);
  size_t all = 0, used = 0;
  for (int k = 0; k < count; k++) {
    hr2d_scene *scene = draw(&r, &plan_classes[_i], 2 + random_below(&r, 12), k % 2);
    hr2di_events found = events_of(scene, 1);
    assert_complete(scene, &found, plan_classes[_i].name);
    all += found.count;
    used += needed(scene, &found);
    hr2di_events_clear(&found);
    hr2d_scene_destroy(scene);
  }
  if (all >= 100) ck_assert_uint_ge(4 * used, 3 * all);
  printf("%s: %zu of %zu events change the view by themselves\n", plan_classes[_i].name, used,
         all);
}
END_TEST

/* Cutting the patches at their events makes ends of these, so that the next generation is
   the first one. */

static const hr2d_patch piece_init = HR2D_PATCH_INIT;

static void add_piece(hr2d_scene *scene, hr2d_segment s, double from, double to) {
  const double half = .5, dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  hr2d_patch piece = piece_init;
  piece.a = (hr2d_point){s.a.x + from * dx, s.a.y + from * dy};
  piece.b = to == 1 ? s.b : (hr2d_point){s.a.x + to * dx, s.a.y + to * dy};
  piece.reflectance = piece.emission = &half;
  piece.reflectance_bands = piece.emission_bands = 1;
  ck_assert_int_eq(hr2d_scene_add(scene, &piece, NULL), HR2D_OK);
}

static hr2d_scene *cut_up(const hr2d_scene *whole, const hr2di_events *e) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0, next = 0; k < hr2d_scene_patches(whole); k++) {
    double from = 0;
    for (; next < e->count && e->event[next].patch == k; next++) {
      add_piece(scene, hr2d_scene_segment(whole, k), from, e->event[next].at);
      from = e->event[next].at;
    }
    add_piece(scene, hr2d_scene_segment(whole, k), from, 1);
  }
  test_commit(scene);
  return scene;
}

typedef struct place {
  uint32_t patch;
  double at;
} place;

/* How rounding moves an event depends on how far from the lines' vertices it is. */
#define NEAR 1e-9

/* Where the events of the pieces are on the whole; ends that are missed by a rounding are
   none. */
static size_t put_together(const hr2d_scene *whole, const hr2di_events *cuts,
                           const hr2di_events *pieces, place *found) {
  size_t count = 0, piece = 0;
  for (size_t k = 0, next = 0, at = 0; k < hr2d_scene_patches(whole); k++) {
    double from = 0, to = 0;
    for (; to < 1; from = to, piece++) {
      const int more = next < cuts->count && cuts->event[next].patch == k;
      to = more ? cuts->event[next++].at : 1;
      for (; at < pieces->count && pieces->event[at].patch == piece; at++) {
        const place p = {(uint32_t)k, from + (to - from) * pieces->event[at].at};
        if (p.at > NEAR && p.at < 1 - NEAR) found[count++] = p;
      }
    }
  }
  return count;
}

static int is_there(place p, const place *in, size_t count) {
  for (size_t k = 0; k < count; k++)
    if (in[k].patch == p.patch && fabs(in[k].at - p.at) < NEAR) return 1;
  return 0;
}

static size_t places_of(const hr2di_events *e, place *found) {
  for (size_t k = 0; k < e->count; k++) found[k] = (place){e->event[k].patch, e->event[k].at};
  return e->count;
}

static void compare_generations(const hr2d_scene *scene, const char *name) {
  hr2di_events first = events_of(scene, 1), second = events_of(scene, 2);
  hr2d_scene *cut = cut_up(scene, &first);
  hr2di_events pieces = events_of(cut, 1);
  place *put = calloc(pieces.count + first.count + 1, sizeof *put);
  place *all = calloc(second.count + 1, sizeof *all);
  size_t put_count = put_together(scene, &first, &pieces, put);
  const size_t count = places_of(&second, all);
  for (size_t k = 0; k < put_count; k++)
    ck_assert_msg(is_there(put[k], all, count), "%s: patch %u has none at %.17g", name,
                  put[k].patch, put[k].at);
  put_count += places_of(&first, put + put_count);
  for (size_t k = 0; k < count; k++)
    ck_assert_msg(is_there(all[k], put, put_count), "%s: patch %u has one at %.17g", name,
                  all[k].patch, all[k].at);
  ck_assert_uint_ge(second.count, first.count);
  free(put);
  free(all);
  hr2di_events_clear(&first);
  hr2di_events_clear(&second);
  hr2di_events_clear(&pieces);
  hr2d_scene_destroy(cut);
}

START_TEST(test_generations) {
  /* Walls along the axes, which stay straight where they are cut. */
  static const int upright[] = {5, 6, 8, 9, 10, 13};
  randoms r = randoms_stream(test_seed(), 200 + _i);
  const int count = test_count(5);
  for (int k = 0; k < count; k++) {
    hr2d_scene *scene = draw(&r, &plan_classes[upright[_i]], 2 + random_below(&r, 5), 0);
    compare_generations(scene, plan_classes[upright[_i]].name);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Rooms that roundings or coincidence make hard. */

static void add_wall(hr2d_scene *scene, double ax, double ay, double bx, double by) {
  add_piece(scene, (hr2d_segment){{ax, ay}, {bx, by}}, 0, 1);
}

static void add_room(hr2d_scene *scene, double width, double height) {
  add_wall(scene, 0, 0, width, 0);
  add_wall(scene, width, 0, width, height);
  add_wall(scene, width, height, 0, height);
  add_wall(scene, 0, height, 0, 0);
}

/* Walls with a front above, and others on the same line with a front below: where one of them
   ends, something is to be seen on one side only. */
START_TEST(test_coincident) {
  randoms r = randoms_stream(test_seed(), 300);
  const int count = test_count(30);
  size_t all = 0, used = 0;
  for (int k = 0; k < count; k++) {
    hr2d_scene *scene = test_new_scene(NULL);
    add_room(scene, 4, 4);
    for (int row = 0; row < 3; row++) {
      const double y = row + random_between(&r, .6, 1.4);
      add_wall(scene, random_between(&r, .2, 1.9), y, random_between(&r, 2.1, 3.8), y);
      add_wall(scene, random_between(&r, 2.1, 3.8), y, random_between(&r, .2, 1.9), y);
    }
    test_commit(scene);
    hr2di_events found = events_of(scene, 1);
    assert_complete(scene, &found, "coincident");
    all += found.count;
    used += needed(scene, &found);
    hr2di_events_clear(&found);
    hr2d_scene_destroy(scene);
  }
  /* Those between a back and a back are not. */
  ck_assert_uint_ge(4 * used, 3 * all);
  printf("coincident: %zu of %zu events change the view by themselves\n", used, all);
}
END_TEST

static hr2d_point move(randoms *r, hr2d_point p) {
  p.x = nextafter(p.x, random_between(r, -9, 9));
  p.y = nextafter(p.y, random_between(r, -9, 9));
  return p;
}

/* A star-shaped room; if moved, each end of a wall by itself goes to a double beside it. */
static hr2d_scene *star(randoms *r, const double *radius, int corners, int moved) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < corners; k++) {
    hr2d_point end[2];
    for (int e = 0; e < 2; e++) {
      const int corner = (k + e) % corners;
      const double turn = 6.2831853071795862 * (corner + .1) / corners;
      end[e] = (hr2d_point){radius[corner] * cos(turn), radius[corner] * sin(turn)};
      if (moved) end[e] = move(r, end[e]);
    }
    add_wall(scene, end[0].x, end[0].y, end[1].x, end[1].y);
  }
  test_commit(scene);
  return scene;
}

/* Ends a rounding apart make no line of their own, and no gap. */
START_TEST(test_ends_apart) {
  randoms r = randoms_stream(test_seed(), 301);
  const int count = test_count(40);
  size_t all = 0;
  for (int k = 0; k < count; k++) {
    double radius[16];
    const int corners = 5 + (int)random_below(&r, 12);
    for (int m = 0; m < corners; m++) radius[m] = random_between(&r, .4, 2);
    hr2d_scene *whole = star(&r, radius, corners, 0), *moved = star(&r, radius, corners, 1);
    hr2di_events expected = events_of(whole, 1), found = events_of(moved, 1);
    ck_assert_uint_eq(found.count, expected.count);
    for (size_t m = 0; m < found.count; m++) {
      ck_assert_uint_eq(found.event[m].patch, expected.event[m].patch);
      ck_assert_double_eq_tol(found.event[m].at, expected.event[m].at, NEAR);
    }
    all += found.count;
    hr2di_events_clear(&expected);
    hr2di_events_clear(&found);
    hr2d_scene_destroy(whole);
    hr2d_scene_destroy(moved);
  }
  ck_assert_uint_ge(all, 3 * (size_t)count);
}
END_TEST

/* Cost. */

/* A row of rooms with one corner each that stands out. */
static void add_cells(hr2d_scene *scene, int count) {
  static const double corner[][2] = {{0, 0}, {1, 0}, {1, 1}, {.4, 1}, {.4, .5}, {0, .5}};
  for (int k = 0; k < count; k++)
    for (size_t m = 0; m < ROWS(corner); m++) {
      const double *a = corner[m], *b = corner[(m + 1) % ROWS(corner)];
      add_wall(scene, 1.25 * k + a[0], a[1], 1.25 * k + b[0], b[1]);
    }
}

/* A row of pins in one room, whose heads see each other. */
static void add_pins(hr2d_scene *scene, int count) {
  add_room(scene, count + 1, 3);
  for (int k = 1; k <= count; k++) {
    const double x = (double)k / (count + 1), head = .5 + (x - .5) * (x - .5);
    add_wall(scene, k, .25, k, head);
    add_wall(scene, k, head, k, .25);
  }
}

static double steps_of(void (*add)(hr2d_scene *, int), int count) {
  hr2d_scene *scene = test_new_scene(NULL);
  add(scene, count);
  test_commit(scene);
  hr2di_events found = events_of(scene, 1);
  const double steps = (double)found.steps;
  ck_assert_uint_ge(found.count, 2 * (size_t)count);
  hr2di_events_clear(&found);
  hr2d_scene_destroy(scene);
  return steps;
}

/* The cost grows with what is seen; pins show that a square would be noticed. */
START_TEST(test_cost) {
  ck_assert_double_le(steps_of(add_cells, 400), 2.1 * steps_of(add_cells, 200));
  ck_assert_double_ge(steps_of(add_pins, 400), 3.5 * steps_of(add_pins, 200));
}
END_TEST

/* Limits. */

START_TEST(test_max) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_scene *scene = test_scene(square, ROWS(square));
  const size_t count[] = {0, 10, 18};
  for (unsigned g = 0; g <= 2; g++) {
    hr2di_events found;
    ck_assert_int_eq(hr2di_events_init(&found, scene, &alloc, g, count[g], NULL, NULL),
                     HR2D_OK);
    ck_assert_uint_eq(found.count, count[g]);
    hr2di_events_clear(&found);
    for (size_t max = 0; max < count[g]; max++) {
      ck_assert_int_eq(hr2di_events_init(&found, scene, &alloc, g, max, NULL, NULL),
                       HR2D_EMAX_ELEMENTS);
      hr2di_events_clear(&found);
    }
  }
  hr2d_scene_destroy(scene);
}
END_TEST

/* In scenes with a plane and without. */
START_TEST(test_failures) {
  static const struct {
    const double (*patch)[6];
    size_t patches;
  } scenes[] = {{screen, ROWS(screen)}, {facing, ROWS(facing)}};
  test_memory memory = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&memory);
  hr2d_scene *scene = test_new_scene(&hooks);
  for (size_t k = 0; k < scenes[_i].patches; k++) {
    const double *p = scenes[_i].patch[k];
    add_wall(scene, p[0], p[1], p[2], p[3]);
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL), _i == 0);
  const long live = memory.live;
  for (int for_good = 0; for_good < 2; for_good++)
    for (long k = 0, done = 0; !done; k++) {
      memory.until_failure = k;
      memory.for_good = for_good;
      memory.failures = 0;
      hr2di_events found;
      const hr2d_status status =
          hr2di_events_init(&found, scene, &hooks, 2, SIZE_MAX, NULL, NULL);
      done = memory.failures == 0;
      ck_assert_int_eq(status, done ? HR2D_OK : HR2D_ENOMEM);
      ck_assert_int_ge(k, done ? 5 : 0);
      hr2di_events_clear(&found);
      ck_assert_int_eq(memory.live, live);
    }
  memory.until_failure = -1;
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("events") {
  ADD_TESTS("known", test_known, test_none, test_unlit, test_black);
  REPEAT_TESTS(plan_class_count, "random", test_complete);
  REPEAT_TESTS(6, "random", test_generations);
  ADD_TESTS("hard", test_coincident, test_ends_apart);
  ADD_TESTS("cost", test_cost);
  ADD_TESTS("limits", test_max);
  REPEAT_TESTS(2, "limits", test_failures);
}
