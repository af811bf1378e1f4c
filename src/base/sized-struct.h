/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Structs that callers fill: their first member is the size they were compiled with. */
#ifndef HR2D_SRC_BASE_SIZED_STRUCT_H
#define HR2D_SRC_BASE_SIZED_STRUCT_H

#include <stddef.h>
#include <string.h>

/* Copies the caller's struct `from` over `to`, a struct of `known` bytes.  Members of `to` that
   the caller's struct does not have keep their values. */
static inline void hr2di_sized_copy(void *to, size_t known, const void *from) {
  size_t given;
  memcpy(&given, from, sizeof given);
  memcpy(to, from, given < known ? given : known);
}

#endif
