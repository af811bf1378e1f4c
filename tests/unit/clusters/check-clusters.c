/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clusters: every pair of patches that see each other is covered once, as a near pair or by a
   link, and links are as exact as requested.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the rooms. */
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "clusters/clusters.h"
#include "support/room-plans.h"
#include "support/support.h"

#define PI 3.14159265358979323846

/* A scene, its exchange areas in scaled lengths, and its sorted pairs. */
typedef struct sorted {
  hr2d_scene *scene;
  size_t n;
  double *area;
  hr2di_clusters *clusters;
  unsigned char *near; /* how often each pair was near */
  double *linked;      /* the matrix of the links at order 1 */
  size_t pairs;
} sorted;

static hr2d_status put_near(void *ctx, const hr2d_pair *pairs, size_t count) {
  sorted *s = ctx;
  /* Check takes a microsecond for each assertion. */
  int right = count >= 1 && count <= 256;
  for (size_t k = 0; k < count; k++) {
    right &= pairs[k].first < pairs[k].second && pairs[k].second < s->n;
    if (right && s->near) s->near[pairs[k].first * s->n + pairs[k].second]++;
  }
  ck_assert_msg(right, "a batch of %zu pairs is not what it should be", count);
  s->pairs += count;
  return HR2D_OK;
}

static double *new_doubles(size_t count) {
  double *made = calloc(count ? count : 1, sizeof *made);
  ck_assert_ptr_nonnull(made);
  return made;
}

static double length_of(const sorted *s, size_t patch) {
  return hr2d_scene_length(s->scene, patch) / hr2d_scene_unit(s->scene);
}

static void gather_by(hr2di_clusters *clusters, const hr2di_cluster_gather *how,
                      const double *radiosity, double *power) {
  ck_assert_int_eq(hr2di_clusters_gather(clusters, how, radiosity, power), HR2D_OK);
}

static void gather(hr2di_clusters *clusters, size_t order, size_t bands,
                   const double *radiosity, double *power) {
  gather_by(clusters, &(hr2di_cluster_gather){.order = order, .bands = bands}, radiosity,
            power);
}

/* Each band has one patch that sends. */
static void gather_matrix(sorted *s) {
  enum { BANDS = 64 };
  double *sent = new_doubles(s->n * BANDS), *power = new_doubles(s->n * BANDS);
  for (size_t first = 0; first < s->n; first += BANDS) {
    memset(sent, 0, s->n * BANDS * sizeof *sent);
    memset(power, 0, s->n * BANDS * sizeof *power);
    for (size_t k = 0; k < BANDS && first + k < s->n; k++) sent[(first + k) * BANDS + k] = 1;
    gather(s->clusters, 1, BANDS, sent, power);
    for (size_t i = 0; i < s->n; i++)
      for (size_t k = 0; k < BANDS && first + k < s->n; k++)
        s->linked[i * s->n + first + k] = power[i * BANDS + k];
  }
  free(sent);
  free(power);
}

/* Takes over the scene. */
static sorted sort_scene(hr2d_scene *scene, double digits) {
  sorted s = {.scene = scene, .n = hr2d_scene_patches(scene)};
  const hr2d_allocator alloc = hr2di_alloc_default();
  s.near = calloc(s.n * s.n, 1);
  s.area = new_doubles(s.n * s.n);
  s.linked = new_doubles(s.n * s.n);
  ck_assert_ptr_nonnull(s.near);
  ck_assert_int_eq(hr2d_exchange_matrix(scene, NULL, s.area, NULL), HR2D_OK);
  for (size_t k = 0; k < s.n * s.n; k++) s.area[k] /= hr2d_scene_unit(scene);
  ck_assert_int_eq(
      hr2di_clusters_create(scene, &alloc, digits, put_near, &s, NULL, &s.clusters), HR2D_OK);
  if (hr2di_clusters_links(s.clusters) > 0) gather_matrix(&s);
  return s;
}

static void free_sorted(sorted *s) {
  hr2di_clusters_destroy(s->clusters);
  hr2d_scene_destroy(s->scene);
  free(s->near);
  free(s->area);
  free(s->linked);
}

/* Counts pairs that are not covered exactly once: pairs that see each other and are neither
   near nor linked, and pairs that are near twice, or near and linked.  A gap that rounding
   alone keeps open may be open for one pair of lines and closed for another, so that tiny
   areas do not count. */
static size_t count_faults(const sorted *s) {
  size_t faults = 0;
  for (size_t i = 0; i < s->n; i++)
    for (size_t j = i + 1; j < s->n; j++) {
      const size_t at = i * s->n + j;
      const int linked = s->linked[at] != 0, seen = s->area[at] > 1e-15;
      faults += s->near[at] > 1 || (s->near[at] && linked) || (seen && !s->near[at] && !linked);
    }
  return faults;
}

/* The largest error of a row of the links applied to some B in [0,1], relative to the
   patch's length. */
static double row_error(const sorted *s) {
  unsigned long r = test_seed();
  double *b = new_doubles(s->n), worst = 0;
  for (size_t k = 0; k < s->n; k++) b[k] = test_random(&r);
  for (size_t i = 0; i < s->n; i++) {
    double error = 0;
    for (size_t j = 0; j < s->n; j++) {
      const size_t at = i < j ? i * s->n + j : j * s->n + i;
      if (!s->near[at]) error += (s->linked[i * s->n + j] - s->area[at]) * b[j];
    }
    worst = fmax(worst, fabs(error) / length_of(s, i));
  }
  free(b);
  return worst;
}

static hr2d_point on_circle(double x, double y, double radius, int k, int n) {
  const double angle = .1 + 2 * PI * (k % n) / n;
  return (hr2d_point){x + radius * cos(angle), y + radius * sin(angle)};
}

static void add_circle(plan *p, double x, double y, double radius, int n, int inside) {
  for (int k = 0; k < n; k++) {
    const hr2d_point a = on_circle(x, y, radius, k, n), b = on_circle(x, y, radius, k + 1, n);
    plan_add(p, inside ? a : b, inside ? b : a, HR2D_SIDES_FRONT);
  }
}

/* The sides of a polygon, each in `parts`. */
static void add_polygon(plan *p, const hr2d_point *corner, int corners, int parts) {
  for (int k = 0; k < corners; k++) {
    const hr2d_point a = corner[k], b = corner[(k + 1) % corners];
    hr2d_point from = a;
    for (int m = 1; m <= parts; m++) {
      const double t = (double)m / parts;
      const hr2d_point to =
          m == parts ? b : (hr2d_point){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      plan_add(p, from, to, HR2D_SIDES_FRONT);
      from = to;
    }
  }
}

static void circle(plan *p, int n) {
  add_circle(p, 0, 0, 1, n, 1);
}

static void pillar(plan *p, int n) {
  add_circle(p, 0, 0, 1, 4 * n / 5, 1);
  add_circle(p, .3, .1, .25, n / 5, 0);
}

static void square(plan *p, int n) {
  add_polygon(p, (hr2d_point[]){{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 4, n / 4);
}

static void tilted(plan *p, int n) {
  add_polygon(p, (hr2d_point[]){{0, 0}, {.7, .3}, {.4, 1}, {-.3, .7}}, 4, n / 4);
}

static void l_shape(plan *p, int n) {
  add_polygon(p, (hr2d_point[]){{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 6, n / 6);
}

/* A room and a screen in it, in parts, with a door beside it. */
static void screen(plan *p, int n) {
  const int parts = n / 8;
  square(p, 4 * parts);
  for (int k = 0; k < 2 * parts; k++)
    plan_add(p, (hr2d_point){.5, .75 * k / (2 * parts)},
             (hr2d_point){.5, .75 * (k + 1) / (2 * parts)}, HR2D_SIDES_BOTH);
}

static void squares(plan *p, int n) {
  randoms r = randoms_stream(test_seed(), 1);
  const int side = (int)ceil(sqrt(n / 4.));
  square(p, 4);
  for (int k = 0; k < n / 4 - 1; k++) {
    const double x = (k % side + random_between(&r, .4, .6)) / side,
                 y = (k / side + random_between(&r, .4, .6)) / side,
                 first = random_between(&r, 0, 2 * PI),
                 radius = random_between(&r, .15, .3) / side;
    hr2d_point corner[4];
    for (int c = 0; c < 4; c++)
      corner[c] = (hr2d_point){x + radius * cos(first - c * PI / 2),
                               y + radius * sin(first - c * PI / 2)};
    add_polygon(p, corner, 4, 1);
  }
}

typedef struct drawing {
  const char *name;
  void (*draw)(plan *p, int n);
} drawing;

static const drawing shapes[] = {{"circle", circle},  {"pillar", pillar}, {"square", square},
                                 {"tilted", tilted},  {"L", l_shape},     {"screen", screen},
                                 {"squares", squares}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static hr2d_scene *scene_of(const plan *p, unsigned forced) {
  return test_painted_scene(p,
                            &(test_paint){.reflectance = .5, .emission = 1, .forced = forced});
}

static hr2d_scene *draw(const drawing *shape, int n, unsigned forced) {
  plan p = {.walls = 0};
  shape->draw(&p, n);
  hr2d_scene *scene = scene_of(&p, forced);
  plan_free(&p);
  return scene;
}

/* Rooms with all kinds of obstacles; with links wherever clusters allow them. */
START_TEST(pairs_are_covered_once) {
  const plan_class *class = &plan_classes[_i];
  randoms r = randoms_stream(test_seed(), 700 + _i);
  const int rooms = test_count(30);
  size_t patches = 0;
  for (int k = 0; k < rooms; k++) {
    plan p = {.walls = 0};
    class->draw(&r, (int)random_power(&r, 0, 2), &p);
    sorted s = sort_scene(scene_of(&p, 0), k % 2 ? 1e-2 : 0);
    ck_assert_msg(count_faults(&s) == 0, "%s: room %d has %zu faults", class->name, k,
                  count_faults(&s));
    ck_assert_double_le(row_error(&s), 1e-2);
    patches += s.n;
    free_sorted(&s);
    plan_free(&p);
  }
  printf("%-16s %d rooms, %zu patches\n", class->name, rooms, patches);
}
END_TEST

START_TEST(links_are_exact_enough) {
  const drawing *shape = &shapes[_i];
  const double digits[] = {1e-3, 1e-6, 1e-10};
  const size_t sizes[] = {300, 800};
  const size_t scenes = test_multiplier() < 0.1 ? 1 : sizeof sizes / sizeof *sizes;
  for (size_t m = 0; m < scenes; m++)
    for (size_t k = 0; k < sizeof digits / sizeof *digits; k++) {
      if (test_multiplier() < 1 && m == 1 && k != (size_t)_i % 3) continue;
      if (!test_meets((size_t)_i, k, 3)) continue;
      sorted s = sort_scene(draw(shape, (int)sizes[m], 0), digits[k]);
      const double error = row_error(&s);
      printf("%-8s %4zu patches, 1e%.0f: %7zu near, %5llu links, error %.1e\n", shape->name,
             s.n, log10(digits[k]), s.pairs,
             (unsigned long long)hr2di_clusters_links(s.clusters), error);
      ck_assert_uint_eq(count_faults(&s), 0);
      ck_assert_double_le(error, digits[k]);
      free_sorted(&s);
    }
}
END_TEST

/* Patches of a large scene. */
static int many(void) {
  return test_multiplier() < 0.1 ? 400 : test_multiplier() < 1 ? 500 : 1000;
}

/* Occlusion that is forced on where nothing is in the way changes nothing. */
START_TEST(what_is_clear_is_linked) {
  sorted s = sort_scene(draw(&shapes[_i], many(), 0), 1e-6);
  sorted t = sort_scene(draw(&shapes[_i], many(), 1u << HR2D_EFFECT_OCCLUSION), 1e-6);
  ck_assert_uint_gt(hr2di_clusters_links(s.clusters), 50);
  ck_assert_uint_eq(hr2di_clusters_links(s.clusters), hr2di_clusters_links(t.clusters));
  ck_assert_mem_eq(s.linked, t.linked, s.n * s.n * sizeof *s.linked);
  ck_assert_uint_eq(count_faults(&t), 0);
  free_sorted(&s);
  free_sorted(&t);
}
END_TEST

/* Negative control: the checks notice faults that are planted. */
START_TEST(faults_are_found) {
  sorted s = sort_scene(draw(&shapes[1], 400, 0), 1e-3);
  size_t near = 0, linked = 0;
  while (!(s.near[near] && s.area[near] > 0)) near++;
  while (s.linked[linked] == 0 || linked / s.n > linked % s.n) linked++;
  ck_assert_uint_eq(count_faults(&s), 0);
  s.near[near] = 0;
  ck_assert_uint_eq(count_faults(&s), 1);
  s.near[near] = 2;
  ck_assert_uint_eq(count_faults(&s), 1);
  s.near[near] = s.near[linked] = 1;
  ck_assert_uint_eq(count_faults(&s), 1);
  s.near[linked] = 0;
  const double was = s.linked[linked];
  s.linked[linked] = 0;
  ck_assert_uint_eq(count_faults(&s), 1);
  s.linked[linked] = was;
  /* With few digits the error is not tiny. */
  ck_assert_double_gt(row_error(&s), 1e-8);
  for (size_t j = 0; j < s.n; j++) s.linked[linked / s.n * s.n + j] = 0;
  ck_assert_double_gt(row_error(&s), 1e-3);
  free_sorted(&s);
}
END_TEST

/* The links of a room do not reach through what stands in it. */
START_TEST(links_mind_the_pillar) {
  plan p = {.walls = 0};
  const int n = many();
  pillar(&p, n);
  p.walls = (size_t)(4 * n / 5);
  sorted s = sort_scene(draw(&shapes[1], n, 0), 1e-6),
         empty = sort_scene(scene_of(&p, 0), 1e-6);
  size_t hidden = 0;
  for (size_t i = 0; i < empty.n; i++)
    for (size_t j = 0; j < empty.n; j++)
      if (empty.linked[i * empty.n + j] != 0 && s.area[i * s.n + j] == 0) {
        ck_assert(s.linked[i * s.n + j] == 0);
        hidden++;
      }
  ck_assert_uint_gt(hidden, (size_t)(n * n / 100));
  free_sorted(&s);
  free_sorted(&empty);
  plan_free(&p);
}
END_TEST

enum { MOST_ORDER = 4 };

/* ∫∫ G φ_l φ_m of a pair by a tensor rule, to `out`, order × order. */
static void brute_pair(const hr2d_scene *scene, size_t i, size_t j, int order,
                       const gsl_integration_glfixed_table *rule, int points, double *out) {
  const hr2d_segment s = hr2d_scene_segment(scene, i), t = hr2d_scene_segment(scene, j);
  const double scale =
      hr2d_scene_length(scene, i) * hr2d_scene_length(scene, j) / 4 / hr2d_scene_unit(scene);
  memset(out, 0, (size_t)(order * order) * sizeof *out);
  for (int a = 0; a < points; a++)
    for (int b = 0; b < points; b++) {
      double xi, eta, u, v;
      gsl_integration_glfixed_point(-1, 1, (size_t)a, &xi, &u, rule);
      gsl_integration_glfixed_point(-1, 1, (size_t)b, &eta, &v, rule);
      const hr2d_point x = {s.a.x + (1 + xi) / 2 * (s.b.x - s.a.x),
                            s.a.y + (1 + xi) / 2 * (s.b.y - s.a.y)};
      const hr2d_point y = {t.a.x + (1 + eta) / 2 * (t.b.x - t.a.x),
                            t.a.y + (1 + eta) / 2 * (t.b.y - t.a.y)};
      const double g = u * v * scale * hr2d_kernel(&s, x, &t, y);
      double p[MOST_ORDER], q[MOST_ORDER];
      gsl_sf_legendre_Pl_array(order - 1, xi, p);
      gsl_sf_legendre_Pl_array(order - 1, eta, q);
      for (int l = 0; l < order; l++)
        for (int m = 0; m < order; m++)
          out[l * order + m] += g * sqrt((2 * l + 1) * (2 * m + 1)) * p[l] * q[m];
    }
}

/* Higher coefficients, too. */
START_TEST(orders_are_exact_enough) {
  enum { ORDER = MOST_ORDER, POINTS = 12 };
  const double digits = _i ? 1e-10 : 1e-6;
  sorted s = sort_scene(draw(&shapes[3], 160, 0), digits);
  ck_assert_uint_gt(hr2di_clusters_links(s.clusters), 20);
  gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(POINTS);
  unsigned long r = test_seed();
  double *b = new_doubles(s.n * ORDER), *power = new_doubles(s.n * ORDER),
         *brute = new_doubles(s.n * ORDER), block[ORDER * ORDER], worst = 0;
  for (size_t k = 0; k < s.n * ORDER; k++) b[k] = test_random(&r) - .3;
  gather(s.clusters, ORDER, 1, b, power);
  for (size_t i = 0; i < s.n; i++)
    for (size_t j = 0; j < s.n; j++) {
      if (s.linked[i * s.n + j] == 0) continue;
      brute_pair(s.scene, i, j, ORDER, rule, POINTS, block);
      for (size_t l = 0; l < ORDER; l++)
        for (size_t m = 0; m < ORDER; m++)
          brute[i * ORDER + l] += block[l * ORDER + m] * b[j * ORDER + m];
    }
  for (size_t k = 0; k < s.n * ORDER; k++)
    worst = fmax(worst, fabs(power[k] - brute[k]) / length_of(&s, k / ORDER));
  printf("order %d, 1e%.0f: error %.1e\n", ORDER, log10(digits), worst);
  ck_assert_double_le(worst, digits);
  gsl_integration_glfixed_table_free(rule);
  free(b);
  free(power);
  free(brute);
  free_sorted(&s);
}
END_TEST

static double product(const double *u, const double *v, size_t count) {
  double sum = 0;
  for (size_t k = 0; k < count; k++) sum += u[k] * v[k];
  return sum;
}

START_TEST(gathers_are_symmetric) {
  const size_t step = test_multiplier() < 1 ? 15 : 6;
  sorted s = sort_scene(draw(&shapes[_i], 400, 0), 1e-4);
  for (size_t order = 1; order <= HR2D_MAX_ORDER; order += step) {
    const size_t count = s.n * order;
    unsigned long r = test_seed();
    double *u = new_doubles(count), *v = new_doubles(count), *ku = new_doubles(count),
           *kv = new_doubles(count);
    for (size_t k = 0; k < count; k++) u[k] = test_random(&r) - .5, v[k] = test_random(&r);
    gather(s.clusters, order, 1, u, ku);
    gather(s.clusters, order, 1, v, kv);
    const double size = sqrt(product(ku, ku, count) * product(v, v, count));
    ck_assert_double_le(fabs(product(ku, v, count) - product(kv, u, count)), 1e-13 * size);
    free(u);
    free(v);
    free(ku);
    free(kv);
  }
  free_sorted(&s);
}
END_TEST

/* Bands do not mix, a gather adds to its output, and two calls give the same. */
START_TEST(bands_are_gathers) {
  enum { ORDER = 3, BANDS = 4 };
  sorted s = sort_scene(draw(&shapes[4], 400, 0), 1e-5);
  ck_assert_uint_gt(hr2di_clusters_links(s.clusters), 20);
  const size_t count = s.n * ORDER;
  unsigned long r = test_seed();
  double *b = new_doubles(count * BANDS), *power = new_doubles(count * BANDS),
         *one = new_doubles(count), *out = new_doubles(count);
  for (size_t k = 0; k < count * BANDS; k++) b[k] = test_random(&r);
  gather(s.clusters, ORDER, BANDS, b, power);
  for (size_t band = 0; band < BANDS; band++) {
    for (size_t k = 0; k < count; k++) one[k] = b[k * BANDS + band], out[k] = 0;
    gather(s.clusters, ORDER, 1, one, out);
    for (size_t k = 0; k < count; k++) ck_assert(out[k] == power[k * BANDS + band]);
    for (size_t k = 0; k < count; k++) out[k] = 1;
    gather(s.clusters, ORDER, 1, one, out);
    for (size_t k = 0; k < count; k++)
      ck_assert_double_le(fabs(out[k] - 1 - power[k * BANDS + band]), 1e-15);
  }
  free(b);
  free(power);
  free(one);
  free(out);
  free_sorted(&s);
}
END_TEST

/* So many patches are worth several threads, and their links several slices.  Room that is
   used again has numbers of the last gather, here of more bands. */
START_TEST(threads_gather_the_same) {
  enum { ORDER = 2, TIMES = 4, BANDS = 3 };
  hr2di_cluster_room room = {0};
  hr2d_scene *scene = draw(&shapes[4], 4000, 0);
  const hr2d_allocator alloc = hr2di_alloc_default();
  sorted s = {.scene = scene, .n = hr2d_scene_patches(scene)};
  ck_assert_int_eq(hr2di_clusters_create(scene, &alloc, 1e-10, put_near, &s, NULL, &s.clusters),
                   HR2D_OK);
  const size_t count = s.n * ORDER;
  unsigned long r = test_seed();
  double *b = new_doubles(count * BANDS), *power[TIMES];
  for (size_t k = 0; k < count * BANDS; k++) b[k] = test_random(&r);
  for (unsigned k = 0; k < TIMES; k++) {
    hr2di_cluster_gather how = {
        .order = ORDER, .bands = BANDS, .threads = 1 + k, .room = k > 0 ? &room : NULL};
    power[k] = new_doubles(count * BANDS);
    if (k == 2) gather_by(s.clusters, &how, b, power[k]);
    how.bands = 1;
    memset(power[k], 0, count * sizeof *b);
    gather_by(s.clusters, &how, b, power[k]);
    ck_assert_mem_eq(power[k], power[0], count * sizeof *b);
  }
  ck_assert(power[0][0] != 0);
  ck_assert_uint_gt(room.values, 0);
  hr2di_cluster_room_clear(&room);
  for (int k = 0; k < TIMES; k++) free(power[k]);
  free(b);
  free_sorted(&s);
}
END_TEST

/* Takes over the scene. */
static size_t count_near(hr2d_scene *scene, double digits, uint64_t *links, uint64_t *bytes) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  sorted s = {.scene = scene, .n = hr2d_scene_patches(scene)};
  ck_assert_int_eq(
      hr2di_clusters_create(scene, &alloc, digits, put_near, &s, NULL, &s.clusters), HR2D_OK);
  *links = hr2di_clusters_links(s.clusters);
  *bytes = hr2di_clusters_bytes(s.clusters);
  hr2di_clusters_destroy(s.clusters);
  hr2d_scene_destroy(scene);
  return s.pairs;
}

/* Near pairs, links and bytes per patch are bounded for all n; without links the near pairs
   grow like n². */
START_TEST(no_square_of_patches) {
  const drawing *shape = &shapes[_i];
  uint64_t links, bytes;
  /* Some shapes may be larger than the others. */
  const int may = _i % 3 == 0;
  const double multiplier = test_multiplier();
  const int few = multiplier >= 0.1 || may ? 2400 : 600;
  const int max = multiplier >= (may ? 0.1 : 1) ? 9600 : few;
  for (int n = 600; n <= max; n *= 4) {
    hr2d_scene *scene = draw(shape, n, 0);
    const size_t near = count_near(scene, 1e-6, &links, &bytes);
    printf("%-8s %4d patches: %7zu near, %6llu links, %8llu bytes\n", shape->name, n, near,
           (unsigned long long)links, (unsigned long long)bytes);
    ck_assert_uint_le(near, (size_t)(80 * n));
    ck_assert_uint_le(links, (uint64_t)n);
    ck_assert_uint_le(bytes, (uint64_t)(100000 + 200 * n));
  }
  const size_t all = count_near(draw(shape, few, 0), 0, &links, &bytes);
  ck_assert_uint_gt(all, (size_t)(few / 6 * few));
  ck_assert_uint_eq(links, 0);
}
END_TEST

/* Among many obstacles hardly more pairs are near than see each other. */
START_TEST(hidden_pairs_are_not_near) {
  sorted s = sort_scene(draw(&shapes[6], many() + 200, 0), 1e-6);
  size_t seen = 0;
  for (size_t k = 0; k < s.n * s.n; k++) seen += s.area[k] > 0;
  printf("squares: %zu pairs see each other, %zu are near, of %zu\n", seen / 2, s.pairs,
         s.n * (s.n - 1) / 2);
  ck_assert_uint_eq(count_faults(&s), 0);
  ck_assert_uint_le(s.pairs, seen);
  free_sorted(&s);
}
END_TEST

static hr2d_status stop_at(void *ctx, const hr2d_pair *pairs, size_t count) {
  int *left = ctx;
  (void)pairs;
  (void)count;
  ck_assert_int_gt(*left, 0);
  return --*left == 0 ? HR2D_STOPPED : HR2D_OK;
}

START_TEST(near_may_stop) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2d_scene *scene = draw(&shapes[_i], 400, 0);
  hr2di_clusters *clusters = NULL;
  for (int calls = 1; calls < 4; calls++) {
    int left = calls;
    ck_assert_int_eq(
        hr2di_clusters_create(scene, &alloc, 1e-3, stop_at, &left, NULL, &clusters),
        HR2D_STOPPED);
    ck_assert_ptr_null(clusters);
  }
  hr2d_scene_destroy(scene);
}
END_TEST

START_TEST(one_patch_has_no_pairs) {
  const double patch[][6] = {{0, 0, 1, 0, 1, .5}};
  sorted s = sort_scene(test_scene(patch, 1), 1e-6);
  ck_assert_uint_eq(s.pairs, 0);
  ck_assert_uint_eq(hr2di_clusters_links(s.clusters), 0);
  free_sorted(&s);
}
END_TEST

START_TEST(allocations_fail_one_by_one) {
  test_memory f = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&f);
  hr2d_scene *scene = draw(&shapes[1], 400, 0);
  sorted s = {.scene = scene, .n = hr2d_scene_patches(scene)};
  double *b = new_doubles(s.n), *power = new_doubles(s.n);
  long k = 0;
  for (int failed = 1; failed; k++) {
    f = (test_memory){.until_failure = k, .for_good = _i};
    hr2di_clusters *clusters = NULL;
    hr2d_status status =
        hr2di_clusters_create(scene, &hooks, 1e-3, put_near, &s, NULL, &clusters);
    if (status)
      ck_assert_ptr_null(clusters);
    else
      status = hr2di_clusters_gather(clusters, &(hr2di_cluster_gather){.order = 1, .bands = 1},
                                     b, power);
    failed = f.failures > 0;
    ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
    hr2di_clusters_destroy(clusters);
    ck_assert_int_eq(f.live, 0);
  }
  printf("%ld allocations failed\n", k - 1);
  ck_assert_int_gt(k, 10);
  free(b);
  free(power);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("clusters") {
  REPEAT_TESTS(plan_class_count, "pairs", pairs_are_covered_once);
  REPEAT_TESTS(SHAPES, "pairs", links_are_exact_enough);
  ADD_TESTS("pairs", what_is_clear_is_linked, faults_are_found, links_mind_the_pillar);
  REPEAT_TESTS(SHAPES - 1, "pairs", no_square_of_patches);
  ADD_TESTS("pairs", hidden_pairs_are_not_near);
  REPEAT_TESTS(2, "gathers", orders_are_exact_enough);
  REPEAT_TESTS(SHAPES, "gathers", gathers_are_symmetric);
  ADD_TESTS("gathers", bands_are_gathers, threads_gather_the_same);
  REPEAT_TESTS(2, "calls", near_may_stop);
  ADD_TESTS("calls", one_patch_has_no_pairs);
  REPEAT_TESTS(2, "calls", allocations_fail_one_by_one);
}
