/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG (ISO/IEC 15948) is a signature and chunks: length, type, data, and a CRC of type and
   data. An animation has in addition acTL, a fcTL before each frame, and fdAT, which is IDAT
   after a number, in all frames but the first. */
#include "output/apng.h"

#include <string.h>

enum { SIGNATURE = 8, AROUND = 12, IHDR = 13, FCTL = 26 };

/* The polynomial of the standard, bit by bit; the files are small. */
static uint32_t crc_of(uint32_t crc, const unsigned char *byte, size_t size) {
  for (size_t k = 0; k < size; k++) {
    crc ^= byte[k];
    for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320U : 0);
  }
  return crc;
}

static void put32(unsigned char *to, uint32_t x) {
  for (int k = 0; k < 4; k++) to[k] = (unsigned char)(x >> (24 - 8 * k));
}

static uint32_t get32(const unsigned char *from) {
  return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

static void write32(FILE *stream, uint32_t x) {
  unsigned char byte[4];
  put32(byte, x);
  fwrite(byte, 1, sizeof byte, stream);
}

/* A chunk whose data are `head` and then `data`. */
static void write_chunk(apng *a, const char *type, const unsigned char *head, uint32_t before,
                        const unsigned char *data, uint32_t size) {
  uint32_t crc = crc_of(0xffffffffU, (const unsigned char *)type, 4);
  crc = crc_of(crc, head, before);
  crc = crc_of(crc, data, size);
  write32(a->stream, before + size);
  fwrite(type, 1, 4, a->stream);
  fwrite(head, 1, before, a->stream);
  fwrite(data, 1, size, a->stream);
  write32(a->stream, ~crc);
}

/* The whole image for so long, in the place of the one before. */
static void write_control(apng *a, const unsigned char *header, unsigned milliseconds) {
  unsigned char data[FCTL] = {0};
  put32(data, a->sequence++);
  memcpy(data + 4, header, 8); /* width and height */
  data[20] = (unsigned char)(milliseconds >> 8 & 255);
  data[21] = (unsigned char)(milliseconds & 255);
  data[22] = (unsigned char)(1000 >> 8);
  data[23] = (unsigned char)(1000 & 255);
  write_chunk(a, "fcTL", data, FCTL, data, 0);
}

static void begin(apng *a, const unsigned char *png, const unsigned char *header) {
  unsigned char data[8] = {0}; /* number of frames; 0: for ever */
  fwrite(png, 1, SIGNATURE, a->stream);
  write_chunk(a, "IHDR", header, IHDR, header, 0);
  put32(data, a->frames);
  write_chunk(a, "acTL", data, sizeof data, data, 0);
}

static void write_image(apng *a, const unsigned char *data, uint32_t size) {
  unsigned char number[4];
  if (!a->done) {
    write_chunk(a, "IDAT", data, size, data, 0);
    return;
  }
  put32(number, a->sequence++);
  write_chunk(a, "fdAT", number, sizeof number, data, size);
}

void apng_add(apng *a, const unsigned char *png, size_t size, unsigned milliseconds) {
  const unsigned char *header = png + SIGNATURE + 8;
  if (size < SIGNATURE + AROUND + IHDR) return;
  if (!a->done) begin(a, png, header);
  write_control(a, header, milliseconds);
  for (size_t at = SIGNATURE; at + AROUND <= size;) {
    const uint32_t length = get32(png + at);
    if (length > size - at - AROUND) break;
    if (!memcmp(png + at + 4, "IDAT", 4)) write_image(a, png + at + 8, length);
    at += AROUND + length;
  }
  a->done++;
}

void apng_end(apng *a) {
  const unsigned char none = 0;
  write_chunk(a, "IEND", &none, 0, &none, 0);
}
