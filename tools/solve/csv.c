/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The leaves of a run as CSV (RFC 4180), in the order of the patches. */
#include "output/csv.h"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "output/complain.h"
#include "output/output.h"
#include "run/leaves.h"
#include "solve/solve.h"

typedef struct writer {
  const run *run;
  FILE *stream;
  size_t patch, order, bands;
  int heat;                            /* the last column is T */
  int sun;                             /* there are columns for what comes straight from it */
  int gathers;                         /* leaves are gathered */
  gsl_integration_glfixed_table *rule; /* for leaves that are gathered */
  double *b, *h; /* of a leaf: bands × order coefficients in Legendre's P_l, and means */
  double *at[2]; /* per band: B and H at a point of it */
} writer;

/* A rule of n points is exact up to degree 2n − 1.  What is gathered on a leaf is as smooth as
   a polynomial of its order, but not one: some points more than coefficients. */
enum { MORE_POINTS = 6 };

/* The solution's own: coefficients of √(2l+1) P_l. */
static void take_own(const writer *w, const piece *p) {
  const double *c = hr2d_solution_field(w->run->solution) + p->element * w->order * w->bands;
  for (size_t b = 0; b < w->bands; b++) {
    w->b[b * w->order] = hr2d_solution_element(w->run->solution, p->element, b);
    w->h[b] = hr2d_solution_element_irradiance(w->run->solution, p->element, b);
    for (size_t l = 1; l < w->order; l++)
      w->b[b * w->order + l] = sqrt(2 * (double)l + 1) * c[l * w->bands + b];
  }
}

/* Where images of a period are cut off, averages of patches are extrapolated well, and leaves
   are not: they see images here and there only.  From points all of the images are seen. */
static int gather(const writer *w, const piece *p) {
  const size_t points = w->order + MORE_POINTS;
  for (size_t k = 0; k < w->order * w->bands; k++) w->b[k] = 0;
  for (size_t b = 0; b < w->bands; b++) w->h[b] = 0;
  for (size_t q = 0; q < points; q++) {
    double x = 0, weight = 0, legendre[HR2D_MAX_ORDER];
    gsl_integration_glfixed_point(-1, 1, q, &x, &weight, w->rule);
    gsl_sf_legendre_Pl_array((int)w->order - 1, x, legendre);
    const double t = p->t0 + (0.5 + 0.5 * x) * (p->t1 - p->t0);
    const int status = run_point(w->run, w->patch, t, w->at[0], w->at[1]);
    if (status) return status;
    for (size_t b = 0; b < w->bands; b++) {
      w->h[b] += 0.5 * weight * w->at[1][b];
      for (size_t l = 0; l < w->order; l++)
        w->b[b * w->order + l] +=
            0.5 * weight * (double)(2 * l + 1) * w->at[0][b] * legendre[l];
    }
  }
  return 0;
}

static void write_temperature(const writer *w, double t, double irradiance) {
  const double kelvin = run_heat_at(w->run, w->patch, t, irradiance);
  fputc(',', w->stream);
  if (!isnan(kelvin)) fprintf(w->stream, "%.17g", kelvin);
}

static int write_leaf(void *ctx, const piece *p) {
  const writer *w = ctx;
  const hr2d_element *e = &hr2d_hierarchy_elements(w->run->hierarchy)[p->element];
  const double unit = hr2d_scene_unit(w->run->scene);
  const int status = w->gathers ? gather(w, p) : 0;
  if (status) return status;
  if (!w->gathers) take_own(w, p);
  fprintf(w->stream, "%zu,", w->patch);
  csv_text(w->stream, hr2d_scene_name(w->run->scene, w->patch));
  fprintf(w->stream, ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", p->t0, p->t1, e->a.x * unit,
          e->a.y * unit, e->b.x * unit, e->b.y * unit);
  for (size_t b = 0; b < w->bands; b++) fprintf(w->stream, ",%.17g", w->b[b * w->order]);
  for (size_t b = 0; b < w->bands; b++) fprintf(w->stream, ",%.17g", w->h[b]);
  for (size_t b = 0; b < w->bands && w->sun; b++)
    fprintf(w->stream, ",%.17g",
            hr2d_scene_sunlight_over(w->run->scene, w->patch, p->t0, p->t1, b));
  for (size_t b = 0; b < w->bands; b++)
    for (size_t l = 1; l < w->order; l++) fprintf(w->stream, ",%.17g", w->b[b * w->order + l]);
  for (size_t b = 0; b < w->bands; b++)
    fprintf(w->stream, ",%.17g", unit * e->length * (w->b[b * w->order] - w->h[b]));
  if (w->heat) write_temperature(w, 0.5 * (p->t0 + p->t1), w->h[0]);
  return fputc('\n', w->stream) == EOF;
}

static void write_header(const writer *w) {
  fputs("patch,name,t0,t1,ax,ay,bx,by", w->stream);
  for (size_t b = 0; b < w->bands; b++) fprintf(w->stream, ",B%zu", b);
  for (size_t b = 0; b < w->bands; b++) fprintf(w->stream, ",H%zu", b);
  for (size_t b = 0; b < w->bands && w->sun; b++) fprintf(w->stream, ",S%zu", b);
  for (size_t b = 0; b < w->bands; b++)
    for (size_t l = 1; l < w->order; l++) fprintf(w->stream, ",B%zuc%zu", b, l);
  for (size_t b = 0; b < w->bands; b++) fprintf(w->stream, ",Q%zu", b);
  if (w->heat) fputs(",T", w->stream);
  fputc('\n', w->stream);
}

/* The room of a writer, in one block. */
static int reserve(writer *w) {
  w->rule = gsl_integration_glfixed_table_alloc(w->order + MORE_POINTS);
  w->b = malloc((w->order + 3) * w->bands * sizeof *w->b);
  if (!w->rule || !w->b) return complain_memory();
  w->h = w->b + w->order * w->bands;
  w->at[0] = w->h + w->bands;
  w->at[1] = w->at[0] + w->bands;
  return 0;
}

int solve_write_csv(const run *r, const char *path) {
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  writer w = {.run = r,
              .stream = out.stream,
              .order = r->account.order,
              .bands = hr2d_scene_bands(r->scene),
              .heat = run_heat_exists(r->scene),
              .sun = run_sun_exists(r->scene),
              .gathers = run_gathers(r) && hr2d_scene_cut_off(r->scene) > 0};
  status = reserve(&w);
  if (!status) status = csv_begin(out.stream, r->options->csv_comment);
  if (!status) write_header(&w);
  for (; !status && w.patch < hr2d_scene_patches(r->scene); w.patch++)
    status = leaves_walk(r->hierarchy, w.patch, 0, write_leaf, &w);
  free(w.b);
  if (w.rule) gsl_integration_glfixed_table_free(w.rule);
  return output_close(&out, ferror(out.stream) ? 0 : status);
}
