/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Looks that are kept against looks that walk beams.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <string.h>

#include "base/alloc.h"
#include "base/team.h"
#include "support/grid-plans.h"
#include "support/support.h"
#include "visibility/beam-cache.h"

enum { MOST = 4096, THREADS = 3 };

#define ROOM 0x1000000

/* What a look has given. */
typedef struct record {
  hr2di_cached_line_class line_class[MOST];
  hr2d_point first[MOST]; /* of the left chain; that of the right one is at MOST − 1 − k */
  uint32_t vertex[MOST];
  size_t classes, bare, vertices;
} record;

static hr2d_status take(void *ctx, const hr2di_line_class *s, hr2di_wall_side from,
                        hr2di_wall_side to) {
  record *r = ctx;
  ck_assert_uint_lt(r->classes, MOST / 2);
  r->line_class[r->classes] = (hr2di_cached_line_class){from, to, 0, 0, 0};
  if (s) {
    r->line_class[r->classes] =
        (hr2di_cached_line_class){from, to, (uint32_t)s->lefts, (uint32_t)s->rights, s->ends};
    r->first[r->classes] = s->left[0];
    r->first[MOST - 1 - r->classes] = s->right[s->rights - 1];
  }
  r->bare += !s;
  r->classes++;
  return HR2D_OK;
}

static void see(void *ctx, uint32_t vertex) {
  record *r = ctx;
  ck_assert_uint_lt(r->vertices, MOST);
  r->vertex[r->vertices++] = vertex;
}

static void look(hr2di_beam_tracer *l, uint32_t patch, int later, record *r) {
  r->classes = r->bare = r->vertices = 0;
  l->take = take;
  l->see = see;
  l->ctx = r;
  ck_assert_int_eq(hr2di_beam_tracer_trace(l, patch, later), HR2D_OK);
}

static int has_later(const hr2d_scene *scene, hr2di_wall_side side, uint32_t patch) {
  const hr2di_parts of = scene->parts.of_side[side].parts;
  for (uint32_t k = of.first; k < of.last; k++) {
    const uint32_t other = scene->parts.part[k].patch;
    if (other != HR2DI_NOBODY && other >= patch) return 1;
  }
  return 0;
}

/* `kept` may lack the chains of line classes to sides without later patches, and nothing else.
 */
static void compare(const hr2d_scene *scene, uint32_t patch, const record *walked,
                    const record *kept) {
  ck_assert_uint_eq(walked->classes, kept->classes);
  ck_assert_uint_eq(walked->vertices, kept->vertices);
  ck_assert_mem_eq(walked->vertex, kept->vertex, kept->vertices * sizeof *kept->vertex);
  for (size_t k = 0; k < walked->classes; k++) {
    const hr2di_cached_line_class *s = &walked->line_class[k], *t = &kept->line_class[k];
    const size_t last = MOST - 1 - k;
    ck_assert(s->from == t->from && s->to == t->to);
    if (t->lefts == 0) {
      ck_assert(!has_later(scene, s->to, patch));
      continue;
    }
    ck_assert_mem_eq(s, t, sizeof *s);
    ck_assert_mem_eq(&walked->first[k], &kept->first[k], sizeof *kept->first);
    ck_assert_mem_eq(&walked->first[last], &kept->first[last], sizeof *kept->first);
  }
}

static hr2d_scene *draw(randoms *r) {
  plan p = grid_plan(r, random_below(r, 2));
  hr2d_scene *scene = plan_try_scene(&p, NULL);
  plan_free(&p);
  if (scene && hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL)) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

typedef struct tally {
  size_t classes, bare;
} tally;

static void check_scene(const hr2d_scene *scene, tally *t) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  static record walked, kept;
  hr2di_beam_cache beam_cache;
  ck_assert_int_eq(hr2di_beam_cache_init(&beam_cache, scene, ROOM), HR2D_OK);
  hr2di_beam_tracer beams = hr2di_beam_tracer_make(scene, NULL, &alloc, NULL);
  hr2di_beam_tracer memory = hr2di_beam_tracer_make(scene, &beam_cache, &alloc, NULL);
  for (uint32_t k = 0; k < scene->patches; k++) {
    const uint64_t before = memory.steps, walked_before = memory.walk.steps;
    look(&beams, k, 1, &walked);
    look(&memory, k, 1, &kept);
    ck_assert_uint_eq(kept.bare, 0);
    compare(scene, k, &walked, &kept);
    const uint64_t steps = memory.walk.steps;
    look(&memory, k, 1, &kept);
    ck_assert_uint_eq(memory.walk.steps, steps);
    ck_assert_uint_eq(memory.steps - before, 2 * (steps - walked_before));
    compare(scene, k, &walked, &kept);
    t->classes += kept.classes;
    t->bare += kept.bare;
    look(&memory, k, 0, &kept);
    ck_assert_uint_eq(kept.bare, 0);
    compare(scene, k, &walked, &kept);
  }
  ck_assert_uint_ge(memory.walk.steps,
                    beams.walk.steps); /* once, and for all line classes again */
  hr2di_beam_tracer_clear(&beams);
  hr2di_beam_tracer_clear(&memory);
  hr2di_beam_cache_clear(&beam_cache);
}

START_TEST(looks_that_are_kept_are_those_of_beams) {
  randoms r = randoms_stream(test_seed(), 12);
  const int count = test_count(300);
  tally t = {0, 0};
  for (int k = 0; k < count; k++) {
    hr2d_scene *scene = draw(&r);
    if (scene) check_scene(scene, &t);
    hr2d_scene_destroy(scene);
  }
  printf("%zu sights are kept, %zu of them without chains\n", t.classes - t.bare, t.bare);
  ck_assert_uint_gt(t.bare, 0);
  ck_assert_uint_gt(t.classes, t.bare);
}
END_TEST

/* A look that takes too many bytes is walked again each time. */
START_TEST(looks_without_room_are_not_kept) {
  randoms r = randoms_stream(test_seed(), 13);
  const hr2d_allocator alloc = hr2di_alloc_default();
  static record walked, again;
  hr2d_scene *scene = NULL;
  while (!scene) scene = draw(&r);
  hr2di_beam_cache beam_cache;
  ck_assert_int_eq(hr2di_beam_cache_init(&beam_cache, scene, scene->patches), HR2D_OK);
  hr2di_beam_tracer l = hr2di_beam_tracer_make(scene, &beam_cache, &alloc, NULL);
  for (uint32_t k = 0; k < scene->patches; k++) {
    look(&l, k, 1, &walked);
    const uint64_t steps = l.walk.steps;
    look(&l, k, 1, &again);
    compare(scene, k, &walked, &again);
    ck_assert(!atomic_load(&beam_cache.of[k].beams));
    if (walked.classes > 0) ck_assert_uint_gt(l.walk.steps, steps);
  }
  hr2di_beam_tracer_clear(&l);
  hr2di_beam_cache_clear(&beam_cache);
  hr2d_scene_destroy(scene);
}
END_TEST

/* Threads that look from the same patches. */
typedef struct crowd {
  const hr2d_scene *scene;
  hr2di_beam_tracer tracer[THREADS];
  size_t classes[THREADS];
} crowd;

static hr2d_status count(void *ctx, const hr2di_line_class *s, hr2di_wall_side from,
                         hr2di_wall_side to) {
  (void)s;
  (void)from;
  (void)to;
  ++*(size_t *)ctx;
  return HR2D_OK;
}

static void look_round(void *ctx, size_t worker, size_t task) {
  crowd *c = ctx;
  (void)worker;
  for (uint32_t k = 0; k < c->scene->patches; k++)
    ck_assert_int_eq(hr2di_beam_tracer_trace(&c->tracer[task], k, 1), HR2D_OK);
}

START_TEST(threads_may_keep_the_same_look) {
  randoms r = randoms_stream(test_seed(), 14);
  const hr2d_allocator alloc = hr2di_alloc_default();
  for (int k = 0; k < test_count(30); k++) {
    hr2d_scene *scene = draw(&r);
    if (!scene) continue;
    crowd c = {.scene = scene};
    hr2di_beam_cache beam_cache;
    ck_assert_int_eq(hr2di_beam_cache_init(&beam_cache, scene, ROOM), HR2D_OK);
    for (int m = 0; m < THREADS; m++) {
      c.tracer[m] = hr2di_beam_tracer_make(scene, &beam_cache, &alloc, NULL);
      c.tracer[m].take = count;
      c.tracer[m].ctx = &c.classes[m];
    }
    hr2di_team_run(THREADS, THREADS, look_round, &c, NULL);
    for (int m = 0; m < THREADS; m++) {
      ck_assert_uint_eq(c.classes[m], c.classes[0]);
      hr2di_beam_tracer_clear(&c.tracer[m]);
    }
    hr2di_beam_cache_clear(&beam_cache);
    hr2d_scene_destroy(scene);
  }
}
END_TEST

TEST_SUITE("looks") {
  ADD_TESTS("looks", looks_that_are_kept_are_those_of_beams, looks_without_room_are_not_kept,
            threads_may_keep_the_same_look);
}
