/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shares of a solve, each in a thread of its own. */
#ifndef HR2D_TESTS_SUPPORT_SHARES_H
#define HR2D_TESTS_SUPPORT_SHARES_H

#include <hr2d/share.h>

enum { SHARES_MOST = 16 };

/* What each thread does with its share. */
typedef void (*shares_work)(hr2d_share *share, void *ctx);

/* Lets `count` threads work at once.  Each adds up values in an order of its own: sums have to
   be the same in all bits, and calls have to match; otherwise it says so and aborts. */
void shares_run(unsigned count, shares_work work, void *ctx);

#endif
