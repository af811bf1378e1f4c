/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A measurement in a process of its own, whose memory is as fresh as that of a user's program.
 */
#ifndef HR2D_BENCH_ALONE_H
#define HR2D_BENCH_ALONE_H

#include <stddef.h>

/* Calls `run` in a new process and brings back what it makes of the `size` bytes of *ctx.
   Whether that worked. */
int alone_run(void (*run)(void *ctx), void *ctx, size_t size);

#endif
