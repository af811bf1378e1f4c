/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An animation in PNG, made of whole PNG files of one size. */
#ifndef HR2D_TOOLS_OUTPUT_APNG_H
#define HR2D_TOOLS_OUTPUT_APNG_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct apng {
  FILE *stream;
  const char *comment; /* NULL: none */
  uint32_t frames;     /* in all; what does not read animations shows the first */
  uint32_t done;       /* frames that were added */
  uint32_t sequence;   /* number of the next chunk of the animation */
} apng;

/* Adds a frame from the bytes of a PNG file as any encoder writes it.  After the first one the
   size, depth and kind of the image are those of the first.  Errors of the stream stay in it.
 */
void apng_add(apng *a, const unsigned char *png, size_t size, unsigned milliseconds);

/* After the last frame. */
void apng_end(apng *a);

#endif
