/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rows.h"

#include <math.h>

#include "bars.h"
#include "timing.h"

static double worst_row(const hr2d_scene *scene, const hr2d_exchange_rows *rows) {
  const uint64_t *start = hr2d_exchange_rows_start(rows);
  const double *area = hr2d_exchange_rows_area(rows);
  double worst = 0;
  for (size_t i = 0; i < hr2d_scene_patches(scene); i++) {
    const double length = hr2d_scene_length(scene, i);
    long double sum = -length;
    for (uint64_t k = start[i]; k < start[i + 1]; k++) sum += area[k];
    worst = fmax(worst, fabs((double)sum) / length);
  }
  return worst;
}

double rows_hold(const hr2d_scene *scene, measured *m) {
  hr2d_exchange_rows *rows = NULL;
  const double start = cpu_seconds();
  if (hr2d_exchange_rows_create(scene, NULL, &rows, &m->counts)) bars_fail("no rows");
  const double seconds = cpu_seconds() - start;
  if (m->entries == 0) m->row = worst_row(scene, rows);
  m->entries = hr2d_exchange_rows_entries(rows);
  hr2d_exchange_rows_destroy(rows);
  return seconds;
}

static hr2d_status weigh_row(void *ctx, const hr2d_exchange_row *row) {
  balance *b = ctx;
  const double length = hr2d_scene_length(b->scene, row->patch);
  long double sum = -length;
  for (size_t k = 0; k < row->count; k++) sum += row->area[k];
  b->worst = fmax(b->worst, fabs((double)sum) / length);
  b->entries += row->count;
  return HR2D_OK;
}

void rows_visit(const hr2d_scene *scene, unsigned threads, balance *b) {
  hr2d_matrix_options options = HR2D_MATRIX_OPTIONS_INIT;
  options.threads = threads;
  *b = (balance){.scene = scene};
  if (hr2d_exchange_rows_visit(scene, &options, weigh_row, b, NULL)) bars_fail("no rows");
}
