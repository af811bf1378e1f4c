/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Half rows have each pair of patches and images once, or in two parts.  The pair of patch i
   and an image of patch k with i < k counts for the entries ik and ki; that of k and an image
   of i is the same by symmetry, and is left out.  So the matrix is symmetric bit for bit.  Rows
   are made by one thread, as their parts meet in the same entries.

   What is cut off of a period is extrapolated entry by entry, see scene/period-weights.c.  It
   is not below 0, and over a row no more than what the patch sees of the ends. */
#include "visibility/image-matrix.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "visibility/row-maker.h"

typedef struct folder {
  const hr2d_scene *scene;
  size_t n;
  double *area;
  unsigned char *partial;           /* per entry */
  double *tail;                     /* per entry: what is extrapolated; NULL: nothing is */
  double *check[HR2DI_TAIL_CHECKS]; /* and what checks leave of it; NULL: nobody asks */
  double *ends;                     /* per patch: what it sees of the ends */
} folder;

static void add_tail(const folder *f, size_t entry, const hr2di_motion *g, double area) {
  if (!f->tail) return;
  f->tail[entry] += (g->weight - 1) * area;
  for (int c = 0; c < HR2DI_TAIL_CHECKS && f->ends; c++)
    f->check[c][entry] += g->check[c] * area;
}

/* Adds a pair of which one is of the cell. */
static void add(const folder *f, size_t patch, size_t other, double area, int partial) {
  const hr2di_symmetry *s = &f->scene->symmetry;
  if (patch >= f->n) return;
  if (other >= s->motions * s->cell) {
    if (f->ends) f->ends[patch] += area;
    return;
  }
  const size_t k = other % s->cell, entry = patch * f->n + k;
  if (patch > k) return;
  f->area[entry] += area;
  add_tail(f, entry, &s->motion[other / s->cell], area);
  f->partial[entry] |= (unsigned char)partial;
}

static hr2d_status take(void *ctx, size_t worker, const hr2di_row *row) {
  const folder *f = ctx;
  const double unit = hr2d_scene_unit(f->scene);
  (void)worker;
  for (size_t k = 0; k < row->count; k++) {
    const size_t other = row->column[k] & ~HR2DI_PARTIAL;
    const int partial = (row->column[k] & HR2DI_PARTIAL) != 0;
    add(f, row->patch, other, row->area[k] * unit, partial);
    add(f, other, row->patch, row->area[k] * unit, partial);
  }
  return HR2D_OK;
}

static hr2d_status mirror(const folder *f, hr2di_watch *watch, hr2d_matrix_counts *counts) {
  hr2d_status status = HR2D_OK;
  for (size_t i = 0; i < f->n && !status; i++) {
    status = hr2di_watch_work(watch, 1 + f->n / 16);
    for (size_t k = i; k < f->n; k++) {
      if (f->tail) f->area[i * f->n + k] += fmax(f->tail[i * f->n + k], 0);
      const double area = f->area[i * f->n + k];
      f->area[k * f->n + i] = area;
      counts->exchange_areas += area != 0;
      counts->partial_pairs += area != 0 && f->partial[i * f->n + k];
    }
  }
  return status;
}

/* The sums over a row of what its entries may be off. */
static void sum_errors(const folder *f, size_t i, double *estimate, double *bound) {
  double sum = 0, all = f->ends[i];
  for (size_t k = 0; k < f->n; k++) {
    const size_t entry = i < k ? i * f->n + k : k * f->n + i;
    double most = 0;
    for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) most = fmax(most, fabs(f->check[c][entry]));
    sum += most;
    all += fmax(f->tail[entry], 0);
  }
  *estimate = fmin(sum, all);
  *bound = fmin(HR2DI_TAIL_BOUND * sum, all);
}

static hr2d_status tell_errors(const folder *f, const hr2d_matrix_options *how,
                               hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t i = 0; i < f->n && !status; i++) {
    double estimate, bound;
    sum_errors(f, i, &estimate, &bound);
    if (how->cut_off_estimate) how->cut_off_estimate[i] = estimate;
    if (how->cut_off_bound) how->cut_off_bound[i] = bound;
    status = hr2di_watch_work(watch, 1 + f->n / 16);
  }
  return status;
}

void hr2di_image_matrix_complete(const hr2d_matrix_options *how, size_t rows) {
  for (size_t i = 0; i < rows && how->cut_off_estimate; i++) how->cut_off_estimate[i] = 0;
  for (size_t i = 0; i < rows && how->cut_off_bound; i++) how->cut_off_bound[i] = 0;
}

static hr2d_status reserve(folder *f, int wanted) {
  const hr2d_allocator *alloc = &f->scene->alloc;
  hr2d_status status = HR2D_OK;
  f->partial = hr2di_alloc_zero(alloc, f->n, f->n);
  if (!f->partial) return HR2D_ENOMEM;
  if (!hr2di_symmetry_cuts(&f->scene->symmetry)) return HR2D_OK;
  f->tail = hr2di_alloc_zero(alloc, f->n, f->n * sizeof *f->tail);
  if (!f->tail) return HR2D_ENOMEM;
  for (int c = 0; c < HR2DI_TAIL_CHECKS && wanted; c++) {
    f->check[c] = hr2di_alloc_zero(alloc, f->n, f->n * sizeof *f->check[c]);
    if (!f->check[c]) status = HR2D_ENOMEM;
  }
  if (wanted && !status) f->ends = hr2di_alloc_zero(alloc, f->n, sizeof *f->ends);
  return wanted && !f->ends ? HR2D_ENOMEM : status;
}

static void clear(folder *f) {
  const hr2d_allocator *alloc = &f->scene->alloc;
  hr2di_alloc_free(alloc, f->partial);
  hr2di_alloc_free(alloc, f->tail);
  hr2di_alloc_free(alloc, f->ends);
  for (int c = 0; c < HR2DI_TAIL_CHECKS; c++) hr2di_alloc_free(alloc, f->check[c]);
}

hr2d_status hr2di_image_matrix(const hr2d_scene *scene, const hr2d_matrix_options *how,
                               hr2di_watch *watch, double *area, hr2d_matrix_counts *counts) {
  hr2di_row_maker maker = {.scene = scene};
  folder f = {.scene = scene, .n = hr2di_scene_cell(scene), .area = area};
  hr2d_matrix_counts sum = {0};
  hr2d_status status = reserve(&f, how->cut_off_estimate || how->cut_off_bound);
  memset(area, 0, f.n * f.n * sizeof *area);
  if (!status) status = hr2di_row_maker_init(&maker, scene, 1, 0, watch);
  if (!status) status = hr2di_row_maker_run(&maker, 0, maker.tasks, take, &f);
  if (!status) status = mirror(&f, watch, &sum);
  if (!status && f.ends) status = tell_errors(&f, how, watch);
  sum.visibility_tests = hr2di_row_maker_steps(&maker);
  hr2di_row_maker_clear(&maker);
  clear(&f);
  if (!status && counts) *counts = sum;
  return status;
}
