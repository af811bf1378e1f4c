/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output/png.h"

#include <string.h>

/* The polynomial of the standard, bit by bit; the files are small. */
static uint32_t crc_of(uint32_t crc, const unsigned char *byte, size_t size) {
  for (size_t k = 0; k < size; k++) {
    crc ^= byte[k];
    for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320U : 0);
  }
  return crc;
}

void png_put32(unsigned char *to, uint32_t x) {
  for (int k = 0; k < 4; k++) to[k] = (unsigned char)(x >> (24 - 8 * k));
}

uint32_t png_read32(const unsigned char *from) {
  return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

static void write32(FILE *stream, uint32_t x) {
  unsigned char byte[4];
  png_put32(byte, x);
  fwrite(byte, 1, sizeof byte, stream);
}

void png_write_chunk(FILE *stream, const char *type, const void *head, uint32_t before,
                     const void *data, uint32_t size) {
  uint32_t crc = crc_of(0xffffffffU, (const unsigned char *)type, 4);
  crc = crc_of(crc, head, before);
  crc = crc_of(crc, data, size);
  write32(stream, before + size);
  fwrite(type, 1, 4, stream);
  fwrite(head, 1, before, stream);
  fwrite(data, 1, size, stream);
  write32(stream, ~crc);
}

/* A tEXt chunk would be in Latin-1.  Behind the keyword: not compressed, no language, no
   translation of the keyword. */
void png_write_comment(FILE *stream, const char *text) {
  static const char head[] = "Comment\0\0\0\0";
  png_write_chunk(stream, "iTXt", head, sizeof head, text, (uint32_t)strlen(text));
}
