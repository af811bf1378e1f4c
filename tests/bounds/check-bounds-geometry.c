/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bounds that the headers state for orientations, exchange areas, kernels, lengths and
   coordinates of elements, against MPFR, on random and on hill-climbed inputs.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the inputs. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "independent/mpfr-exchange.h"
#include "support/hill-climb.h"
#include "support/support.h"

#define ROUNDING 0x1p-53

/* The bounds of geometry.h, scene.h and hierarchy.h. */
#define AREA   4e-15
#define KERNEL 3e-15
#define LENGTH (3 * ROUNDING)

static hr2d_segment segment_at(const double *x, int k) {
  return (hr2d_segment){hill_point(x, 2 * k), hill_point(x, 2 * k + 1)};
}

static void put_pair(double *x, pair p) {
  const hr2d_point point[4] = {p.i.a, p.i.b, p.j.a, p.j.b};
  for (int k = 0; k < 4; k++) {
    x[2 * k] = point[k].x;
    x[2 * k + 1] = point[k].y;
  }
}

/* The inputs of a search: a class of pairs, or, for NULL, numbers of any exponent of a
   double, some of them 0 or equal. */
static void draw_any(randoms *r, double *x, int count) {
  const double low = random_between(r, -1074, 1023), high = random_between(r, low, 1024);
  for (int k = 0; k < count; k++) {
    const int e = (int)floor(random_between(r, low, high));
    x[k] = ldexp(random_between(r, -2, 2), e < 1023 ? e : 1022);
    if (random_below(r, 6) == 0) x[k] = k ? x[random_below(r, k)] : 0;
    if (random_below(r, 8) == 0) x[k] = 0;
  }
}

static void draw_coordinates(const void *ctx, randoms *r, double *x) {
  const pair_class *class = ctx;
  if (class)
    put_pair(x, draw_pair(class, r));
  else
    draw_any(r, x, 8);
}

static const pair_class *class_of(int index) {
  return index < pair_class_count ? &pair_classes[index] : NULL;
}

static const char *title(const char *what, const pair_class *class) {
  static char text[80];
  snprintf(text, sizeof text, "%s, %s", what, class ? class->name : "any exponents");
  return text;
}

/* How near to a wrong sign: 2 for one, else below 1 the more digits of the products cancel. */
static double orientation_risk(const void *ctx, const double *x) {
  (void)ctx;
  const hr2d_point a = hill_point(x, 0), b = hill_point(x, 1), c = hill_point(x, 2);
  mpfr_t det, size;
  mpfr_inits2(MPFR_PREC_MIN, det, size, (mpfr_ptr)0);
  mpfr_orient(det, a, b, c);
  const int sign = (mpfr_sgn(det) > 0) - (mpfr_sgn(det) < 0);
  mpfr_distance(size, a, b);
  if (!mpfr_zero_p(size)) mpfr_div(det, det, size, MPFR_RNDN);
  mpfr_distance(size, a, c);
  if (!mpfr_zero_p(size)) mpfr_div(det, det, size, MPFR_RNDN);
  const double digits = sign ? -(double)mpfr_get_exp(det) : 0;
  mpfr_clears(det, size, (mpfr_ptr)0);
  if (hr2d_orientation(a, b, c) != sign) return 2;
  return digits > 0 ? digits / (digits + 1) : 0;
}

START_TEST(orientations_have_exact_signs) {
  const pair_class *class = class_of(_i);
  const hill h = {title("orientation", class), 6, 3, draw_coordinates, orientation_risk, class};
  hill_hold(&h, (hill_effort){2000, 8, 400}, _i, 1);
}
END_TEST

static double area_error(const void *ctx, const double *x) {
  (void)ctx;
  const hr2d_segment i = segment_at(x, 0), j = segment_at(x, 1);
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  mpfr_exchange_area(exact, &i, &j);
  const double error = mpfr_double_error(hr2d_exchange_area(&i, &j), exact);
  mpfr_clear(exact);
  return error;
}

START_TEST(exchange_areas_hold_their_bound) {
  const pair_class *class = class_of(_i);
  const hill h = {title("exchange area", class), 8, 4, draw_coordinates, area_error, class};
  hill_hold(&h, (hill_effort){class ? 1000 : 8000, 12, 600}, 100 + _i, AREA);
}
END_TEST

/* A point of a segment, often rounded off it, or anywhere else. */
static void put_place(randoms *r, double *x, int k, hr2d_segment s) {
  const double t = random_below(r, 3) ? random_unit(r) : ldexp(random_below(r, 9), -3);
  x[2 * k] = s.a.x + t * (s.b.x - s.a.x);
  x[2 * k + 1] = s.a.y + t * (s.b.y - s.a.y);
  if (random_below(r, 4) == 0) x[2 * k] = random_nudge(r, x[2 * k], 3);
}

static void draw_places(const void *ctx, randoms *r, double *x) {
  if (!ctx) {
    draw_any(r, x, 12);
    return;
  }
  draw_coordinates(ctx, r, x);
  put_place(r, x, 4, segment_at(x, 0));
  put_place(r, x, 5, segment_at(x, 1));
}

static double kernel_error(const void *ctx, const double *at) {
  (void)ctx;
  const hr2d_segment i = segment_at(at, 0), j = segment_at(at, 1);
  const hr2d_point x = hill_point(at, 4), y = hill_point(at, 5);
  const double g = hr2d_kernel(&i, x, &j, y);
  if (!isfinite(x.x) || !isfinite(x.y) || !isfinite(y.x) || !isfinite(y.y))
    return isnan(g) ? 0 : INFINITY;
  if (x.x == y.x && x.y == y.y) return g == 0 || g == INFINITY ? 0 : INFINITY;
  if ((i.a.x == i.b.x && i.a.y == i.b.y) || (j.a.x == j.b.x && j.a.y == j.b.y))
    return g == 0 ? 0 : INFINITY;
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  mpfr_kernel_of_lines(exact, &i, x, &j, y);
  const double error = g == hr2d_kernel(&j, y, &i, x) ? mpfr_double_error(g, exact) : INFINITY;
  mpfr_clear(exact);
  return error;
}

START_TEST(kernels_hold_their_bound) {
  const pair_class *class = class_of(_i);
  const hill h = {title("kernel", class), 12, 6, draw_places, kernel_error, class};
  hill_hold(&h, (hill_effort){class ? 1000 : 8000, 12, 600}, 200 + _i, KERNEL);
}
END_TEST

/* A scene of one patch; NULL where there cannot be one. */
static hr2d_scene *scene_of(hr2d_point a, hr2d_point b) {
  hr2d_scene *scene;
  hr2d_patch patch = HR2D_PATCH_INIT;
  patch.a = a;
  patch.b = b;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  if (hr2d_scene_add(scene, &patch, NULL) || hr2d_scene_commit(scene)) {
    hr2d_scene_destroy(scene);
    return NULL;
  }
  return scene;
}

/* The unit's own rule is checked on the way: nothing else may come from hr2d_scene_unit(). */
static double length_error(const void *ctx, const double *x) {
  (void)ctx;
  hr2d_scene *scene = scene_of(hill_point(x, 0), hill_point(x, 1));
  if (!scene) return -1;
  double max = 0;
  for (int k = 0; k < 4; k++) max = fmax(max, fabs(x[k]));
  ck_assert_double_eq(hr2d_scene_unit(scene), ldexp(1, ilogb(max)));
  mpfr_t exact;
  mpfr_init2(exact, MPFR_PREC_MIN);
  mpfr_distance(exact, hill_point(x, 0), hill_point(x, 1));
  const double error = mpfr_double_error(hr2d_scene_length(scene, 0), exact);
  mpfr_clear(exact);
  hr2d_scene_destroy(scene);
  return error;
}

START_TEST(lengths_hold_their_bound) {
  const pair_class *class = class_of(_i);
  const hill h = {title("length", class), 4, 2, draw_coordinates, length_error, class};
  hill_hold(&h, (hill_effort){1000, 6, 400}, 300 + _i, LENGTH);
}
END_TEST

/* Halves again and again the children that the bits of `path` name, as refinement does, with
   the policy asking for the first of a pair only. */
typedef struct descent {
  uint64_t path;
  unsigned depth;
} descent;

static hr2d_status refuse(void *ctx, const hr2d_batch *batch, double *error) {
  const descent *d = ctx;
  for (size_t k = 0; k < batch->count; k++) {
    uint32_t e = batch->pairs[k].first;
    unsigned level = hr2d_element_level(batch->hierarchy, e), on = level < d->depth;
    for (; level > 0; level--) {
      const uint32_t above = hr2d_element_parent(batch->hierarchy, e);
      on &= (e - batch->elements[above].child) == ((d->path >> level) & 1);
      e = above;
    }
    error[k] = on ? INFINITY : 0;
  }
  return HR2D_OK;
}

static hr2d_status split_first(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) split[k] = HR2D_SPLIT_FIRST;
  return HR2D_OK;
}

/* |coordinate − exact coordinate| divided by the largest coordinate of the patch and by the
   level.  The 1400 bits suffice for an exact one: a double of magnitude below 2 over 2^60. */
static double off_exact(const hr2d_hierarchy *h, uint32_t e, uint64_t place, unsigned level) {
  const hr2d_element *element = hr2d_hierarchy_elements(h);
  const hr2d_element *patch = &element[element[e].patch];
  const double ends[2][2] = {{patch->a.x, patch->b.x}, {patch->a.y, patch->b.y}};
  const double got[2] = {element[e].a.x, element[e].a.y};
  double max = 0, worst = 0;
  mpfr_t x;
  mpfr_init2(x, 1400);
  for (int k = 0; k < 4; k++) max = fmax(max, fabs(ends[k / 2][k % 2]));
  for (int k = 0; k < 2; k++) {
    mpfr_set_d(x, ends[k][1], MPFR_RNDN);
    mpfr_sub_d(x, x, ends[k][0], MPFR_RNDN);
    mpfr_mul_d(x, x, ldexp((double)place, -(int)level), MPFR_RNDN);
    mpfr_add_d(x, x, ends[k][0], MPFR_RNDN);
    mpfr_sub_d(x, x, got[k], MPFR_RNDN);
    worst = fmax(worst, fabs(mpfr_get_d(x, MPFR_RNDN)) / max);
  }
  mpfr_clear(x);
  return level ? worst / level : worst > 0 ? INFINITY : 0;
}

/* Follows the path, looking at the start of each element and at its length. */
static double worst_on_path(const hr2d_hierarchy *h, uint64_t path) {
  const hr2d_element *element = hr2d_hierarchy_elements(h);
  double worst = 0;
  uint64_t place = 0;
  uint32_t e = 0;
  for (unsigned level = 0; level < 53; level++) {
    worst = fmax(worst, off_exact(h, e, place, level));
    if (element[e].length < 0x1p-1000) break;
    if (element[e].length != ldexp(element[0].length, -(int)level)) return INFINITY;
    if (!element[e].child) break;
    const uint64_t bit = (path >> (level + 1)) & 1;
    e = element[e].child + (uint32_t)bit;
    place = 2 * place + bit;
  }
  return worst;
}

static double halving_error(const void *ctx, const double *x) {
  (void)ctx;
  descent d = {.path = 0, .depth = 45};
  const hr2d_oracle oracle = {.struct_size = sizeof oracle,
                              .name = "path",
                              .flags = HR2D_ORACLE_SYMMETRIC,
                              .estimate = refuse};
  const hr2d_policy policy = {
      .struct_size = sizeof policy, .name = "first", .preferred_subdivision = split_first};
  const double patch[2][6] = {{x[0], x[1], x[2], x[3]}, {x[4], x[5], x[6], x[7]}};
  for (int k = 0; k < 60; k++)
    d.path |= (uint64_t)(x[8 + k % 12] * ldexp(1, k / 12) > 0.5) << k;
  const double light = 1;
  hr2d_scene *scene;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (int k = 0; k < 2; k++) {
    hr2d_patch p = HR2D_PATCH_INIT;
    p.a = (hr2d_point){patch[k][0], patch[k][1]};
    p.b = (hr2d_point){patch[k][2], patch[k][3]};
    p.emission = &light;
    p.emission_bands = 1;
    if (hr2d_scene_add(scene, &p, NULL)) break;
  }
  if (hr2d_scene_patches(scene) < 2 || hr2d_scene_commit(scene)) {
    hr2d_scene_destroy(scene);
    return -1;
  }
  test_links t = test_make_links(scene, &oracle, &d, &policy, NULL);
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = 1;
  options.max_level = 50;
  hr2d_refine_counts counts;
  double error = -1;
  if (hr2d_refine_count(t.links, &options, &counts) == HR2D_OK && counts.levels > 0)
    error = worst_on_path(t.hierarchy, d.path);
  test_free_links(&t);
  return error;
}

static void draw_descent(const void *ctx, randoms *r, double *x) {
  draw_coordinates(ctx, r, x);
  for (int k = 8; k < 20; k++) x[k] = random_unit(r);
}

START_TEST(midpoints_hold_their_bound) {
  const hill h = {title("midpoint", &pair_classes[_i]),
                  20,
                  4,
                  draw_descent,
                  halving_error,
                  &pair_classes[_i]};
  hill_hold(&h, (hill_effort){150, 2, 200}, 400 + _i, ROUNDING);
}
END_TEST

/* Negative controls: the climber finds what textbook code loses, from harmless starts. */
static double plain_orientation_risk(const void *ctx, const double *x) {
  const hr2d_point a = hill_point(x, 0), b = hill_point(x, 1), c = hill_point(x, 2);
  const double det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  const int sign = (det > 0) - (det < 0);
  const double risk = orientation_risk(ctx, x);
  return sign == hr2d_orientation(a, b, c) ? risk : 2;
}

static double plain_kernel_error(const void *ctx, const double *at) {
  (void)ctx;
  const hr2d_segment i = segment_at(at, 0), j = segment_at(at, 1);
  const double dx = at[10] - at[8], dy = at[11] - at[9], r = sqrt(dx * dx + dy * dy);
  const double ix = i.b.x - i.a.x, iy = i.b.y - i.a.y, jx = j.b.x - j.a.x, jy = j.b.y - j.a.y;
  const double g = (ix * (at[11] - i.a.y) - iy * (at[10] - i.a.x)) *
                   (jx * (at[9] - j.a.y) - jy * (at[8] - j.a.x)) /
                   (2 * sqrt(ix * ix + iy * iy) * sqrt(jx * jx + jy * jy) * r * r * r);
  if (kernel_error(ctx, at) != 0 && r > 0) {
    mpfr_t exact;
    mpfr_init2(exact, MPFR_PREC_MIN);
    mpfr_kernel_of_lines(exact, &i, hill_point(at, 4), &j, hill_point(at, 5));
    const double error = mpfr_zero_p(exact) ? -1 : mpfr_double_error(g, exact);
    mpfr_clear(exact);
    return error;
  }
  return -1;
}

START_TEST(the_climber_finds_what_textbooks_lose) {
  const hill sign = {"textbook orientation", 6, 3, draw_coordinates, plain_orientation_risk,
                     &pair_classes[0]};
  hill_exceed(&sign, (hill_effort){0, 20, 400}, 500, 2);
  const hill g = {"textbook kernel", 12, 6, draw_places, plain_kernel_error, &pair_classes[0]};
  hill_exceed(&g, (hill_effort){0, 10, 400}, 501, 1e-6);
}
END_TEST

TEST_SUITE("bounds of geometry") {
  const int all = pair_class_count + 1;
  REPEAT_TESTS(all, "geometry", orientations_have_exact_signs, exchange_areas_hold_their_bound,
               kernels_hold_their_bound, lengths_hold_their_bound);
  REPEAT_TESTS(pair_class_count, "geometry", midpoints_hold_their_bound);
  ADD_TESTS("geometry", the_climber_finds_what_textbooks_lose);
}
