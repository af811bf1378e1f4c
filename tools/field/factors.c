/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view factors from points to patches as CSV (RFC 4180): a row for each patch that a point
   sees. */
#include <stdio.h>

#include "field/field.h"
#include "output/complain.h"
#include "output/csv.h"
#include "output/output.h"
#include "output/progress.h"

typedef struct writer {
  const field *f;
  FILE *stream;
} writer;

static void write_share(const writer *w, size_t point, double share) {
  const hr2d_point at = w->f->at[point];
  fprintf(w->stream, "%zu,%.17g,%.17g,%.17g,", point, at.x, at.y, share);
}

/* The sky and black backs are no patches. */
static void write_rest(const writer *w, size_t point, const char *name, double share) {
  if (!(share > 0)) return;
  write_share(w, point, share);
  fprintf(w->stream, ",%s\n", name);
}

static hr2d_status write_row(void *ctx, const hr2d_field_row *row) {
  const writer *w = ctx;
  for (size_t k = 0; k < row->count; k++) {
    write_share(w, row->point, row->share[k]);
    fprintf(w->stream, "%u,", (unsigned)row->patch[k]);
    csv_text(w->stream, hr2d_scene_name(w->f->scene, row->patch[k]));
    fputc('\n', w->stream);
  }
  write_rest(w, row->point, "sky", row->sky);
  write_rest(w, row->point, "back", row->back);
  return ferror(w->stream) ? HR2D_EIO : HR2D_OK; /* output_close() says why */
}

int field_write_factors(const field *f, const char *path) {
  output out;
  progress p;
  int status = output_open(&out, path);
  if (status) return status;
  writer w = {f, out.stream};
  progress_start(&p, f->options->quiet);
  const hr2d_field_options how = {.struct_size = sizeof how,
                                  .threads = options_threads(f->options),
                                  .progress = progress_show,
                                  .progress_ctx = &p};
  status = csv_begin(out.stream, f->options->csv_comment);
  fputs("point,x,y,share,patch,name\n", out.stream);
  hr2d_status call = HR2D_OK;
  if (!status)
    call = hr2d_field_rows_visit(f->scene, f->at, NULL, f->count, &how, write_row, &w);
  progress_clear(&p);
  progress_end();
  if (call && !ferror(out.stream)) status = complain_call(f->options->scene, "", call);
  return output_close(&out, status);
}
