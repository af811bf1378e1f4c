/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Structs that callers fill: their first member is the size they were compiled with. */
#ifndef HR2D_SRC_BASE_SIZED_STRUCT_H
#define HR2D_SRC_BASE_SIZED_STRUCT_H

#include <hr2d/status.h>
#include <stddef.h>
#include <string.h>

/* Copies the caller's struct `from`, unless it is NULL, over `to`, a struct of `known` bytes.
   Members of `to` that the caller's struct does not have keep their values.  Returns HR2D_OK,
   or HR2D_EINVAL if the size has no room for itself: it was not set. */
static inline hr2d_status hr2di_sized_copy(void *to, size_t known, const void *from) {
  size_t given;
  if (!from) return HR2D_OK;
  memcpy(&given, from, sizeof given);
  if (given < sizeof given) return HR2D_EINVAL;
  given -= given % sizeof given; /* no compiler ends a struct within a member */
  memcpy(to, from, given < known ? given : known);
  memcpy(to, &known, sizeof known);
  return HR2D_OK;
}

#endif
