/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Links of clusters and the error of a round room with one short lamp, which is dark but for
   the lamp: against exchange areas of all pairs of pieces, by crossed strings. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/strategy.h"
#include "accuracy/target.h"
#include "estimate/error-estimate.h"
#include "links/linkset-impl.h"
#include "support/support.h"

#define PI 3.14159265358979323846

enum { PATCHES = 600, PIECES = 2, ALL = PATCHES * PIECES, ITERATIONS = 60 };

/* Of all patches; the first one is the lamp, with E = 1. */
#define RHO 0.5

static hr2d_point corner(int k) {
  const double angle = 2 * PI * (k % PATCHES) / PATCHES;
  return (hr2d_point){cos(angle), sin(angle)};
}

/* Patches along a square, one of which shines into a corner. */
static hr2d_point on_square(int k) {
  const int side = PATCHES / 4;
  const double at = (double)(k % side) / side;
  const hr2d_point place[] = {{at, 0}, {1, at}, {1 - at, 1}, {0, 1 - at}};
  return place[k / side % 4];
}

static hr2d_scene *room(hr2d_point (*vertex)(int k)) {
  double(*patch)[6] = malloc(PATCHES * sizeof *patch);
  ck_assert_ptr_nonnull(patch);
  for (int k = 0; k < PATCHES; k++) {
    const hr2d_point a = vertex(k), b = vertex(k + 1);
    const double row[6] = {a.x, a.y, b.x, b.y, k == 0, RHO};
    for (int m = 0; m < 6; m++) patch[k][m] = row[m];
  }
  hr2d_scene *scene = test_scene((const double(*)[6])patch, PATCHES);
  free(patch);
  return scene;
}

/* A piece of a patch, with so many pieces on each. */
static hr2d_segment piece(int k, int pieces) {
  const hr2d_point a = corner(k / pieces), b = corner(k / pieces + 1);
  const double from = (double)(k % pieces) / pieces, to = (double)(k % pieces + 1) / pieces;
  return (hr2d_segment){{a.x + from * (b.x - a.x), a.y + from * (b.y - a.y)},
                        {a.x + to * (b.x - a.x), a.y + to * (b.y - a.y)}};
}

static double between(hr2d_point p, hr2d_point q) {
  return hypot(p.x - q.x, p.y - q.y);
}

static double strings(hr2d_segment s, hr2d_segment t) {
  return 0.5 * (between(s.a, t.a) + between(s.b, t.b) - between(s.a, t.b) - between(s.b, t.a));
}

/* Averages of B and H of patches with constants on pieces: fixed-point iteration. */
static void solve_pieces(int pieces, double *b, double *h) {
  const int n = PATCHES * pieces;
  double *factor = calloc((size_t)n * n, sizeof *factor), *value = calloc(2 * n, sizeof *value);
  ck_assert(factor && value);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      if (i / pieces != j / pieces) {
        const hr2d_segment s = piece(i, pieces), t = piece(j, pieces);
        factor[i * n + j] = fabs(strings(s, t)) / between(s.a, s.b);
      }
  for (int step = 0; step < ITERATIONS; step++) {
    for (int i = 0; i < n; i++) {
      double sum = 0;
      for (int j = 0; j < n; j++) sum += factor[i * n + j] * value[j];
      value[n + i] = sum;
    }
    for (int i = 0; i < n; i++) value[i] = (i < pieces) + RHO * value[n + i];
  }
  for (int k = 0; k < PATCHES; k++) {
    b[k] = h[k] = 0;
    for (int m = 0; m < pieces; m++) {
      b[k] += value[k * pieces + m] / pieces;
      h[k] += value[n + k * pieces + m] / pieces;
    }
  }
  free(factor);
  free(value);
}

/* What pieces of whole patches are off by is four times as much as for halves. */
static void reference(double b[PATCHES], double h[PATCHES]) {
  double coarse_b[PATCHES], coarse_h[PATCHES];
  solve_pieces(1, coarse_b, coarse_h);
  solve_pieces(PIECES, b, h);
  for (int k = 0; k < PATCHES; k++) {
    ck_assert_double_le(fabs(b[k] - coarse_b[k]), 1e-4 * b[k]);
    ck_assert_double_le(fabs(h[k] - coarse_h[k]), 1e-4 * h[k]);
  }
}

typedef struct trial {
  hr2d_target target;
  hr2di_resolution fineness;
  hr2di_graded answer;
  hr2di_error_pair errors;
} trial;

/* One graded solve for a target, with links of clusters of this accuracy, judged by an aim. */
static void try_accuracy(const hr2d_scene *scene, double target, double accuracy, double aim,
                         trial *t) {
  const hr2d_target given = {.struct_size = sizeof given, .error = target};
  hr2di_survey survey;
  hr2di_message message = {.text = ""};
  ck_assert_int_eq(hr2di_target_init(&t->target, scene, &given, target), HR2D_OK);
  ck_assert_int_eq(hr2di_strategy_survey(scene, NULL, 1, NULL, &survey), HR2D_OK);
  t->fineness = hr2di_strategy_for(scene, &survey, target, &t->target, NULL);
  t->fineness.cluster_accuracy = accuracy;
  t->fineness.aim = aim;
  ck_assert_int_eq(hr2di_graded_refine(&t->answer, scene, &t->fineness, &t->target, &message),
                   HR2D_OK);
  ck_assert_ptr_nonnull(t->answer.links->roots.clusters);
  ck_assert_uint_gt(hr2di_clusters_links(t->answer.links->roots.clusters), 0);
  ck_assert_int_eq(hr2di_graded_solve(&t->answer, &t->fineness, &t->target, &message), HR2D_OK);
  ck_assert_int_eq(
      hr2di_error_estimate(&t->answer, &t->fineness, &t->target, &t->errors, &message),
      HR2D_OK);
}

static void clear(trial *t, const hr2d_scene *scene) {
  hr2di_graded_clear(&t->answer);
  hr2di_target_clear(&t->target, &scene->alloc);
}

/* The lamp's H is a thousandth of its B: what clusters lack of its row must not be a part of
   that B. */
START_TEST(inaccurate_clusters_are_no_light) {
  static double b[PATCHES], h[PATCHES];
  hr2d_scene *scene = room(corner);
  trial t;
  double worst = 0, lamp;
  reference(b, h);
  try_accuracy(scene, 1e-1, 1e-2, 1e-1, &t);
  for (int k = 0; k < PATCHES; k++) {
    worst = fmax(worst, fabs(hr2d_solution_average(t.answer.solution, k, 0) / b[k] - 1));
    const double off = fabs(hr2d_solution_irradiance(t.answer.solution, k, 0) / h[k] - 1);
    worst = fmax(worst, off);
    if (k == 0) lamp = off;
  }
  ck_assert_double_le(lamp, 0.02);
  ck_assert_double_le(worst, fmax(t.errors.average.bound, t.errors.irradiance.bound));
  /* As much of the row of the lamp is lacking as would be most of its H. */
  ck_assert_double_le(h[0], 0.01 * b[0]);
  clear(&t, scene);
  hr2d_scene_destroy(scene);
}
END_TEST

/* They are blamed for their part of an error, and of one that others make they are not. */
START_TEST(clusters_are_blamed_for_their_part) {
  hr2d_scene *scene = room(corner), *square = room(on_square);
  trial coarse, fine;
  try_accuracy(scene, 1e-6, 1e-2, 1e-6, &coarse);
  const double all = coarse.errors.average.estimate, part = coarse.answer.clustered;
  ck_assert_double_gt(all, 1e-6);
  ck_assert_double_le(fabs(part - all), 0.5 * all);
  hr2di_resolution raised = coarse.fineness;
  ck_assert_int_eq(hr2di_strategy_raise_clusters(&raised, part, 1e-6), 0);
  ck_assert_double_lt(raised.cluster_accuracy, 1e-2 * 1e-6 / part);
  ck_assert_uint_eq(raised.order, coarse.fineness.order);
  ck_assert_uint_eq(raised.corner_levels, coarse.fineness.corner_levels);
  /* Elements of few coefficients, with clusters for many digits. */
  try_accuracy(square, 1e-1, 1e-9, 1e-7, &fine);
  ck_assert_double_gt(fine.errors.average.estimate, 1e-7);
  ck_assert_double_gt(fine.answer.clustered, 0);
  ck_assert_double_le(fine.answer.clustered, 0.1 * fine.errors.average.estimate);
  clear(&coarse, scene);
  clear(&fine, square);
  hr2d_scene_destroy(square);
  hr2d_scene_destroy(scene);
}
END_TEST

/* One attempt is enough, and the errors hold. */
START_TEST(a_round_room_is_solved_at_once) {
  static double b[PATCHES], h[PATCHES];
  hr2d_scene *scene = room(corner);
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution;
  hr2d_account account;
  target.error = 1e-3;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_OK);
  ck_assert_uint_eq(account.solves, 1);
  reference(b, h);
  for (int k = 0; k < PATCHES; k++) {
    ck_assert_double_le(fabs(hr2d_solution_average(solution, k, 0) / b[k] - 1), 1e-3);
    ck_assert_double_le(fabs(hr2d_solution_irradiance(solution, k, 0) / h[k] - 1), 1e-3);
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}
END_TEST

/* What a callback reads of an answer that is judged. */
typedef struct reading {
  const hr2di_graded *answer;
  unsigned order;
  hr2di_roots roots;
  uint64_t links;
  hr2d_refine_counts counts;
  int calls;
} reading;

static reading read_answer(const hr2di_graded *answer) {
  return (reading){.answer = answer,
                   .order = hr2d_hierarchy_order(answer->hierarchy),
                   .roots = answer->links->roots,
                   .links = hr2d_linkset_size(answer->links),
                   .counts = hr2d_linkset_counts(answer->links)};
}

static hr2d_status read_again(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  reading *before = ctx;
  const reading now = read_answer(before->answer);
  ck_assert_uint_eq(now.order, before->order);
  ck_assert_uint_eq(now.links, before->links);
  ck_assert(now.roots.clusters == before->roots.clusters);
  ck_assert(now.roots.accuracy == before->roots.accuracy);
  ck_assert_int_eq(memcmp(&now.counts, &before->counts, sizeof now.counts), 0);
  before->calls++;
  return HR2D_OK;
}

/* The finer operator is another one: the answer is as it was made all the while. */
START_TEST(an_answer_is_judged_as_it_is) {
  hr2d_scene *scene = room(corner);
  hr2di_message message = {.text = ""};
  trial t;
  try_accuracy(scene, 1e-1, 1e-2, 1e-1, &t);
  reading before = read_answer(&t.answer);
  t.target.progress = read_again;
  t.target.progress_ctx = &before;
  ck_assert_int_eq(hr2di_error_estimate(&t.answer, &t.fineness, &t.target, &t.errors, &message),
                   HR2D_OK);
  ck_assert_int_gt(before.calls, 0);
  clear(&t, scene);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("cluster residuals") {
  ADD_TESTS("cluster residuals", inaccurate_clusters_are_no_light,
            clusters_are_blamed_for_their_part, an_answer_is_judged_as_it_is,
            a_round_room_is_solved_at_once);
}
