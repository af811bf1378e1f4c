/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix as Matrix Market, in coordinates that count from 1. */
#include <inttypes.h>
#include <stdio.h>

#include "factors/factors.h"
#include "output/output.h"
#include "output/provenance.h"

int factors_write_mtx(const factors *f) {
  output out;
  int status = output_open(&out, f->options->mtx);
  const size_t n = f->count;
  if (status) return status;
  fputs("%%MatrixMarket matrix coordinate real general\n"
        "% view factors: row i has the part of the light of patch i that reaches patch j\n",
        out.stream);
  status = provenance_print(out.stream, "% ", "\n");
  fprintf(out.stream, "%zu %zu %" PRIu64 "\n", n, n, f->start[n]);
  for (size_t i = 0; i < n && !ferror(out.stream); i++) factors_print_entries(f, i, out.stream);
  return output_close(&out, status);
}
