/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the writers read of the compressed rows. */
#include <inttypes.h>

#include "factors/factors.h"

const double *factors_row(const factors *f, size_t i) {
  for (size_t k = 0; k < f->count; k++) f->row[k] = 0;
  for (uint64_t k = f->start[i]; k < f->start[i + 1]; k++)
    f->row[f->column[k]] = f->area[k] / f->length[i];
  return f->row;
}

void factors_print_entries(const factors *f, size_t i, FILE *stream) {
  for (uint64_t k = f->start[i]; k < f->start[i + 1]; k++)
    fprintf(stream, "%zu %" PRIu32 " %.17g\n", i + 1, f->column[k] + 1,
            f->area[k] / f->length[i]);
}

uint64_t factors_unseen(const factors *f) {
  const uint64_t patches = hr2d_scene_patches(f->scene);
  return patches * (patches - 1) / 2 - f->counts.exchange_areas;
}
