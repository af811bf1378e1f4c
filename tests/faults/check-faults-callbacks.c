/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Callbacks that fail, stop, write nonsense or nothing, or call the library.  The call
   returns the status of the callback, its objects are unchanged, and the same call then
   gives the same bits. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "support/fault-calls.h"

/* The behaviour of the callbacks of one kind. */
typedef struct puppet {
  long calls, at;   /* calls so far, and the number of the call that fails; −1: none fails */
  hr2d_status says; /* then */
  void (*does)(const fault_stage *s); /* at every call */
  const fault_stage *stage;
  int nested; /* calls of `does` */
} puppet;

static puppet on_progress, on_estimate, on_accept, on_acceptable, on_limit, on_split, on_visit;

static hr2d_status play(puppet *p) {
  const long number = p->calls++;
  if (p->does) {
    p->does(p->stage);
    p->nested++;
  }
  return number == p->at ? p->says : HR2D_OK;
}

static void rest(void) {
  on_progress = on_estimate = on_accept = on_acceptable = on_limit = on_split = on_visit =
      (puppet){.at = -1};
}

static hr2d_status report(void *ctx, const hr2d_progress *progress) {
  (void)ctx;
  ck_assert_str_ne(progress->phase, "");
  ck_assert(progress->fraction >= 0 && progress->fraction <= 1);
  return play(&on_progress);
}

static hr2d_status seen(void *ctx, const hr2d_link *links, size_t count) {
  *(uint64_t *)ctx = fault_mix(*(uint64_t *)ctx, links, count * sizeof *links);
  return play(&on_visit);
}

/* Writes errors and decisions in place of the correct ones; NULL: the correct ones are
   written. */
static void (*write_error)(double *error, size_t count);
static void (*write_byte)(unsigned char *byte, size_t count);

static hr2d_status estimate(void *ctx, const hr2d_batch *batch, double *error) {
  if (write_error)
    write_error(error, batch->count);
  else
    hr2d_oracle_size()->estimate(ctx, batch, error);
  return play(&on_estimate);
}

static hr2d_status accept(void *ctx, const hr2d_batch *batch, double epsilon,
                          unsigned char *accepted) {
  if (write_byte)
    write_byte(accepted, batch->count);
  else
    hr2d_oracle_size()->accept(ctx, batch, epsilon, accepted);
  return play(&on_accept);
}

static hr2d_status acceptable(void *ctx, const hr2d_batch *batch, const double *error,
                              unsigned char *accepted) {
  (void)ctx;
  if (write_byte)
    write_byte(accepted, batch->count);
  else
    for (size_t k = 0; k < batch->count; k++) accepted[k] = error[k] <= batch->epsilon;
  return play(&on_acceptable);
}

static hr2d_status limit(void *ctx, const hr2d_batch *batch, unsigned char *limited) {
  (void)ctx;
  if (write_byte)
    write_byte(limited, batch->count);
  else
    memset(limited, 0, batch->count);
  return play(&on_limit);
}

static hr2d_status divide(void *ctx, const hr2d_batch *batch, unsigned char *split) {
  if (write_byte)
    write_byte(split, batch->count);
  else
    hr2d_policy_original()->preferred_subdivision(ctx, batch, split);
  return play(&on_split);
}

static const hr2d_oracle slow_oracle = {sizeof slow_oracle, "slow", HR2D_ORACLE_SYMMETRIC,
                                        estimate,           NULL,   NULL};
static const hr2d_oracle fast_oracle = {sizeof fast_oracle, "fast", HR2D_ORACLE_SYMMETRIC,
                                        estimate,           accept, NULL};
static const hr2d_policy plain_policy = {
    sizeof plain_policy, "plain", 0, NULL, limit, divide, NULL};
static const hr2d_policy full_policy = {
    sizeof full_policy, "full", 0, acceptable, limit, divide, NULL};

static hr2d_refine_options fine(double epsilon, unsigned threads) {
  hr2d_refine_options o = HR2D_REFINE_OPTIONS_INIT;
  o.epsilon = epsilon;
  o.max_level = 8;
  o.threads = threads;
  o.progress = report;
  return o;
}

static hr2d_status refine(fault_stage *s, uint64_t *sum) {
  const hr2d_refine_options o = fine(0.02, 1);
  return fault_mix_stage(s, sum, hr2d_refine(s->links, &o));
}

static hr2d_status count(fault_stage *s, uint64_t *sum) {
  const hr2d_refine_options o = fine(0.02, 1);
  return fault_count(s, sum, &o);
}

static hr2d_status half(void *ctx, const hr2d_batch *batch, unsigned char *claimed) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++)
    claimed[k] = batch->elements[batch->pairs[k].first].patch != 1;
  return HR2D_OK;
}

static hr2d_status count_some(fault_stage *s, uint64_t *sum) {
  hr2d_row_counts row[64];
  hr2d_refine_options o = fine(0.02, 1);
  o.row_from = 1;
  o.claim = half;
  o.row_counts = row;
  return fault_count(s, sum, &o);
}

static hr2d_status count_by_three(fault_stage *s, uint64_t *sum) {
  hr2d_refine_options o = fine(0.005, 3);
  o.max_level = 9;
  return fault_count(s, sum, &o);
}

static hr2d_status visit(fault_stage *s, uint64_t *sum) {
  const hr2d_refine_options o = fine(0.02, 1);
  hr2d_refine_counts counts;
  return fault_mix_stage(s, sum, hr2d_refine_visit(s->links, &o, seen, sum, &counts));
}

static hr2d_status study(fault_stage *s, uint64_t *sum) {
  static const double epsilon[] = {0.3, 0.02};
  const hr2d_refine_options o = fine(1, 1);
  return fault_study(s, sum, &o, epsilon, 2);
}

static hr2d_status solve(fault_stage *s, uint64_t *sum) {
  hr2d_solve_options how = HR2D_SOLVE_OPTIONS_INIT;
  how.progress = report;
  return fault_solve(s, sum, &how);
}

static hr2d_status matrix_on(fault_stage *s, uint64_t *sum, unsigned threads) {
  hr2d_matrix_options how = HR2D_MATRIX_OPTIONS_INIT;
  how.threads = threads;
  how.progress = report;
  return fault_matrix(s, sum, &how);
}

static hr2d_status matrix(fault_stage *s, uint64_t *sum) {
  return matrix_on(s, sum, 1);
}

static hr2d_status matrix_by_three(fault_stage *s, uint64_t *sum) {
  return matrix_on(s, sum, 3);
}

#define ALL SIZE_MAX

/* The average of one patch, or of all. */
static hr2d_status reach_as(fault_stage *s, uint64_t *sum, size_t important, double budget) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-4;
  target.important = &important;
  target.important_count = important != ALL;
  target.progress = report;
  target.seconds = budget;
  hr2d_solution_destroy(s->result);
  s->result = NULL;
  const hr2d_status status = hr2d_solve_to(s->scene, &target, &s->result, NULL);
  if (!status) *sum = fault_mix_count(*sum, fault_solution_sum(s->result));
  return status;
}

static hr2d_status reach(fault_stage *s, uint64_t *sum) {
  return reach_as(s, sum, ALL, 0);
}

static hr2d_status reach_one(fault_stage *s, uint64_t *sum) {
  return reach_as(s, sum, 1, 0);
}

/* A budget that is far from spent: answers of falling error. */
static hr2d_status reach_in_time(fault_stage *s, uint64_t *sum) {
  return reach_as(s, sum, ALL, 1e6);
}

static hr2d_status predict(fault_stage *s, uint64_t *sum) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_prediction p;
  target.progress = report;
  const hr2d_status status = hr2d_predict(s->scene, &target, &p);
  if (!status) *sum = fault_mix_count(fault_mix_count(*sum, p.elements), p.links);
  return status;
}

static hr2d_status measure(fault_stage *s, uint64_t *sum) {
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_error average;
  how.error = 1e-3;
  how.progress = report;
  const hr2d_status status = hr2d_solution_error(s->solution, &how, &average, NULL);
  if (!status) *sum = fault_mix(*sum, &average, sizeof average);
  return status;
}

typedef struct act {
  const char *name;
  fault_setting setting;
  hr2d_status (*call)(fault_stage *s, uint64_t *sum);
  long sure; /* calls back that there are every time; 0: all of them */
} act;

#define SLOW .plan = PLAN_ROOM, .oracle = &slow_oracle, .policy = &full_policy
#define FAST .plan = PLAN_ROOM, .oracle = &fast_oracle, .policy = &plain_policy

static const act acts[] = {
    {"refine", {.depth = DEPTH_COMMITTED, SLOW}, refine, 0},
    {"refine, fast", {.depth = DEPTH_COMMITTED, FAST}, refine, 0},
    {"refine again", {.depth = DEPTH_REFINED, SLOW}, refine, 0},
    {"refine_count", {.depth = DEPTH_COMMITTED, FAST}, count, 0},
    {"refine_count of some", {.depth = DEPTH_COMMITTED, FAST}, count_some, 0},
    {"refine_count by 3", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, count_by_three, 2},
    {"refine_visit", {.depth = DEPTH_COMMITTED, FAST}, visit, 0},
    {"study_run", {.depth = DEPTH_COMMITTED, SLOW}, study, 0},
    {"solve", {.depth = DEPTH_REFINED, .plan = PLAN_ROOM, .epsilon = 0.3}, solve, 0},
    {"solve, directed",
     {.depth = DEPTH_REFINED, .plan = PLAN_OPEN, .oracle = NULL, .epsilon = 0.3},
     solve,
     0},
    {"solve, order 4", {.depth = DEPTH_REFINED, .plan = PLAN_ROOM, .order = 4}, solve, 0},
    {"exchange_matrix", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, matrix, 0},
    {"exchange_matrix by 3", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, matrix_by_three, 1},
    {"solve_to", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, reach, 0},
    {"solve_to, one patch", {.depth = DEPTH_COMMITTED, .plan = PLAN_PAIR}, reach_one, 0},
    {"solve_to, in time", {.depth = DEPTH_COMMITTED, .plan = PLAN_PAIR}, reach_in_time, 0},
    {"predict", {.depth = DEPTH_COMMITTED, .plan = PLAN_ROOM}, predict, 20},
    {"solution_error", {.depth = DEPTH_SOLVED, .plan = PLAN_PAIR}, measure, 0},
};
enum { ACTS = sizeof acts / sizeof *acts };

/* Plays to the end; no callback does anything special except `who`.  Returns the digest of
   the result. */
static uint64_t undisturbed(const act *a, puppet *who, puppet as) {
  fault_stage s;
  uint64_t sum = 0;
  rest();
  fault_stage_make(&s, &a->setting);
  rest();
  if (who) *who = as;
  if (who) who->stage = &s;
  const hr2d_status status = a->call(&s, &sum);
  ck_assert_msg(!status, "%s: %s", a->name, hr2d_strerror(status));
  if (who) as = *who;
  fault_stage_end(&s);
  return sum;
}

/* Callback number `at` of a kind says `says`. */
static void disturb(const act *a, puppet *who, long at, hr2d_status says, uint64_t usual) {
  fault_stage s;
  uint64_t sum = 0;
  rest();
  fault_stage_make(&s, &a->setting);
  const uint64_t before = fault_stage_sum(&s);
  rest();
  who->at = at;
  who->says = says;
  hr2d_status status = a->call(&s, &sum);
  ck_assert_msg(who->calls > at, "%s: only %ld calls back", a->name, who->calls);
  ck_assert_msg(status == says, "%s, call %ld said %d: %d", a->name, at, (int)says,
                (int)status);
  ck_assert_msg(fault_stage_sum(&s) == before, "%s, call %ld said %d: objects have changed",
                a->name, at, (int)says);
  ck_assert_msg(!s.result, "%s, call %ld said %d: a result all the same", a->name, at,
                (int)says);
  rest();
  sum = 0;
  status = a->call(&s, &sum);
  ck_assert_msg(!status, "%s, again: %s", a->name, hr2d_strerror(status));
  ck_assert_msg(sum == usual, "%s, call %ld said %d: another result", a->name, at, (int)says);
  fault_stage_end(&s);
}

static const hr2d_status sayings[] = {HR2D_STOPPED,    HR2D_ENOMEM,        HR2D_EINVAL,
                                      HR2D_ESTATE,     HR2D_ERANGE,        HR2D_EIO,
                                      HR2D_ESYNTAX,    HR2D_ESCENE,        HR2D_EUNSUPPORTED,
                                      HR2D_ECALLBACK,  HR2D_EMAX_ELEMENTS, HR2D_EMAX_LINKS,
                                      HR2D_EMAX_BYTES, HR2D_ENO_SOLUTION,  HR2D_ENOT_CONVERGED,
                                      HR2D_EACCURACY,  (hr2d_status)99,    (hr2d_status)-1};
enum { SAYINGS = sizeof sayings / sizeof *sayings };

/* Stops at calls at equal distances, and returns every status in the middle.  Below a
   multiplier of 1 each place returns a sixth of the statuses, another sixth each time. */
static void disturb_everywhere(const act *a, puppet *who, const char *kind) {
  static int part = 0;
  const uint64_t usual = undisturbed(a, NULL, (puppet){0});
  const long calls = a->sure && a->sure < who->calls ? a->sure : who->calls;
  const double multiplier = test_multiplier(), max = 12 * (multiplier < 1 ? multiplier : 1) + 1;
  const double step = (double)calls > max ? (double)calls / max : 1;
  if (!calls) return;
  for (double at = 0; at < (double)calls; at += step)
    disturb(a, who, (long)at, HR2D_STOPPED, usual);
  disturb(a, who, calls - 1, HR2D_STOPPED, usual);
  const int every = multiplier < 1 ? 6 : 1;
  for (int k = part++ % every; k < SAYINGS; k += every)
    disturb(a, who, calls / 2, sayings[k], usual);
  printf("%-24s %5ld calls of %s\n", a->name, calls, kind);
  fflush(stdout);
}

START_TEST(progress_ends_every_long_call) {
  for (int k = 0; k < ACTS; k++) {
    disturb_everywhere(&acts[k], &on_progress, "progress");
    rest();
    undisturbed(&acts[k], NULL, (puppet){0});
    ck_assert_msg(on_progress.calls > 0, "%s tells no progress", acts[k].name);
  }
}
END_TEST

START_TEST(oracles_policies_and_visitors_end_a_call) {
  static const struct {
    puppet *who;
    const char *kind;
  } kinds[] = {{&on_estimate, "estimate"},           {&on_accept, "accept"},
               {&on_acceptable, "acceptable"},       {&on_limit, "recursion_limit"},
               {&on_split, "preferred_subdivision"}, {&on_visit, "visitor"}};
  for (size_t m = 0; m < sizeof kinds / sizeof *kinds; m++)
    for (int k = 0; k < ACTS && acts[k].call != solve; k++)
      disturb_everywhere(&acts[k], kinds[m].who, kinds[m].kind);
}
END_TEST

static void write_nan(double *error, size_t n) {
  for (size_t k = 0; k < n; k++) error[k] = k + 1 == n ? (double)NAN : 0;
}
static void write_negative(double *error, size_t n) {
  for (size_t k = 0; k < n; k++) error[k] = k + 1 == n ? -0x1p-1074 : 0;
}
static void write_nothing(double *error, size_t n) {
  (void)error;
  (void)n;
}
static void write_all_but_one(double *error, size_t n) {
  for (size_t k = 0; k + 1 < n; k++) error[k] = 0;
}
static void write_negative_zero(double *error, size_t n) {
  for (size_t k = 0; k < n; k++) error[k] = -0.;
}
static void write_zero(double *error, size_t n) {
  for (size_t k = 0; k < n; k++) error[k] = 0;
}
static void write_denormal(double *error, size_t n) {
  for (size_t k = 0; k < n; k++) error[k] = 0x1p-1074;
}
static void write_infinity(double *error, size_t n) {
  for (size_t k = 0; k < n; k++) error[k] = HUGE_VAL;
}
static void write_huge(double *error, size_t n) {
  for (size_t k = 0; k < n; k++) error[k] = 0x1p1023;
}

/* Refines to level 3 with ε, and sums up what came of it. */
static hr2d_status refine_with(const hr2d_oracle *oracle, const hr2d_policy *policy,
                               double epsilon, uint64_t *sum) {
  const fault_setting setting = {
      .depth = DEPTH_COMMITTED, .plan = PLAN_ROOM, .oracle = oracle, .policy = policy};
  fault_stage s;
  fault_stage_make(&s, &setting);
  const uint64_t before = fault_stage_sum(&s);
  hr2d_refine_options o = HR2D_REFINE_OPTIONS_INIT;
  o.epsilon = epsilon > 0 ? epsilon : HR2D_EPSILON_ZERO;
  o.max_level = 3;
  const hr2d_status status = hr2d_refine(s.links, &o);
  *sum = fault_stage_sum(&s);
  if (status) ck_assert_uint_eq(*sum, before);
  if (status) ck_assert_str_ne(hr2d_linkset_message(s.links), "");
  fault_stage_end(&s);
  return status;
}

START_TEST(estimates_without_meaning_are_refused) {
  static void (*const bad[])(double *, size_t) = {write_nan, write_negative, write_nothing,
                                                  write_all_but_one};
  uint64_t one, other;
  rest();
  for (int k = 0; k < 4; k++) {
    write_error = bad[k];
    ck_assert_int_eq(refine_with(&slow_oracle, NULL, 1, &one), HR2D_ECALLBACK);
    ck_assert_int_eq(refine_with(&slow_oracle, &full_policy, 1, &one), HR2D_ECALLBACK);
  }
  write_error = write_negative_zero;
  ck_assert_int_eq(refine_with(&slow_oracle, NULL, 0, &one), HR2D_OK);
  write_error = write_zero;
  ck_assert_int_eq(refine_with(&slow_oracle, NULL, 0, &other), HR2D_OK);
  ck_assert_uint_eq(one, other);
  write_error = write_denormal;
  ck_assert_int_eq(refine_with(&slow_oracle, NULL, 0x1p-1074, &one), HR2D_OK);
  ck_assert_uint_eq(one, other);
  ck_assert_int_eq(refine_with(&slow_oracle, NULL, 0, &one), HR2D_OK);
  write_error = write_infinity;
  ck_assert_int_eq(refine_with(&slow_oracle, NULL, DBL_MAX, &other), HR2D_OK);
  ck_assert_uint_eq(one, other); /* all refused */
  write_error = write_huge;
  ck_assert_int_eq(refine_with(&slow_oracle, NULL, 1, &other), HR2D_OK);
  ck_assert_uint_eq(one, other);
  write_error = NULL;
}
END_TEST

static unsigned char byte;
static void write_the_byte(unsigned char *at, size_t n) {
  memset(at, byte, n);
}
static void write_no_byte(unsigned char *at, size_t n) {
  (void)at;
  (void)n;
}

static uint64_t refine_byte(const hr2d_oracle *oracle, const hr2d_policy *policy, int value) {
  uint64_t sum;
  byte = (unsigned char)value;
  write_byte = value < 0 ? write_no_byte : write_the_byte;
  const hr2d_status status = refine_with(oracle, policy, 0.1, &sum);
  write_byte = NULL;
  ck_assert_int_eq(status, HR2D_OK);
  return sum;
}

START_TEST(any_byte_but_0_is_a_yes_and_none_is_a_no) {
  static const hr2d_policy judging = {sizeof judging, "judging", 0,   acceptable,
                                      NULL,           NULL,      NULL};
  static const hr2d_policy limiting = {sizeof limiting, "limiting", 0, NULL, limit, NULL, NULL};
  static const struct {
    const hr2d_oracle *oracle;
    const hr2d_policy *policy;
  } cases[] = {{&fast_oracle, NULL}, {NULL, &judging}, {NULL, &limiting}};
  rest();
  for (int k = 0; k < 3; k++) {
    const uint64_t yes = refine_byte(cases[k].oracle, cases[k].policy, 1);
    const uint64_t no = refine_byte(cases[k].oracle, cases[k].policy, 0);
    ck_assert_uint_ne(yes, no);
    ck_assert_uint_eq(refine_byte(cases[k].oracle, cases[k].policy, 255), yes);
    ck_assert_uint_eq(refine_byte(cases[k].oracle, cases[k].policy, 128), yes);
    ck_assert_uint_eq(refine_byte(cases[k].oracle, cases[k].policy, -1), no);
  }
}
END_TEST

START_TEST(subdivisions_without_meaning_are_refused) {
  static const hr2d_policy dividing = {sizeof dividing, "dividing", 0, NULL, NULL,
                                       divide,          NULL};
  uint64_t sum;
  rest();
  for (int value = -1; value < 256; value++) {
    byte = (unsigned char)value;
    write_byte = value < 0 ? write_no_byte : write_the_byte;
    const hr2d_status status = refine_with(NULL, &dividing, 0.1, &sum);
    ck_assert_int_eq(status, value >= 0 && value <= HR2D_SPLIT_BOTH ? HR2D_OK : HR2D_ECALLBACK);
  }
  write_byte = NULL;
}
END_TEST

/* Callbacks that call the library. */
static int inside;

static hr2d_status never(void *ctx, void *bytes, size_t size) {
  (void)ctx;
  memset(bytes, 0, size);
  return HR2D_OK;
}

static void change_what_is_worked_on(const fault_stage *s) {
  if (inside++) return;
  hr2d_refine_counts counts;
  uint64_t sum = 0;
  hr2d_linkset *others = NULL;
  hr2d_solution *solution = NULL;
  ck_assert_int_eq(hr2d_refine(s->links, NULL), HR2D_ESTATE);
  ck_assert_str_ne(hr2d_linkset_message(s->links), "");
  ck_assert_int_eq(hr2d_refine_count(s->links, NULL, &counts), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_refine_visit(s->links, NULL, seen, &sum, &counts), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_solve(s->links, NULL, &solution), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_state_read(s->links, never, NULL, &solution), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_hierarchy_set_order(s->hierarchy, 3), HR2D_ESTATE);
  /* Another set on the same hierarchy. */
  ck_assert_int_eq(hr2d_linkset_create(s->hierarchy, NULL, NULL, NULL, NULL, &others), HR2D_OK);
  ck_assert_int_eq(hr2d_refine(others, NULL), HR2D_ESTATE);
  ck_assert_int_eq(hr2d_state_read(others, never, NULL, &solution), HR2D_ESTATE);
  hr2d_linkset_destroy(others);
  inside = 0;
}

static void use_other_objects(const fault_stage *s) {
  const fault_setting setting = {.depth = DEPTH_SOLVED, .plan = PLAN_PAIR, .order = 2};
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_solution *solution = NULL;
  hr2d_hierarchy *hierarchy = NULL;
  double area[64];
  if (inside++) return;
  fault_stage other;
  fault_stage_make(&other, &setting);
  fault_stage_end(&other);
  /* The scene is only read, by whomever. */
  ck_assert_int_eq(hr2d_exchange_matrix(s->scene, NULL, area, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_hierarchy_create(s->scene, &hierarchy), HR2D_OK);
  hr2d_hierarchy_destroy(hierarchy);
  target.error = 0.1;
  ck_assert_int_eq(hr2d_solve_to(s->scene, &target, &solution, NULL), HR2D_OK);
  hr2d_solution_destroy(solution);
  if (s->solution) ck_assert_double_gt(hr2d_solution_average(s->solution, 0, 0), 0);
  ck_assert_uint_gt(hr2d_hierarchy_count(s->hierarchy).elements, 0);
  inside = 0;
}

static void call_back(const act *a, puppet *who, void (*does)(const fault_stage *)) {
  const uint64_t usual = undisturbed(a, NULL, (puppet){0});
  if (!who->calls) return;
  const uint64_t sum = undisturbed(a, who, (puppet){.at = -1, .does = does});
  ck_assert_msg(sum == usual, "%s: another result", a->name);
  ck_assert_int_gt(who->nested, 0);
}

/* At the first calls only: each makes a solution of its own. */
static void use_other_objects_now_and_then(const fault_stage *s) {
  static int turns;
  if (turns++ % 200 == 0) use_other_objects(s);
}

START_TEST(what_is_worked_on_cannot_be_changed_from_within) {
  puppet *const kinds[] = {&on_progress, &on_estimate, &on_accept, &on_acceptable,
                           &on_limit,    &on_split,    &on_visit};
  for (size_t m = 0; m < sizeof kinds / sizeof *kinds; m++)
    for (int k = 0; k < ACTS; k++)
      /* A study has hierarchies of its own, as what solves to a target. */
      if (acts[k].call == refine || acts[k].call == count || acts[k].call == visit ||
          acts[k].call == count_by_three || acts[k].call == solve)
        call_back(&acts[k], kinds[m], change_what_is_worked_on);
}
END_TEST

START_TEST(other_objects_can_be_used_from_within) {
  puppet *const kinds[] = {&on_progress, &on_estimate, &on_split, &on_visit};
  for (size_t m = 0; m < sizeof kinds / sizeof *kinds; m++)
    for (int k = 0; k < ACTS; k++)
      call_back(&acts[k], kinds[m], use_other_objects_now_and_then);
}
END_TEST

START_TEST(an_error_that_no_budget_suffices_for_is_not_known) {
  const fault_setting setting = {.depth = DEPTH_SOLVED, .plan = PLAN_ROOM};
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_error average = {-1, -1}, sup = {-1, -1};
  fault_stage s;
  rest();
  fault_stage_make(&s, &setting);
  how.max_links = 1;
  ck_assert_int_eq(hr2d_solution_error(s.solution, &how, &average, &sup), HR2D_EACCURACY);
  how.max_links = 0;
  how.seconds = 1e-9;
  ck_assert_int_eq(hr2d_solution_error(s.solution, &how, &average, &sup), HR2D_EACCURACY);
  ck_assert_double_eq(average.bound, -1);
  fault_stage_end(&s);
}
END_TEST

TEST_SUITE("faults of callbacks") {
  ADD_TESTS(
      "callbacks", progress_ends_every_long_call, oracles_policies_and_visitors_end_a_call,
      estimates_without_meaning_are_refused, any_byte_but_0_is_a_yes_and_none_is_a_no,
      subdivisions_without_meaning_are_refused, what_is_worked_on_cannot_be_changed_from_within,
      other_objects_can_be_used_from_within, an_error_that_no_budget_suffices_for_is_not_known);
}
