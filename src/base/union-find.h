/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Union-find on an array of parents; a root is its own parent, and the least number of its
   set. */
#ifndef HR2D_SRC_BASE_UNION_FIND_H
#define HR2D_SRC_BASE_UNION_FIND_H

#include <stdint.h>

/* The root of the set that holds k; halves the path to it. */
static inline uint32_t hr2di_union_find(uint32_t *parent, uint32_t k) {
  while (parent[k] != k) {
    parent[k] = parent[parent[k]];
    k = parent[k];
  }
  return k;
}

/* Joins the sets that hold i and j.  Returns the former root whose parent is now the root of
   both; or the common root, if i and j were in one set before. */
static inline uint32_t hr2di_union_join(uint32_t *parent, uint32_t i, uint32_t j) {
  i = hr2di_union_find(parent, i);
  j = hr2di_union_find(parent, j);
  const uint32_t root = i < j ? i : j, other = i < j ? j : i;
  parent[other] = root;
  return other;
}

#endif
