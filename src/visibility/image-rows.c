/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Half rows have each pair of patches and images once, or in two parts.  The pair of patch i
   and an image of patch k with i < k counts for the entries ik and ki; that of k and an image
   of i is the same by symmetry, and is left out.  So the rows are symmetric bit for bit.  They
   are made by one thread, as their parts meet in the same entries, which a table has with i ≤
   k.

   What is cut off of a period is extrapolated entry by entry, see scene/period-weights.c.  It
   is not below 0, and over a row no more than what the patch sees of the ends. */
#include "visibility/image-rows.h"

#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "visibility/entry-table.h"
#include "visibility/row-assembly.h"

typedef struct folder {
  const hr2d_scene *scene;
  size_t n;
  hr2di_entry_table table;
  double *ends; /* per patch: what it sees of the ends; NULL: nobody asks what is cut off */
  hr2di_watch *watch;
} folder;

static void add_tail(const folder *f, size_t entry, const hr2di_motion *g, double area) {
  if (!f->table.tails) return;
  hr2di_entry_tail *tail = &f->table.tail[entry];
  tail->sum += (g->weight - 1) * area;
  for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) tail->check[c] += g->check[c] * area;
}

/* Adds a pair of which one is of the cell. */
static hr2d_status add(folder *f, size_t patch, size_t other, double area, int partial) {
  const hr2di_symmetry *s = &f->scene->symmetry;
  if (patch >= f->n) return HR2D_OK;
  if (other >= s->motions * s->cell) {
    if (f->ends) f->ends[patch] += area;
    return HR2D_OK;
  }
  const size_t k = other % s->cell;
  size_t entry;
  if (patch > k) return HR2D_OK;
  const hr2d_status status =
      hr2di_entry_table_find(&f->table, (uint64_t)patch * f->n + k, &entry);
  if (status) return status;
  f->table.entry[entry].area += area;
  f->table.entry[entry].partial |= partial;
  add_tail(f, entry, &s->motion[other / s->cell], area);
  return HR2D_OK;
}

static hr2d_status take(void *ctx, size_t worker, const hr2di_row *row) {
  folder *f = ctx;
  const double unit = hr2d_scene_unit(f->scene);
  hr2d_status status = HR2D_OK;
  (void)worker;
  for (size_t k = 0; k < row->count && !status; k++) {
    const size_t other = row->column[k] & ~HR2DI_PARTIAL;
    const int partial = (row->column[k] & HR2DI_PARTIAL) != 0;
    status = hr2di_watch_work(f->watch, 1);
    if (!status) status = add(f, row->patch, other, row->area[k] * unit, partial);
    if (!status) status = add(f, other, row->patch, row->area[k] * unit, partial);
  }
  return status;
}

/* Adds what is extrapolated, and counts the entries of each row behind the start of the next.
 */
static hr2d_status complete_entries(folder *f, uint64_t *start, hr2d_matrix_counts *counts) {
  hr2d_status status = HR2D_OK;
  for (size_t m = 0; m < f->table.count && !status; m++) {
    hr2di_entry *e = &f->table.entry[m];
    const size_t i = (size_t)(e->key / f->n), k = (size_t)(e->key % f->n);
    if (m % 16 == 0) status = hr2di_watch_work(f->watch, 4);
    if (f->table.tails) e->area += fmax(f->table.tail[m].sum, 0);
    if (e->area == 0) continue;
    start[i + 1]++;
    if (i != k) start[k + 1]++;
    counts->exchange_areas++;
    counts->partial_pairs += e->partial != 0;
  }
  for (size_t i = 0; i < f->n; i++) start[i + 1] += start[i];
  return status;
}

/* Entries come in the order of rows, so that row k has its columns in order: those before k
   come with their own rows, earlier. */
static hr2d_status fill_rows(const folder *f, hr2di_image_rows *r, uint64_t *next) {
  hr2d_status status = HR2D_OK;
  for (size_t i = 0; i < f->n; i++) next[i] = r->start[i];
  for (size_t m = 0; m < f->table.count && !status; m++) {
    const hr2di_entry *e = &f->table.entry[m];
    const size_t i = (size_t)(e->key / f->n), k = (size_t)(e->key % f->n);
    if (m % 16 == 0) status = hr2di_watch_work(f->watch, 8);
    if (e->area == 0) continue;
    r->column[next[i]] = (uint32_t)k;
    r->area[next[i]++] = e->area;
    if (i == k) continue;
    r->column[next[k]] = (uint32_t)i;
    r->area[next[k]++] = e->area;
  }
  return status;
}

static hr2d_status make_rows(folder *f, hr2di_image_rows *r, hr2d_matrix_counts *counts) {
  const hr2d_allocator *alloc = &f->scene->alloc;
  hr2d_status status = hr2di_entry_table_sort(&f->table);
  r->start = hr2di_alloc_zero(alloc, f->n + 1, sizeof *r->start);
  uint64_t *next = hr2di_alloc(alloc, f->n, sizeof *next);
  if (!status && (!r->start || !next)) status = HR2D_ENOMEM;
  if (!status) status = complete_entries(f, r->start, counts);
  if (!status) {
    r->column = hr2di_alloc(alloc, (size_t)r->start[f->n] + 1, sizeof *r->column);
    r->area = hr2di_alloc(alloc, (size_t)r->start[f->n] + 1, sizeof *r->area);
    status = r->column && r->area ? fill_rows(f, r, next) : HR2D_ENOMEM;
  }
  hr2di_alloc_free(alloc, next);
  return status;
}

/* The sums over a row of what its entries may be off, and what they are at most. */
typedef struct row_errors {
  double sum, all;
} row_errors;

static void add_error(row_errors *e, const hr2di_entry_tail *tail) {
  double max = 0;
  for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) max = fmax(max, fabs(tail->check[c]));
  e->sum += max;
  e->all += fmax(tail->sum, 0);
}

/* In the order of columns, as in fill_rows(). */
static hr2d_status tell_errors(const folder *f, const hr2d_matrix_options *how) {
  row_errors *row = hr2di_alloc_zero(&f->scene->alloc, f->n, sizeof *row);
  hr2d_status status = row ? HR2D_OK : HR2D_ENOMEM;
  for (size_t i = 0; i < f->n && !status; i++) row[i].all = f->ends[i];
  for (size_t m = 0; m < f->table.count && !status; m++) {
    const size_t i = (size_t)(f->table.entry[m].key / f->n),
                 k = (size_t)(f->table.entry[m].key % f->n);
    if (m % 16 == 0) status = hr2di_watch_work(f->watch, 8);
    add_error(&row[i], &f->table.tail[m]);
    if (i != k) add_error(&row[k], &f->table.tail[m]);
  }
  for (size_t i = 0; i < f->n && !status; i++) {
    if (how->cut_off_estimate) how->cut_off_estimate[i] = fmin(row[i].sum, row[i].all);
    if (how->cut_off_bound)
      how->cut_off_bound[i] = fmin(HR2DI_TAIL_BOUND * row[i].sum, row[i].all);
  }
  hr2di_alloc_free(&f->scene->alloc, row);
  return status;
}

void hr2di_image_rows_complete(const hr2d_matrix_options *how, size_t rows) {
  for (size_t i = 0; i < rows && how->cut_off_estimate; i++) how->cut_off_estimate[i] = 0;
  for (size_t i = 0; i < rows && how->cut_off_bound; i++) how->cut_off_bound[i] = 0;
}

static void describe(void *of, hr2d_progress *report) {
  report->fraction = hr2di_row_assembly_fraction(of);
}

hr2d_status hr2di_image_rows_init(hr2di_image_rows *rows, const hr2d_scene *scene,
                                  const hr2d_matrix_options *how, hr2di_watch *watch,
                                  hr2d_matrix_counts *counts) {
  const hr2d_allocator *alloc = &scene->alloc;
  const int tails = hr2di_symmetry_cuts(&scene->symmetry);
  const int wanted = tails && (how->cut_off_estimate || how->cut_off_bound);
  hr2di_row_assembly maker = {.scene = scene};
  folder f = {.scene = scene,
              .n = hr2di_scene_cell(scene),
              .table = {.alloc = alloc, .watch = watch, .tails = tails},
              .watch = watch};
  hr2d_matrix_counts sum = {0};
  *rows = (hr2di_image_rows){0};
  if (wanted) f.ends = hr2di_alloc_zero(alloc, f.n, sizeof *f.ends);
  hr2d_status status = wanted && !f.ends ? HR2D_ENOMEM : HR2D_OK;
  if (!status) status = hr2di_row_assembly_init(&maker, scene, 1, 0, watch);
  hr2di_watch_describe(watch, describe, &maker);
  if (!status) status = hr2di_row_assembly_run(&maker, 0, maker.tasks, take, &f);
  hr2di_watch_describe(watch, NULL, NULL);
  if (!status) status = make_rows(&f, rows, &sum);
  if (!status && wanted) status = tell_errors(&f, how);
  sum.visibility_tests = hr2di_row_assembly_steps(&maker);
  hr2di_row_assembly_clear(&maker);
  hr2di_entry_table_clear(&f.table);
  hr2di_alloc_free(alloc, f.ends);
  if (!status && counts) *counts = sum;
  return status;
}

void hr2di_image_rows_clear(hr2di_image_rows *rows, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, rows->start);
  hr2di_alloc_free(alloc, rows->column);
  hr2di_alloc_free(alloc, rows->area);
  *rows = (hr2di_image_rows){0};
}
