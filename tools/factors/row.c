/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the writers read of the compressed rows. */
#include <inttypes.h>

#include "factors/factors.h"

const double *factors_row(const factors *f, size_t i) {
  const uint64_t *start = hr2d_exchange_rows_start(f->rows);
  const uint32_t *column = hr2d_exchange_rows_column(f->rows);
  const double *area = hr2d_exchange_rows_area(f->rows);
  const double length = hr2d_scene_length(f->scene, i);
  for (size_t k = 0; k < f->patches; k++) f->row[k] = 0;
  for (uint64_t k = start[i]; k < start[i + 1]; k++) f->row[column[k]] = area[k] / length;
  return f->row;
}

void factors_print_entries(const factors *f, size_t i, FILE *stream) {
  const uint64_t *start = hr2d_exchange_rows_start(f->rows);
  const uint32_t *column = hr2d_exchange_rows_column(f->rows);
  const double *area = hr2d_exchange_rows_area(f->rows);
  const double length = hr2d_scene_length(f->scene, i);
  for (uint64_t k = start[i]; k < start[i + 1]; k++)
    fprintf(stream, "%zu %" PRIu32 " %.17g\n", i + 1, column[k] + 1, area[k] / length);
}

uint64_t factors_unseen(const factors *f) {
  return (uint64_t)f->patches * (f->patches - 1) / 2 - f->counts.exchange_areas;
}
