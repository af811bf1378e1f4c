/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bars that a bench holds its figures to, and failures. */
#ifndef HR2D_BENCH_BARS_H
#define HR2D_BENCH_BARS_H

/* Prints that a value is above its bar, if it is. */
void bars_hold(const char *what, double value, double max);

/* How many bars were missed so far, as the status of a program. */
int bars_status(void);

/* Ends the program with a message. */
_Noreturn void bars_fail(const char *what);

#endif
