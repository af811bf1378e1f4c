/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mean light of a grid as Portable Float Map: a line "Pf" or "PF", of one number or three
   for each pixel, a line with width and height, a line with a scale, which is negative for the
   least significant byte first, and then floats, row by row from the bottom, as the grid has
   its nodes. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "field/field.h"
#include "output/complain.h"
#include "output/output.h"

int field_check_pfm(const field *f) {
  if (!f->options->pfm || f->bands == 1 || f->bands == 3) return 0;
  return complain_usage("--pfm: a float map has one band or three, and this scene has %zu",
                        f->bands);
}

void field_to_pixel_centres(hr2d_field_grid *g) {
  const double x = (g->high.x - g->low.x) / (2 * (double)g->columns),
               y = (g->high.y - g->low.y) / (2 * (double)g->rows);
  g->low = (hr2d_point){g->low.x + x, g->low.y + y};
  g->high = (hr2d_point){g->high.x - x, g->high.y - y};
}

/* Of all machines the one byte order that the head of the file tells. */
static void put_float(float value, FILE *stream) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  for (unsigned shift = 0; shift < 32; shift += 8) fputc((int)(bits >> shift & 0xff), stream);
}

int field_write_pfm(const field *f, const char *path) {
  output out;
  const int status = output_open(&out, path);
  if (status) return status;
  fprintf(out.stream, "%s\n%zu %zu\n-1.0\n", f->bands == 3 ? "PF" : "Pf", f->grid.columns,
          f->grid.rows);
  for (size_t k = 0; k < f->count * f->bands && !ferror(out.stream); k++)
    put_float((float)f->mean[k], out.stream);
  return output_close(&out, status);
}
