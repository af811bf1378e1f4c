/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix as the text file ViewFactors.dat of Elmer (https://www.elmerfem.org).

   For each surface Elmer's solver reads the number of its factors, and then a line "i j F_ij"
   for each, list-directed; it multiplies by the area itself.  Surfaces count from 1, in the
   order in which the mesh has the boundary elements with Radiation = Diffuse Gray. */
#include <inttypes.h>
#include <stdio.h>

#include "factors/factors.h"
#include "output/output.h"

int factors_write_elmer(const factors *f) {
  output out;
  const int status = output_open(&out, f->options->elmer);
  const size_t n = f->count;
  if (status) return status;
  for (size_t i = 0; i < n && !ferror(out.stream); i++) {
    fprintf(out.stream, "%" PRIu64 "\n", f->start[i + 1] - f->start[i]);
    factors_print_entries(f, i, out.stream);
  }
  return output_close(&out, 0);
}
