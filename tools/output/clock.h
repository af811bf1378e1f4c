/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wall time. */
#ifndef HR2D_TOOLS_OUTPUT_CLOCK_H
#define HR2D_TOOLS_OUTPUT_CLOCK_H

/* Wall time in seconds since a fixed moment. */
double clock_seconds(void);

#endif
