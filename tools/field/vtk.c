/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field as VTK image data (.vti).  Arrays are doubles in base64, as text cannot hold NaN:
   the length in bytes as 8 bytes, and then the numbers, in the byte order of the machine. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "field/field.h"
#include "output/complain.h"
#include "output/output.h"
#include "output/provenance.h"

/* Bytes that wait until there are three. */
typedef struct base64 {
  FILE *stream;
  unsigned char byte[3];
  int count;
} base64;

static void put_three(base64 *b) {
  static const char digit[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const unsigned bits = (unsigned)b->byte[0] << 16 | (unsigned)b->byte[1] << 8 | b->byte[2];
  for (int k = 0; k < 4; k++)
    fputc(k <= b->count ? digit[bits >> (18 - 6 * k) & 63] : '=', b->stream);
  memset(b->byte, 0, sizeof b->byte);
  b->count = 0;
}

static void put_bytes(base64 *b, const void *from, size_t size) {
  const unsigned char *byte = from;
  for (size_t k = 0; k < size; k++) {
    b->byte[b->count++] = byte[k];
    if (b->count == 3) put_three(b);
  }
}

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

static void write_array(const field *f, FILE *stream, const char *name, size_t band,
                        size_t items, item_fn item) {
  base64 b = {.stream = stream};
  const uint64_t bytes = f->count * items * sizeof(double);
  fprintf(stream,
          "<DataArray type=\"Float64\" Name=\"%s\" NumberOfComponents=\"%zu\" "
          "format=\"binary\">\n",
          name, items);
  put_bytes(&b, &bytes, sizeof bytes);
  if (b.count) put_three(&b);
  for (size_t k = 0; k < f->count * items; k++) {
    const double value = item(f, k / items, band, k % items);
    put_bytes(&b, &value, sizeof value);
  }
  if (b.count) put_three(&b);
  fputs("\n</DataArray>\n", stream);
}

static double spacing(double low, double high, size_t count) {
  return count > 1 ? (high - low) / (double)(count - 1) : 1;
}

/* A string of VTK is the codes of its bytes, up to a 0. */
static int write_provenance(FILE *stream) {
  char *text = provenance_text();
  if (!text) return complain_memory();
  fputs("<FieldData>\n<DataArray type=\"String\" Name=\"provenance\" NumberOfTuples=\"1\" "
        "format=\"ascii\">\n",
        stream);
  for (const char *c = text; *c; c++) fprintf(stream, "%d ", (unsigned char)*c);
  fputs("0\n</DataArray>\n</FieldData>\n", stream);
  free(text);
  return 0;
}

int field_write_vtk(const field *f, const char *path) {
  output out;
  int status = output_open(&out, path);
  const uint16_t one = 1;
  if (status) return status;
  const hr2d_field_grid *g = &f->grid;
  fprintf(out.stream,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
          "byte_order=\"%s\" header_type=\"UInt64\">\n"
          "<ImageData WholeExtent=\"0 %zu 0 %zu 0 0\" Origin=\"%.17g %.17g 0\" "
          "Spacing=\"%.17g %.17g 1\">\n",
          *(const unsigned char *)&one ? "LittleEndian" : "BigEndian", g->columns - 1,
          g->rows - 1, g->low.x, g->low.y, spacing(g->low.x, g->high.x, g->columns),
          spacing(g->low.y, g->high.y, g->rows));
  status = write_provenance(out.stream);
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
  fputs("</PointData>\n</Piece>\n</ImageData>\n</VTKFile>\n", out.stream);
  return output_close(&out, status);
}
