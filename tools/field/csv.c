/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field as CSV (RFC 4180). */
#include "output/csv.h"

#include <math.h>
#include <stdio.h>

#include "field/field.h"
#include "output/output.h"

int field_write_csv(const field *f, const char *path) {
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  status = csv_begin(out.stream, f->options->csv_comment);
  fprintf(out.stream, "x,y,band,mean,flux_x,flux_y,sky%s,error%s\n",
          f->heat ? ",temperature" : "", f->irradiance ? ",irradiance,irradiance_error" : "");
  for (size_t k = 0; k < f->count * f->bands && !status && !ferror(out.stream); k++) {
    const size_t point = k / f->bands;
    fprintf(out.stream, "%.17g,%.17g,%zu,", f->at[point].x, f->at[point].y, k % f->bands);
    if (f->place[point] == HR2D_PLACE_OUTSIDE)
      fputs(",,,", out.stream);
    else
      fprintf(out.stream, "%.17g,%.17g,%.17g,", f->mean[k], f->flux[2 * k], f->flux[2 * k + 1]);
    fprintf(out.stream, "%.17g,", f->sky[point]);
    if (f->heat && f->place[point] != HR2D_PLACE_OUTSIDE)
      fprintf(out.stream, "%.17g", field_temperature(f, point));
    if (f->heat) fputc(',', out.stream);
    if (!isnan(f->error[k])) fprintf(out.stream, "%.17g", f->error[k]);
    if (f->irradiance) {
      fputc(',', out.stream);
      if (!isnan(f->irradiance[k])) fprintf(out.stream, "%.17g", f->irradiance[k]);
      fputc(',', out.stream);
      if (!isnan(f->irradiance_error[k])) fprintf(out.stream, "%.17g", f->irradiance_error[k]);
    }
    fputc('\n', out.stream);
  }
  return output_close(&out, status);
}
