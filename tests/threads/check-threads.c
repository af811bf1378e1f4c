/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The promises of the headers to threads of the application: they may share a committed
   scene, a hierarchy that is no longer refined, a solution, and the code.  Each thread gets
   the same bits as it gets alone; some calls start threads of the library, too.
   ThreadSanitizer finds the races that change no result; see doc/testing.md. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L /* pthread_barrier_t */
#endif
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/pair-classes.h"
#include "support/room-plans.h"
#include "support/support.h"

enum { THREADS = 4, SETS = 3, BANDS = 2 };

/* The objects that the threads share.  The parallel run comes first: after a serial one,
   data that are made on first use would exist already. */
typedef struct common {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links[SETS];
  hr2d_solution *solution;
  test_memory memory;
} common;

/* Does the work of a kind and mixes all its results into `*digest`. */
typedef hr2d_status (*job)(const common *c, unsigned kind, uint64_t *digest);

static void mix(uint64_t *digest, const void *bytes, size_t count) {
  const unsigned char *byte = bytes;
  for (size_t k = 0; k < count; k++)
    *digest = (*digest ^ byte[k]) * 0x100000001b3u; /* FNV-1a */
}

static void mix_number(uint64_t *digest, double number) {
  mix(digest, &number, sizeof number);
}

static void mix_count(uint64_t *digest, uint64_t count) {
  mix(digest, &count, sizeof count);
}

static void mix_counts(uint64_t *digest, const hr2d_refine_counts *n) {
  mix_count(digest, n->elements);
  mix_count(digest, n->links);
  mix_count(digest, n->limited_links);
  mix_count(digest, n->blocked_pairs);
  mix_count(digest, n->levels);
}

static void mix_links(uint64_t *digest, const hr2d_linkset *links) {
  for (uint64_t k = 0; k < hr2d_linkset_size(links); k++) {
    const hr2d_link link = hr2d_linkset_get(links, k);
    mix(digest, &link.pair, sizeof link.pair);
    mix_number(digest, link.exchange_area);
  }
}

static void mix_solution(uint64_t *digest, const hr2d_solution *solution) {
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(hr2d_solution_links(solution));
  const hr2d_scene *scene = hr2d_hierarchy_scene(h);
  for (size_t band = 0; band < hr2d_scene_bands(scene); band++) {
    for (uint32_t e = 0; e < hr2d_hierarchy_count(h).elements; e++)
      mix_number(digest, hr2d_solution_element(solution, e, band));
    for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
      mix_number(digest, hr2d_solution_at(solution, k, 0.3, band));
      mix_number(digest, hr2d_solution_net_flux(solution, k, band));
    }
    mix_number(digest, hr2d_solution_power(solution, band).absorbed);
  }
  mix_number(digest, hr2d_solution_residual(solution));
}

/* Two rooms with an opening between them and furniture, under a sky, in two bands: every effect
   is on but that of a gas, which does not go with some of the calls. */
static const double wall[][4] = {
    {0, 0, 2, 0},      {2, 0, 2, 1},     {2, 1, 1.1, 1},     {0.8, 1, 0, 1},
    {0, 1, 0, 0},      {1, 0, 1, 0.3},   {1, 0.7, 1, 1},     {.4, .3, .6, .35},
    {.6, .35, .5, .5}, {.5, .5, .4, .3}, {1.4, .2, 1.5, .6},
};

static void fill(hr2d_scene *scene) {
  const double sky[BANDS] = {.25, .125};
  for (size_t k = 0; k < sizeof wall / sizeof *wall; k++) {
    const double emission[BANDS] = {k == 0, k == 10 ? .5 : 0}, rho = .3 + .05 * (double)k;
    const int inner = k == 5 || k == 6 || k == 10;
    const double tau = .1;
    const hr2d_patch patch = {.a = {wall[k][0], wall[k][1]},
                              .b = {wall[k][2], wall[k][3]},
                              .emission = emission,
                              .emission_bands = BANDS,
                              .reflectance = &rho,
                              .reflectance_bands = 1,
                              .transmittance = &tau,
                              .transmittance_bands = k == 10,
                              .sides = inner ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT};
    ck_assert_int_eq(hr2d_scene_add(scene, &patch, NULL), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_scene_set_background(scene, sky, BANDS), HR2D_OK);
  test_commit(scene);
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    ck_assert_msg(hr2d_scene_effect(scene, (hr2d_effect)e, NULL) != (e == HR2D_EFFECT_MEDIUM),
                  "%s", hr2d_effect_name((hr2d_effect)e));
}

/* Three link sets on one hierarchy, of order 1 or more, none of them solved. */
static void set_up(common *c, unsigned order) {
  *c = (common){.memory.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&c->memory);
  ck_assert_int_eq(hr2d_scene_create(&hooks, &c->scene), HR2D_OK);
  fill(c->scene);
  ck_assert_int_eq(hr2d_hierarchy_create(c->scene, &c->hierarchy), HR2D_OK);
  for (unsigned k = 0; k < SETS; k++) {
    const hr2d_oracle *oracle = k == 1 ? hr2d_oracle_bf() : hr2d_oracle_size();
    const hr2d_refine_options options =
        test_options((k == 1 ? .02 : .6) * (k == 2 ? .5 : 1), 4);
    ck_assert_int_eq(hr2d_linkset_create(c->hierarchy, oracle, NULL, NULL, NULL, &c->links[k]),
                     HR2D_OK);
    ck_assert_int_eq(hr2d_refine(c->links[k], &options), HR2D_OK);
  }
  ck_assert_int_eq(hr2d_hierarchy_set_order(c->hierarchy, order), HR2D_OK);
}

static void tear_down(common *c) {
  hr2d_solution_destroy(c->solution);
  for (unsigned k = 0; k < SETS; k++) hr2d_linkset_destroy(c->links[k]);
  hr2d_hierarchy_destroy(c->hierarchy);
  hr2d_scene_destroy(c->scene);
  ck_assert_int_eq(c->memory.live, 0);
}

typedef struct thread {
  pthread_t id;
  pthread_barrier_t *start;
  const common *c;
  job job;
  unsigned kind;
  uint64_t digest;
  hr2d_status status;
} thread;

static void *run(void *data) {
  thread *t = data;
  pthread_barrier_wait(t->start);
  t->status = t->job(t->c, t->kind, &t->digest);
  return NULL;
}

/* `kinds` sorts of work in as many threads, or the same in more; then each one alone. */
static void together(const common *c, job work, unsigned kinds, const char *name) {
  thread t[THREADS];
  const unsigned threads = kinds == 1 ? THREADS : kinds;
  pthread_barrier_t start;
  ck_assert_int_eq(pthread_barrier_init(&start, NULL, threads), 0);
  for (unsigned k = 0; k < threads; k++) {
    t[k] = (thread){.start = &start, .c = c, .job = work, .kind = k % kinds};
    ck_assert_int_eq(pthread_create(&t[k].id, NULL, run, &t[k]), 0);
  }
  for (unsigned k = 0; k < threads; k++) pthread_join(t[k].id, NULL);
  pthread_barrier_destroy(&start);
  for (unsigned k = 0; k < threads; k++) {
    uint64_t digest = 0;
    ck_assert_msg(t[k].status == HR2D_OK, "%s: %s", name, hr2d_strerror(t[k].status));
    ck_assert_int_eq(work(c, k % kinds, &digest), HR2D_OK);
    ck_assert_msg(digest == t[k].digest, "%s, thread %u: other bits than alone", name, k);
    for (unsigned m = 0; m < k; m++)
      ck_assert_msg((t[m].digest == digest) == (m % kinds == k % kinds),
                    "%s: the digest is blind", name);
  }
}

static void repeat(unsigned order, job work, unsigned kinds, const char *name) {
  const int rounds = (int)test_rounds(5, 1);
  for (int k = 0; k < rounds; k++) {
    common c;
    set_up(&c, order);
    together(&c, work, kinds, name);
    tear_down(&c);
  }
}

/* Hierarchies of one scene: a set is refined, counted on several threads, solved, refined
   further with this solution, and checked. */
static hr2d_status tell(const common *c, unsigned kind, uint64_t *digest) {
  const hr2d_oracle *oracle[] = {hr2d_oracle_size(), hr2d_oracle_bf(), hr2d_oracle_size2(),
                                 hr2d_oracle_l1()};
  const hr2d_policy *policy = kind == 2 ? hr2d_policy_modified() : hr2d_policy_original();
  hr2d_refine_options options = test_options(kind == 1 || kind == 3 ? .05 : .7, 5);
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_refine_counts counts;
  hr2d_hierarchy *h = NULL;
  hr2d_linkset *links = NULL;
  hr2d_solution *solution = NULL;
  hr2d_status status = hr2d_hierarchy_create(c->scene, &h);
  if (!status) status = hr2d_linkset_create(h, oracle[kind], NULL, policy, NULL, &links);
  options.threads = how.threads = 2;
  if (!status) status = hr2d_refine_count(links, &options, &counts);
  if (!status) mix_counts(digest, &counts);
  if (!status) status = hr2d_refine(links, &options);
  if (!status) status = hr2d_solve(links, &how, &solution);
  options.brightness = solution;
  options.epsilon /= 2;
  if (!status) status = hr2d_refine(links, &options);
  hr2d_solution_destroy(solution);
  solution = NULL;
  if (!status) status = hr2d_solve(links, &how, &solution);
  if (!status) status = hr2d_linkset_validate(links);
  if (!status) mix_links(digest, links);
  if (!status) mix_solution(digest, solution);
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(h);
  return status;
}

START_TEST(hierarchies_of_one_scene) {
  repeat(1, tell, THREADS, "hierarchies of one scene");
}
END_TEST

/* The first solve of a set at an order above 1 makes its blocks. */
static hr2d_status solve_set(const common *c, unsigned kind, uint64_t *digest) {
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *solution = NULL;
  how.threads = 1 + kind;
  const hr2d_status status = hr2d_solve(c->links[kind], &how, &solution);
  if (!status) mix_solution(digest, solution);
  hr2d_solution_destroy(solution);
  return status;
}

START_TEST(sets_of_one_hierarchy) {
  repeat(1, solve_set, SETS, "sets of one hierarchy");
  repeat(5, solve_set, SETS, "sets of one hierarchy, order 5");
}
END_TEST

static hr2d_status fill_matrix(const common *c, unsigned kind, uint64_t *digest) {
  const size_t n = hr2d_scene_patches(c->scene);
  hr2d_matrix_options options = HR2D_MATRIX_OPTIONS_INIT;
  hr2d_matrix_counts counts;
  double *area = malloc(n * n * sizeof *area);
  options.threads = 2;
  (void)kind;
  const hr2d_status status =
      area ? hr2d_exchange_matrix(c->scene, &options, area, &counts) : HR2D_ENOMEM;
  if (!status) mix(digest, area, n * n * sizeof *area);
  if (!status) mix_count(digest, counts.partial_pairs);
  free(area);
  return status;
}

START_TEST(matrices_of_one_scene) {
  repeat(1, fill_matrix, 1, "matrices of one scene");
}
END_TEST

static hr2d_status solve_target(const common *c, unsigned kind, uint64_t *digest) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_account account;
  hr2d_prediction prediction;
  hr2d_solution *solution = NULL;
  target.error = kind == 0 ? 1e-2 : 1e-4;
  target.threads = kind == 2 ? 2 : 1;
  target.norm = kind == 2 ? HR2D_NORM_SUP : HR2D_NORM_AVERAGE;
  if (kind == 2) target.error = 1e-1;
  hr2d_status status = hr2d_predict(c->scene, &target, &prediction);
  if (!status) mix_count(digest, prediction.links);
  if (!status) status = hr2d_solve_to(c->scene, &target, &solution, &account);
  if (!status) mix_solution(digest, solution);
  if (!status) mix_number(digest, account.average.bound);
  hr2d_solution_destroy(solution);
  return status;
}

START_TEST(targets_on_one_scene) {
  const int rounds = (int)test_rounds(2, 1);
  for (int k = 0; k < rounds; k++) {
    common c;
    set_up(&c, 1);
    together(&c, solve_target, 3, "targets on one scene");
    tear_down(&c);
  }
}
END_TEST

/* Everything that only reads a solution, its links, its elements and its scene. */
static hr2d_status ask(const common *c, unsigned kind, uint64_t *digest) {
  const hr2d_hierarchy *h = c->hierarchy;
  double t[8], value[8 * BANDS];
  size_t found;
  (void)kind;
  for (int k = 0; k < 8; k++) t[k] = k / 7.;
  for (size_t k = 0; k < hr2d_scene_patches(c->scene); k++) {
    const hr2d_status status = hr2d_solution_gather(c->solution, k, t, 8, value);
    if (status) return status;
    mix(digest, value, sizeof value);
    if (hr2d_scene_find(c->scene, hr2d_scene_name(c->scene, k), &found)) return HR2D_EINVAL;
    mix_count(digest, found);
    mix_number(digest, hr2d_solution_average(c->solution, k, 0));
    mix_number(digest, hr2d_solution_irradiance_at(c->solution, k, .7, 1));
    mix_count(digest, hr2d_hierarchy_leaf(h, k, .4));
  }
  mix_links(digest, c->links[0]);
  mix_solution(digest, c->solution);
  return HR2D_OK;
}

/* Many threads work on one solution. */
static void share_solution(unsigned order, job work, const char *name) {
  common c;
  set_up(&c, order);
  ck_assert_int_eq(hr2d_solve(c.links[0], NULL, &c.solution), HR2D_OK);
  together(&c, work, 1, name);
  tear_down(&c);
}

START_TEST(one_solution) {
  share_solution(3, ask, "one solution");
}
END_TEST

static hr2d_status measure_error(const common *c, unsigned kind, uint64_t *digest) {
  hr2d_error average, sup;
  hr2d_target how = HR2D_TARGET_INIT;
  (void)kind;
  how.error = 1e-2;
  const hr2d_status status = hr2d_solution_error(c->solution, &how, &average, &sup);
  if (!status) mix_number(digest, average.bound);
  if (!status) mix_number(digest, sup.estimate);
  return status;
}

START_TEST(errors_of_one_solution) {
  share_solution(1, measure_error, "errors of one solution");
}
END_TEST

/* Objects that have nothing in common but the code, and jansson's. */
static const char *const text[] = {
    ("{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":"
     "{\"name\":\"room\",\"reflectance\":0.5,\"emission\":0.25},\"geometry\":{\"type\":"
     "\"Polygon\",\"coordinates\":[[[0,0],[2,0],[2,1],[0,1],[0,0]]]}}]}"),
    ("T a room\nC\nV 1 0.0 0.0\nV 2 1.5 0.0\nV 3 1.5 1.25\nS 1 1 2 0 0 0 0.9 floor\n"
     "S 2 2 3 0 0 0 0.5 wall\n*\n"),
    "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":3}]}",
};

static hr2d_status read_text(const common *c, unsigned kind, uint64_t *digest) {
  hr2d_scene *scene = NULL;
  (void)c;
  hr2d_status status = hr2d_scene_create(NULL, &scene);
  if (status) return status;
  const hr2d_status read = hr2d_scene_parse(scene, text[kind], strlen(text[kind]));
  mix_count(digest, (uint64_t)read);
  mix(digest, hr2d_scene_message(scene), strlen(hr2d_scene_message(scene)));
  if (!read) status = hr2d_scene_commit(scene);
  for (size_t k = 0; k < hr2d_scene_patches(scene) && !read; k++) {
    const hr2d_segment at = hr2d_scene_segment(scene, k);
    mix(digest, &at, sizeof at);
  }
  hr2d_scene_destroy(scene);
  return status;
}

/* Exchange areas of hard pairs, around occluders too. */
static hr2d_status exchange(const common *c, unsigned kind, uint64_t *digest) {
  randoms r = {.state = test_seed() + kind};
  const int pairs = (int)test_rounds(40, 1);
  (void)c;
  for (int class = 0; class < occluded_class_count; class ++)
    for (int k = 0; k < pairs; k++) {
      occluded_pair p;
      double area;
      draw_occluded(&occluded_classes[class], &r, &p);
      const hr2d_status status =
          hr2d_exchange_area_occluded(&p.i, &p.j, p.occluder, p.count, NULL, &area);
      if (status) return status;
      mix_number(digest, area);
      mix_number(digest, hr2d_exchange_area(&p.i, &p.j));
      mix_count(digest, (uint64_t)hr2d_orientation(p.i.a, p.i.b, p.j.a));
    }
  return HR2D_OK;
}

START_TEST(nothing_in_common) {
  repeat(1, read_text, 3, "scenes");
  repeat(1, exchange, THREADS, "exchange areas");
}
END_TEST

TEST_SUITE("threads") {
  ADD_TESTS("threads", hierarchies_of_one_scene, sets_of_one_hierarchy, matrices_of_one_scene,
            targets_on_one_scene, one_solution, errors_of_one_solution, nothing_in_common);
}
