/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix as CSV (RFC 4180). */
#include "output/csv.h"

#include <stdio.h>

#include "factors/factors.h"
#include "output/output.h"

int factors_write_csv(const factors *f) {
  output out;
  int status = output_open(&out, f->options->csv);
  const size_t n = f->count;
  if (status) return status;
  status = csv_begin(out.stream, f->options->csv_comment);
  for (size_t k = 0; k < n; k++) {
    csv_text(out.stream, f->name[k]);
    fputc(k + 1 < n ? ',' : '\n', out.stream);
  }
  for (size_t i = 0; i < n && !ferror(out.stream); i++) {
    const double *row = factors_row(f, i);
    for (size_t k = 0; k < n; k++)
      fprintf(out.stream, "%.17g%c", row[k], k + 1 < n ? ',' : '\n');
  }
  return output_close(&out, status);
}
