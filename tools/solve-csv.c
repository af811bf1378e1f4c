/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The leaves of a run as CSV (RFC 4180), in the order of the patches. */
#include <stdio.h>

#include "csv.h"
#include "leaves.h"
#include "output.h"
#include "run.h"

typedef struct writer {
  const run *run;
  FILE *stream;
  size_t patch;
} writer;

static int write_leaf(void *ctx, const piece *p) {
  const writer *w = ctx;
  const hr2d_element *e = &hr2d_hierarchy_elements(w->run->hierarchy)[p->element];
  const double unit = hr2d_scene_unit(w->run->scene);
  fprintf(w->stream, "%zu,", w->patch);
  csv_text(w->stream, hr2d_scene_name(w->run->scene, w->patch));
  fprintf(w->stream, ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", p->t0, p->t1, e->a.x * unit,
          e->a.y * unit, e->b.x * unit, e->b.y * unit);
  const size_t bands = hr2d_scene_bands(w->run->scene);
  for (size_t b = 0; b < bands; b++)
    fprintf(w->stream, ",%.17g", hr2d_solution_element(w->run->solution, p->element, b));
  const double middle = 0.5 * (p->t0 + p->t1);
  for (size_t b = 0; b < bands; b++)
    fprintf(w->stream, ",%.17g",
            hr2d_solution_irradiance_at(w->run->solution, w->patch, middle, b));
  return fputc('\n', w->stream) == EOF;
}

int write_leaves(const run *r, const char *path) {
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  writer w = {r, out.stream, 0};
  fputs("patch,name,t0,t1,ax,ay,bx,by", out.stream);
  for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++) fprintf(out.stream, ",B%zu", b);
  for (size_t b = 0; b < hr2d_scene_bands(r->scene); b++) fprintf(out.stream, ",H%zu", b);
  fputc('\n', out.stream);
  for (; !status && w.patch < hr2d_scene_patches(r->scene); w.patch++)
    status = walk_leaves(r->hierarchy, w.patch, 0, write_leaf, &w);
  return output_close(&out, ferror(out.stream) ? 0 : status);
}
