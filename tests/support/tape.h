/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state in memory, for the callbacks that write and read it. */
#ifndef HR2D_TESTS_SUPPORT_TAPE_H
#define HR2D_TESTS_SUPPORT_TAPE_H

#include <hr2d/hr2d.h>

typedef struct tape {
  unsigned char *byte; /* freed by the caller */
  size_t size, at;
  long until_failure; /* calls that still succeed; negative: no failure */
  hr2d_status failure;
  hr2d_linkset *touched; /* refined from inside of each call */
} tape;

/* hr2d_write_fn and hr2d_read_fn of a tape. */
hr2d_status tape_record(void *ctx, const void *bytes, size_t size);
hr2d_status tape_play(void *ctx, void *bytes, size_t size);

#endif
