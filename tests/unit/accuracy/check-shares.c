/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves by several shares, each in a thread: no bit depends on their number; elements, links
   and oracle calls are those without shares, and B, H and errors differ by roundings.  Each
   share has its part of the links, and parts are even. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/shares.h"
#include "support/slow-scenes.h"
#include "support/support.h"
#include "support/symmetric-scenes.h"

enum { MOST_VALUES = 4000 };

/* What a solve has found. */
typedef struct found {
  hr2d_status status;
  size_t values;
  double average[MOST_VALUES], irradiance[MOST_VALUES];
  double error[8]; /* estimates and bounds of the account */
  hr2d_power power;
  double cut_off; /* of it */
  uint64_t elements, leaves, links, calls, tests, own_links, own_tests, solves;
} found;

typedef struct kind {
  const char *name;
  const char *file; /* of examples/scenes; NULL: a slow scene */
  slow_kind slow;
  size_t patches;
  double error; /* of a target; 0: a solve by ε */
  double epsilon, from;
  unsigned order;
  double plates; /* their distance; 0: other scenes */
  int fibres;    /* in a room of four walls; 0: other scenes */
  int bare;      /* without errors at points */
  int ordered, no_closure, sup, heated, even_tests;
  symmetric_kind symmetric;
  uint64_t solves; /* at least */
  const hr2d_oracle *(*oracle)(void);
} kind;

static const kind kinds[] = {
    {"lit room", "lit-room.geojson", .error = 1e-5},
    {"partition", "partition.geojson", .error = 1e-3},
    {"partition, points", "partition.geojson", .error = 1e-2, .sup = 1},
    {"partition, averages", "partition.geojson", .error = 1e-3, .bare = 1},
    {"panels", "solar-panels.geojson", .error = 1e-4},
    {"squares", NULL, SLOW_SQUARES, 300, .error = 1e-1},
    {"divided squares", NULL, SLOW_SQUARES, 560, .error = 1e-3, .solves = 2},
    {"round", NULL, SLOW_ROUND, 300, .error = 1e-6},
    {"city", NULL, SLOW_CITY, 60, .error = 1e-2},
    {"room of order 1", "lit-room.geojson", .epsilon = 0.2, .order = 1},
    {"room of order 4", "lit-room.geojson", .epsilon = 0.3, .order = 4},
    {"room in steps", "lit-room.geojson", .epsilon = 0.1, .from = 0.8, .order = 3},
    {"partition of order 3", "partition.geojson", .epsilon = 0.4, .order = 3},
    {"directed", "lit-room.geojson", .epsilon = 0.3, .order = 2, .ordered = 1},
    {"directed, order 1", "partition.geojson", .epsilon = 0.4, .order = 1, .ordered = 1},
    {"no closure", "solar-panels.geojson", .epsilon = 0.3, .order = 3, .no_closure = 1},
    {"l1", "lit-room.geojson", .epsilon = 1e-3, .order = 2, .oracle = hr2d_oracle_l1},
    {"panels of order 1", "solar-panels.geojson", .epsilon = 0.3, .order = 1},
    {"temperatures", NULL, .heated = 1, .error = 1e-3},
    {"temperatures of order 1", NULL, .heated = 1, .epsilon = 0.3, .order = 1},
    {"temperatures of order 3", NULL, .heated = 1, .epsilon = 0.4, .order = 3},
    {"city of order 2", NULL, SLOW_CITY, 60, .epsilon = 0.5, .order = 2},
    {"half", .symmetric = SYMMETRIC_HALF, .error = 1e-4},
    {"half, points", .symmetric = SYMMETRIC_HALF, .error = 1e-2, .sup = 1},
    {"half of order 1", .symmetric = SYMMETRIC_HALF, .epsilon = 0.2, .order = 1},
    {"half of order 3", .symmetric = SYMMETRIC_HALF, .epsilon = 0.3, .order = 3},
    {"half in steps", .symmetric = SYMMETRIC_HALF, .epsilon = 0.1, .from = 0.4, .order = 2},
    {"half, directed", .symmetric = SYMMETRIC_HALF, .epsilon = 0.3, .order = 1, .ordered = 1},
    {"oblique half", .symmetric = SYMMETRIC_OBLIQUE, .error = 1e-3},
    {"quarter", .symmetric = SYMMETRIC_QUARTER, .error = 1e-2},
    {"quarter of order 1", .symmetric = SYMMETRIC_QUARTER, .epsilon = 0.3, .order = 1},
    {"quarter of order 2", .symmetric = SYMMETRIC_QUARTER, .epsilon = 0.5, .order = 2},
    {"plates", .symmetric = SYMMETRIC_PLATES, .error = 1e-6},
    {"plates of order 1", .symmetric = SYMMETRIC_PLATES, .epsilon = 0.3, .order = 1},
    {"plates of order 4", .symmetric = SYMMETRIC_PLATES, .epsilon = 0.5, .order = 4},
    {"streets", .symmetric = SYMMETRIC_STREETS, .error = 1e-5},
    {"streets of order 1", .symmetric = SYMMETRIC_STREETS, .epsilon = 0.3, .order = 1},
    {"panels", .symmetric = SYMMETRIC_PANELS, .error = 1e-3},
    {"panels of order 1", .symmetric = SYMMETRIC_PANELS, .epsilon = 0.3, .order = 1},
    {"panels of order 2", .symmetric = SYMMETRIC_PANELS, .epsilon = 0.5, .order = 2},
    {"hall", .symmetric = SYMMETRIC_HALL, .error = 1e-3},
    {"row", .symmetric = SYMMETRIC_ROW, .epsilon = 1, .order = 2},
    {"sun and sky", .symmetric = SYMMETRIC_SUNNY, .error = 1e-3},
    {"furnace", .symmetric = SYMMETRIC_HEATED, .error = 1e-3},
    {"greenhouse", "greenhouse.geojson", .error = 1e-5},
    {"greenhouse of order 1", "greenhouse.geojson", .epsilon = 0.2, .order = 1},
    {"shields of order 2", "radiation-shields.geojson", .epsilon = 0.3, .order = 2},
};

enum { KINDS = sizeof kinds / sizeof *kinds };

static hr2d_status add_plates(hr2d_scene *scene, double apart) {
  const hr2d_segment one = {{0, 0}, {1, 0}}, other = {{1, apart}, {0, apart}};
  const hr2d_status status = test_add_patch(scene, one, 1, .5, HR2D_SIDES_FRONT);
  return status ? status : test_add_patch(scene, other, 0, .5, HR2D_SIDES_FRONT);
}

/* Fibres of 16 sides, each in a cell of its own. */
static hr2d_status add_fibres(hr2d_scene *scene, int fibres) {
  const double pi = 3.14159265358979323846, far = ceil(sqrt(fibres)) + .5;
  const hr2d_point corner[] = {{-.5, -.5}, {far, -.5}, {far, far}, {-.5, far}};
  const int side = (int)ceil(sqrt(fibres));
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 4 && !status; k++)
    status = test_add_patch(scene, (hr2d_segment){corner[k], corner[(k + 1) % 4]}, k == 0, .5,
                            HR2D_SIDES_FRONT);
  for (int k = 0; k < 16 * fibres && !status; k++) {
    const int f = k / 16;
    const double x = f % side + .1 * (f % 3), y = f / side + .1 * (f % 4),
                 r = .1 + .03 * (f % 5);
    const double from = -2 * pi * (k % 16) / 16 + f, to = -2 * pi * ((k + 1) % 16) / 16 + f;
    const hr2d_segment s = {{x + r * cos(from), y + r * sin(from)},
                            {x + r * cos(to), y + r * sin(to)}};
    status = test_add_patch(scene, s, 0, .5, HR2D_SIDES_FRONT);
  }
  return status;
}

static hr2d_scene *make(const kind *k) {
  if (k->file) return test_shipped_scene(k->file);
  hr2d_scene *scene = test_new_scene(NULL);
  const hr2d_status status = k->plates > 0   ? add_plates(scene, k->plates)
                             : k->fibres > 0 ? add_fibres(scene, k->fibres)
                             : k->symmetric  ? symmetric_add(scene, k->symmetric)
                             : k->heated     ? slow_add_heated(scene)
                                             : slow_add(scene, k->slow, k->patches);
  ck_assert_int_eq(status, HR2D_OK);
  test_commit(scene);
  return scene;
}

static void read_solution(const hr2d_scene *scene, const hr2d_solution *solution, found *f) {
  const size_t bands = hr2d_scene_bands(scene);
  f->values = hr2d_scene_patches(scene) * bands;
  ck_assert_uint_le(f->values, MOST_VALUES);
  for (size_t k = 0; k < f->values; k++) {
    f->average[k] = hr2d_solution_average(solution, k / bands, k % bands);
    f->irradiance[k] = hr2d_solution_irradiance(solution, k / bands, k % bands);
  }
  f->power = hr2d_solution_power(solution, 0);
  f->cut_off = hr2d_solution_power_cut_off(solution, 0);
  const hr2d_linkset *links = hr2d_solution_links(solution);
  const hr2d_refine_counts counts = hr2d_linkset_counts(links);
  f->links = counts.links;
  f->calls = counts.oracle_calls;
  f->tests = counts.visibility_tests;
  f->own_links = hr2d_linkset_size(links);
  f->own_tests = hr2d_linkset_own_tests(links);
}

static void solve_to(const kind *k, const hr2d_scene *scene, hr2d_share *share, found *f) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  hr2d_account a;
  target.error = k->error;
  target.share = share;
  target.points = !k->bare;
  if (k->sup) target.norm = HR2D_NORM_SUP;
  f->status = hr2d_solve_to(scene, &target, &solution, &a);
  if (!solution) return;
  read_solution(scene, solution, f);
  const double error[] = {a.average.estimate,
                          a.average.bound,
                          a.sup.estimate,
                          a.sup.bound,
                          a.irradiance.estimate,
                          a.irradiance.bound,
                          a.irradiance_sup.estimate,
                          a.irradiance_sup.bound};
  memcpy(f->error, error, sizeof error);
  f->elements = a.elements;
  f->leaves = a.leaves;
  f->solves = a.solves;
  hr2d_solution_destroy(solution);
}

static hr2d_status refine(const kind *k, hr2d_linkset *links, hr2d_share *share) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_status status = HR2D_OK;
  options.ordered = k->ordered;
  options.max_level = 6;
  options.share = share;
  options.packed = k->ordered;
  options.epsilon = k->from > 0 ? k->from : k->epsilon;
  for (;; options.epsilon = fmax(0.5 * options.epsilon, k->epsilon)) {
    status = hr2d_refine(links, &options);
    if (status || options.epsilon <= k->epsilon) return status;
  }
}

static void solve_by(const kind *k, const hr2d_scene *scene, hr2d_share *share, found *f) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_hierarchy *h = NULL;
  hr2d_linkset *links = NULL;
  hr2d_solution *solution = NULL;
  if (k->no_closure) options.closure = HR2D_CLOSURE_OFF;
  f->status = hr2d_hierarchy_create(scene, &h);
  if (!f->status)
    f->status =
        hr2d_linkset_create(h, k->oracle ? k->oracle() : NULL, NULL, NULL, NULL, &links);
  if (!f->status) f->status = refine(k, links, share);
  if (!f->status) f->status = hr2d_hierarchy_set_order(h, k->order);
  if (!f->status) f->status = hr2d_solve(links, &options, &solution);
  if (solution) read_solution(scene, solution, f);
  f->elements = hr2d_hierarchy_count(h).elements;
  f->leaves = hr2d_hierarchy_count(h).leaves;
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(h);
}

static void solve(const kind *k, const hr2d_scene *scene, hr2d_share *share, found *f) {
  memset(f, 0, sizeof *f);
  (k->error > 0 ? solve_to : solve_by)(k, scene, share, f);
}

typedef struct job {
  const kind *kind;
  const hr2d_scene *scene;
  found *found; /* of each share */
} job;

static void work(hr2d_share *share, void *ctx) {
  job *j = ctx;
  solve(j->kind, j->scene, share, &j->found[share->number]);
}

static double largest(const double *value, size_t count) {
  double max = 0;
  for (size_t k = 0; k < count; k++) max = fmax(max, fabs(value[k]));
  return max;
}

static void compare_with_one(const kind *k, const found *f, const found *one) {
  ck_assert_int_eq(f->status, one->status);
  ck_assert_uint_eq(f->elements, one->elements);
  ck_assert_uint_eq(f->leaves, one->leaves);
  ck_assert_uint_eq(f->links, one->links);
  ck_assert_uint_eq(f->calls, one->calls);
  if (k->from == 0) ck_assert_uint_eq(f->tests, one->tests);
  ck_assert_double_eq_tol(f->cut_off, one->cut_off, 1e-6 * one->cut_off + 1e-13);
  const double b = largest(one->average, one->values);
  const double h = largest(one->irradiance, one->values);
  for (size_t m = 0; m < one->values; m++) {
    ck_assert_double_eq_tol(f->average[m], one->average[m], 1e-12 * b);
    ck_assert_double_eq_tol(f->irradiance[m], one->irradiance[m], 1e-12 * h);
  }
  for (int m = 0; m < 8; m++) {
    const int measured = !k->bare || m % 4 < 2;
    ck_assert_int_eq(isnan(f->error[m]), !measured);
    ck_assert_int_eq(isnan(one->error[m]), !measured);
    if (measured)
      ck_assert_double_eq_tol(f->error[m], one->error[m], 1e-6 * one->error[m] + 1e-13);
  }
}

static void expect_plates(const found *f) {
  double answer[2];
  symmetric_plates_answer(answer);
  for (int k = 0; k < 2; k++)
    ck_assert_double_eq_tol(f->average[k], answer[k], 1e-6 * answer[k]);
}

/* The links of a share are not counted here: they are its own.  Which line classes a further
   refinement cuts in one go depends on the links that stand side by side. */
static int same_bits(const kind *k, const found *f, const found *g) {
  found copy = *g;
  copy.own_links = f->own_links;
  copy.own_tests = f->own_tests;
  if (k->from > 0) copy.tests = f->tests;
  return !memcmp(f, &copy, sizeof copy);
}

START_TEST(no_bit_depends_on_shares) {
  const kind *k = &kinds[_i];
  hr2d_scene *scene = make(k);
  found *one = calloc(1 + SHARES_MOST, sizeof *one), *of = one + 1;
  found first = {0};
  ck_assert_ptr_nonnull(one);
  solve(k, scene, NULL, one);
  ck_assert_uint_ge(one->solves, k->solves);
  for (unsigned count = 1; count <= 4; count++) {
    job j = {k, scene, of};
    uint64_t links = 0;
    if (!test_meets((size_t)_i, count, 4)) continue;
    shares_run(count, work, &j);
    if (!first.values) first = of[0];
    for (unsigned m = 0; m < count; m++) {
      ck_assert_msg(same_bits(k, &of[m], &first), "%s: other bits on share %u of %u", k->name,
                    m, count);
      links += of[m].own_links;
    }
    ck_assert_uint_eq(links, one->own_links);
  }
  compare_with_one(k, &first, one);
  if (k->symmetric == SYMMETRIC_PLATES) expect_plates(&first);
  printf("%s: %llu elements, %llu links, %llu solves\n", k->name,
         (unsigned long long)one->elements, (unsigned long long)one->links,
         (unsigned long long)one->solves);
  free(one);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Links to be shared out to a target: few long rows, many short ones, both.  With a hundred
   patches and less, looks round from the same ones are most of the tests. */
static const kind even_kinds[] = {
    {"near plates", .plates = 1e-6, .error = 1e-8},
    {"squares in a room", NULL, SLOW_SQUARES, 240, .error = 1e-1, .even_tests = 1},
    {"fibres in a room", .fibres = 16, .error = 1e-1, .even_tests = 1},
    {"round room", NULL, SLOW_ROUND, 100, .error = 1e-4},
    {"soup in a room", NULL, SLOW_SOUP, 100, .error = 1e-1},
    {"city", NULL, SLOW_CITY, 250, .error = 1e-2, .even_tests = 1},
    {"quarter", .symmetric = SYMMETRIC_QUARTER, .error = 1e-3},
    {"temperatures", NULL, .heated = 1, .error = 1e-6},
};

enum { EVEN_KINDS = sizeof even_kinds / sizeof *even_kinds };

/* The largest number of some shares, and all of them together. */
typedef struct spread {
  double max, all;
} spread;

static void spread_add(spread *s, uint64_t number) {
  s->max = fmax(s->max, (double)number);
  s->all += (double)number;
}

static void check_spread(const kind *k, const found *of, unsigned count) {
  spread links = {0, 0}, tests = {0, 0};
  for (unsigned m = 0; m < count; m++) {
    spread_add(&links, of[m].own_links);
    spread_add(&tests, of[m].own_tests);
  }
  ck_assert_double_eq(links.all, (double)of[0].links);
  const double even = links.max * count / links.all, one = fmax(1, (double)of[0].tests);
  printf("%s: %.0f links, the most of %u shares %.3f times the mean; %.0f tests, %.3f times, "
         "%.3f together\n",
         k->name, links.all, count, even, (double)of[0].tests, tests.max * count / one,
         tests.all / one);
  ck_assert_double_ge(links.all, 100);
  ck_assert_msg(even <= 1.15, "%s: %g of the mean on one of %u shares", k->name, even, count);
  ck_assert_msg(!k->even_tests || tests.max * count <= 1.3 * one,
                "%s: one of %u shares has %g tests, and one process %g", k->name, count,
                tests.max, one);
}

START_TEST(links_are_shared_out_evenly) {
  const kind *k = &even_kinds[_i];
  hr2d_scene *scene = make(k);
  found *of = calloc(SHARES_MOST, sizeof *of);
  ck_assert_ptr_nonnull(of);
  for (unsigned count = 8; count <= SHARES_MOST; count *= 2) {
    job j = {k, scene, of};
    if (!test_meets((size_t)_i, count / 8, 2)) continue;
    shares_run(count, work, &j);
    check_spread(k, of, count);
  }
  free(of);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("shares") {
  REPEAT_TESTS(EVEN_KINDS, "even", links_are_shared_out_evenly);
  REPEAT_TESTS(KINDS, "bits", no_bit_depends_on_shares);
}
