/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinds of pairs that differ in how their blocks are integrated. */
#ifndef HR2D_TESTS_SUPPORT_PAIR_KINDS_H
#define HR2D_TESTS_SUPPORT_PAIR_KINDS_H

#include "support/random.h"
#include "support/visibility-cases.h"

typedef struct pair_kind {
  const char *name;
  occluded_pair (*draw)(randoms *r);
  unsigned steps; /* of a reference that is exact */
} pair_kind;

extern const pair_kind pair_kinds[];
extern const size_t pair_kind_count;

#endif
