/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas row by row.  Threads make the rows of some blocks and keep them; then the
   calling thread shows them in the order of the blocks. */
#include <hr2d/transport.h>
#include <math.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "scene/scene-impl.h"
#include "visibility/image-rows.h"
#include "visibility/row-assembly.h"

/* Rows that a thread makes before they are shown have some 3 MB: more than threads take to
   start, and to wait for the last one. */
enum { ENTRIES = 1 << 18, LEAST_ROWS = 256, MOST_ROWS = 1 << 14 };

/* A row of a round, in the memory of its thread. */
typedef struct kept_row {
  size_t first; /* among the entries of the thread */
  uint32_t count;
  uint32_t worker;
} kept_row;

/* The entries that a thread has made in a round. */
typedef struct store {
  uint32_t *column;
  double *area;
  size_t used, room[2];
} store;

typedef struct visit {
  hr2di_row_assembly maker;
  const hr2d_allocator *alloc;
  hr2di_watch *watch;
  double unit;
  store *store;   /* per thread */
  kept_row *kept; /* per patch */
  hr2d_exchange_row_fn show;
  void *ctx;
  hr2d_matrix_counts counts;
} visit;

static hr2d_status keep_row(void *ctx, size_t worker, const hr2di_row *row) {
  visit *v = ctx;
  store *s = &v->store[worker];
  const size_t needed = s->used + row->count;
  if (hr2di_alloc_reserve(v->alloc, &s->column, &s->room[0], needed, sizeof *s->column) ||
      hr2di_alloc_reserve(v->alloc, &s->area, &s->room[1], needed, sizeof *s->area))
    return HR2D_ENOMEM;
  for (size_t k = 0; k < row->count; k++) {
    s->column[s->used + k] = row->column[k];
    s->area[s->used + k] = row->area[k] * v->unit;
  }
  v->kept[row->patch] = (kept_row){s->used, (uint32_t)row->count, (uint32_t)worker};
  s->used = needed;
  return HR2D_OK;
}

static hr2d_status show_row(visit *v, uint32_t patch) {
  const kept_row kept = v->kept[patch];
  const store *s = &v->store[kept.worker];
  uint32_t *column = s->column ? s->column + kept.first : NULL;
  for (uint32_t k = 0; k < kept.count; k++) {
    v->counts.partial_pairs += (column[k] & HR2DI_PARTIAL) != 0;
    column[k] &= ~HR2DI_PARTIAL;
  }
  v->counts.exchange_areas += kept.count;
  const hr2d_exchange_row row = {sizeof row, patch, kept.count, column,
                                 s->area ? s->area + kept.first : NULL};
  const hr2d_status status = v->show(v->ctx, &row);
  return status ? status : hr2di_watch_work(v->watch, 1 + kept.count / 32);
}

/* The end of the tasks of a round of so many rows. */
static size_t end_of_round(const hr2di_row_assembly *m, size_t first, size_t rows) {
  size_t last = first;
  for (size_t made = 0; last < m->tasks && made < rows; last++)
    made += m->task[last].last - m->task[last].first;
  return last;
}

/* How many rows the next round has, if they are as long as those of this one. */
static size_t next_rows(const visit *v, size_t rows) {
  size_t entries = 1;
  for (size_t k = 0; k < v->maker.workers; k++) entries += v->store[k].used;
  const double wanted = (double)rows * ENTRIES / (double)entries;
  return v->maker.workers * (size_t)fmin(fmax(wanted, LEAST_ROWS), MOST_ROWS);
}

static hr2d_status show_all(visit *v) {
  const hr2di_row_assembly *m = &v->maker;
  hr2d_status status = HR2D_OK;
  size_t rows = LEAST_ROWS * m->workers;
  for (size_t first = 0, last; first < m->tasks && !status; first = last) {
    last = end_of_round(m, first, rows);
    for (size_t k = 0; k < m->workers; k++) v->store[k].used = 0;
    status = hr2di_row_assembly_run(&v->maker, first, last, keep_row, v);
    rows = next_rows(v, rows);
    for (size_t task = first; task < last && !status; task++)
      for (uint32_t k = m->task[task].first; k < m->task[task].last && !status; k++)
        status = show_row(v, m->scene->runs.patch[k]);
  }
  v->counts.exchange_areas /= 2;
  v->counts.partial_pairs /= 2;
  v->counts.visibility_tests = hr2di_row_assembly_steps(m);
  return status;
}

static void describe(void *of, hr2d_progress *report) {
  report->fraction = hr2di_row_assembly_fraction(of);
}

static hr2d_status run(visit *v, size_t patches) {
  hr2di_watch_describe(v->watch, describe, &v->maker);
  v->store = hr2di_alloc_zero(v->alloc, v->maker.workers, sizeof *v->store);
  v->kept = hr2di_alloc(v->alloc, patches, sizeof *v->kept);
  hr2d_status status = v->store && v->kept ? show_all(v) : HR2D_ENOMEM;
  for (size_t k = 0; k < v->maker.workers && v->store; k++) {
    hr2di_alloc_free(v->alloc, v->store[k].column);
    hr2di_alloc_free(v->alloc, v->store[k].area);
  }
  hr2di_alloc_free(v->alloc, v->store);
  hr2di_alloc_free(v->alloc, v->kept);
  return status ? status : hr2di_watch_ask(v->watch);
}

static hr2d_status visit_images(const hr2d_scene *scene, const hr2d_matrix_options *how,
                                hr2di_watch *watch, hr2d_exchange_row_fn show, void *ctx,
                                hr2d_matrix_counts *counts) {
  const size_t n = hr2di_scene_cell(scene);
  hr2di_image_rows rows;
  hr2d_matrix_counts made;
  hr2d_status status = hr2di_image_rows_init(&rows, scene, how, watch, &made);
  for (size_t i = 0; i < n && !status; i++) {
    const uint64_t first = rows.start[i];
    const size_t count = (size_t)(rows.start[i + 1] - first);
    const hr2d_exchange_row shown = {sizeof shown, i, count, rows.column + first,
                                     rows.area + first};
    status = show(ctx, &shown);
    if (!status) status = hr2di_watch_work(watch, 1 + count / 32);
  }
  if (!status && counts) *counts = made;
  hr2di_image_rows_clear(&rows, &scene->alloc);
  return status ? status : hr2di_watch_ask(watch);
}

hr2d_status hr2d_exchange_rows_visit(const hr2d_scene *scene,
                                     const hr2d_matrix_options *options,
                                     hr2d_exchange_row_fn show, void *ctx,
                                     hr2d_matrix_counts *counts) {
  if (!scene || !show) return HR2D_EINVAL;
  if (!scene->committed) return HR2D_ESTATE;
  if (hr2di_scene_has_gas(scene)) return HR2D_EUNSUPPORTED;
  hr2d_matrix_options o = HR2D_MATRIX_OPTIONS_INIT;
  hr2d_status status = hr2di_sized_copy(&o, sizeof o, options);
  if (status) return status;
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, o.progress, o.progress_ctx, "factors");
  visit v = {.alloc = &scene->alloc,
             .watch = &watch,
             .unit = hr2d_scene_unit(scene),
             .show = show,
             .ctx = ctx};
  hr2di_image_rows_complete(&o, hr2di_scene_cell(scene));
  if (scene->symmetry.motion) return visit_images(scene, &o, &watch, show, ctx, counts);
  status = hr2di_row_assembly_init(&v.maker, scene, o.threads, 1, &watch);
  if (!status) status = run(&v, scene->patches);
  hr2di_row_assembly_clear(&v.maker);
  if (!status && counts) *counts = v.counts;
  return status;
}
