/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a patch sees near to it takes most of the time of grading, and depends on no other
   patch: so patches look on any thread.  Numbers of elements, and which patches stand on which,
   depend on the order of patches: so one thread divides them, in this order. */
#include "base/alloc.h"
#include "base/team.h"
#include "mesh/grader.h"
#include "scene/scene-impl.h"

enum { BAND = 256, MOST_WORKERS = 64 };

/* What a patch has found. */
typedef struct found {
  hr2di_image_points near;
  hr2di_grading_mark *mark;
  size_t marks, mark_capacity;
  uint32_t *feet;
  size_t feet_count, feet_capacity;
} found;

typedef struct worker {
  hr2di_grader g; /* with the arrays of the patch under way */
  hr2di_grading grading;
  hr2di_visible_vertices seen;
  hr2di_watch own; /* but the calling thread has that of the grading */
  hr2d_status status;
} worker;

typedef struct team {
  hr2di_grader *g;
  worker *worker;
  size_t workers;
  uint32_t first; /* the patch of found[0] */
  atomic_int failed;
  found found[BAND];
} team;

/* Exchanges the arrays of a grader with those of a patch. */
static void exchange(hr2di_grader *g, found *f) {
  const found kept = {g->near, g->mark,       g->marks,        g->mark_capacity,
                      g->feet, g->feet_count, g->feet_capacity};
  g->near = f->near;
  g->mark = f->mark;
  g->marks = f->marks;
  g->mark_capacity = f->mark_capacity;
  g->feet = f->feet;
  g->feet_count = f->feet_count;
  g->feet_capacity = f->feet_capacity;
  *f = kept;
}

static void trace(void *ctx, size_t number, size_t task) {
  team *t = ctx;
  worker *w = &t->worker[number];
  const uint32_t patch = t->first + (uint32_t)task;
  if (w->status || atomic_load(&t->failed) || !w->g.steps->divides(&w->g, patch)) return;
  exchange(&w->g, &t->found[task]);
  w->status = w->g.steps->trace(&w->g, patch);
  exchange(&w->g, &t->found[task]);
  if (w->status) atomic_store(&t->failed, 1);
}

static hr2d_status do_band(team *t, size_t count) {
  hr2di_grader *g = t->g;
  hr2d_status status = HR2D_OK;
  hr2di_team_run(t->workers, count, trace, t, g->grading->watch);
  for (size_t k = 0; k < t->workers && !status; k++) status = t->worker[k].status;
  for (size_t k = 0; k < count && !status; k++) {
    const uint32_t patch = t->first + (uint32_t)k;
    if (!g->steps->divides(g, patch)) continue;
    exchange(g, &t->found[k]);
    status = g->steps->divide(g, patch);
    exchange(g, &t->found[k]);
  }
  return status;
}

static hr2d_status hire(team *t, size_t k) {
  worker *w = &t->worker[k];
  hr2di_grader *g = t->g;
  hr2di_watch_follow(&w->own, g->grading->watch);
  w->grading = *g->grading;
  if (k > 0) w->grading.watch = &w->own;
  w->g = *g;
  w->g.grading = &w->grading;
  w->g.near = (hr2di_image_points){0};
  w->g.mark = NULL;
  w->g.marks = w->g.mark_capacity = 0;
  w->g.waits = 1;
  w->g.seen = g->seen ? &w->seen : NULL;
  return g->seen ? hr2di_visible_vertices_init(&w->seen, g->h->scene, g->grading->beam_cache,
                                               &g->h->alloc, w->grading.watch)
                 : HR2D_OK;
}

static void clear(team *t) {
  const hr2d_allocator *alloc = &t->g->h->alloc;
  for (size_t k = 0; k < t->workers; k++) {
    worker *w = &t->worker[k];
    if (w->g.survey.exponent > 0 && w->g.survey.exponent < t->g->survey.exponent)
      t->g->survey.exponent = w->g.survey.exponent;
    hr2di_visible_vertices_clear(&w->seen);
  }
  for (size_t k = 0; k < BAND; k++) {
    hr2di_alloc_free(alloc, t->found[k].near.point);
    hr2di_alloc_free(alloc, t->found[k].mark);
    hr2di_alloc_free(alloc, t->found[k].feet);
  }
  hr2di_alloc_free(alloc, t->worker);
  hr2di_alloc_free(alloc, t);
}

hr2d_status hr2di_grader_team(hr2di_grader *g, size_t threads) {
  const hr2d_allocator *alloc = &g->h->alloc;
  const size_t patches = hr2di_scene_cell(g->h->scene);
  team *t = hr2di_alloc_zero(alloc, 1, sizeof *t);
  worker *w = hr2di_alloc_zero(alloc, threads, sizeof *w);
  if (!t || !w) {
    hr2di_alloc_free(alloc, t);
    hr2di_alloc_free(alloc, w);
    return HR2D_ENOMEM;
  }
  t->g = g;
  t->worker = w;
  t->workers = threads < MOST_WORKERS ? threads : MOST_WORKERS;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < t->workers && !status; k++) status = hire(t, k);
  for (; t->first < patches && !status; t->first += BAND)
    status = do_band(t, patches - t->first < BAND ? patches - t->first : BAND);
  clear(t);
  return status;
}
