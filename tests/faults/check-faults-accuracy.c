/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Allocation k fails in hr2d_solve_to(), hr2d_predict(), hr2d_solution_error(), hr2d_enclose()
   and calls of operators, which choose elements and links themselves. */
#include <string.h>

#include "clusters/clusters.h"
#include "links/linkset-impl.h"
#include "support/fault-stage.h"

static hr2d_status solve_to(fault_stage *s, uint64_t *sum, const hr2d_target *target) {
  hr2d_account account;
  hr2d_solution_destroy(s->result);
  s->result = (hr2d_solution *)s; /* to be overwritten in any case */
  const hr2d_status status = hr2d_solve_to(s->scene, target, &s->result, &account);
  if (status) {
    ck_assert_ptr_null(s->result);
    if (status == HR2D_ENOMEM && *account.reason)
      ck_assert_msg(strstr(account.reason, "memory") || strstr(account.reason, "room"), "%s",
                    account.reason);
    return status;
  }
  ck_assert_str_eq(account.reason, "");
  const uint64_t counts[] = {account.order, account.solves, account.elements, account.leaves,
                             account.links, account.events, account.bytes,    account.kernels};
  *sum = fault_mix(*sum, counts, sizeof counts);
  *sum = fault_mix(*sum, &account.average, sizeof account.average);
  *sum = fault_mix(*sum, &account.sup, sizeof account.sup);
  *sum = fault_mix_count(*sum, fault_solution_sum(s->result));
  return HR2D_OK;
}

static hr2d_status reach(fault_stage *s, uint64_t *sum) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-3;
  target.points = 1;
  return solve_to(s, sum, &target);
}

static hr2d_status reach_everywhere(fault_stage *s, uint64_t *sum) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-2;
  target.norm = HR2D_NORM_SUP;
  return solve_to(s, sum, &target);
}

static hr2d_status reach_some(fault_stage *s, uint64_t *sum) {
  const size_t important[] = {1, 0, 1};
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-3;
  target.important = important;
  target.important_count = 3;
  return solve_to(s, sum, &target);
}

static hr2d_status reach_by_two(fault_stage *s, uint64_t *sum) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-2;
  target.threads = 2;
  return solve_to(s, sum, &target);
}

static hr2d_status reach_roughly(fault_stage *s, uint64_t *sum) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 0.5;
  return solve_to(s, sum, &target);
}

/* The number of allocations varies, because short runs are repeated until their time can be
   measured. */
static hr2d_status predict(fault_stage *s, uint64_t *sum) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_prediction p;
  target.error = 1e-3;
  const hr2d_status status = hr2d_predict(s->scene, &target, &p);
  const uint64_t counts[] = {p.order, p.elements, p.leaves, p.links, p.bytes};
  if (!status) *sum = fault_mix(*sum, counts, sizeof counts);
  return status;
}

static hr2d_status enclose(fault_stage *s, uint64_t *sum) {
  hr2d_enclose_options options = HR2D_ENCLOSE_OPTIONS_INIT;
  hr2d_enclosure *made = (hr2d_enclosure *)s;
  options.gap = 0.2;
  options.max_links = 1000;
  hr2d_enclosure_account a;
  const hr2d_status status = hr2d_enclose(s->scene, &options, &made, &a);
  if (status && status != HR2D_EACCURACY) {
    ck_assert_ptr_null(made);
    return status;
  }
  const uint64_t counts[] = {a.elements, a.leaves, a.links, a.rounds, a.sweeps};
  *sum = fault_mix(*sum, counts, sizeof counts);
  *sum = fault_mix(*sum, &a.gap, sizeof a.gap);
  hr2d_enclosure_destroy(made);
  return HR2D_OK;
}

static hr2d_status measure(fault_stage *s, uint64_t *sum) {
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_error average, sup;
  how.error = 1e-3;
  const hr2d_status status = hr2d_solution_error(s->solution, &how, &average, &sup);
  if (status) return status;
  *sum = fault_mix(fault_mix(*sum, &average, sizeof average), &sup, sizeof sup);
  return HR2D_OK;
}

static hr2d_status mix_operator(hr2d_operator *op, uint64_t *sum) {
  hr2d_account account;
  hr2d_solution *s = NULL;
  double column[64];
  hr2d_gradient gradient = HR2D_GRADIENT_INIT;
  hr2d_status status = hr2d_operator_solve(op, NULL, NULL, &s, &account);
  if (!status) *sum = fault_mix_count(*sum, fault_solution_sum(s));
  if (!status) *sum = fault_mix(*sum, &account.average, sizeof account.average);
  if (!status) status = hr2d_operator_gradient(op, s, NULL, NULL, &gradient);
  if (!status) status = hr2d_operator_response(op, NULL, 0, 1, column);
  if (!status) *sum = fault_mix(*sum, column, sizeof *column);
  hr2d_solution_destroy(s);
  return status;
}

/* All calls of an operator; each of them may fail. */
static hr2d_status operate(fault_stage *s, uint64_t *sum) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 0.1;
  target.max_bytes = 1 << 30; /* no views are kept, for which a call does without memory */
  hr2d_operator *op = (hr2d_operator *)s;
  hr2d_status status = hr2d_operator_create(s->scene, &target, &op, NULL);
  if (status) {
    ck_assert_ptr_null(op);
    return status;
  }
  status = mix_operator(op, sum);
  if (status) ck_assert_str_ne(hr2d_operator_message(op), "");
  hr2d_operator_destroy(op);
  return status;
}

static void play(const char *name, fault_depth depth, fault_plan plan,
                 hr2d_status (*call)(fault_stage *, uint64_t *), int max) {
  const fault_act act = {
      .name = name, .setting = {.depth = depth, .plan = plan}, .call = call, .max = max};
  fault_play(&act);
}

START_TEST(targets) {
  play("solve_to", DEPTH_COMMITTED, PLAN_PAIR, reach, 100);
  play("solve_to, occluded", DEPTH_COMMITTED, PLAN_ROOM, reach, 50);
  play("solve_to, open", DEPTH_COMMITTED, PLAN_OPEN, reach, 50);
  play("solve_to, images", DEPTH_COMMITTED, PLAN_IMAGES, reach, 30);
  play("solve_to, plates", DEPTH_COMMITTED, PLAN_PLATES, reach, 30);
  play("solve_to, at points", DEPTH_COMMITTED, PLAN_ROOM, reach_everywhere, 40);
  play("solve_to, one patch", DEPTH_COMMITTED, PLAN_ROOM, reach_some, 40);
  play("solve_to, heat", DEPTH_COMMITTED, PLAN_HEAT, reach, 100);
  play("solve_to, heat, one patch", DEPTH_COMMITTED, PLAN_HEAT, reach_some, 40);
  play("solve_to, 2 threads", DEPTH_COMMITTED, PLAN_OPEN, reach_by_two, 30);
}
END_TEST

static uint64_t cluster_links(fault_plan plan) {
  fault_stage s;
  uint64_t sum = 0;
  fault_stage_make(&s, &(fault_setting){.depth = DEPTH_COMMITTED, .plan = plan});
  ck_assert_int_eq(reach_roughly(&s, &sum), HR2D_OK);
  const hr2d_linkset *links = hr2d_solution_links(s.result);
  ck_assert_ptr_nonnull(links->roots.clusters);
  const uint64_t count = hr2di_clusters_links(links->roots.clusters);
  fault_stage_end(&s);
  return count;
}

START_TEST(clusters) {
  ck_assert_uint_gt(cluster_links(PLAN_ROWS), 0);
  play("solve_to, clusters", DEPTH_COMMITTED, PLAN_ROWS, reach_roughly, 12);
}
END_TEST

START_TEST(beams) {
  fault_stage s;
  uint64_t sum = 0;
  fault_stage_make(&s, &(fault_setting){.depth = DEPTH_COMMITTED, .plan = PLAN_BLOCKS});
  ck_assert_int_eq(reach_roughly(&s, &sum), HR2D_OK);
  ck_assert_ptr_null(hr2d_solution_links(s.result)->roots.clusters);
  ck_assert_ptr_nonnull(hr2d_solution_links(s.result)->roots.row);
  fault_stage_end(&s);
  play("solve_to, beams", DEPTH_COMMITTED, PLAN_BLOCKS, reach_roughly, 12);
}
END_TEST

START_TEST(predictions) {
  play("predict", DEPTH_COMMITTED, PLAN_ROOM, predict, 10);
  play("predict, heat", DEPTH_COMMITTED, PLAN_HEAT, predict, 10);
  play("solution_error", DEPTH_SOLVED, PLAN_PAIR, measure, 40);
  play("solution_error, occluded", DEPTH_SOLVED, PLAN_ROOM, measure, 20);
}
END_TEST

START_TEST(enclosures) {
  play("enclose", DEPTH_COMMITTED, PLAN_PAIR, enclose, 40);
  play("enclose, occluded", DEPTH_COMMITTED, PLAN_ROOM, enclose, 40);
  play("enclose, open", DEPTH_COMMITTED, PLAN_OPEN, enclose, 40);
}
END_TEST

START_TEST(operators) {
  play("operator", DEPTH_COMMITTED, PLAN_PAIR, operate, 60);
  play("operator, occluded", DEPTH_COMMITTED, PLAN_ROOM, operate, 40);
  play("operator, images", DEPTH_COMMITTED, PLAN_IMAGES, operate, 30);
}
END_TEST

TEST_SUITE("faults of targets") {
  ADD_TESTS("memory", targets, clusters, beams, predictions, enclosures, operators);
}
