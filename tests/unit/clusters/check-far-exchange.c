/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The public calls for clusters: near pairs and links make up all exchange areas, those of the
   library and those of a regular polygon, and a solver of one's own uses them. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/memory.h"
#include "support/shares.h"
#include "support/support.h"

#define PI 3.14159265358979323846

/* Lengths are far from 1, so that units count. */
#define RADIUS 700.

enum { ROOM = 400, SMALL = 200, PILLAR = 24, ORDER = 3, BANDS = 2 };

static hr2d_status add_side(hr2d_scene *scene, double radius, int k, int count, int inside,
                            double emission) {
  const double angle[] = {2 * PI * k / count, 2 * PI * (k + 1) / count}, rho = .6;
  const double from = angle[!inside], to = angle[inside];
  hr2d_patch p = HR2D_PATCH_INIT;
  p.a = (hr2d_point){radius * cos(from), radius * sin(from)};
  p.b = (hr2d_point){radius * cos(to), radius * sin(to)};
  p.emission = &emission;
  p.reflectance = &rho;
  p.emission_bands = p.reflectance_bands = 1;
  return hr2d_scene_add(scene, &p, NULL);
}

/* A round room with a round pillar in it. */
static hr2d_scene *make_scene(const hr2d_allocator *alloc, int room) {
  hr2d_scene *scene = NULL;
  hr2d_status status = hr2d_scene_create(alloc, &scene);
  for (int k = 0; k < room && !status; k++)
    status = add_side(scene, RADIUS, k, room, 1, k < room / 8);
  for (int k = 0; k < PILLAR && !status; k++)
    status = add_side(scene, RADIUS / 3, k, PILLAR, 0, 0);
  if (!status) status = hr2d_scene_commit(scene);
  ck_assert_int_eq(status, HR2D_OK);
  return scene;
}

/* So large that there are links of nine digits. */
static int large_room(void) {
  return (int)test_some(1600, 800);
}

/* How often each pair is near. */
typedef struct nearby {
  size_t n;
  unsigned char *times;
} nearby;

static hr2d_status note(void *ctx, const hr2d_pair *pairs, size_t count) {
  nearby *near = ctx;
  for (size_t k = 0; k < count; k++) near->times[pairs[k].first * near->n + pairs[k].second]++;
  return HR2D_OK;
}

static hr2d_status ignore(void *ctx, const hr2d_pair *pairs, size_t count) {
  (void)ctx;
  (void)pairs;
  (void)count;
  return HR2D_OK;
}

static hr2d_clusters *make_clusters(const hr2d_scene *scene, double accuracy, nearby *near) {
  hr2d_clusters_options options = HR2D_CLUSTERS_OPTIONS_INIT;
  hr2d_clusters *clusters = NULL;
  options.accuracy = accuracy;
  near->n = hr2d_scene_patches(scene);
  near->times = calloc(near->n * near->n, 1);
  ck_assert_ptr_nonnull(near->times);
  ck_assert_int_eq(hr2d_clusters_create(scene, &options, note, near, &clusters), HR2D_OK);
  ck_assert_uint_gt(hr2d_clusters_links(clusters), 0);
  ck_assert_uint_gt(hr2d_clusters_bytes(clusters), 0);
  return clusters;
}

static double *new_doubles(size_t count) {
  double *made = calloc(count, sizeof *made);
  ck_assert_ptr_nonnull(made);
  return made;
}

/* power = K B, over clusters and near pairs. */
static void transport(hr2d_clusters *clusters, const nearby *near, const double *area,
                      const double *b, double *power) {
  ck_assert_int_eq(hr2d_clusters_gather(clusters, NULL, 1, 1, b, power), HR2D_OK);
  for (size_t i = 0; i < near->n; i++)
    for (size_t j = i + 1; j < near->n; j++)
      if (near->times[i * near->n + j]) {
        power[i] += area[i * near->n + j] * b[j];
        power[j] += area[i * near->n + j] * b[i];
      }
}

/* The largest error of a row, relative to the length of the patch. */
static double error_of(const hr2d_scene *scene, const double *area, double accuracy) {
  nearby near;
  hr2d_clusters *clusters = make_clusters(scene, accuracy, &near);
  const size_t n = near.n;
  double *b = new_doubles(n), *power = new_doubles(n), worst = 0;
  unsigned long r = test_seed();
  size_t twice = 0;
  for (size_t k = 0; k < n; k++) b[k] = test_random(&r);
  transport(clusters, &near, area, b, power);
  for (size_t i = 0; i < n; i++) {
    double is = 0;
    for (size_t j = 0; j < n; j++) is += area[i * n + j] * b[j];
    worst = fmax(worst, fabs(power[i] - is) / hr2d_scene_length(scene, i));
  }
  for (size_t k = 0; k < n * n; k++) twice += near.times[k] > 1;
  ck_assert_uint_eq(twice, 0);
  hr2d_clusters_destroy(clusters);
  free(near.times);
  free(b);
  free(power);
  return worst;
}

static double *all_areas(const hr2d_scene *scene) {
  const size_t n = hr2d_scene_patches(scene);
  double *area = new_doubles(n * n);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, area, NULL), HR2D_OK);
  return area;
}

START_TEST(near_pairs_and_links_are_all) {
  hr2d_scene *scene = make_scene(NULL, large_room());
  double *area = all_areas(scene);
  const double coarse = error_of(scene, area, 1e-2), usual = error_of(scene, area, 0),
               fine = error_of(scene, area, 1e-9);
  printf("errors of rows: %.1e at 1e-2, %.1e at 1e-6, %.1e at 1e-9\n", coarse, usual, fine);
  ck_assert_double_le(coarse, 1e-2);
  ck_assert_double_le(usual, 1e-6);
  ck_assert_double_le(fine, 1e-9);
  ck_assert_double_gt(coarse, 1e-9); /* the control: links are what differs */
  free(area);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_segment side_of_polygon(size_t k, size_t count) {
  const double from = 2 * PI * (double)k / (double)count,
               to = 2 * PI * (double)(k + 1) / (double)count;
  return (hr2d_segment){{RADIUS * cos(from), RADIUS * sin(from)},
                        {RADIUS * cos(to), RADIUS * sin(to)}};
}

/* Sums over near pairs. */
typedef struct near_sum {
  size_t n;
  const double *b;
  double *power;
} near_sum;

static hr2d_status add_near(void *ctx, const hr2d_pair *pairs, size_t count) {
  near_sum *sum = ctx;
  for (size_t k = 0; k < count; k++) {
    const hr2d_segment i = side_of_polygon(pairs[k].first, sum->n),
                       j = side_of_polygon(pairs[k].second, sum->n);
    const double area = hr2d_exchange_area(&i, &j);
    sum->power[pairs[k].first] += area * sum->b[pairs[k].second];
    sum->power[pairs[k].second] += area * sum->b[pairs[k].first];
  }
  return HR2D_OK;
}

/* Crossed strings are chords: sides m apart in a regular polygon of n have the exchange area
   4R sin(πm/n) sin²(π/2n). */
START_TEST(a_polygon_is_known) {
  enum { N = 3000 };
  static double b[N], power[N], near_power[N], known[N];
  const double half = sin(PI / (2. * N)), length = 2 * RADIUS * sin(PI / N);
  near_sum sum = {N, b, near_power};
  unsigned long r = test_seed();
  hr2d_scene *scene = NULL;
  hr2d_clusters *clusters = NULL;
  double worst = 0;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  for (int k = 0; k < N; k++) {
    ck_assert_int_eq(add_side(scene, RADIUS, k, N, 1, 1), HR2D_OK);
    b[k] = test_random(&r);
    known[k] = 4 * RADIUS * sin(PI * k / N) * half * half;
  }
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_clusters_create(scene, NULL, add_near, &sum, &clusters), HR2D_OK);
  ck_assert_uint_gt(hr2d_clusters_links(clusters), 0);
  ck_assert_int_eq(hr2d_clusters_gather(clusters, NULL, 1, 1, b, power), HR2D_OK);
  for (int i = 0; i < N; i++) {
    double is = 0;
    for (int j = 0; j < N; j++) is += known[(j - i + N) % N] * b[j];
    worst = fmax(worst, fabs(power[i] + near_power[i] - is) / length);
  }
  printf("polygon: off by %.1e\n", worst);
  ck_assert_double_le(worst, HR2D_DEFAULT_CLUSTER_ACCURACY);
  hr2d_clusters_destroy(clusters);
  hr2d_scene_destroy(scene);
}
END_TEST

/* B = E + ρ K B / A by iteration; all exchange areas leave no residual. */
START_TEST(a_solver_of_ones_own) {
  hr2d_scene *scene = make_scene(NULL, large_room());
  nearby near;
  hr2d_clusters *clusters = make_clusters(scene, 1e-9, &near);
  const size_t n = near.n;
  double *area = all_areas(scene), *b = new_doubles(n), *power = new_doubles(n);
  for (int sweep = 0; sweep < 60; sweep++) {
    transport(clusters, &near, area, b, power);
    for (size_t k = 0; k < n; k++)
      b[k] = hr2d_scene_emission(scene, k, 0) +
             hr2d_scene_reflectance(scene, k, 0) * power[k] / hr2d_scene_length(scene, k);
  }
  for (size_t i = 0; i < n; i++) {
    double h = 0;
    for (size_t j = 0; j < n; j++) h += area[i * n + j] * b[j];
    const double is = hr2d_scene_emission(scene, i, 0) +
                      hr2d_scene_reflectance(scene, i, 0) * h / hr2d_scene_length(scene, i);
    ck_assert_double_eq_tol(b[i], is, 1e-8);
  }
  hr2d_clusters_destroy(clusters);
  free(near.times);
  free(area);
  free(b);
  free(power);
  hr2d_scene_destroy(scene);
}
END_TEST

typedef struct stage {
  hr2d_scene *scene;
  size_t values;
  double *b, *power, *shared;
} stage;

static stage set_stage(void) {
  stage s = {.scene = make_scene(NULL, ROOM)};
  unsigned long r = test_seed();
  s.values = hr2d_scene_patches(s.scene) * ORDER * BANDS;
  s.b = new_doubles(s.values);
  s.power = new_doubles(s.values);
  s.shared = new_doubles(s.values);
  for (size_t k = 0; k < s.values; k++) s.b[k] = test_random(&r);
  return s;
}

static void clear_stage(stage *s) {
  free(s->b);
  free(s->power);
  free(s->shared);
  hr2d_scene_destroy(s->scene);
}

START_TEST(threads_gather_the_same) {
  stage s = set_stage();
  nearby near;
  hr2d_clusters *clusters = make_clusters(s.scene, 0, &near);
  hr2d_clusters_options options = HR2D_CLUSTERS_OPTIONS_INIT;
  ck_assert_int_eq(hr2d_clusters_gather(clusters, NULL, ORDER, BANDS, s.b, s.power), HR2D_OK);
  options.threads = 3;
  ck_assert_int_eq(hr2d_clusters_gather(clusters, &options, ORDER, BANDS, s.b, s.shared),
                   HR2D_OK);
  ck_assert_int_eq(memcmp(s.power, s.shared, s.values * sizeof *s.power), 0);
  hr2d_clusters_destroy(clusters);
  free(near.times);
  clear_stage(&s);
}
END_TEST

/* Each share has clusters of its own. */
static void gather_share(hr2d_share *share, void *ctx) {
  const stage *s = ctx;
  hr2d_clusters_options options = HR2D_CLUSTERS_OPTIONS_INIT;
  hr2d_clusters *clusters = NULL;
  double *power = share->number == 0 ? s->shared : new_doubles(s->values);
  options.share = share;
  ck_assert_int_eq(hr2d_clusters_create(s->scene, &options, ignore, NULL, &clusters), HR2D_OK);
  ck_assert_int_eq(hr2d_clusters_gather(clusters, &options, ORDER, BANDS, s->b, power),
                   HR2D_OK);
  hr2d_clusters_destroy(clusters);
  if (share->number > 0) free(power);
}

START_TEST(shares_have_the_sum) {
  stage s = set_stage();
  hr2d_clusters *clusters = NULL;
  double max = 0;
  ck_assert_int_eq(hr2d_clusters_create(s.scene, NULL, ignore, NULL, &clusters), HR2D_OK);
  ck_assert_int_eq(hr2d_clusters_gather(clusters, NULL, ORDER, BANDS, s.b, s.power), HR2D_OK);
  shares_run(3, gather_share, &s);
  for (size_t k = 0; k < s.values; k++) max = fmax(max, fabs(s.power[k]));
  for (size_t k = 0; k < s.values; k++)
    ck_assert_double_eq_tol(s.shared[k], s.power[k], 1e-13 * max);
  hr2d_clusters_destroy(clusters);
  clear_stage(&s);
}
END_TEST

static hr2d_status refuse_pairs(void *ctx, const hr2d_pair *pairs, size_t count) {
  (void)ctx;
  (void)pairs;
  (void)count;
  return HR2D_ESTATE;
}

static hr2d_status refuse(void *ctx, const hr2d_progress *progress) {
  (void)ctx;
  (void)progress;
  return HR2D_STOPPED;
}

START_TEST(what_is_wrong_is_refused) {
  hr2d_scene *scene = make_scene(NULL, ROOM), *bare = NULL;
  hr2d_clusters_options options = HR2D_CLUSTERS_OPTIONS_INIT;
  hr2d_clusters *clusters = NULL;
  double value = 0;
  ck_assert_int_eq(hr2d_scene_create(NULL, &bare), HR2D_OK);
  ck_assert_int_eq(hr2d_clusters_create(bare, NULL, ignore, NULL, &clusters), HR2D_ESTATE);
  const double wrong[] = {-1e-9, 1.5, NAN};
  for (size_t k = 0; k < 3; k++) {
    options.accuracy = wrong[k];
    ck_assert_int_eq(hr2d_clusters_create(scene, &options, ignore, NULL, &clusters),
                     HR2D_EINVAL);
  }
  options = (hr2d_clusters_options){.struct_size = 1};
  ck_assert_int_eq(hr2d_clusters_create(scene, &options, ignore, NULL, &clusters), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_clusters_create(scene, NULL, refuse_pairs, NULL, &clusters),
                   HR2D_ESTATE);
  hr2d_clusters_options_init(&options, sizeof options);
  options.progress = refuse;
  ck_assert_int_eq(hr2d_clusters_create(scene, &options, ignore, NULL, &clusters),
                   HR2D_STOPPED);
  ck_assert_ptr_null(clusters);
  ck_assert_int_eq(hr2d_clusters_create(scene, NULL, ignore, NULL, &clusters), HR2D_OK);
  ck_assert_int_eq(hr2d_clusters_gather(clusters, NULL, 0, 1, &value, &value), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_clusters_gather(clusters, NULL, HR2D_MAX_ORDER + 1, 1, &value, &value),
                   HR2D_EINVAL);
  ck_assert_int_eq(hr2d_clusters_gather(clusters, NULL, 1, 0, &value, &value), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_clusters_gather(clusters, NULL, 1, SIZE_MAX / 2, &value, &value),
                   HR2D_EINVAL);
  hr2d_clusters_destroy(clusters);
  hr2d_clusters_destroy(NULL);
  hr2d_scene_destroy(bare);
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(images_are_refused) {
  hr2d_scene *scene = NULL;
  hr2d_clusters *clusters = NULL;
  ck_assert_int_eq(hr2d_scene_create(NULL, &scene), HR2D_OK);
  ck_assert_int_eq(add_side(scene, 1, 1, 8, 1, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_add_mirror(scene, (hr2d_segment){{0, -1}, {0, 1}}), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(scene), HR2D_OK);
  ck_assert_int_eq(hr2d_clusters_create(scene, NULL, ignore, NULL, &clusters),
                   HR2D_EUNSUPPORTED);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Hooks are those of the scene. */
START_TEST(allocations_fail_one_by_one) {
  test_memory f = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&f);
  hr2d_scene *scene = make_scene(&hooks, SMALL);
  const long held = f.live;
  const size_t n = hr2d_scene_patches(scene);
  double *b = new_doubles(n), *power = new_doubles(n);
  hr2d_clusters_options options = HR2D_CLUSTERS_OPTIONS_INIT;
  long k = 0;
  options.accuracy = 1e-2;
  for (int failed = 1; failed; k++) {
    hr2d_clusters *clusters = NULL;
    f.until_failure = k;
    f.for_good = _i;
    f.failures = 0;
    hr2d_status status = hr2d_clusters_create(scene, &options, ignore, NULL, &clusters);
    if (status)
      ck_assert_ptr_null(clusters);
    else
      ck_assert_uint_gt(hr2d_clusters_links(clusters), 0);
    if (!status) status = hr2d_clusters_gather(clusters, NULL, 1, 1, b, power);
    failed = f.failures > 0;
    ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
    hr2d_clusters_destroy(clusters);
    ck_assert_int_eq(f.live, held);
  }
  ck_assert_int_gt(k, 10);
  f.until_failure = -1;
  free(b);
  free(power);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("far exchange") {
  ADD_TESTS("sums", near_pairs_and_links_are_all, a_polygon_is_known, a_solver_of_ones_own);
  ADD_TESTS("gathers", threads_gather_the_same, shares_have_the_sum);
  ADD_TESTS("calls", what_is_wrong_is_refused, images_are_refused);
  REPEAT_TESTS(2, "calls", allocations_fail_one_by_one);
}
