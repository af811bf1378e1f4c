/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas as compressed rows.

   Threads make half rows and keep them in chunks of their own.  A row of the result is the half
   row of its patch, and what other half rows have in its column.  As these are visited in
   order, both parts are sorted and are merged. */
#include <hr2d/transport.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "scene/scene-impl.h"
#include "visibility/image-rows.h"
#include "visibility/row-assembly.h"

/* Entries of the first chunk of a thread, and of the largest; each is twice the one before. */
enum { CHUNK = 1 << 12, LARGEST_CHUNK = 1 << 19, MOST_THREADS = 256 };

struct hr2d_exchange_rows {
  hr2d_allocator alloc;
  uint64_t *start;
  uint32_t *column;
  double *area;
  size_t patches;
};

/* Entries of half rows, all of the same thread. */
typedef struct chunk {
  struct chunk *next;
  uint32_t *column;
  double *area;
  size_t used, room;
} chunk;

typedef struct half_row {
  const uint32_t *column;
  const double *area;
  uint32_t count;
} half_row;

typedef struct builder {
  hr2di_row_assembly maker;
  hr2di_watch *watch;
  const hr2d_allocator *alloc;
  hr2d_exchange_rows *rows;
  half_row *half; /* per patch */
  uint64_t *fill; /* per patch: behind its last entry so far */
  double unit;
  chunk *chunk[MOST_THREADS];
  hr2d_matrix_counts counts;
} builder;

/* ---- half rows */

static chunk *add_chunk(builder *b, size_t worker, size_t needed) {
  chunk *c = hr2di_alloc_zero(b->alloc, 1, sizeof *c);
  if (!c) return NULL;
  c->next = b->chunk[worker];
  size_t room = c->next ? 2 * c->next->room : CHUNK;
  if (room > LARGEST_CHUNK) room = LARGEST_CHUNK;
  if (room < needed) room = needed;
  c->room = room;
  b->chunk[worker] = c;
  c->column = hr2di_alloc(b->alloc, room, sizeof *c->column);
  c->area = hr2di_alloc(b->alloc, room, sizeof *c->area);
  return c->column && c->area ? c : NULL;
}

static hr2d_status keep_row(void *ctx, size_t worker, const hr2di_row *row) {
  builder *b = ctx;
  chunk *c = b->chunk[worker];
  if (row->count == 0) return HR2D_OK;
  if (!c || c->room - c->used < row->count) c = add_chunk(b, worker, row->count);
  if (!c) return HR2D_ENOMEM;
  uint32_t *column = c->column + c->used;
  double *area = c->area + c->used;
  memcpy(column, row->column, row->count * sizeof *column);
  for (size_t k = 0; k < row->count; k++) area[k] = row->area[k] * b->unit;
  c->used += row->count;
  b->half[row->patch] = (half_row){column, area, (uint32_t)row->count};
  return HR2D_OK;
}

static void free_chunks(builder *b) {
  for (size_t k = 0; k < MOST_THREADS; k++)
    while (b->chunk[k]) {
      chunk *c = b->chunk[k];
      b->chunk[k] = c->next;
      hr2di_alloc_free(b->alloc, c->column);
      hr2di_alloc_free(b->alloc, c->area);
      hr2di_alloc_free(b->alloc, c);
    }
}

/* ---- whole rows */

/* Sets the starts of rows that have a place for each half of each pair. */
static hr2d_status count_entries(builder *b) {
  const size_t n = b->rows->patches;
  uint64_t *start = b->rows->start;
  hr2d_status status = HR2D_OK;
  for (size_t i = 0; i < n && !status; i++) {
    const half_row *h = &b->half[i];
    start[i + 1] += h->count;
    for (uint32_t k = 0; k < h->count; k++) start[(h->column[k] & ~HR2DI_PARTIAL) + 1]++;
    status = hr2di_watch_work(b->watch, 1 + h->count / 32);
  }
  for (size_t i = 0; i < n; i++) start[i + 1] += start[i];
  return status;
}

static hr2d_status reserve_entries(builder *b) {
  hr2d_exchange_rows *r = b->rows;
  if (r->start[r->patches] > SIZE_MAX / sizeof *r->area) return HR2D_ENOMEM;
  const size_t entries = (size_t)r->start[r->patches];
  r->column = hr2di_alloc(b->alloc, entries, sizeof *r->column);
  r->area = hr2di_alloc(b->alloc, entries, sizeof *r->area);
  b->fill = hr2di_alloc(b->alloc, r->patches, sizeof *b->fill);
  return r->column && r->area && b->fill ? HR2D_OK : HR2D_ENOMEM;
}

/* Puts what others have in column i at the end of row i, and leaves room for its half row. */
static hr2d_status scatter(builder *b) {
  hr2d_exchange_rows *r = b->rows;
  hr2d_status status = HR2D_OK;
  for (size_t i = 0; i < r->patches; i++) b->fill[i] = r->start[i] + b->half[i].count;
  for (size_t i = 0; i < r->patches && !status; i++) {
    const half_row *h = &b->half[i];
    for (uint32_t k = 0; k < h->count; k++) {
      const uint64_t at = b->fill[h->column[k] & ~HR2DI_PARTIAL]++;
      r->column[at] = (uint32_t)i | (h->column[k] & HR2DI_PARTIAL);
      r->area[at] = h->area[k];
    }
    status = hr2di_watch_work(b->watch, 1 + h->count / 16);
  }
  return status;
}

/* Merges the half row of i with the entries that end row i, [tail, last), and moves it to `to`;
   returns its length.  What is written never overtakes what is read: to + made ≤ tail, as there
   is room for the half row before `tail`.  The loop has no branches that depend on the columns
   but for the end of a part. */
static size_t merge(builder *b, size_t i, uint64_t tail, uint64_t last, uint64_t to) {
  const half_row h = b->half[i];
  uint32_t *const column = b->rows->column, *const made_column = column + to;
  double *const area = b->rows->area, *const made_area = area + to;
  size_t head = 0, made = 0, partial = 0;
  while (head < h.count && tail < last) {
    const uint32_t mine = h.column[head], theirs = column[tail];
    const uint32_t p = mine & ~HR2DI_PARTIAL, q = theirs & ~HR2DI_PARTIAL;
    const double first = p <= q ? h.area[head] : 0, second = q <= p ? area[tail] : 0;
    partial += ((p <= q ? mine : 0) | (q <= p ? theirs : 0)) >> 31;
    head += p <= q;
    tail += q <= p;
    made_column[made] = p < q ? p : q;
    made_area[made++] = first + second;
  }
  for (; head < h.count; head++) {
    made_column[made] = h.column[head] & ~HR2DI_PARTIAL;
    made_area[made++] = h.area[head];
    partial += h.column[head] >> 31;
  }
  for (; tail < last; tail++) {
    const uint32_t theirs = column[tail];
    made_area[made] = area[tail];
    made_column[made++] = theirs & ~HR2DI_PARTIAL;
    partial += theirs >> 31;
  }
  b->counts.partial_pairs += partial;
  return made;
}

static hr2d_status merge_all(builder *b) {
  hr2d_exchange_rows *r = b->rows;
  hr2d_status status = HR2D_OK;
  uint64_t first = 0, made = 0;
  for (size_t i = 0; i < r->patches && !status; i++) {
    const uint64_t last = r->start[i + 1];
    const size_t count = merge(b, i, first + b->half[i].count, last, made);
    r->start[i] = made;
    made += count;
    first = last;
    status = hr2di_watch_work(b->watch, 1 + count / 32);
  }
  r->start[r->patches] = made;
  b->counts.exchange_areas = made / 2;
  b->counts.partial_pairs /= 2;
  return status;
}

static hr2d_status reserve_rows(builder *b) {
  const size_t n = b->rows->patches;
  b->rows->start = hr2di_alloc_zero(b->alloc, n + 1, sizeof *b->rows->start);
  b->half = hr2di_alloc_zero(b->alloc, n, sizeof *b->half);
  return b->rows->start && b->half ? HR2D_OK : HR2D_ENOMEM;
}

static void describe(void *of, hr2d_progress *report) {
  report->fraction = hr2di_row_assembly_fraction(of);
}

static hr2d_status make_halves(builder *b, const hr2d_scene *scene, unsigned threads) {
  hr2d_status status = hr2di_row_assembly_init(&b->maker, scene, threads, 0, b->watch);
  hr2di_watch_describe(b->watch, describe, &b->maker);
  if (!status) status = reserve_rows(b);
  if (!status) status = hr2di_row_assembly_run(&b->maker, 0, b->maker.tasks, keep_row, b);
  b->counts.visibility_tests = hr2di_row_assembly_steps(&b->maker);
  hr2di_watch_describe(b->watch, NULL, NULL);
  hr2di_row_assembly_clear(&b->maker);
  return status;
}

static hr2d_status join_halves(builder *b) {
  hr2d_status status = count_entries(b);
  b->watch->report.fraction = 1;
  if (!status) status = reserve_entries(b);
  if (!status) status = scatter(b);
  if (!status) status = merge_all(b);
  return status ? status : hr2di_watch_ask(b->watch);
}

static hr2d_status build(builder *b, const hr2d_scene *scene, unsigned threads) {
  hr2d_status status = make_halves(b, scene, threads);
  if (!status) status = join_halves(b);
  free_chunks(b);
  hr2di_alloc_free(b->alloc, b->half);
  hr2di_alloc_free(b->alloc, b->fill);
  return status;
}

static hr2d_status build_of_images(builder *b, const hr2d_scene *scene,
                                   const hr2d_matrix_options *how) {
  hr2di_image_rows made;
  hr2d_status status = hr2di_image_rows_init(&made, scene, how, b->watch, &b->counts);
  if (!status) status = hr2di_watch_ask(b->watch);
  if (status) {
    hr2di_image_rows_clear(&made, b->alloc);
    return status;
  }
  b->rows->start = made.start;
  b->rows->column = made.column;
  b->rows->area = made.area;
  return HR2D_OK;
}

hr2d_status hr2d_exchange_rows_create(const hr2d_scene *scene,
                                      const hr2d_matrix_options *options,
                                      hr2d_exchange_rows **rows, hr2d_matrix_counts *counts) {
  if (!scene || !rows) return HR2D_EINVAL;
  if (!scene->committed) return HR2D_ESTATE;
  if (hr2di_scene_has_gas(scene)) return HR2D_EUNSUPPORTED;
  hr2d_matrix_options o = HR2D_MATRIX_OPTIONS_INIT;
  hr2d_status status = hr2di_sized_copy(&o, sizeof o, options);
  if (status) return status;
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, o.progress, o.progress_ctx, "factors");
  hr2d_exchange_rows *made = hr2di_alloc_zero(&scene->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  made->alloc = scene->alloc;
  made->patches = hr2di_scene_cell(scene);
  builder b = {
      .watch = &watch, .alloc = &made->alloc, .rows = made, .unit = hr2d_scene_unit(scene)};
  hr2di_image_rows_complete(&o, made->patches);
  status =
      scene->symmetry.motion ? build_of_images(&b, scene, &o) : build(&b, scene, o.threads);
  if (status) {
    hr2d_exchange_rows_destroy(made);
    return status;
  }
  if (counts) *counts = b.counts;
  *rows = made;
  return HR2D_OK;
}

void hr2d_exchange_rows_destroy(hr2d_exchange_rows *rows) {
  if (!rows) return;
  const hr2d_allocator alloc = rows->alloc;
  hr2di_alloc_free(&alloc, rows->start);
  hr2di_alloc_free(&alloc, rows->column);
  hr2di_alloc_free(&alloc, rows->area);
  hr2di_alloc_free(&alloc, rows);
}

uint64_t hr2d_exchange_rows_entries(const hr2d_exchange_rows *rows) {
  if (!rows) return 0;
  return rows->start[rows->patches];
}

const uint64_t *hr2d_exchange_rows_start(const hr2d_exchange_rows *rows) {
  if (!rows) return NULL;
  return rows->start;
}

const uint32_t *hr2d_exchange_rows_column(const hr2d_exchange_rows *rows) {
  if (!rows) return NULL;
  return rows->column;
}

const double *hr2d_exchange_rows_area(const hr2d_exchange_rows *rows) {
  if (!rows) return NULL;
  return rows->area;
}
