/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of a block as they are stored: doubles C_lm, or floats C_lm/C_00, where C_00 is
   the exchange area of the link.  So C_00 has all its digits in both, and exchange areas may be
   less than any float.  Arithmetic is in doubles. */
#ifndef HR2D_SRC_LINKS_BLOCK_NUMBERS_H
#define HR2D_SRC_LINKS_BLOCK_NUMBERS_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#include "base/wide.h"

/* What roundings of floats do to irradiance, relative to that from the largest radiosity: each
   is FLT_EPSILON/2 of its C_lm at most, Σ_lm √(2l+1) |C_lm| is a few C_00, and signs are
   random. Averages were a tenth of that apart (tests/unit/estimate/check-single-blocks.c). */
#define HR2DI_SINGLE_ROUNDING (4 * FLT_EPSILON)

/* The bytes of a number. */
static inline size_t hr2di_number_size(int single) {
  return single ? sizeof(float) : sizeof(double);
}

/* C_lm of a link with this exchange area, from number k of its block.  `single` is a constant
   to the compiler where it matters. */
HR2DI_PART double hr2di_number_at(const void *block, size_t k, int single, double area) {
  return single ? area * (double)((const float *)block)[k] : ((const double *)block)[k];
}

/* Numbers [k, k + 4) of a block, likewise: floats are converted side by side. */
HR2DI_PART void hr2di_four_numbers(const void *block, size_t k, int single, double area,
                                   hr2di_four *to) {
  typedef float four __attribute__((vector_size(16), aligned(4), may_alias));
  if (single)
    *to = area * __builtin_convertvector(*(const four *)((const float *)block + k), hr2di_four);
  else
    *to = *(const hr2di_four *)((const double *)block + k);
}

/* A block in two parts: its first `lead` rows and columns, and row by row the rest. */
typedef struct hr2di_stored_block {
  const void *value, *rest; /* `rest` is NULL if lead is order */
  size_t order, lead;
  int single;
} hr2di_stored_block;

/* The k-th block behind one, in arrays of blocks like it. */
HR2DI_PART hr2di_stored_block hr2di_block_behind(const hr2di_stored_block *b, uint64_t k) {
  const size_t number = hr2di_number_size(b->single), leading = b->lead * b->lead;
  const size_t others = b->order * b->order - leading;
  const char *value = b->value, *rest = b->rest;
  return (hr2di_stored_block){value + k * leading * number,
                              others > 0 ? rest + k * others * number : NULL, b->order, b->lead,
                              b->single};
}

/* Numbers [from, from + count) of a part as doubles. */
HR2DI_PART void hr2di_read_numbers(const void *part, size_t from, size_t count, int single,
                                   double area, double *to) {
  size_t k = 0;
  for (; k + 4 <= count; k += 4)
    hr2di_four_numbers(part, from + k, single, area, (hr2di_four *)(to + k));
  for (; k < count; k++) to[k] = hr2di_number_at(part, from + k, single, area);
}

/* Both parts as doubles, row by row. */
HR2DI_PART void hr2di_join_block(const hr2di_stored_block *b, double area, double *to) {
  const size_t order = b->order, lead = b->lead, width = order - lead;
  if (width == 0) {
    hr2di_read_numbers(b->value, 0, order * order, b->single, area, to);
    return;
  }
  for (size_t l = 0; l < lead; l++, to += order) {
    hr2di_read_numbers(b->value, l * lead, lead, b->single, area, to);
    hr2di_read_numbers(b->rest, l * width, width, b->single, area, to + lead);
  }
  hr2di_read_numbers(b->rest, lead * width, width * order, b->single, area, to);
}

#endif
