/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view of a point, against rays between all directions of vertices, against MPFR, closed
   forms, and integrals over whole patches.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <mpfr.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "independent/mpfr-exchange.h"
#include "scene/scene-impl.h"
#include "support/order.h"
#include "support/room-plans.h"
#include "support/support.h"
#include "visibility/point-view.h"

#define PI 3.14159265358979323846

typedef long double real;

static hr2di_point_viewer *viewer_of(const hr2d_scene *scene) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_point_viewer *viewer = NULL;
  ck_assert_int_eq(hr2di_point_viewer_create(scene, &alloc, NULL, &viewer), HR2D_OK);
  return viewer;
}

/* Computes a view and checks the invariants of every view. */
static hr2di_view_from look(hr2di_point_viewer *viewer, size_t patch, double t) {
  hr2di_view_from seen;
  double front = 0;
  ck_assert_int_eq(hr2di_view_at(viewer, patch, t, &seen), HR2D_OK);
  for (size_t k = 0; k < seen.count; k++) {
    const hr2di_visible_interval *g = &seen.interval[k];
    ck_assert(g->patch != patch);
    ck_assert(0 <= g->from && g->from < g->to && g->to <= 1);
    ck_assert(0 < g->sine && g->sine <= 1);
    if (k > 0) {
      ck_assert_uint_le(g[-1].patch, g->patch);
      ck_assert(g[-1].patch < g->patch || g[-1].to <= g->from + 2 * DBL_EPSILON);
    }
    front += g->sine;
  }
  ck_assert(fabs(front - seen.front) <= 1e-14);
  ck_assert(0 <= seen.front && seen.front <= 1);
  ck_assert(0 <= seen.back && seen.back <= 1);
  ck_assert(0 <= seen.sky && seen.sky <= 1);
  ck_assert(fabs(seen.front + seen.back + seen.sky - 1) <= 1e-14);
  return seen;
}

/* A vertex in the frame of the point: along the patch, and above it. */
typedef struct place {
  real s, h;
} place;

typedef struct brute {
  size_t patches, directions;
  size_t patch;
  place (*end)[2];
  real *direction; /* angles to the normal, sorted */
  real *sine;      /* of each patch's front */
  real back, sky;
} brute;

/* Heights have the sign of exact ones. */
static place place_of(hr2d_segment own, real t, hr2d_point v) {
  const real x = (real)own.b.x - own.a.x, y = (real)own.b.y - own.a.y, length = hypotl(x, y);
  mpfr_t det;
  mpfr_init2(det, MPFR_PREC_MIN);
  mpfr_orient(det, own.a, own.b, v);
  const real area = mpfr_get_ld(det, MPFR_RNDN);
  mpfr_clear(det);
  return (place){(x * ((real)v.x - own.a.x) + y * ((real)v.y - own.a.y)) / length - t * length,
                 area / length};
}

static real crossed(place p, place q) {
  return p.s * q.h - p.h * q.s;
}

/* The patch that a ray meets first, or none; *front: whether it meets the front.  Of several
   patches in the same place it is one that shows its front. */
static size_t first_hit(const brute *b, real angle, int *front) {
  const place ray = {sinl(angle), cosl(angle)};
  size_t first = SIZE_MAX;
  real nearest = INFINITY;
  for (size_t k = 0; k < b->patches; k++) {
    const place p = b->end[k][0], q = b->end[k][1];
    if (k == b->patch || (p.h <= 0 && q.h <= 0)) continue;
    const real at_p = crossed(ray, p), at_q = crossed(ray, q);
    if ((at_p > 0) == (at_q > 0)) continue;
    const real distance = crossed(p, q) / (at_q - at_p);
    const int shows = at_q > at_p;
    if (!(distance > 0)) continue;
    const real tie = 1e-14L * distance;
    if (distance > nearest + (shows ? tie : -tie)) continue;
    nearest = distance;
    first = k;
    *front = shows;
  }
  return first;
}

/* Angles grow towards b.  Patch `without`, if there is one, is left out. */
static brute brute_look(const hr2d_scene *scene, size_t patch, double t, size_t without) {
  brute b = {.patches = hr2d_scene_patches(scene), .patch = patch};
  const hr2d_segment own = hr2d_scene_segment(scene, patch);
  b.end = malloc(b.patches * sizeof *b.end);
  b.direction = malloc((2 * b.patches + 2) * sizeof *b.direction);
  b.sine = calloc(b.patches, sizeof *b.sine);
  b.direction[b.directions++] = -acosl(-1) / 2;
  b.direction[b.directions++] = acosl(-1) / 2;
  for (size_t k = 0; k < b.patches; k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k);
    b.end[k][0] = place_of(own, t, s.a);
    b.end[k][1] = place_of(own, t, s.b);
    if (k == without) b.end[k][0].h = b.end[k][1].h = -1;
    for (int e = 0; e < 2; e++)
      if (b.end[k][e].h > 0) b.direction[b.directions++] = atan2l(b.end[k][e].s, b.end[k][e].h);
  }
  qsort(b.direction, b.directions, sizeof *b.direction, order_long_doubles);
  for (size_t k = 1; k < b.directions; k++) {
    const real middle = (b.direction[k - 1] + b.direction[k]) / 2;
    const real sine = cosl(middle) * sinl((b.direction[k] - b.direction[k - 1]) / 2);
    int front = 0;
    if (!(sine > 1e-18L)) continue;
    const size_t hit = first_hit(&b, middle, &front);
    if (hit == SIZE_MAX)
      b.sky += sine;
    else if (front)
      b.sine[hit] += sine;
    else
      b.back += sine;
  }
  return b;
}

static void brute_free(brute *b) {
  free(b->end);
  free(b->direction);
  free(b->sine);
}

/* Whether a patch begins or ends so near to the point that a long double does not tell where
   to 1e-14; the ends of its own patch are known better. */
static int touched(const brute *b) {
  const place *own = b->end[b->patch];
  const real length = own[1].s - own[0].s;
  for (size_t k = 0; k < 2 * b->patches; k++) {
    const place v = b->end[k / 2][k % 2];
    const int is_own = v.h == 0 && (v.s == own[0].s || v.s == own[1].s);
    if (!is_own && hypotl(v.s, v.h) < 1e-4L * length) return 1;
  }
  return 0;
}

static place point_on(const brute *b, size_t patch, real f) {
  const place p = b->end[patch][0], q = b->end[patch][1];
  return (place){p.s + f * (q.s - p.s), p.h + f * (q.h - p.h)};
}

static real sine_between(const brute *b, size_t patch, real from, real to) {
  const place p = point_on(b, patch, from), q = point_on(b, patch, to);
  return (p.s / hypotl(p.s, p.h) - q.s / hypotl(q.s, q.h)) / 2;
}

/* The part is as wide as its sine, up to rounding of the fractions, and a ray sees its
   inside.  The ray does not go to the middle, where another patch may end on it. */
static void check_part(const brute *b, const hr2di_visible_interval *g) {
  const real slack = 4 * DBL_EPSILON, from = g->from, to = g->to;
  int front = 0;
  const real more = sine_between(b, g->patch, fmaxl(from - slack, 0), fminl(to + slack, 1));
  const real less = sine_between(b, g->patch, from + slack, to - slack);
  ck_assert_msg(g->sine <= more + 1e-14L && g->sine >= less - 1e-14L,
                "patch %zu sees %g to %g of %u: %g, not %Lg to %Lg", b->patch, g->from, g->to,
                g->patch, g->sine, less, more);
  if (g->sine < 1e-12) return;
  const place inside = point_on(b, g->patch, from + .4142L * (to - from));
  const size_t hit = first_hit(b, atan2l(inside.s, inside.h), &front);
  ck_assert_msg(hit == g->patch && front, "patch %zu sees %zu, not %u", b->patch, hit,
                g->patch);
}

/* The largest difference of form factors. */
static double compare(const brute *b, const hr2di_view_from *seen) {
  real worst = fmaxl(fabsl(b->back - seen->back), fabsl(b->sky - seen->sky));
  real *sine = calloc(b->patches, sizeof *sine);
  for (size_t k = 0; k < seen->count; k++)
    sine[seen->interval[k].patch] += seen->interval[k].sine;
  for (size_t k = 0; k < b->patches; k++) worst = fmaxl(worst, fabsl(sine[k] - b->sine[k]));
  free(sine);
  return (double)worst;
}

static double draw_fraction(randoms *r) {
  switch (random_below(r, 5)) {
  case 0:
    return (1 + random_below(r, 15)) / 16.0;
  case 1:
    return random_power(r, -6, -1);
  case 2:
    return 1 - random_power(r, -6, -1);
  default:
    return random_between(r, .001, .999);
  }
}

/* Walls taken away, turned around and made one-sided: holes, backs, and sky. */
static void ruin(randoms *r, plan *p, int kind) {
  size_t kept = 0;
  for (size_t k = 0; k < p->walls; k++) {
    if (kind > 0 && random_below(r, 4) == 0) continue;
    p->wall[kept] = p->wall[k];
    p->sides[kept] = p->sides[k];
    if (kind > 1 && random_below(r, 2)) p->sides[kept] = HR2D_SIDES_FRONT;
    if (kind > 1 && random_below(r, 4) == 0)
      p->wall[kept] = (hr2d_segment){p->wall[k].b, p->wall[k].a};
    kept++;
  }
  if (kept > 0) p->walls = kept;
}

typedef struct rooms {
  randoms r;
  plan plan;
} rooms;

/* As given, or turned, so that no coordinate is a round number. */
static hr2d_scene *draw_scene(rooms *s, const plan_class *class, int max, int kind, int turned,
                              unsigned forced) {
  const double angle = random_between(&s->r, 0, 6.3);
  s->plan = (plan){.walls = 0};
  class->draw(&s->r, (int)random_power(&s->r, 0, log10(max)), &s->plan);
  ruin(&s->r, &s->plan, kind);
  if (turned) plan_transform(&s->plan, (similarity){.u = cos(angle), .v = sin(angle)});
  return test_painted_scene(&s->plan, &(test_paint){.emission = 1, .forced = forced});
}

START_TEST(rays_see_the_same) {
  const plan_class *class = &plan_classes[_i];
  rooms s = {.r = randoms_stream(test_seed(), 600 + _i)};
  double worst = 0;
  for (int k = 0; k < test_count(24); k++) {
    hr2d_scene *scene = draw_scene(&s, class, 40, k % 3, k % 2, 0);
    hr2di_point_viewer *viewer = viewer_of(scene);
    for (int m = 0; m < 40; m++) {
      const size_t patch = (size_t)(random_bits(&s.r) % hr2d_scene_patches(scene));
      const double t = draw_fraction(&s.r);
      const hr2di_view_from seen = look(viewer, patch, t);
      brute b = brute_look(scene, patch, t, SIZE_MAX);
      for (size_t g = 0; g < seen.count && !touched(&b); g++) check_part(&b, &seen.interval[g]);
      if (!touched(&b)) worst = fmax(worst, compare(&b, &seen));
      ck_assert_msg(worst < 1e-13, "%s, scene %d: patch %zu at %a is off by %g", class->name, k,
                    patch, t, worst);
      brute_free(&b);
    }
    hr2di_point_viewer_destroy(viewer);
    hr2d_scene_destroy(scene);
    plan_free(&s.plan);
  }
  printf("%-16s to rays %.2e\n", class->name, worst);
}
END_TEST

START_TEST(a_missing_patch_is_noticed) {
  rooms s = {.r = randoms_stream(test_seed(), 700 + _i)};
  hr2d_scene *scene = draw_scene(&s, &plan_classes[_i], 20, 0, 1, 0);
  hr2di_point_viewer *viewer = viewer_of(scene);
  const hr2di_view_from seen = look(viewer, 0, .37);
  for (size_t k = 0; k < seen.count; k++) {
    const hr2di_visible_interval *g = &seen.interval[k];
    brute b = brute_look(scene, 0, .37, g->patch);
    ck_assert_double_ge(compare(&b, &seen), g->sine * (1 - 1e-6));
    brute_free(&b);
  }
  ck_assert_uint_ge(seen.count, 2);
  hr2di_point_viewer_destroy(viewer);
  hr2d_scene_destroy(scene);
  plan_free(&s.plan);
}
END_TEST

/* The area that walls with one side go round: a star of three corners may be inside out. */
static double area_of(const plan *p) {
  double area = 0;
  for (size_t k = 0; k < p->walls; k++) {
    const hr2d_segment w = p->wall[k];
    if (p->sides[k] == HR2D_SIDES_FRONT) area += (w.a.x * w.b.y - w.a.y * w.b.x) / 2;
  }
  return area;
}

/* The rooms' walls share their vertices bit for bit, however these are rounded. */
START_TEST(rooms_are_closed) {
  static const double fraction[] = {0, 0x1p-1074, 1e-300, 1e-20, .25, .5, 1 - 0x1p-53, 1};
  const plan_class *class = &plan_classes[_i];
  rooms s = {.r = randoms_stream(test_seed(), 800 + _i)};
  double worst = 0;
  for (int k = 0; k < test_count(30); k++) {
    hr2d_scene *scene = draw_scene(&s, class, 60, 0, k % 2, 0);
    hr2di_point_viewer *viewer = viewer_of(scene);
    for (size_t patch = 0; patch < hr2d_scene_patches(scene) && area_of(&s.plan) > 0; patch++)
      for (size_t m = 0; m < 8; m++) {
        const hr2di_view_from seen = look(viewer, patch, fraction[m]);
        worst = fmax(worst, 1 - seen.front);
      }
    hr2di_point_viewer_destroy(viewer);
    hr2d_scene_destroy(scene);
    plan_free(&s.plan);
  }
  printf("%-16s row sums %.2e\n", class->name, worst);
  ck_assert_double_lt(worst, 1e-14);
}
END_TEST

/* Σ w_j ½|sinθ| over the patches that a point of a patch sees. */
typedef struct integrand {
  hr2di_point_viewer *viewer;
  size_t patch;
  const double *weight;
} integrand;

static double weighed(double t, void *params) {
  const integrand *f = params;
  hr2di_view_from seen;
  double sum = 0;
  ck_assert_int_eq(hr2di_view_at(f->viewer, f->patch, t, &seen), HR2D_OK);
  for (size_t k = 0; k < seen.count; k++)
    sum += f->weight[seen.interval[k].patch] * seen.interval[k].sine;
  return sum;
}

/* Where lines through two vertices meet a patch, sorted, with its ends. */
static double *find_events(const hr2d_scene *scene, size_t patch, size_t *count) {
  const size_t n = hr2d_scene_patches(scene);
  place *end = malloc(2 * n * sizeof *end);
  double *event = malloc((2 * n * (2 * n - 1) / 2 + 2) * sizeof *event);
  const hr2d_segment own = hr2d_scene_segment(scene, patch);
  for (size_t k = 0; k < 2 * n; k++) {
    const hr2d_segment s = hr2d_scene_segment(scene, k / 2);
    end[k] = place_of(own, 0, k % 2 ? s.b : s.a);
  }
  *count = 0;
  event[(*count)++] = 0;
  event[(*count)++] = 1;
  const real length = hypotl((real)own.b.x - own.a.x, (real)own.b.y - own.a.y);
  for (size_t k = 0; k < 2 * n; k++)
    for (size_t m = 0; m < k; m++) {
      const place p = end[k], q = end[m];
      const real t = (p.s - p.h * (q.s - p.s) / (q.h - p.h)) / length;
      if (t > 0 && t < 1) event[(*count)++] = (double)t;
    }
  qsort(event, *count, sizeof *event, order_doubles);
  free(end);
  return event;
}

static double integrate(integrand *f, const double *event, size_t count) {
  gsl_function function = {weighed, f};
  gsl_integration_workspace *space = gsl_integration_workspace_alloc(100);
  double sum = 0;
  for (size_t k = 1; k < count; k++) {
    double value = 0, error;
    if (event[k] - event[k - 1] < 1e-14) continue;
    gsl_integration_qag(&function, event[k - 1], event[k], 1e-14, 1e-11, 100, GSL_INTEG_GAUSS21,
                        space, &value, &error);
    sum += value;
  }
  gsl_integration_workspace_free(space);
  return sum;
}

/* All entries of a row at once, each with a weight of its own. */
START_TEST(views_integrate_to_exchange_areas) {
  const plan_class *class = &plan_classes[_i];
  rooms s = {.r = randoms_stream(test_seed(), 900 + _i)};
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  double worst = 0;
  for (int k = 0; k < test_count(3); k++) {
    hr2d_scene *scene = draw_scene(&s, class, 8, k % 3, 1, 0);
    const size_t n = hr2d_scene_patches(scene), patch = (size_t)(random_bits(&s.r) % n);
    double *area = malloc(n * n * sizeof *area), *weight = malloc(n * sizeof *weight);
    ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
    real expected = 0;
    for (size_t j = 0; j < n; j++) {
      weight[j] = random_unit(&s.r);
      expected += weight[j] * area[patch * n + j] / hr2d_scene_length(scene, patch);
    }
    integrand f = {viewer_of(scene), patch, weight};
    size_t events;
    double *event = find_events(scene, patch, &events);
    worst = fmax(worst, (double)fabsl(integrate(&f, event, events) - expected));
    hr2di_point_viewer_destroy(f.viewer);
    free(event);
    free(weight);
    free(area);
    hr2d_scene_destroy(scene);
    plan_free(&s.plan);
  }
  gsl_set_error_handler(handler);
  printf("%-16s to exchange areas %.2e\n", class->name, worst);
  ck_assert_double_lt(worst, 1e-11);
}
END_TEST

START_TEST(forced_occlusion_changes_no_bit) {
  for (int k = 0; k < test_count(20); k++) {
    rooms plain = {.r = randoms_stream(test_seed(), 1000 + k)}, forced = plain;
    hr2d_scene *one = draw_scene(&plain, &plan_classes[0], 10, k % 2, 1, 0);
    hr2d_scene *other =
        draw_scene(&forced, &plan_classes[0], 10, k % 2, 1, 1u << HR2D_EFFECT_OCCLUSION);
    ck_assert(!hr2d_scene_effect(one, HR2D_EFFECT_OCCLUSION, NULL));
    ck_assert(hr2d_scene_effect(other, HR2D_EFFECT_OCCLUSION, NULL));
    hr2di_point_viewer *first = viewer_of(one), *second = viewer_of(other);
    for (size_t patch = 0; patch < hr2d_scene_patches(one); patch++)
      for (int m = 0; m < 20; m++) {
        const double t = m < 2 ? m : draw_fraction(&plain.r);
        const hr2di_view_from p = look(first, patch, t), q = look(second, patch, t);
        ck_assert_uint_eq(p.count, q.count);
        for (size_t g = 0; g < p.count; g++) {
          ck_assert_uint_eq(p.interval[g].patch, q.interval[g].patch);
          ck_assert(p.interval[g].from == q.interval[g].from);
          ck_assert(p.interval[g].to == q.interval[g].to);
          ck_assert(p.interval[g].sine == q.interval[g].sine);
        }
        ck_assert(p.front == q.front && p.back == q.back && p.sky == q.sky);
      }
    hr2di_point_viewer_destroy(first);
    hr2di_point_viewer_destroy(second);
    hr2d_scene_destroy(one);
    hr2d_scene_destroy(other);
    plan_free(&plain.plan);
    plan_free(&forced.plan);
  }
}
END_TEST

/* More than any coordinates' exponents differ by, twice, and t's. */
enum { DIGITS = 8000 };

/* A vector in the frame of the point, times its patch's length; 0 if it is none. */
static int exact_place(mpfr_t s, mpfr_t h, hr2d_segment own, double t, hr2d_point v) {
  mpfr_t x, y, vx, vy, p;
  mpfr_inits2(DIGITS, x, y, vx, vy, p, (mpfr_ptr)0);
  mpfr_set_d(x, own.b.x, MPFR_RNDN);
  mpfr_sub_d(x, x, own.a.x, MPFR_RNDN);
  mpfr_set_d(y, own.b.y, MPFR_RNDN);
  mpfr_sub_d(y, y, own.a.y, MPFR_RNDN);
  mpfr_mul_d(p, x, t, MPFR_RNDN);
  mpfr_set_d(vx, v.x, MPFR_RNDN);
  mpfr_sub_d(vx, vx, own.a.x, MPFR_RNDN);
  mpfr_sub(vx, vx, p, MPFR_RNDN);
  mpfr_mul_d(p, y, t, MPFR_RNDN);
  mpfr_set_d(vy, v.y, MPFR_RNDN);
  mpfr_sub_d(vy, vy, own.a.y, MPFR_RNDN);
  mpfr_sub(vy, vy, p, MPFR_RNDN);
  mpfr_fmma(s, x, vx, y, vy, MPFR_RNDN);
  mpfr_fmms(h, x, vy, y, vx, MPFR_RNDN);
  mpfr_clears(x, y, vx, vy, p, (mpfr_ptr)0);
  return !mpfr_zero_p(s) || !mpfr_zero_p(h);
}

/* The sine of a direction, or that of the horizon for one behind. */
static void exact_sine(mpfr_t sine, const mpfr_t s, const mpfr_t h, int horizon) {
  if (mpfr_sgn(h) <= 0) {
    mpfr_set_si(sine, horizon, MPFR_RNDN);
    return;
  }
  mpfr_hypot(sine, s, h, MPFR_RNDN);
  mpfr_div(sine, s, sine, MPFR_RNDN);
}

/* The view of a point of i in a scene with j alone; 0 if there is no such scene. */
static int exact_view(mpfr_t sine, hr2d_segment i, double t, hr2d_segment j) {
  mpfr_t s, h, u, v, turn;
  mpfr_inits2(DIGITS, s, h, u, v, turn, (mpfr_ptr)0);
  mpfr_set_prec(sine, DIGITS);
  mpfr_set_zero(sine, 1);
  const int apart = exact_place(s, h, i, t, j.a) && exact_place(u, v, i, t, j.b);
  mpfr_fmms(turn, s, v, h, u, MPFR_RNDN);
  if (apart && mpfr_sgn(turn) > 0 && (mpfr_sgn(h) > 0 || mpfr_sgn(v) > 0)) {
    exact_sine(sine, s, h, 1);
    exact_sine(turn, u, v, -1);
    mpfr_sub(sine, sine, turn, MPFR_RNDN);
    mpfr_div_2ui(sine, sine, 1, MPFR_RNDN);
  }
  mpfr_clears(s, h, u, v, turn, (mpfr_ptr)0);
  return apart;
}

static hr2d_scene *scene_of_pair(pair p) {
  hr2d_scene *scene = NULL;
  const hr2d_patch i = {.a = p.i.a, .b = p.i.b}, j = {.a = p.j.a, .b = p.j.b};
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  if (!hr2d_scene_add(scene, &i, NULL) && !hr2d_scene_add(scene, &j, NULL) &&
      !hr2d_scene_commit(scene))
    return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

START_TEST(sines_keep_their_digits) {
  const pair_class *class = &pair_classes[_i];
  randoms r = randoms_stream(test_seed(), 1100 + _i);
  mpfr_t sine;
  mpfr_init2(sine, DIGITS);
  double worst = 0;
  int compared = 0;
  for (int k = 0; k < test_count(500); k++) {
    const pair p = draw_pair(class, &r);
    hr2d_scene *scene = scene_of_pair(p);
    if (!scene) continue;
    hr2di_point_viewer *viewer = viewer_of(scene);
    for (int m = 0; m < 4; m++) {
      const double t = m % 2 ? draw_fraction(&r)
                       : m   ? random_power(&r, -30, 0)
                             : random_unit(&r);
      const hr2di_view_from seen = look(viewer, 0, t);
      if (!exact_view(sine, p.i, t, p.j)) continue;
      /* Too narrow to be seen at all. */
      if (seen.count == 0 && mpfr_cmp_d(sine, 0x1p-100) < 0) continue;
      if (mpfr_sgn(sine) > 0 && mpfr_cmp_d(sine, 0x1p-1000) < 0) continue;
      if (mpfr_sgn(sine) == 0) {
        ck_assert_double_eq(seen.front, 0);
        continue;
      }
      /* For a patch that is nearly edge-on an absolute error of 2^-104 is allowed. */
      const double rounding = 0x1p-104 / mpfr_get_d(sine, MPFR_RNDN);
      worst = fmax(worst, mpfr_relative_error(seen.front, sine) - rounding);
      compared++;
    }
    hr2di_point_viewer_destroy(viewer);
    hr2d_scene_destroy(scene);
  }
  mpfr_clear(sine);
  printf("%-20s %5d sines, relative error %.2e\n", class->name, compared, worst);
  ck_assert_double_lt(worst, 1e-14);
}
END_TEST

static hr2d_scene *scene_of(const hr2d_patch *patch, size_t count) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < count; k++)
    ck_assert_int_eq(hr2d_scene_add(scene, &patch[k], NULL), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* What patch 0 sees at t: of each patch as expected, of backs, and of the sky. */
static void expect(const hr2d_patch *patch, size_t count, double t, const double *sine,
                   double back, double sky) {
  hr2d_scene *scene = scene_of(patch, count);
  hr2di_point_viewer *viewer = viewer_of(scene);
  const hr2di_view_from seen = look(viewer, 0, t);
  const size_t n = hr2d_scene_patches(scene);
  double *sum = calloc(n, sizeof *sum);
  for (size_t k = 0; k < seen.count; k++) sum[seen.interval[k].patch] += seen.interval[k].sine;
  for (size_t k = 0; k < n; k++) ck_assert_double_eq_tol(sum[k], sine[k], 1e-15);
  ck_assert_double_eq_tol(seen.back, back, 1e-15);
  ck_assert_double_eq_tol(seen.sky, sky, 1e-15);
  free(sum);
  hr2di_point_viewer_destroy(viewer);
  hr2d_scene_destroy(scene);
}

START_TEST(corners) {
  const hr2d_patch square[] = {{.a = {0, 0}, .b = {1, 0}},
                               {.a = {1, 0}, .b = {1, 1}},
                               {.a = {1, 1}, .b = {0, 1}},
                               {.a = {0, 1}, .b = {0, 0}}};
  static const double fraction[] = {0, 0x1p-1074, 1e-300, 1e-20, .25, .5, .9, 1 - 0x1p-53, 1};
  for (size_t k = 0; k < sizeof fraction / sizeof *fraction; k++) {
    const double t = fraction[k], rest = 1 - t;
    const double left = (1 - t / hypot(t, 1)) / 2, right = (1 - rest / hypot(rest, 1)) / 2;
    expect(square, 4, t, (double[]){0, right, 1 - left - right, left}, 0, 0);
    /* In a corner of 45°, and past it. */
    const hr2d_patch wedge[] = {square[0], {.a = {1, 1}, .b = {0, 0}}};
    const double open = (1 + rest / hypot(rest, 1)) / 2;
    expect(wedge, 2, t, (double[]){0, open}, 0, 1 - open);
  }
}
END_TEST

/* Spokes from the start of patch 0: it sees the nearest one, and nothing behind. */
START_TEST(fans) {
  const double root = sqrt(.5), none[9] = {0};
  hr2d_patch fan[] = {{.b = {1, 0}},
                      {.b = {0, 1}, .sides = HR2D_SIDES_BOTH},
                      {.b = {1, 1}, .sides = HR2D_SIDES_BOTH},
                      {.b = {-1, 2}, .sides = HR2D_SIDES_BOTH}};
  double sine[] = {0, 0, 0, 0, (1 + root) / 2, 0, 0};
  expect(fan, 4, 0, sine, 0, (1 - root) / 2);
  fan[2].sides = HR2D_SIDES_FRONT;
  expect(fan, 4, 0, none, (1 + root) / 2, (1 - root) / 2);
  fan[2].a = (hr2d_point){1, 1};
  fan[2].b = (hr2d_point){0, 0};
  sine[3] = sine[4];
  sine[4] = 0;
  expect(fan, 4, 0, sine, 0, (1 - root) / 2);
}
END_TEST

/* A wall on the point itself, and the point's patch on the inside of a wall. */
START_TEST(feet) {
  hr2d_patch wall[] = {{.a = {-1, 0}, .b = {1, 0}}, {.a = {0, 1}, .b = {0, 0}}};
  expect(wall, 2, .5, (double[]){0, .5}, 0, .5);
  wall[1].sides = HR2D_SIDES_BOTH;
  expect(wall, 2, .5, (double[]){0, .5, 0}, 0, .5);
  wall[0].a.x = -3;
  expect(wall, 2, .75, (double[]){0, 0, .5}, 0, .5);
  hr2d_patch host[] = {{.a = {0, 0}, .b = {1, 0}}, {.a = {0, 1}, .b = {0, -1}}};
  expect(host, 2, 0, (double[]){0, .5}, 0, .5);
  host[0] = (hr2d_patch){.a = {-1, 0}, .b = {0, 0}};
  expect(host, 2, 1, (double[]){0, 0}, .5, .5);
}
END_TEST

/* The sine to the edge of a thing at height 1 is x/√(1+x²). */
START_TEST(things_overhead) {
  const double half = 1 / sqrt(5), one = sqrt(.5);
  hr2d_patch above[] = {{.a = {-1, 0}, .b = {1, 0}},
                        {.a = {.5, 1}, .b = {-.5, 1}, .sides = HR2D_SIDES_BOTH},
                        {.a = {2, 2}, .b = {-2, 2}}};
  expect(above, 3, .5, (double[]){0, half, 0, one - half}, 0, 1 - one);
  above[1].sides = HR2D_SIDES_FRONT;
  expect(above, 3, .5, (double[]){0, half, one - half}, 0, 1 - one);
  above[1].a.x = -.5;
  above[1].b.x = .5;
  expect(above, 3, .5, (double[]){0, 0, one - half}, half, 1 - one);
  /* Back to back in part: of the longer one the back is seen past the shorter one. */
  const hr2d_patch part[] = {
      {.a = {-1, 0}, .b = {1, 0}}, {.a = {-1, 1}, .b = {1, 1}}, {.a = {.5, 1}, .b = {-.5, 1}}};
  expect(part, 3, .5, (double[]){0, 0, half}, one - half, 1 - one);
  /* One back behind another counts once, though nothing that is seen is hidden. */
  const hr2d_patch backs[] = {
      {.a = {-1, 0}, .b = {1, 0}}, {.a = {-1, 1}, .b = {1, 1}}, {.a = {-1, 2}, .b = {1, 2}}};
  expect(backs, 3, .5, (double[]){0, 0, 0}, one, 1 - one);
}
END_TEST

START_TEST(parts_are_where_rays_end) {
  const hr2d_patch patch[] = {{.a = {-1, 0}, .b = {1, 0}},
                              {.a = {.25, 1}, .b = {-.5, 1}, .sides = HR2D_SIDES_BOTH},
                              {.a = {4, 2}, .b = {-4, 2}},
                              {.a = {-8, 3}, .b = {-8, -1}}};
  const double expected[][3] = {{1, 0, 1}, {3, 0, .4375}, {3, .625, 1}, {4, 0, .75}};
  hr2d_scene *scene = scene_of(patch, 4);
  hr2di_point_viewer *viewer = viewer_of(scene);
  const hr2di_view_from seen = look(viewer, 0, .5);
  ck_assert_uint_eq(seen.count, 4);
  for (size_t k = 0; k < 4; k++) {
    ck_assert_uint_eq(seen.interval[k].patch, (unsigned)expected[k][0]);
    ck_assert_double_eq_tol(seen.interval[k].from, expected[k][1], 1e-15);
    ck_assert_double_eq_tol(seen.interval[k].to, expected[k][2], 1e-15);
  }
  hr2di_point_viewer_destroy(viewer);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Open scenes of the examples, with ground, roofs and sky. */
static const char *const open_scenes[] = {"street-canyon.geojson", "solar-panels.geojson",
                                          "castel-del-monte.geojson", "occluders-200.geojson"};

START_TEST(examples_are_seen_by_rays) {
  randoms r = randoms_stream(test_seed(), 1200);
  hr2d_scene *scene = test_shipped_scene(open_scenes[_i]);
  hr2di_point_viewer *viewer = viewer_of(scene);
  double worst = 0, sky = 0, back = 0;
  for (int k = 0; k < test_count(200); k++) {
    const size_t patch = (size_t)(random_bits(&r) % hr2d_scene_patches(scene));
    const double t = random_unit(&r);
    const hr2di_view_from seen = look(viewer, patch, t);
    brute b = brute_look(scene, patch, t, SIZE_MAX);
    worst = fmax(worst, compare(&b, &seen));
    sky = fmax(sky, seen.sky);
    back = fmax(back, seen.back);
    brute_free(&b);
  }
  printf("%-26s to rays %.2e, sky to %.3g, backs to %.3g\n", open_scenes[_i], worst, sky, back);
  ck_assert_double_lt(worst, 1e-13);
  hr2di_point_viewer_destroy(viewer);
  hr2d_scene_destroy(scene);
}
END_TEST

/* The views of all patches, with a viewer of their own. */
static hr2d_status look_around(const hr2d_scene *scene, const hr2d_allocator *alloc,
                               double *front) {
  hr2di_point_viewer *viewer = NULL;
  hr2di_view_from seen;
  hr2d_status status = hr2di_point_viewer_create(scene, alloc, NULL, &viewer);
  *front = 0;
  for (size_t patch = 0; patch < hr2d_scene_patches(scene) && !status; patch++) {
    status = hr2di_view_at(viewer, patch, .3, &seen);
    if (!status) *front += seen.front;
  }
  hr2di_point_viewer_destroy(viewer);
  return status;
}

START_TEST(allocations_fail_one_by_one) {
  test_memory memory = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&memory);
  rooms s = {.r = randoms_stream(test_seed(), 1300)};
  hr2d_scene *scene = draw_scene(&s, &plan_classes[_i / 2 ? 0 : 5], 30, _i / 2 ? 0 : 2, 1, 0);
  double expected, front;
  long k = 0;
  ck_assert_int_eq(look_around(scene, &hooks, &expected), HR2D_OK);
  for (int failed = 1; failed; k++) {
    memory = (test_memory){.until_failure = k, .for_good = _i % 2};
    const hr2d_status status = look_around(scene, &hooks, &front);
    failed = memory.failures > 0;
    ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
    ck_assert_int_eq(memory.live, 0);
  }
  ck_assert(front == expected);
  ck_assert_int_gt(k, 3);
  hr2di_point_viewer_destroy(NULL);
  hr2d_scene_destroy(scene);
  plan_free(&s.plan);
}
END_TEST

TEST_SUITE("point view") {
  REPEAT_TESTS(plan_class_count, "rays", rays_see_the_same, a_missing_patch_is_noticed);
  REPEAT_TESTS(4, "rays", examples_are_seen_by_rays);
  REPEAT_TESTS(plan_class_count, "sums", rooms_are_closed, views_integrate_to_exchange_areas);
  REPEAT_TESTS(pair_class_count, "sums", sines_keep_their_digits);
  ADD_TESTS("closed forms", corners, fans, feet, things_overhead, parts_are_where_rays_end);
  ADD_TESTS("calls", forced_occlusion_changes_no_bit);
  REPEAT_TESTS(4, "calls", allocations_fail_one_by_one);
}
