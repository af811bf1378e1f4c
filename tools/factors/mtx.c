/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix as Matrix Market, in coordinates that count from 1. */
#include <inttypes.h>
#include <stdio.h>

#include "factors/factors.h"
#include "output/output.h"

int factors_write_mtx(const factors *f) {
  output out;
  const int status = output_open(&out, f->options->mtx);
  const size_t n = f->patches;
  if (status) return status;
  const uint64_t *start = hr2d_exchange_rows_start(f->rows);
  const uint32_t *column = hr2d_exchange_rows_column(f->rows);
  const double *area = hr2d_exchange_rows_area(f->rows);
  fputs("%%MatrixMarket matrix coordinate real general\n"
        "% view factors: row i has the part of the light of patch i that reaches patch j\n",
        out.stream);
  fprintf(out.stream, "%zu %zu %" PRIu64 "\n", n, n, start[n]);
  for (size_t i = 0; i < n && !ferror(out.stream); i++) {
    const double length = hr2d_scene_length(f->scene, i);
    for (uint64_t k = start[i]; k < start[i + 1]; k++)
      fprintf(out.stream, "%zu %" PRIu32 " %.17g\n", i + 1, column[k] + 1, area[k] / length);
  }
  return output_close(&out, 0);
}
