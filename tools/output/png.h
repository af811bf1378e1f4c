/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chunks of PNG files (ISO/IEC 15948): length, type, data, and a CRC of type and data. */
#ifndef HR2D_TOOLS_OUTPUT_PNG_H
#define HR2D_TOOLS_OUTPUT_PNG_H

#include <stdint.h>
#include <stdio.h>

enum {
  PNG_SIGNATURE = 8,
  PNG_AROUND = 12, /* length, type and CRC of a chunk */
  PNG_IHDR = 13    /* the data of the first chunk, IHDR */
};

uint32_t png_read32(const unsigned char *from);
void png_put32(unsigned char *to, uint32_t x);

/* Writes a chunk whose data are `head` and then `data`. */
void png_write_chunk(FILE *stream, const char *type, const void *head, uint32_t before,
                     const void *data, uint32_t size);

/* Writes a text in UTF-8 under the keyword Comment.  It stands behind IHDR. */
void png_write_comment(FILE *stream, const char *text);

#endif
