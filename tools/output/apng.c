/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beside the chunks of PNG an animation has acTL, a fcTL before each frame, and fdAT, which is
   IDAT after a number, in all frames but the first. */
#include "output/apng.h"

#include <string.h>

#include "output/png.h"

enum { FCTL = 26 };

/* The whole image for so long, in the place of the one before. */
static void write_control(apng *a, const unsigned char *header, unsigned milliseconds) {
  unsigned char data[FCTL] = {0};
  png_put32(data, a->sequence++);
  memcpy(data + 4, header, 8); /* width and height */
  data[20] = (unsigned char)(milliseconds >> 8 & 255);
  data[21] = (unsigned char)(milliseconds & 255);
  data[22] = (unsigned char)(1000 >> 8);
  data[23] = (unsigned char)(1000 & 255);
  png_write_chunk(a->stream, "fcTL", data, FCTL, data, 0);
}

static void begin(apng *a, const unsigned char *png, const unsigned char *header) {
  unsigned char data[8] = {0}; /* number of frames; 0: for ever */
  fwrite(png, 1, PNG_SIGNATURE, a->stream);
  png_write_chunk(a->stream, "IHDR", header, PNG_IHDR, header, 0);
  if (a->comment) png_write_comment(a->stream, a->comment);
  png_put32(data, a->frames);
  png_write_chunk(a->stream, "acTL", data, sizeof data, data, 0);
}

static void write_image(apng *a, const unsigned char *data, uint32_t size) {
  unsigned char number[4];
  if (!a->done) {
    png_write_chunk(a->stream, "IDAT", data, size, data, 0);
    return;
  }
  png_put32(number, a->sequence++);
  png_write_chunk(a->stream, "fdAT", number, sizeof number, data, size);
}

void apng_add(apng *a, const unsigned char *png, size_t size, unsigned milliseconds) {
  const unsigned char *header = png + PNG_SIGNATURE + 8;
  if (size < PNG_SIGNATURE + PNG_AROUND + PNG_IHDR) return;
  if (!a->done) begin(a, png, header);
  write_control(a, header, milliseconds);
  for (size_t at = PNG_SIGNATURE; at + PNG_AROUND <= size;) {
    const uint32_t length = png_read32(png + at);
    if (length > size - at - PNG_AROUND) break;
    if (!memcmp(png + at + 4, "IDAT", 4)) write_image(a, png + at + 8, length);
    at += PNG_AROUND + length;
  }
  a->done++;
}

void apng_end(apng *a) {
  const unsigned char none = 0;
  png_write_chunk(a->stream, "IEND", &none, 0, &none, 0);
}
