/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Half rows have each pair of patches and images once, or in two parts.  The pair of patch i
   and an image of patch k with i < k counts for the entries ik and ki; that of k and an image
   of i is the same by symmetry, and is left out.  So the matrix is symmetric bit for bit.  Rows
   are made by one thread, as their parts meet in the same entries. */
#include "visibility/image-matrix.h"

#include <string.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "visibility/row-maker.h"

typedef struct folder {
  const hr2d_scene *scene;
  size_t n;
  double *area;
  unsigned char *partial; /* per entry */
} folder;

/* Adds a pair of which one is of the cell. */
static void add(const folder *f, size_t patch, size_t other, double area, int partial) {
  const hr2di_symmetry *s = &f->scene->symmetry;
  if (patch >= f->n || other >= s->motions * s->cell) return;
  const size_t k = other % s->cell;
  if (patch > k) return;
  f->area[patch * f->n + k] += s->motion[other / s->cell].weight * area;
  f->partial[patch * f->n + k] |= (unsigned char)partial;
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
      const double area = f->area[i * f->n + k];
      f->area[k * f->n + i] = area;
      counts->exchange_areas += area != 0;
      counts->partial_pairs += area != 0 && f->partial[i * f->n + k];
    }
  }
  return status;
}

hr2d_status hr2di_image_matrix(const hr2d_scene *scene, hr2di_watch *watch, double *area,
                               hr2d_matrix_counts *counts) {
  hr2di_row_maker maker;
  folder f = {.scene = scene, .n = hr2di_scene_cell(scene), .area = area};
  hr2d_matrix_counts sum = {0};
  f.partial = hr2di_alloc_zero(&scene->alloc, f.n, f.n);
  if (!f.partial) return HR2D_ENOMEM;
  memset(area, 0, f.n * f.n * sizeof *area);
  hr2d_status status = hr2di_row_maker_init(&maker, scene, 1, 0, watch);
  if (!status) status = hr2di_row_maker_run(&maker, 0, maker.tasks, take, &f);
  if (!status) status = mirror(&f, watch, &sum);
  sum.visibility_tests = hr2di_row_maker_steps(&maker);
  hr2di_row_maker_clear(&maker);
  hr2di_alloc_free(&scene->alloc, f.partial);
  if (!status && counts) *counts = sum;
  return status;
}
