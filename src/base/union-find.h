/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Union-find: the root of k, with every other node on the way halved out. */
#ifndef HR2D_SRC_BASE_UNION_FIND_H
#define HR2D_SRC_BASE_UNION_FIND_H

#include <stdint.h>

static inline uint32_t hr2di_find(uint32_t *above, uint32_t k) {
  while (above[k] != k) {
    above[k] = above[above[k]];
    k = above[k];
  }
  return k;
}

#endif
