/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Long calls ask their callback often enough, and end when it says so.

   No clock is read.  A watch counts the work that loops declare; the largest amount between two
   questions has a limit.  Loops might declare too little: so the sum of all that a call
   declares is compared with what other counters say that it did.  bench/bench-polls.c compares
   with time. */
#include <check.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "base/team.h"
#include "beams/walk.h"
#include "scene/scene-impl.h"
#include "support/memory.h"
#include "support/random.h"
#include "support/settings.h"
#include "support/slow-phases.h"
#include "support/suite.h"

/* 5 ms of declared work. */
enum { MOST = 5 * HR2DI_WATCH_SPAN, REFUSAL = 77 };

/* What a callback saw. */
typedef struct witness {
  unsigned long asks, stop_at; /* the question that is refused; 0: none */
  uint64_t span;               /* of the watch from the first question on; 0: as it is */
  uint64_t max, total;
} witness;

static hr2d_status ask(void *ctx, const hr2d_progress *progress) {
  witness *w = ctx;
  hr2di_watch *watch = hr2di_watch_of(progress);
  ck_assert_uint_eq(progress->struct_size, sizeof *progress);
  ck_assert_str_ne(progress->phase, "");
  ck_assert(progress->fraction >= 0 && progress->fraction <= 1);
  if (w->span) watch->span = w->span;
  w->max = watch->max > w->max ? watch->max : w->max;
  w->total = watch->total;
  return ++w->asks == w->stop_at ? (hr2d_status)REFUSAL : HR2D_OK;
}

static slow_stage stage(slow_kind kind, size_t count, witness *w) {
  return (slow_stage){.kind = kind,
                      .count = count,
                      .epsilon = 0.5,
                      .order = 1,
                      .threads = 1,
                      .ask = ask,
                      .ctx = w};
}

static const slow_phase *phase_called(const char *name) {
  size_t k = 0;
  while (strcmp(slow_phases[k].name, name) != 0) k++;
  return &slow_phases[k];
}

static witness watch_phase(const slow_phase *phase, slow_stage *s, witness w) {
  s->ctx = &w;
  ck_assert_int_eq(phase->prepare(s), HR2D_OK);
  ck_assert_int_eq(phase->run(s), HR2D_OK);
  return w;
}

/* Kind and phase by one number. */
#define CASES (SLOW_KINDS * SLOW_PHASES)

START_TEST(little_work_lies_between_two_questions) {
  const slow_phase *phase = &slow_phases[_i / SLOW_KINDS];
  for (unsigned order = 1; order <= 6; order += 5) {
    if (!test_meets((size_t)_i, order / 6, 2)) continue;
    witness w = {0};
    slow_stage s = stage((slow_kind)(_i % SLOW_KINDS), order == 1 ? 160 : 24, &w);
    s.order = order;
    w = watch_phase(phase, &s, w);
    ck_assert_msg(w.max <= MOST, "%s, %s, order %u: %llu units of work without a question",
                  slow_name(s.kind), phase->name, order, (unsigned long long)w.max);
    slow_clear(&s);
  }
}
END_TEST

/* If it did not ask so often, this would show. */
START_TEST(too_few_questions_are_noticed) {
  static const struct {
    const char *name;
    size_t count;
  } calls[] = {{"commit", 2500},  {"events", 2000}, {"roots", 500},
               {"factors", 1500}, {"rows", 1500},   {"visit", 1500},
               {"refine", 250},   {"count", 250},   {"validate", 250}};
  for (size_t k = 0; k < sizeof calls / sizeof *calls; k++) {
    slow_stage s = stage(SLOW_SPOKES, calls[k].count, NULL);
    const witness w =
        watch_phase(phase_called(calls[k].name), &s, (witness){.span = 2 * (uint64_t)MOST});
    ck_assert_msg(w.max > MOST, "%s", calls[k].name);
    slow_clear(&s);
  }
}
END_TEST

/* The last question may come up to a span before the end of a call. */
static void declares(const char *what, witness w, double work) {
  ck_assert_msg((double)w.total + HR2DI_WATCH_SPAN >= work,
                "%s: %llu units of work are declared, but there are %g", what,
                (unsigned long long)w.total, work);
}

/* One unit is 0.1 µs; the least that each of these can take. */
START_TEST(what_is_declared_is_what_is_done) {
  slow_stage s = stage(SLOW_ROUND, 20000, NULL);
  witness w = watch_phase(phase_called("commit"), &s, (witness){0});
  declares("commit", w, 12. * 20000);
  slow_clear(&s);

  s = stage(SLOW_ROUND, 1500, NULL);
  w = watch_phase(phase_called("refine"), &s, (witness){0});
  declares("refine", w, 0.5 * (double)hr2d_linkset_counts(s.links).oracle_calls);
  slow_clear(&s);

  s = stage(SLOW_SPOKES, 300, NULL);
  w = watch_phase(phase_called("refine"), &s, (witness){0});
  declares("refine past walls", w, 0.4 * (double)hr2d_linkset_counts(s.links).visibility_tests);
  slow_clear(&s);

  s = stage(SLOW_SPOKES, 100, NULL);
  s.order = 6;
  w = watch_phase(phase_called("solve"), &s, (witness){0});
  declares("blocks", w, 0.05 * (double)hr2d_solution_work(s.solution).kernels);
  slow_clear(&s);

  s = stage(SLOW_CITY, 2000, NULL);
  w = watch_phase(phase_called("events"), &s, (witness){0});
  declares("events", w, (double)hr2d_scene_patches(s.scene) * 50);
  slow_clear(&s);

  /* Where beams meet more before they end. */
  s = stage(SLOW_COMB, 1000, NULL);
  w = watch_phase(phase_called("events"), &s, (witness){0});
  declares("events of a comb", w, (double)hr2d_scene_patches(s.scene) * 100);
  slow_clear(&s);

  s = stage(SLOW_SQUARES, 4000, NULL);
  w = watch_phase(phase_called("read"), &s, (witness){0});
  declares("read", w, (double)s.size / 16);
  slow_clear(&s);
}
END_TEST

static hr2d_status ignore(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  (void)ctx;
  (void)s;
  (void)j;
  return HR2D_OK;
}

/* From all sides of walls, with a watch or without: the triangles that beams enter. */
static uint64_t look_everywhere(const hr2d_scene *scene, hr2di_watch *watch) {
  hr2di_walk walk = {.in = &scene->plane.triangulation,
                     .wanted = scene->parts.wanted,
                     .take = ignore,
                     .alloc = scene->alloc,
                     .watch = watch};
  for (hr2di_wall_side side = 0; side < 2 * walk.in->edges; side++)
    ck_assert_int_eq(hr2di_walk_from(&walk, side, NULL), HR2D_OK);
  const uint64_t steps = walk.steps;
  hr2di_walk_clear(&walk);
  return steps;
}

START_TEST(a_loop_that_declares_nothing_is_noticed) {
  slow_stage s = stage(SLOW_SOUP, 200, NULL);
  ck_assert_int_eq(phase_called("factors")->prepare(&s), HR2D_OK);
  for (int watched = 0; watched < 2; watched++) {
    witness w = {0};
    hr2di_watch watch;
    hr2di_watch_init(&watch, ask, &w, "test");
    const uint64_t steps = look_everywhere(s.scene, watched ? &watch : NULL);
    hr2di_watch_ask(&watch);
    ck_assert_int_eq((double)w.total >= 0.1 * (double)steps, watched);
  }
  slow_clear(&s);
}
END_TEST

static uint64_t mix(uint64_t sum, const void *bytes, size_t size) {
  const unsigned char *byte = bytes;
  for (size_t k = 0; k < size; k++) sum = (sum ^ byte[k]) * UINT64_C(0x100000001b3);
  return sum;
}

/* All that a caller can see of the objects. */
static uint64_t sum_of(const slow_stage *s) {
  const size_t n = hr2d_scene_patches(s->scene);
  uint64_t sum = n;
  for (size_t k = 0; k < n; k++) {
    const hr2d_segment at = hr2d_scene_segment(s->scene, k);
    sum = mix(sum, &at, sizeof at);
  }
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    sum = 2 * sum + (uint64_t)hr2d_scene_effect(s->scene, (hr2d_effect)e, NULL);
  if (s->hierarchy) sum = 31 * sum + hr2d_hierarchy_count(s->hierarchy).elements;
  for (uint64_t k = 0; s->links && k < hr2d_linkset_size(s->links); k++) {
    const hr2d_link link = hr2d_linkset_get(s->links, k);
    sum = mix(sum, &link, sizeof link);
  }
  for (size_t k = 0; s->solution && k < n; k++) {
    const double b = hr2d_solution_average(s->solution, k, 0);
    sum = mix(sum, &b, sizeof b);
  }
  return sum;
}

/* As many patches as make a phase last longer than a millisecond. */
static size_t size_for(const slow_phase *phase) {
  static const struct {
    const char *name;
    size_t count;
  } known[] = {{"read", 400},   {"split", 400}, {"commit", 300}, {"refine l1", 10},
               {"gather", 150}, {"write", 200}, {"resume", 200}, {"past", 400},
               {"events", 400}, {"snap", 400}};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (!strcmp(phase->name, known[k].name)) return known[k].count;
  return 50;
}

/* Stops at a question drawn at random.  The objects are as before, and the call can be made
   again, with the same bits in the end. */
static int stop_once(const slow_phase *phase, slow_kind kind, unsigned threads,
                     unsigned long *state) {
  test_memory memory = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&memory);
  witness w = {.span = 300};
  slow_stage s = stage(kind, size_for(phase), &w);
  s.hooks = &hooks;
  s.threads = threads;
  s.order = kind == SLOW_COMB && phase == phase_called("solve") ? 4 : 1;
  ck_assert_int_eq(phase->prepare(&s), HR2D_OK);
  const uint64_t before = sum_of(&s);
  ck_assert_int_eq(phase->run(&s), HR2D_OK);
  const uint64_t undisturbed = sum_of(&s);
  const unsigned long asks = w.asks;
  slow_clear(&s);
  ck_assert_int_eq(memory.live, 0);
  if (asks == 0) return 0;
  ck_assert_int_eq(phase->prepare(&s), HR2D_OK);
  int ended = 0;
  for (int turn = 0; turn < 3 && !ended; turn++) {
    const unsigned long max = threads == 1 ? asks : 1;
    w = (witness){.span = 300,
                  .stop_at = 1 + (unsigned long)(test_random(state) * (double)max)};
    const int status = (int)phase->run(&s);
    /* Blocks that a stopped solve has made are kept, so that later ones ask less often. */
    ended = status == HR2D_OK && w.asks < w.stop_at;
    if (ended) continue;
    ck_assert_msg(status == REFUSAL, "%s, %s, question %lu of %lu", slow_name(kind),
                  phase->name, w.stop_at, asks);
    ck_assert_uint_eq(w.asks, w.stop_at);
    ck_assert_msg(sum_of(&s) == before, "%s, %s, question %lu: something has changed",
                  slow_name(kind), phase->name, w.stop_at);
  }
  w = (witness){.span = 300};
  if (!ended) ck_assert_int_eq(phase->run(&s), HR2D_OK);
  ck_assert_uint_eq(sum_of(&s), undisturbed);
  slow_clear(&s);
  ck_assert_int_eq(memory.live, 0);
  return 1;
}

START_TEST(every_phase_stops_at_any_question) {
  const slow_phase *phase = &slow_phases[_i];
  unsigned long state = test_seed() + (unsigned long)_i;
  int stopped = 0;
  for (int kind = 0; kind < SLOW_KINDS; kind++)
    if (!stopped || test_meets((size_t)_i, (size_t)kind, SLOW_KINDS))
      stopped += stop_once(phase, (slow_kind)kind, 1, &state);
  ck_assert_msg(stopped > 0, "%s never asks", phase->name);
}
END_TEST

START_TEST(teams_stop) {
  static const char *const names[] = {"factors", "count", "solve"};
  unsigned long state = test_seed();
  for (size_t k = 0; k < sizeof names / sizeof *names; k++)
    for (int kind = 0; kind < SLOW_KINDS; kind++)
      stop_once(phase_called(names[k]), (slow_kind)kind, 3, &state);
}
END_TEST

/* A callback of its own comes first; the scene's is for calls without. */
START_TEST(callbacks_of_calls_come_before_that_of_the_scene) {
  witness own = {0}, of_scene = {0};
  slow_stage s = stage(SLOW_SPOKES, 200, &own);
  ck_assert_int_eq(phase_called("refine")->prepare(&s), HR2D_OK);
  hr2d_scene_set_progress(s.scene, ask, &of_scene);
  ck_assert_int_eq(phase_called("refine")->run(&s), HR2D_OK);
  ck_assert_uint_gt(own.asks, 0);
  ck_assert_uint_eq(of_scene.asks, 0);
  s.ask = NULL;
  of_scene.stop_at = 2;
  hr2d_refine_counts counts;
  hr2d_linkset *links = NULL;
  hr2d_hierarchy *hierarchy = NULL;
  ck_assert_int_eq(hr2d_hierarchy_create(s.scene, &hierarchy), HR2D_OK);
  ck_assert_int_eq(hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links), HR2D_OK);
  hr2d_refine_options o = HR2D_REFINE_OPTIONS_INIT;
  o.epsilon = 0.5;
  ck_assert_int_eq((int)hr2d_refine_count(links, &o, &counts), REFUSAL);
  ck_assert_ptr_nonnull(strstr(hr2d_linkset_message(links), "progress"));
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  slow_clear(&s);
}
END_TEST

START_TEST(stopped_commits_say_so) {
  witness w = {.stop_at = 1};
  slow_stage s = stage(SLOW_SQUARES, 800, &w);
  ck_assert_int_eq(phase_called("commit")->prepare(&s), HR2D_OK);
  ck_assert_int_eq((int)phase_called("commit")->run(&s), REFUSAL);
  ck_assert_ptr_nonnull(strstr(hr2d_scene_message(s.scene), "callback \"progress\""));
  const hr2d_patch more = {.a = {-1, -1}, .b = {-1, -2}};
  ck_assert_int_eq(hr2d_scene_add(s.scene, &more, NULL), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(s.scene), HR2D_OK);
  slow_clear(&s);
}
END_TEST

/* What a visitor got since the last question. */
typedef struct listener {
  unsigned long heard, max, all;
} listener;

static hr2d_status ask_listener(void *ctx, const hr2d_progress *progress) {
  listener *l = ctx;
  hr2di_watch_of(progress)->span = 300;
  l->heard = 0;
  return HR2D_OK;
}

static hr2d_status listen(void *ctx, const hr2d_warning *warning) {
  listener *l = ctx;
  (void)warning;
  l->all++;
  if (++l->heard > l->max) l->max = l->heard;
  return HR2D_OK;
}

/* A text takes microseconds, and there may be one for each end. */
START_TEST(warnings_come_with_questions_between) {
  listener l = {0};
  slow_stage s = stage(SLOW_SLIVERS, 400, NULL);
  ck_assert_int_eq(phase_called("lint")->prepare(&s), HR2D_OK);
  hr2d_lint_options o = HR2D_LINT_OPTIONS_INIT;
  o.progress = ask_listener;
  o.progress_ctx = &l;
  ck_assert_int_eq(hr2d_scene_lint(s.scene, listen, &l, &o), HR2D_OK);
  ck_assert_uint_gt(l.all, 100);
  ck_assert_uint_le(l.max, 10);
  slow_clear(&s);
}
END_TEST

static hr2d_status count_solve(void *ctx, const hr2d_progress *progress) {
  uint64_t *declared = ctx;
  if (!strcmp(progress->phase, "solve")) *declared = hr2di_watch_of(progress)->total;
  return HR2D_OK;
}

/* With one link at most the answer is a fallback solve, whose work is the light from outside:
   each patch looks at each piece of the sky, in .1 µs or more. */
START_TEST(fallbacks_declare_the_light_from_outside) {
  enum { PATCHES = 2000, PIECES = 24 };
  hr2d_sky_piece piece[PIECES];
  double value[PIECES];
  uint64_t declared = 0;
  hr2d_solution *solution = NULL;
  slow_stage s = stage(SLOW_CITY, PATCHES, NULL);
  for (size_t k = 0; k < PIECES; k++) {
    piece[k] = (hr2d_sky_piece){270 + 7.5 * (double)k, 277.5 + 7.5 * (double)k};
    value[k] = (double)k;
  }
  ck_assert_int_eq(phase_called("commit")->prepare(&s), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_set_sky(s.scene, piece, PIECES, value, 1), HR2D_OK);
  ck_assert_int_eq(hr2d_scene_commit(s.scene), HR2D_OK);
  hr2d_target target = HR2D_TARGET_INIT;
  target.max_links = 1;
  target.progress = count_solve;
  target.progress_ctx = &declared;
  ck_assert_int_eq(hr2d_solve_to(s.scene, &target, &solution, NULL), HR2D_EACCURACY);
  ck_assert_ptr_nonnull(solution);
  ck_assert_uint_ge(declared + HR2DI_WATCH_SPAN, PATCHES * PIECES);
  hr2d_solution_destroy(solution);
  slow_clear(&s);
}
END_TEST

static int by_value(const void *left, const void *right) {
  const uint64_t l = *(const uint64_t *)left, r = *(const uint64_t *)right;
  return (l > r) - (l < r);
}

/* Orders that make a simple quicksort slow. */
START_TEST(sorts_are_sorted) {
  enum { COUNT = 20000 };
  static uint64_t item[COUNT], expected[COUNT];
  randoms r = randoms_stream(test_seed(), 0);
  for (int kind = 0; kind < 4; kind++) {
    for (size_t k = 0; k < COUNT; k++)
      item[k] = kind == 0 ? random_bits(&r) : kind == 1 ? k : kind == 2 ? COUNT - k : k % 7;
    memcpy(expected, item, sizeof item);
    qsort(expected, COUNT, sizeof *expected, by_value);
    witness w = {0};
    hr2di_watch watch;
    hr2di_watch_init(&watch, ask, &w, "sort");
    ck_assert_int_eq(hr2di_sort(item, COUNT, sizeof *item, by_value, &watch), HR2D_OK);
    ck_assert(!memcmp(item, expected, sizeof item));
    ck_assert_uint_gt(w.asks, 0);
    ck_assert_uint_le(w.max, MOST);
    /* Also of many that are equal: n log n, and not n². */
    ck_assert_uint_le(w.total, 20 * COUNT);
  }
}
END_TEST

typedef struct tally {
  atomic_int done[1000];
  hr2di_watch own[4], *leader;
  atomic_int stopped;
} tally;

static void count_task(void *ctx, size_t worker, size_t task) {
  tally *t = ctx;
  hr2di_watch *watch = worker ? &t->own[worker] : t->leader;
  atomic_fetch_add(&t->done[task], 1);
  /* A task without end, but for the watch. */
  if (task < 4)
    while (!hr2di_watch_work(watch, 100)) continue;
  if (hr2di_watch_status(watch)) atomic_fetch_add(&t->stopped, 1);
}

START_TEST(teams_share_tasks_and_stop_together) {
  static tally t;
  for (size_t threads = 1; threads <= 4; threads++) {
    witness w = {.stop_at = 5};
    hr2di_watch leader;
    memset(&t, 0, sizeof t);
    hr2di_watch_init(&leader, ask, &w, "test");
    t.leader = &leader;
    for (size_t k = 0; k < 4; k++) hr2di_watch_follow(&t.own[k], &leader);
    hr2di_team_run(threads, 1000, count_task, &t, &leader);
    ck_assert_int_eq((int)leader.status, REFUSAL);
    ck_assert_int_ge(atomic_load(&t.stopped), 4);
    for (size_t k = 0; k < 1000; k++) ck_assert_int_eq(atomic_load(&t.done[k]), 1);
  }
}
END_TEST

TEST_SUITE("check-polls") {
  REPEAT_TESTS(CASES, "work", little_work_lies_between_two_questions);
  ADD_TESTS("controls", too_few_questions_are_noticed, what_is_declared_is_what_is_done,
            a_loop_that_declares_nothing_is_noticed);
  REPEAT_TESTS(SLOW_PHASES, "stops", every_phase_stops_at_any_question);
  ADD_TESTS("callbacks", teams_stop, callbacks_of_calls_come_before_that_of_the_scene,
            stopped_commits_say_so, warnings_come_with_questions_between,
            fallbacks_declare_the_light_from_outside);
  ADD_TESTS("base", sorts_are_sorted, teams_share_tasks_and_stop_together);
}
