/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field as VTK image data (.vti). */
#include "output/vtk.h"

#include "field/field.h"
#include "output/output.h"

/* Item k of a point, of an array with so many of them per point. */
typedef double (*item_fn)(const field *f, size_t point, size_t band, size_t k);

static double mean(const field *f, size_t point, size_t band, size_t k) {
  (void)k;
  return f->mean[point * f->bands + band];
}

static double irradiance(const field *f, size_t point, size_t band, size_t k) {
  (void)k;
  return f->irradiance[point * f->bands + band];
}

/* Vectors have three components. */
static double flux(const field *f, size_t point, size_t band, size_t k) {
  return k < 2 ? f->flux[2 * (point * f->bands + band) + k] : 0;
}

static double sky(const field *f, size_t point, size_t band, size_t k) {
  (void)band, (void)k;
  return f->sky[point];
}

static double temperature(const field *f, size_t point, size_t band, size_t k) {
  (void)band, (void)k;
  return field_temperature(f, point);
}

static double kind(const field *f, size_t point, size_t band, size_t k) {
  (void)band, (void)k;
  return f->place[point];
}

typedef struct array {
  const field *f;
  size_t band, items;
  item_fn item;
} array;

static double number(const void *ctx, size_t k) {
  const array *a = ctx;
  return a->item(a->f, k / a->items, a->band, k % a->items);
}

static void write_array(const field *f, FILE *stream, const char *name, size_t band,
                        size_t items, item_fn item) {
  const array a = {f, band, items, item};
  vtk_array(stream, name, VTK_DOUBLE, f->count, items, number, &a);
}

static double spacing(double low, double high, size_t count) {
  return count > 1 ? (high - low) / (double)(count - 1) : 1;
}

int field_write_vtk(const field *f, const char *path) {
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  const hr2d_field_grid *g = &f->grid;
  vtk_begin(out.stream, "ImageData");
  fprintf(out.stream,
          "<ImageData WholeExtent=\"0 %zu 0 %zu 0 0\" Origin=\"%.17g %.17g 0\" "
          "Spacing=\"%.17g %.17g 1\">\n",
          g->columns - 1, g->rows - 1, g->low.x, g->low.y,
          spacing(g->low.x, g->high.x, g->columns), spacing(g->low.y, g->high.y, g->rows));
  status = vtk_provenance(out.stream);
  fprintf(out.stream, "<Piece Extent=\"0 %zu 0 %zu 0 0\">\n<PointData>\n", g->columns - 1,
          g->rows - 1);
  for (size_t b = 0; b < f->bands; b++) {
    char name[32];
    snprintf(name, sizeof name, "mean%zu", b);
    write_array(f, out.stream, name, b, 1, mean);
    snprintf(name, sizeof name, "flux%zu", b);
    write_array(f, out.stream, name, b, 3, flux);
    snprintf(name, sizeof name, "irradiance%zu", b);
    if (f->irradiance) write_array(f, out.stream, name, b, 1, irradiance);
  }
  write_array(f, out.stream, "sky", 0, 1, sky);
  write_array(f, out.stream, "place", 0, 1, kind);
  if (f->heat) write_array(f, out.stream, "temperature", 0, 1, temperature);
  fputs("</PointData>\n", out.stream);
  vtk_end(out.stream, "ImageData");
  return output_close(&out, status);
}
