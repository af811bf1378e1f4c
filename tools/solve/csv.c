/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The leaves of a run as CSV (RFC 4180), in the order of the patches. */
#include "output/csv.h"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <stdio.h>

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
  gsl_integration_glfixed_table *rule; /* with a point for each coefficient of a leaf */
} writer;

typedef double (*field_fn)(const hr2d_solution *, size_t, double, size_t);

/* The first `count` coefficients of a field, a polynomial on the leaf, in Legendre's P_l.  A
   rule of `order` points is exact up to degree 2·order − 1, which its product with P_l has at
   most. */
static void expand(const writer *w, const piece *p, field_fn field, size_t band, size_t count,
                   double *c) {
  for (size_t l = 0; l < count; l++) c[l] = 0;
  for (size_t q = 0; q < w->order; q++) {
    double x = 0, weight = 0, legendre[HR2D_MAX_ORDER];
    gsl_integration_glfixed_point(-1, 1, q, &x, &weight, w->rule);
    gsl_sf_legendre_Pl_array((int)count - 1, x, legendre);
    const double t = p->t0 + (0.5 + 0.5 * x) * (p->t1 - p->t0);
    const double value = 0.5 * weight * field(w->run->solution, w->patch, t, band);
    for (size_t l = 0; l < count; l++) c[l] += (double)(2 * l + 1) * value * legendre[l];
  }
}

static void write_coefficients(const writer *w, const piece *p) {
  double c[HR2D_MAX_ORDER];
  for (size_t b = 0; b < w->bands; b++) {
    expand(w, p, hr2d_solution_at, b, w->order, c);
    for (size_t l = 1; l < w->order; l++) fprintf(w->stream, ",%.17g", c[l]);
  }
}

static void write_temperature(const writer *w, double irradiance) {
  const double kelvin = run_heat_at(w->run, w->patch, irradiance);
  fputc(',', w->stream);
  if (!isnan(kelvin)) fprintf(w->stream, "%.17g", kelvin);
}

static int write_leaf(void *ctx, const piece *p) {
  const writer *w = ctx;
  const hr2d_element *e = &hr2d_hierarchy_elements(w->run->hierarchy)[p->element];
  const double unit = hr2d_scene_unit(w->run->scene);
  fprintf(w->stream, "%zu,", w->patch);
  csv_text(w->stream, hr2d_scene_name(w->run->scene, w->patch));
  fprintf(w->stream, ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", p->t0, p->t1, e->a.x * unit,
          e->a.y * unit, e->b.x * unit, e->b.y * unit);
  for (size_t b = 0; b < w->bands; b++)
    fprintf(w->stream, ",%.17g", hr2d_solution_element(w->run->solution, p->element, b));
  double first = 0; /* H of the first band */
  for (size_t b = 0; b < w->bands; b++) {
    double mean = 0;
    expand(w, p, hr2d_solution_irradiance_at, b, 1, &mean);
    fprintf(w->stream, ",%.17g", mean);
    if (b == 0) first = mean;
  }
  for (size_t b = 0; b < w->bands && w->sun; b++)
    fprintf(w->stream, ",%.17g",
            hr2d_scene_sunlight_over(w->run->scene, w->patch, p->t0, p->t1, b));
  write_coefficients(w, p);
  if (w->heat) write_temperature(w, first);
  return fputc('\n', w->stream) == EOF;
}

static void write_header(const writer *w) {
  fputs("patch,name,t0,t1,ax,ay,bx,by", w->stream);
  for (size_t b = 0; b < w->bands; b++) fprintf(w->stream, ",B%zu", b);
  for (size_t b = 0; b < w->bands; b++) fprintf(w->stream, ",H%zu", b);
  for (size_t b = 0; b < w->bands && w->sun; b++) fprintf(w->stream, ",S%zu", b);
  for (size_t b = 0; b < w->bands; b++)
    for (size_t l = 1; l < w->order; l++) fprintf(w->stream, ",B%zuc%zu", b, l);
  if (w->heat) fputs(",T", w->stream);
  fputc('\n', w->stream);
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
              .sun = run_sun_exists(r->scene)};
  w.rule = gsl_integration_glfixed_table_alloc(w.order);
  if (!w.rule) return output_close(&out, complain_memory());
  write_header(&w);
  for (; !status && w.patch < hr2d_scene_patches(r->scene); w.patch++)
    status = leaves_walk(r->hierarchy, w.patch, 0, write_leaf, &w);
  gsl_integration_glfixed_table_free(w.rule);
  return output_close(&out, ferror(out.stream) ? 0 : status);
}
