/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plainest recursion for the links of two unit patches that face each other at a distance:
   max(A)/r ≤ ε, original variant. */
#ifndef HR2D_BENCH_PLAIN_H
#define HR2D_BENCH_PLAIN_H

#include <stdint.h>

/* Grows the trees, decides by A² ≤ ε²r² and, if `stored`, keeps what a link needs, with the
   textbook's crossed strings.  Seconds. */
double plain_run(double distance, double epsilon, int stored, uint64_t *links);

/* The leanest of all: no trees, no N, nothing but two parallel lines in registers. */
double plain_count(double distance, double epsilon, uint64_t *links);

#endif
