/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes whose patches cross or lie on one another: which are refused, and where they are
   split.  Judged in long double, in which the distance of a point from a line is known to
   2^-60. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene-impl.h"
#include "support/plane.h"
#include "support/support.h"

#define MOST 512

typedef long double real;

/* One rounding, if the largest coordinate is 1. */
#define ROUNDING 0x1p-50

/* An assertion of Check's writes to a file each time, which is too slow for millions. */
#define DEMAND(condition, ...)                                                                 \
  do {                                                                                         \
    if (!(condition)) ck_abort_msg(__VA_ARGS__);                                               \
  } while (0)

typedef struct drawing {
  hr2d_segment s[MOST];
  hr2d_sides sides[MOST];
  size_t count;
} drawing;

static double uniform(unsigned long *state, double low, double high) {
  return low + (high - low) * test_random(state);
}

static void draw(drawing *d, double ax, double ay, double bx, double by) {
  DEMAND(d->count < MOST, "too many");
  d->sides[d->count] = HR2D_SIDES_FRONT;
  d->s[d->count++] = (hr2d_segment){{ax, ay}, {bx, by}};
}

/* Turned by an angle, stretched and moved: what met in one point now meets in one
   within rounding. */
typedef struct motion {
  double cosine, sine, scale, dx, dy;
} motion;

static motion turned(double angle, double scale, double dx, double dy) {
  return (motion){cos(angle), sin(angle), scale, dx, dy};
}

static void draw_moved(drawing *d, const motion *m, double ax, double ay, double bx,
                       double by) {
  draw(d, (m->cosine * ax - m->sine * ay) * m->scale + m->dx,
       (m->sine * ax + m->cosine * ay) * m->scale + m->dy,
       (m->cosine * bx - m->sine * by) * m->scale + m->dx,
       (m->sine * bx + m->cosine * by) * m->scale + m->dy);
}

static const double material[] = {1, 2, 3, .25, .5, .75};

static hr2d_patch patch_of(const drawing *d, size_t k, char *name) {
  hr2d_patch p = HR2D_PATCH_INIT;
  sprintf(name, "w%zu", k);
  p.a = d->s[k].a;
  p.b = d->s[k].b;
  p.name = name;
  p.emission = material + k % 3;
  p.emission_bands = k % 2 ? 3 : 1;
  p.reflectance = material + 3;
  p.reflectance_bands = k % 3 ? 3 : 0;
  p.sides = d->sides[k];
  return p;
}

static hr2d_scene *scene_of(const drawing *d, const hr2d_allocator *hooks) {
  hr2d_scene *scene = test_new_scene(hooks);
  for (size_t k = 0; k < d->count; k++) {
    char name[32];
    const hr2d_patch p = patch_of(d, k, name);
    DEMAND(hr2d_scene_add(scene, &p, NULL) == HR2D_OK, "%s", hr2d_scene_message(scene));
  }
  return scene;
}

/* Commit's checks alone: the analysis of the effects takes its time with thousands. */
static hr2d_status check(hr2d_scene *scene) {
  const hr2d_status status = hr2di_scene_scale(scene, NULL);
  return status ? status : hr2di_scene_check_overlaps(scene, NULL);
}

static double largest(const hr2d_segment *s) {
  return fmax(fmax(fabs(s->a.x), fabs(s->a.y)), fmax(fabs(s->b.x), fabs(s->b.y)));
}

static double scene_scale(const drawing *d) {
  double max = 0;
  for (size_t k = 0; k < d->count; k++) max = fmax(max, largest(&d->s[k]));
  return max;
}

/* Without squares that overflow where a long double is no longer than a double. */
static real length(const hr2d_segment *s) {
  const real x = (real)s->b.x - s->a.x, y = (real)s->b.y - s->a.y;
  const real max = fmaxl(fabsl(x), fabsl(y));
  return max == 0 ? 0 : max * hypotl(x / max, y / max);
}

/* How far p is to the left of the line of s. */
static real left_of(const hr2d_segment *s, hr2d_point p) {
  const real ux = (real)s->b.x - s->a.x, uy = (real)s->b.y - s->a.y, l = length(s);
  return ux / l * ((real)p.y - s->a.y) - uy / l * ((real)p.x - s->a.x);
}

static int sign(real x) {
  return (x > 0) - (x < 0);
}

/* By how much two segments that cross do so at least; 0 where they do not. */
static real poke(const hr2d_segment *s, const hr2d_segment *t) {
  const real a = left_of(s, t->a), b = left_of(s, t->b), c = left_of(t, s->a),
             d = left_of(t, s->b);
  if (sign(a) * sign(b) >= 0 || sign(c) * sign(d) >= 0) return 0;
  return fminl(fminl(fabsl(a), fabsl(b)), fminl(fabsl(c), fabsl(d)));
}

/* The pieces of one patch after the cut: [first, end). */
typedef struct chain {
  size_t first, end;
} chain;

static void check_piece(const hr2d_scene *scene, size_t patch, size_t index,
                        const char *expected, const hr2d_segment *whole, double scale) {
  const char *name = hr2d_scene_name(scene, index);
  DEMAND(strcmp(name, expected) == 0, "%s is called %s", expected, name);
  const size_t bands = patch % 2 ? 3 : 1;
  for (size_t band = 0; band < 3; band++)
    DEMAND(hr2d_scene_emission(scene, index, band) ==
                   material[patch % 3 + (bands == 1 ? 0 : band)] &&
               hr2d_scene_reflectance(scene, index, band) ==
                   (patch % 3 ? material[3 + band] : 0),
           "%s has another material", expected);
  const hr2d_segment s = hr2d_scene_segment(scene, index);
  const real off = fmaxl(fabsl(left_of(whole, s.a)), fabsl(left_of(whole, s.b)));
  DEMAND(off <= 3 * ROUNDING * scale, "%s is %Lg from its patch", expected, off / scale);
  const real forward =
      (((real)s.b.x - s.a.x) / scale) * (((real)whole->b.x - whole->a.x) / scale) +
      (((real)s.b.y - s.a.y) / scale) * (((real)whole->b.y - whole->a.y) / scale);
  DEMAND(forward > 0, "%s runs backwards", expected);
}

/* Checks the pieces of a patch, or of its back, from index `first` on. */
static chain check_chain(const hr2d_scene *scene, const drawing *d, size_t patch, int back,
                         size_t first, double scale) {
  hr2d_segment whole = d->s[patch];
  if (back) whole = (hr2d_segment){whole.b, whole.a};
  hr2d_point from = whole.a;
  chain c = {first, first};
  char name[64], number[128];
  sprintf(name, "w%zu%s", patch, back ? " (back)" : "");
  real total = 0;
  while (!plane_same(from, whole.b)) {
    DEMAND(c.end < hr2d_scene_patches(scene), "%s does not end", name);
    const hr2d_segment s = hr2d_scene_segment(scene, c.end);
    DEMAND(plane_same(s.a, from), "%s has a gap", name);
    from = s.b;
    total += length(&s);
    c.end++;
  }
  for (size_t k = first; k < c.end; k++) {
    snprintf(number, sizeof number, "%s [%zu]", name, k - first + 1);
    check_piece(scene, patch, k, c.end == first + 1 ? name : number, &whole, scale);
  }
  DEMAND(fabsl(total - length(&whole)) <= (real)(c.end - first) * 4 * ROUNDING * scale,
         "%s is %Lg longer than it was", name, total - length(&whole));
  return c;
}

static int share_a_point(const hr2d_scene *scene, chain c, chain e) {
  for (size_t k = c.first; k <= c.end; k++)
    for (size_t m = e.first; m <= e.end; m++) {
      const hr2d_point p = k < c.end ? hr2d_scene_segment(scene, k).a
                                     : hr2d_scene_segment(scene, k - 1).b,
                       q = m < e.end ? hr2d_scene_segment(scene, m).a
                                     : hr2d_scene_segment(scene, m - 1).b;
      if (plane_same(p, q)) return 1;
    }
  return 0;
}

static real shortest_piece(const hr2d_scene *scene) {
  real min = HUGE_VALL;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    min = fminl(min, length(&s));
  }
  return min;
}

/* No two patches cross by more than a rounding. */
static void check_apart(const hr2d_scene *scene, double scale) {
  const size_t n = hr2d_scene_patches(scene);
  for (size_t i = 0; n <= 2000 && i < n; i++)
    for (size_t j = i + 1; j < n; j++) {
      const hr2d_segment s = hr2d_scene_segment(scene, i), t = hr2d_scene_segment(scene, j);
      DEMAND(poke(&s, &t) <= 1.001L * ROUNDING * scale, "%s and %s cross by %Lg",
             hr2d_scene_name(scene, i), hr2d_scene_name(scene, j), poke(&s, &t) / scale);
    }
}

typedef struct outcome {
  size_t crossings; /* pairs of lines drawn */
  size_t cuts;      /* places */
  size_t pieces;
  real shortest; /* piece, where the scene's scale is 1 */
} outcome;

/* The patch drawn of which a message speaks as `patch 3 ("w1 (back)")`. */
static size_t named_in(const char *message, int second) {
  const char *name = strstr(message, "(\"w");
  if (name && second) name = strstr(name + 1, "(\"w");
  DEMAND(name != NULL, "no name in %s", message);
  return strtoul(name + 3, NULL, 10);
}

static void check_refused(hr2d_scene *scene, const drawing *d, double scale) {
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  const char *message = hr2d_scene_message(scene), *place = strstr(message, "cross at (");
  ck_assert_msg(place != NULL, "%s", message);
  hr2d_point x;
  ck_assert_int_eq(sscanf(place, "cross at (%lf, %lf)", &x.x, &x.y), 2);
  const hr2d_segment *s = &d->s[named_in(message, 0)], *t = &d->s[named_in(message, 1)];
  ck_assert_ldouble_gt(poke(s, t), 0);
  ck_assert_ldouble_le(fmaxl(fabsl(left_of(s, x)), fabsl(left_of(t, x))), 2e-8 * scale);
  ck_assert(strstr(message, "hr2d_scene_split_crossings() or --split-crossings") != NULL);
}

/* Cuts a drawing and checks all that is promised. */
static outcome check_split(const drawing *d) {
  const double scale = scene_scale(d);
  outcome o = {0};
  hr2d_scene *scene = scene_of(d, NULL);
  for (size_t i = 0; i < d->count; i++)
    for (size_t j = i + 1; j < d->count; j++)
      o.crossings += poke(&d->s[i], &d->s[j]) > 1.001L * ROUNDING * scale;
  if (o.crossings > 0) check_refused(scene, d, scale);
  ck_assert_msg(hr2d_scene_split_crossings(scene, &o.cuts) == HR2D_OK, "%s",
                hr2d_scene_message(scene));
  chain *c = calloc(d->count, sizeof *c);
  size_t next = 0;
  for (size_t k = 0; k < d->count; k++) {
    c[k] = check_chain(scene, d, k, 0, next, scale);
    next = c[k].end;
    if (d->sides[k] != HR2D_SIDES_BOTH) continue;
    const chain back = check_chain(scene, d, k, 1, next, scale);
    ck_assert_uint_eq(back.end - back.first, c[k].end - c[k].first);
    for (size_t m = 0; m < back.end - back.first; m++) {
      const hr2d_segment s = hr2d_scene_segment(scene, c[k].first + m),
                         t = hr2d_scene_segment(scene, back.end - 1 - m);
      DEMAND(plane_same(s.a, t.b) && plane_same(s.b, t.a),
             "w%zu is cut differently in front and behind", k);
    }
    next = back.end;
  }
  ck_assert_uint_eq(next, hr2d_scene_patches(scene));
  for (size_t i = 0; i < d->count; i++)
    for (size_t j = i + 1; j < d->count; j++)
      if (poke(&d->s[i], &d->s[j]) > 1.001L * ROUNDING * scale)
        DEMAND(share_a_point(scene, c[i], c[j]), "w%zu and w%zu share no point", i, j);
  free(c);
  check_apart(scene, scale);
  o.pieces = hr2d_scene_patches(scene);
  o.shortest = shortest_piece(scene) / scale;
  size_t again = 77;
  ck_assert_int_eq(hr2d_scene_split_crossings(scene, &again), HR2D_OK);
  ck_assert_uint_eq(again, 0);
  ck_assert_uint_eq(hr2d_scene_patches(scene), o.pieces);
  const hr2d_status status = o.pieces <= 300 ? hr2d_scene_commit(scene) : check(scene);
  ck_assert_msg(status == HR2D_OK, "%s", hr2d_scene_message(scene));
  hr2d_scene_destroy(scene);
  return o;
}

START_TEST(random_segments_are_cut) {
  unsigned long state = test_seed();
  size_t crossings = 0;
  real shortest = 1;
  for (size_t round = 0; round < test_rounds(300, 6); round++) {
    drawing d = {.count = 0};
    const size_t n = 2 + (size_t)(test_random(&state) * test_random(&state) * 199);
    const double reach = uniform(&state, 0.1, 1);
    for (size_t k = 0; k < n; k++) {
      const double x = uniform(&state, -1, 1), y = uniform(&state, -1, 1);
      draw(&d, x, y, x + uniform(&state, -reach, reach), y + uniform(&state, -reach, reach));
      if (test_random(&state) < .3) d.sides[k] = HR2D_SIDES_BOTH;
    }
    const outcome o = check_split(&d);
    ck_assert_uint_eq(o.cuts, o.crossings);
    crossings += o.crossings;
    shortest = fminl(shortest, o.shortest);
  }
  ck_assert_uint_gt(crossings, 1000 * (test_rounds(300, 6) > 100));
  printf("%zu crossings, shortest piece %Lg\n", crossings, shortest);
}
END_TEST

/* n level and n upright lines, and the diagonals through their crossings. */
static void lattice(drawing *d, const motion *m, int n, int diagonals) {
  for (int k = 1; k <= n; k++) {
    draw_moved(d, m, .5, k, n + .5, k);
    draw_moved(d, m, k, .5, k, n + .5);
  }
  if (diagonals)
    for (int k = 2 - n; k <= n - 2; k++) {
      const double low = fmax(1, 1 + k) - .25, high = fmin(n, n + k) + .25;
      draw_moved(d, m, low, low - k, high, high - k);
      draw_moved(d, m, low, n + 1 - low + k, high, n + 1 - high + k);
    }
}

/* Places of a lattice with diagonals of both directions: the crossings of lines, and
   the middles of squares where both diagonals through it are long enough to be drawn. */
static size_t lattice_places(int n) {
  size_t middles = 0;
  for (int x = 1; x < n; x++)
    for (int y = 1; y < n; y++) {
      const int k = x - y, other = x + y + 1 - (n + 1);
      middles += abs(k) <= n - 2 && abs(other) <= n - 2;
    }
  return (size_t)(n * n) + middles;
}

START_TEST(lattices_are_cut_where_they_cross) {
  unsigned long state = test_seed();
  for (int n = 2; n <= 30; n += n < 8 ? 1 : 11)
    for (size_t round = 0; round < test_rounds(10, 3); round++)
      for (int diagonals = 0; diagonals < 2; diagonals++) {
        const double scale = pow(10, uniform(&state, -3, 3));
        const motion still = {1, 0, 1, 0, 0}, moved = turned(uniform(&state, 0, 6.3), scale,
                                                             uniform(&state, -9, 9) * scale,
                                                             uniform(&state, -9, 9) * scale);
        drawing d = {.count = 0};
        if (diagonals && n > 20) continue;
        lattice(&d, round ? &moved : &still, n, diagonals);
        for (size_t k = 0; k < d.count; k++)
          d.sides[k] = test_random(&state) < .2 ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT;
        const outcome o = check_split(&d);
        ck_assert_uint_eq(o.cuts, diagonals ? lattice_places(n) : (size_t)(n * n));
        ck_assert_ldouble_gt(o.shortest, 1e-4);
      }
}
END_TEST

START_TEST(stars_are_cut_in_one_point) {
  unsigned long state = test_seed();
  for (size_t round = 0; round < test_rounds(200, 10); round++) {
    drawing d = {.count = 0};
    const size_t n = 2 + (size_t)(test_random(&state) * (round % 10 ? 40. : 198.));
    const double x = uniform(&state, -3, 3), y = uniform(&state, -3, 3);
    for (size_t k = 0; k < n; k++) {
      const double angle =
          3.14159265358979 * (round % 2 ? test_random(&state) : (double)k / (double)n);
      const double from = uniform(&state, .1, 2), to = uniform(&state, .1, 2);
      draw(&d, x - from * cos(angle), y - from * sin(angle), x + to * cos(angle),
           y + to * sin(angle));
    }
    const outcome o = check_split(&d);
    ck_assert_uint_eq(o.cuts, 1);
    ck_assert_uint_eq(o.pieces, 2 * n);
  }
}
END_TEST

/* Lines through pairs of points of a lattice: many cross in one place, at any angle. */
START_TEST(lines_through_lattice_points_are_cut) {
  unsigned long state = test_seed();
  for (size_t round = 0; round < test_rounds(30, 4); round++) {
    const int n = 3 + (int)(round % 2);
    const double scale = pow(10, uniform(&state, -3, 3));
    const motion m = turned(uniform(&state, 0, 6.3), scale, uniform(&state, -9, 9) * scale,
                            uniform(&state, -9, 9) * scale);
    drawing d = {.count = 0};
    for (int dx = 0; dx < n; dx++)
      for (int dy = dx ? 1 - n : 1; dy < n; dy++)
        for (int k = 0; k < n * n; k++) {
          /* Each line once: from its first point on it to its last. */
          const int x = k / n, y = k % n;
          int steps = 0, whole = 1;
          for (int f = 2; f < n; f++) whole &= dx % f != 0 || dy % f != 0;
          if (!whole || (dx == 0 && dy > 1) || (dy == 0 && dx > 1)) continue;
          if (x - dx >= 0 && y - dy >= 0 && y - dy < n) continue;
          while (x + (steps + 1) * dx < n && y + (steps + 1) * dy < n &&
                 y + (steps + 1) * dy >= 0)
            steps++;
          if (steps == 0) continue;
          const double from = uniform(&state, .05, .2), to = steps + uniform(&state, .05, .2);
          draw_moved(&d, &m, x - from * dx, y - from * dy, x + to * dx, y + to * dy);
        }
    const outcome o = check_split(&d);
    ck_assert_uint_lt(3 * o.cuts, 2 * o.crossings);
    /* Ends come close to crossings by chance, but no piece is as short as roundings. */
    ck_assert_ldouble_gt(o.shortest, 1e-11);
  }
}
END_TEST

START_TEST(scales_and_offsets_change_little) {
  unsigned long state = test_seed();
  const double scale[] = {1e-150, 1e150, 1e-300, 1e300, 1, 1},
               offset[] = {0, 0, 0, 0, 1e8, -1e12};
  for (size_t round = 0; round < test_rounds(60, 12); round++) {
    const motion m = turned(uniform(&state, 0, 6.3), scale[round % 6], offset[round % 6],
                            offset[round % 6] / 3);
    drawing d = {.count = 0};
    for (int k = 0; k < 40; k++) {
      const double x = uniform(&state, -1, 1), y = uniform(&state, -1, 1);
      draw_moved(&d, &m, x, y, x + uniform(&state, -1, 1), y + uniform(&state, -1, 1));
    }
    const outcome o = check_split(&d);
    ck_assert_uint_gt(o.cuts, 20);
    if (offset[round % 6] == 0) ck_assert_uint_eq(o.cuts, o.crossings);
    drawing grid = {.count = 0};
    lattice(&grid, &m, 5, 1);
    ck_assert_uint_eq(check_split(&grid).cuts, lattice_places(5));
  }
}
END_TEST

START_TEST(two_sided_crosses_are_cut) {
  drawing d = {.count = 0};
  draw(&d, 0, 0, 3, 1);
  draw(&d, 1, -1, 2, 2);
  d.sides[0] = d.sides[1] = HR2D_SIDES_BOTH;
  const outcome o = check_split(&d);
  ck_assert_uint_eq(o.cuts, 1);
  ck_assert_uint_eq(o.pieces, 8);
}
END_TEST

/* A point of a wall, as programs compute it. */
static hr2d_point point_on(unsigned long *state, const hr2d_segment *s) {
  const double t = test_random(state), dx = s->b.x - s->a.x, dy = s->b.y - s->a.y;
  if (test_random(state) < .5) return (hr2d_point){s->a.x + t * dx, s->a.y + t * dy};
  return (hr2d_point){(1 - t) * s->a.x + t * s->b.x, (1 - t) * s->a.y + t * s->b.y};
}

/* Walls that end on a slanted wall, before or after the scene is moved.  None is refused,
   and there is nothing to cut. */
START_TEST(rounded_junctions_are_allowed) {
  unsigned long state = test_seed();
  size_t through = 0;
  real deepest = 0;
  const size_t max = test_rounds(20000, 500);
  for (size_t round = 0; round < max; round++) {
    const double scale = pow(10, uniform(&state, -6, 6));
    const double offset = round % 3 ? 0 : scale * pow(10, uniform(&state, -1, 5));
    drawing plan = {.count = 0}, d = {.count = 0};
    draw(&plan, uniform(&state, -1, 1), uniform(&state, -1, 1), uniform(&state, -1, 1),
         uniform(&state, -1, 1));
    for (int k = 0; k < 4; k++) {
      const hr2d_point p = point_on(&state, &plan.s[0]);
      const hr2d_point q = {uniform(&state, -1, 1), uniform(&state, -1, 1)};
      draw(&plan, p.x, p.y, q.x, q.y);
      if (k % 2) plan.s[plan.count - 1] = (hr2d_segment){q, p};
    }
    const motion m = turned(uniform(&state, 0, 6.3), scale, offset, -offset);
    for (size_t k = 0; k < plan.count; k++) {
      const hr2d_segment s = plan.s[k];
      if (round % 2)
        draw_moved(&d, &m, s.a.x, s.a.y, s.b.x, s.b.y);
      else
        draw(&d, s.a.x, s.a.y, s.b.x, s.b.y);
    }
    for (size_t k = 1; k < d.count; k++) {
      const real depth = poke(&d.s[0], &d.s[k]) / scene_scale(&d);
      through += depth > 0;
      deepest = depth < 1e-9L ? fmaxl(depth, deepest) : deepest;
    }
    /* The walls that end there may cross each other. */
    for (size_t k = 1; k < d.count; k++) {
      drawing two = {.s = {d.s[0], d.s[k]}, .count = 2};
      hr2d_scene *scene = scene_of(&two, NULL);
      const hr2d_status status = check(scene);
      DEMAND(status == HR2D_OK, "%s", hr2d_scene_message(scene));
      hr2d_scene_destroy(scene);
    }
  }
  /* Negative control: without the rounding allowed for many would be refused. */
  ck_assert_uint_gt(through, max / 2);
  printf("%zu of %zu go through, by up to %.3Lg roundings\n", through, 4 * max,
         deepest / ROUNDING);
}
END_TEST

typedef struct refusal {
  double patch[2][4];
  const char *phrase; /* NULL where nothing is wrong */
} refusal;

#define ULP 0x1p-52

static const refusal refusals[] = {
    {{{0, 0, 2, 0}, {0, 0, 2, 0}},
     "patch 1 is a copy of patch 0, from (0, 0) to (2, 0), 2 long"},
    {{{1, 0, 2, 0}, {0, 0, 3, 0}},
     "patch 0 lies on patch 1 with its front on the same side, from (1, 0) to (2, 0), 1 long"},
    {{{0, 0, 3, 6}, {0, 0, 1, 2}}, "patch 1 lies on patch 0 with its front on the same side"},
    {{{0, 0, 2, 0}, {1, 0, 3, 0}},
     "patch 0 and patch 1 lie on one another with their fronts on the same side, from (1, 0) "
     "to (2, 0), 1 long"},
    /* Neighbours that overlap by less than a rounding, and by more. */
    {{{0, 0, 1 + ULP, 0}, {1, 0, 2, 0}}, NULL},
    {{{0, 0, 1 + 16 * ULP, 0}, {1, 0, 2, 0}}, "lie on one another"},
    {{{0, 0, 1, 1}, {.3, .3 + ULP / 4, 2, 2}},
     "patch 0 and patch 1 lie on one another within rounding with their fronts on the same "
     "side"},
    {{{0, 0, 1, 1}, {.3, .3 + ULP / 4, .6, .6}}, "patch 1 lies on patch 0 within rounding"},
    {{{0, 0, 1, 1}, {.3, .3 + 16 * ULP, .6, .6 + 16 * ULP}}, NULL},
    /* Back to back: exactly, with an ulp of room, and through each other. */
    {{{0, 0, 2, 0}, {3, 0, 1, 0}}, NULL},
    {{{0, 0, 2, 0}, {3, -ULP, 1, -ULP}}, NULL},
    {{{0, 0, 2, 0}, {3, ULP, 1, ULP}},
     "patch 0 and patch 1 face each other with no more than a rounding between them, from "
     "(1, "},
    {{{0, 0, 2, 0}, {3, ULP, 1, -ULP / 2}}, "\"sides\": \"both\""},
    {{{0, 0, 2, 0}, {2, ULP, 0, ULP}}, "face each other"},
    {{{0, 0, 2, 0}, {2, 16 * ULP, 0, 16 * ULP}}, NULL},
    {{{0, 0, 1, 0}, {1, 7 * ULP, 0, 7 * ULP}}, "face each other"},
    {{{0, 0, 1, 0}, {1, 8 * ULP, 0, 8 * ULP}}, NULL},
};

static hr2d_scene *scene_of_two(const refusal *r, int swapped) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (int k = 0; k < 2; k++) {
    const double *c = r->patch[swapped ? 1 - k : k];
    hr2d_patch p = HR2D_PATCH_INIT;
    p.a = (hr2d_point){c[0], c[1]};
    p.b = (hr2d_point){c[2], c[3]};
    ck_assert_int_eq(hr2d_scene_add(scene, &p, NULL), HR2D_OK);
  }
  return scene;
}

START_TEST(patches_on_one_another_are_refused) {
  for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++)
    for (int swapped = 0; swapped < 2; swapped++) {
      hr2d_scene *scene = scene_of_two(&refusals[k], swapped);
      const char *phrase = refusals[k].phrase;
      ck_assert_msg(hr2d_scene_commit(scene) == (phrase ? HR2D_ESCENE : HR2D_OK), "%zu: %s", k,
                    hr2d_scene_message(scene));
      const char *message = hr2d_scene_message(scene);
      if (phrase && !swapped)
        ck_assert_msg(strstr(message, phrase) != NULL, "\"%s\" is not in \"%s\"", phrase,
                      message);
      ck_assert(!phrase || (strstr(message, "patch 0") && strstr(message, "patch 1")));
      ck_assert(strstr(message, "cross at") == NULL);
      hr2d_scene_destroy(scene);
    }
}
END_TEST

/* Slanted walls of two features that share a part of one line.  If their ends are not the
   same doubles, one lies in front of the other, or behind it, by a rounding.  Refused scenes
   can be split at the ends; then the walls stand exactly back to back. */
START_TEST(slanted_walls_back_to_back_are_never_wrong) {
  unsigned long state = test_seed();
  size_t fine = 0, refused = 0;
  for (size_t round = 0; round < test_rounds(4000, 200); round++) {
    const hr2d_segment line = {{uniform(&state, -1, 1), uniform(&state, -1, 1)},
                               {uniform(&state, -1, 1), uniform(&state, -1, 1)}};
    const hr2d_point p = point_on(&state, &line);
    const hr2d_segment beyond = {line.a, p};
    drawing d = {.count = 0};
    draw(&d, p.x, p.y, line.b.x, line.b.y);
    const hr2d_point q = point_on(&state, &line);
    draw(&d, q.x, q.y, beyond.a.x, beyond.a.y);
    const real u = fabsl(length(&(hr2d_segment){line.a, q}) - length(&beyond));
    if (u < 1e-3L || length(&d.s[0]) < 1e-3L || length(&d.s[1]) < 1e-3L) continue;
    const int share = length(&(hr2d_segment){line.a, q}) > length(&beyond);
    const int in_front = hr2d_orientation(d.s[0].a, d.s[0].b, q) > 0 ||
                         hr2d_orientation(d.s[1].a, d.s[1].b, p) > 0;
    hr2d_scene *scene = scene_of(&d, NULL);
    const hr2d_status status = check(scene);
    ck_assert_int_eq(status, share && in_front ? HR2D_ESCENE : HR2D_OK);
    *(status ? &refused : &fine) += 1;
    if (status) ck_assert(strstr(hr2d_scene_message(scene), "face each other") != NULL);
    scene->exponent = 0;
    size_t cuts = 77;
    ck_assert_int_eq(hr2d_scene_split_crossings(scene, &cuts), HR2D_OK);
    ck_assert_uint_eq(cuts, 0);
    ck_assert_uint_eq(hr2d_scene_patches(scene), status ? 4 : 2);
    test_commit(scene);
    hr2d_scene_destroy(scene);
  }
  ck_assert_uint_gt(fine, 10);
  ck_assert_uint_gt(refused, 10);
}
END_TEST

/* Two features that share a part of a line exactly, crossed there and elsewhere. */
START_TEST(shared_stretches_are_cut_alike) {
  for (int k = 1; k < 30; k++) {
    drawing d = {.count = 0};
    draw(&d, 0, 0, 20, 10);
    draw(&d, 30, 15, 10, 5);
    draw(&d, k + .3, -20, k - .05, 20);
    const outcome o = check_split(&d);
    ck_assert_uint_eq(o.cuts, 1);
    ck_assert_uint_eq(o.pieces, k < 10 || k >= 20 ? 7 : 8);
  }
}
END_TEST

/* Rounding turns the centre of a star into many crossings close together.  After the split
   nothing may be refused. */
START_TEST(blurred_stars_are_cut) {
  unsigned long state = test_seed();
  size_t left_out = 0;
  real max = 0;
  for (size_t round = 0; round < test_rounds(600, 40); round++) {
    drawing d = {.count = 0};
    const double blur = ULP * pow(10, uniform(&state, 0, 4));
    const int arms = 3 + (int)uniform(&state, 0, 30);
    for (int k = 0; k < arms; k++) {
      const double angle = uniform(&state, 0, 6.3), from = -uniform(&state, .1, 1),
                   to = uniform(&state, .1, 1);
      draw(&d, .4 + from * cos(angle) + uniform(&state, -blur, blur),
           -.3 + from * sin(angle) + uniform(&state, -blur, blur),
           .4 + to * cos(angle) + uniform(&state, -blur, blur),
           -.3 + to * sin(angle) + uniform(&state, -blur, blur));
    }
    hr2d_scene *scene = scene_of(&d, NULL);
    real before = 0, after = 0;
    for (size_t k = 0; k < d.count; k++) before += length(&d.s[k]);
    size_t cuts;
    ck_assert_msg(hr2d_scene_split_crossings(scene, &cuts) == HR2D_OK, "%s",
                  hr2d_scene_message(scene));
    for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
      const hr2d_segment s = hr2d_scene_segment(scene, k);
      after += length(&s);
    }
    ck_assert_ldouble_le(fabsl(after - before), 0x1p-30L);
    left_out += fabsl(after - before) > 64 * ULP;
    max = fmaxl(max, fabsl(after - before));
    check_apart(scene, scene_scale(&d));
    ck_assert_msg(check(scene) == HR2D_OK, "%s", hr2d_scene_message(scene));
    hr2d_scene_destroy(scene);
  }
  printf("pieces left out in %zu scenes, %Lg of length\n", left_out, max);
}
END_TEST

/* Through by an ulp: for a length that matters, and for less. */
START_TEST(flat_crossings_are_refused) {
  const double down[] = {1e-6, 40 * ULP};
  for (int k = 0; k < 2; k++) {
    drawing d = {.count = 0};
    draw(&d, 0, 0, 1, 0);
    draw(&d, 0, ULP, 1.5, -down[k]);
    hr2d_scene *scene = scene_of(&d, NULL);
    ck_assert_int_eq(hr2d_scene_commit(scene), k ? HR2D_ESCENE : HR2D_OK);
    ck_assert(k == 0 || strstr(hr2d_scene_message(scene), " cross at (0.03658") != NULL);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

/* Far from the origin a rounding is much of a patch, and no reason to leave it out. */
START_TEST(copies_far_off_are_refused) {
  const double x = 0x1p+30, y = 0x1p+29, ulp = 0x1p-23;
  drawing d = {.count = 0};
  draw(&d, x, y, x + 1, y);
  draw(&d, x + .5, y + ulp, x + 1.5, y + ulp);
  hr2d_scene *scene = scene_of(&d, NULL);
  ck_assert_int_eq(hr2d_scene_split_crossings(scene, NULL), HR2D_OK);
  double length = 0;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) length += hr2d_scene_length(scene, k);
  ck_assert_double_eq_tol(length, 2, 1e-9);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_ESCENE);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(scene), "is a copy of patch"));
  hr2d_scene_destroy(scene);
}
END_TEST

/* Triangles as thin as 1e-14, and patches far shorter than others. */
/* A fan of needles between points of a lattice of a few roundings, and a patch 2^461 times as
   long: cuts bend pieces to and fro between the same points.  Pieces doubled every other round,
   to 2^30 of them, when a patch could go along a wall more than once. */
START_TEST(needles_do_not_multiply) {
#define U(k) (0x1.c6bf52634p-461 + (k)*0x1p-513)
  static const double at[][4] = {
      {U(-8), U(-8), U(8), U(-8)},
      {U(8), U(-8), U(8), U(4)},
      {U(8), U(4), U(8), U(-8)},
      {U(8), U(4), U(-8), U(-8)},
      {U(8), U(-8), U(8), 0x3p-1062},
      {U(8), 0x3p-1062, U(8), U(-8)},
      {U(8), 0x3p-1062, U(-8), U(0)},
      {U(-8), U(0), U(2), 0},
      {U(2), 0, U(-8), U(0)},
      {U(2), 0, U(-7), U(-7)},
      {U(-7), U(-7), U(2), 0},
      {U(-7), U(-7), -0x1.7ffffffffffffp+0, U(-8)},
      {-0x1.7ffffffffffffp+0, U(-8), U(-8), 0x1p-1050},
      {U(-8), 0x1p-1050, U(-8), U(-8)},
  };
#undef U
  enum { COUNT = sizeof at / sizeof *at };
  drawing d = {.count = 0};
  for (int k = 0; k < COUNT; k++) draw(&d, at[k][0], at[k][1], at[k][2], at[k][3]);
  hr2d_scene *scene = scene_of(&d, NULL);
  const hr2d_status status = hr2d_scene_split_crossings(scene, NULL);
  ck_assert(status == HR2D_OK || status == HR2D_ESCENE);
  ck_assert_uint_le(hr2d_scene_patches(scene), COUNT * COUNT);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(slivers_are_legal) {
  unsigned long state = test_seed();
  for (size_t round = 0; round < test_rounds(2000, 100); round++) {
    const double thin = pow(10, uniform(&state, -14, -1)),
                 small = pow(10, uniform(&state, -9, 0)), t = uniform(&state, .01, .99);
    drawing d = {.count = 0};
    const motion m = turned(uniform(&state, 0, 6.3), 1, .5, -.5);
    draw_moved(&d, &m, 0, 0, 1, 0);
    draw_moved(&d, &m, 1, 0, t, thin);
    draw_moved(&d, &m, t, thin, 0, 0);
    d.s[1].a = d.s[0].b;
    d.s[2].b = d.s[0].a;
    draw_moved(&d, &m, t, -1e-6, t + small, -1e-6);
    draw_moved(&d, &m, t, -1e-6, t, -1e-6 - small);
    hr2d_scene *scene = scene_of(&d, NULL);
    ck_assert_msg(hr2d_scene_commit(scene) == HR2D_OK, "%g, %g: %s", thin, small,
                  hr2d_scene_message(scene));
    hr2d_scene_destroy(scene);
  }
}
END_TEST

START_TEST(scenes_without_crossings_stay_as_they_are) {
  hr2d_scene *scene = test_new_scene(NULL);
  size_t cuts = 77;
  ck_assert_int_eq(hr2d_scene_split_crossings(scene, &cuts), HR2D_OK);
  ck_assert_uint_eq(cuts, 0);
  hr2d_scene_destroy(scene);
  drawing d = {.count = 0};
  draw(&d, 0, 0, 4, 0);
  draw(&d, 1, 0, 2, 3);
  draw(&d, 4, 0, 4, 1);
  scene = scene_of(&d, NULL);
  ck_assert_int_eq(hr2d_scene_split_crossings(scene, NULL), HR2D_OK);
  for (size_t k = 0; k < 3; k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    ck_assert(plane_same(s.a, d.s[k].a) && plane_same(s.b, d.s[k].b));
  }
  ck_assert_str_eq(hr2d_scene_name(scene, 1), "w1");
  ck_assert_double_eq(hr2d_scene_unit(scene), 1);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_split_crossings(scene, &cuts), HR2D_ESTATE);
  ck_assert_uint_eq(cuts, 0);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(failed_allocations_change_nothing) {
  drawing d = {.count = 0};
  const motion m = turned(1, 1, .1, .2);
  lattice(&d, &m, 4, 1);
  d.sides[0] = d.sides[3] = HR2D_SIDES_BOTH;
  draw(&d, 9, 9, 10, 10); /* is not cut */
  test_memory fault = {.until_failure = -1, .for_good = 1};
  const hr2d_allocator hooks = test_hooks(&fault);
  hr2d_scene *scene = scene_of(&d, &hooks);
  const size_t n = hr2d_scene_patches(scene);
  const long live = fault.live;
  hr2d_status status = HR2D_ENOMEM;
  long k = 0;
  for (; status == HR2D_ENOMEM; k++) {
    size_t cuts = 77;
    fault.until_failure = k;
    status = hr2d_scene_split_crossings(scene, &cuts);
    fault.until_failure = -1;
    if (status == HR2D_OK) break;
    ck_assert_int_eq(status, HR2D_ENOMEM);
    ck_assert_uint_eq(cuts, 77);
    ck_assert_int_eq(fault.live, live);
    ck_assert_uint_eq(hr2d_scene_patches(scene), n);
    ck_assert_double_eq(hr2d_scene_unit(scene), 1);
    for (size_t p = 0, w = 0; p < n; p++, w++) {
      char name[32];
      const hr2d_patch whole = patch_of(&d, w, name);
      const hr2d_segment s = hr2d_scene_segment(scene, p);
      ck_assert(plane_same(s.a, whole.a) && plane_same(s.b, whole.b));
      ck_assert_str_eq(hr2d_scene_name(scene, p), name);
      p += whole.sides == HR2D_SIDES_BOTH;
    }
  }
  ck_assert_int_eq(status, HR2D_OK);
  ck_assert_int_gt(k, 100);
  printf("%ld allocations failed\n", k);
  test_commit(scene);
  hr2d_scene_destroy(scene);
  ck_assert_int_eq(fault.live, 0);
}
END_TEST

TEST_SUITE("crossings") {
  ADD_TESTS("refused", rounded_junctions_are_allowed, patches_on_one_another_are_refused,
            slanted_walls_back_to_back_are_never_wrong, flat_crossings_are_refused,
            copies_far_off_are_refused, slivers_are_legal, needles_do_not_multiply);
  ADD_TESTS("cuts", random_segments_are_cut, lattices_are_cut_where_they_cross,
            lines_through_lattice_points_are_cut, stars_are_cut_in_one_point,
            blurred_stars_are_cut, scales_and_offsets_change_little, two_sided_crosses_are_cut,
            shared_stretches_are_cut_alike, scenes_without_crossings_stay_as_they_are,
            failed_allocations_change_nothing);
}
