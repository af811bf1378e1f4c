/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output/vtk.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "output/complain.h"
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

void vtk_begin(FILE *stream, const char *type) {
  const uint16_t one = 1;
  fprintf(stream,
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"1.0\" "
          "byte_order=\"%s\" header_type=\"UInt64\">\n",
          type, *(const unsigned char *)&one ? "LittleEndian" : "BigEndian");
}

/* A string of VTK is the codes of its bytes, up to a 0. */
int vtk_provenance(FILE *stream) {
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

void vtk_array(FILE *stream, const char *name, vtk_type type, size_t count, size_t components,
               vtk_item *item, const void *ctx) {
  base64 b = {.stream = stream};
  const uint64_t bytes = (uint64_t)count * components * 8;
  fprintf(stream,
          "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%zu\" "
          "format=\"binary\">\n",
          type == VTK_DOUBLE ? "Float64" : "Int64", name, components);
  put_bytes(&b, &bytes, sizeof bytes);
  if (b.count) put_three(&b);
  for (size_t k = 0; k < count * components; k++) {
    const double value = item(ctx, k);
    const int64_t whole = type == VTK_INTEGER ? (int64_t)value : 0;
    put_bytes(&b, type == VTK_DOUBLE ? (const void *)&value : &whole, 8);
  }
  if (b.count) put_three(&b);
  fputs("\n</DataArray>\n", stream);
}

void vtk_end(FILE *stream, const char *type) {
  fprintf(stream, "</Piece>\n</%s>\n</VTKFile>\n", type);
}
