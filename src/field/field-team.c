/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdatomic.h>

#include "base/alloc.h"
#include "base/team.h"
#include "field/field-impl.h"

hr2d_status hr2di_field_scene_init(hr2di_with_plane *s, const hr2d_scene *scene,
                                   hr2di_watch *watch) {
  const hr2d_status status = hr2di_with_images_init(s, scene, &scene->alloc, watch);
  return !status && s->scene.unclear.is ? HR2D_ESCENE : status;
}

int hr2di_field_finite(const hr2d_point *at, size_t count) {
  for (size_t k = 0; k < count; k++)
    if (!isfinite(at[k].x) || !isfinite(at[k].y)) return 0;
  return 1;
}

int hr2di_field_lit_sky(const hr2d_scene *scene) {
  for (size_t b = 0; b < scene->bands; b++)
    if (hr2d_scene_background(scene, b) > 0) return 1;
  return hr2di_scene_has_sun(scene) || hr2di_scene_has_sky(scene);
}

hr2d_place hr2di_field_place(const hr2d_scene *scene, double front, double sky, int touches) {
  if (front == 0 && !(sky > 0 && hr2di_field_lit_sky(scene))) return HR2D_PLACE_OUTSIDE;
  return touches ? HR2D_PLACE_PATCH : HR2D_PLACE_BETWEEN;
}

typedef struct team {
  const hr2di_field_team *is;
  hr2di_field_worker *worker;
  size_t workers, tasks;
  atomic_size_t done;
  atomic_int stop;
} team;

static hr2d_status hire(team *t) {
  const hr2d_allocator *alloc = &t->is->scene->alloc;
  size_t count = hr2di_team_threads(t->is->threads);
  if (count > t->tasks) count = t->tasks;
  t->worker = hr2di_alloc_zero(alloc, count, sizeof *t->worker);
  if (!t->worker) return HR2D_ENOMEM;
  for (; t->workers < count; t->workers++) {
    hr2di_field_worker *w = &t->worker[t->workers];
    w->watch = t->workers == 0 ? t->is->watch : &w->own;
    hr2di_watch_follow(&w->own, t->is->watch);
    w->view =
        (hr2di_visibility_polygon){.scene = t->is->scene, .alloc = *alloc, .watch = w->watch};
    w->room = hr2di_alloc(alloc, t->is->needs, sizeof *w->room);
    if (!w->room) return HR2D_ENOMEM;
  }
  return HR2D_OK;
}

static void dismiss(team *t, uint64_t *steps) {
  for (size_t k = 0; k < t->workers; k++) {
    *steps += t->worker[k].view.between.steps;
    hr2di_visibility_polygon_clear(&t->worker[k].view);
    hr2di_alloc_free(&t->is->scene->alloc, t->worker[k].room);
  }
  hr2di_alloc_free(&t->is->scene->alloc, t->worker);
}

/* Every thread looks whether another has failed. */
static void do_task(void *ctx, size_t worker, size_t task) {
  team *t = ctx;
  hr2di_field_worker *w = &t->worker[worker];
  hr2d_status status = atomic_load(&t->stop) ? HR2D_STOPPED : hr2di_watch_status(w->watch);
  hr2di_visibility_polygon_restart(&w->view);
  if (!status) status = t->is->run(t->is->ctx, w, task);
  atomic_fetch_add(&t->done, 1);
  if (!status || w->status) return;
  w->status = status;
  atomic_store(&t->stop, 1);
}

static void describe(void *of, hr2d_progress *report) {
  const team *t = of;
  report->fraction = (double)atomic_load(&t->done) / (double)t->tasks;
}

/* The status of the first that failed and was not told to stop. */
hr2d_status hr2di_field_team_run(const hr2di_field_team *is, size_t tasks, uint64_t *steps) {
  team t = {.is = is, .tasks = tasks};
  if (tasks == 0) return HR2D_OK;
  hr2d_status status = hire(&t);
  if (!status) {
    hr2di_watch_describe(is->watch, describe, &t);
    hr2di_team_run(t.workers, tasks, do_task, &t, is->watch);
    hr2di_watch_describe(is->watch, NULL, NULL);
  }
  for (size_t k = 0; k < t.workers && t.worker; k++)
    if (t.worker[k].status && (!status || status == HR2D_STOPPED)) status = t.worker[k].status;
  dismiss(&t, steps);
  return status;
}
