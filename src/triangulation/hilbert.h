/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Places along a Hilbert curve: points near on the curve are near in the plane. */
#ifndef HR2D_SRC_TRIANGULATION_HILBERT_H
#define HR2D_SRC_TRIANGULATION_HILBERT_H

#include <stdint.h>

/* The place of cell (x, y) of 2^32 × 2^32 cells. */
static inline uint64_t hr2di_hilbert_place(uint32_t x, uint32_t y) {
  uint64_t place = 0;
  for (uint32_t bit = UINT32_C(1) << 31; bit > 0; bit >>= 1) {
    const uint32_t right = (x & bit) != 0, up = (y & bit) != 0;
    place = place << 2 | ((3 * right) ^ up);
    /* The lower two quarters are turned; the right one of them also upside down. */
    const uint32_t turn = up - 1, over = turn & (0 - right);
    const uint32_t u = x ^ over, v = y ^ over, changed = (u ^ v) & turn;
    x = u ^ changed;
    y = v ^ changed;
  }
  return place;
}

#endif
