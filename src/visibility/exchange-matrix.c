/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exchange areas of all pairs of patches as a full matrix: half rows are put into their
   rows, and then the two halves of each pair are added. */
#include <hr2d/visibility.h>
#include <math.h>
#include <string.h>

#include "base/sized-struct.h"
#include "scene/scene-impl.h"
#include "visibility/image-rows.h"
#include "visibility/row-assembly.h"

enum { TILE = 8 };

typedef struct matrix {
  hr2di_row_assembly maker;
  size_t n;
  double *area;
  double unit; /* of the scene's coordinates */
} matrix;

/* Entries of partial pairs are negative until they are mirrored. */
static hr2d_status put_row(void *ctx, size_t worker, const hr2di_row *row) {
  const matrix *m = ctx;
  double *area = m->area + row->patch * m->n;
  (void)worker;
  memset(area, 0, m->n * sizeof *area);
  for (size_t k = 0; k < row->count; k++) {
    const double value = row->area[k] * m->unit;
    area[row->column[k] & ~HR2DI_PARTIAL] = row->column[k] & HR2DI_PARTIAL ? -value : value;
  }
  return HR2D_OK;
}

static void add_halves(const matrix *m, size_t i, size_t j, hr2d_matrix_counts *counts) {
  double *one = &m->area[i * m->n + j], *other = &m->area[j * m->n + i];
  if (*one == 0 && *other == 0) return;
  counts->exchange_areas++;
  counts->partial_pairs += *one < 0 || *other < 0;
  *one = *other = fabs(*one) + fabs(*other);
}

/* Tile by tile, lest each value take a cache line of its own. */
static hr2d_status mirror(const matrix *m, hr2di_watch *watch, hr2d_matrix_counts *counts) {
  const size_t n = m->n;
  hr2d_status status = HR2D_OK;
  for (size_t i0 = 0; i0 < n && !status; i0 += TILE)
    for (size_t j0 = i0; j0 < n && !(status = hr2di_watch_work(watch, TILE)); j0 += TILE)
      for (size_t i = i0; i < n && i < i0 + TILE; i++)
        for (size_t j = j0 > i ? j0 : i + 1; j < n && j < j0 + TILE; j++)
          add_halves(m, i, j, counts);
  return status;
}

/* Rows have n zeros first, and then their entries. */
static hr2d_status put_images(const matrix *m, const hr2d_scene *scene,
                              const hr2d_matrix_options *how, hr2di_watch *watch,
                              hr2d_matrix_counts *counts) {
  const size_t n = hr2di_scene_cell(scene);
  hr2di_image_rows rows;
  hr2d_status status = hr2di_image_rows_init(&rows, scene, how, watch, counts);
  for (size_t i = 0; i < n && !status; i++) {
    memset(m->area + i * n, 0, n * sizeof *m->area);
    for (uint64_t k = rows.start[i]; k < rows.start[i + 1]; k++)
      m->area[i * n + rows.column[k]] = rows.area[k];
    status = hr2di_watch_work(watch, 1 + n / 32);
  }
  hr2di_image_rows_clear(&rows, &scene->alloc);
  return status;
}

static void describe(void *of, hr2d_progress *report) {
  report->fraction = hr2di_row_assembly_fraction(of);
}

hr2d_status hr2d_exchange_matrix(const hr2d_scene *scene, const hr2d_matrix_options *options,
                                 double *area, hr2d_matrix_counts *counts) {
  if (!scene || !area) return HR2D_EINVAL;
  if (!scene->committed) return HR2D_ESTATE;
  if (hr2di_scene_has_gas(scene)) return HR2D_EUNSUPPORTED;
  matrix m = {.n = scene->patches, .area = area, .unit = hr2d_scene_unit(scene)};
  hr2d_matrix_options o = HR2D_MATRIX_OPTIONS_INIT;
  hr2d_status status = hr2di_sized_copy(&o, sizeof o, options);
  if (status) return status;
  hr2d_matrix_counts sum = {0};
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, o.progress, o.progress_ctx, "factors");
  hr2di_image_rows_complete(&o, hr2di_scene_cell(scene));
  if (scene->symmetry.motion) {
    status = put_images(&m, scene, &o, &watch, counts);
    return status ? status : hr2di_watch_ask(&watch);
  }
  status = hr2di_row_assembly_init(&m.maker, scene, o.threads, 0, &watch);
  hr2di_watch_describe(&watch, describe, &m.maker);
  if (!status) status = hr2di_row_assembly_run(&m.maker, 0, m.maker.tasks, put_row, &m);
  if (!status) status = mirror(&m, &watch, &sum);
  if (!status) status = hr2di_watch_ask(&watch);
  sum.visibility_tests = hr2di_row_assembly_steps(&m.maker);
  if (!status && counts) *counts = sum;
  hr2di_row_assembly_clear(&m.maker);
  return status;
}
