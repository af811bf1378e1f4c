/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plainest recursion for the links of two unit patches that face each other at a distance:
   max(A)/r ≤ ε, original variant. */
#ifndef HR2D_BENCH_PLAIN_H
#define HR2D_BENCH_PLAIN_H

#include <hr2d/linkset.h>
#include <stdint.h>

/* Grows the trees and decides by A² ≤ ε²r²; if `stored`, it stores the data of each link,
   with exchange areas by crossed strings.  Returns seconds of processor time. */
double plain_run(double distance, double epsilon, int stored, uint64_t *links);

/* Gathers `sweeps` times, both ways, over links of 16 bytes as plain_run() stores them, among
   `elements` elements.  Returns seconds. */
double plain_sweeps(const hr2d_link *link, uint64_t links, size_t elements, int sweeps);

/* Counts links only: no trees and no N, two parallel lines in registers.  Returns seconds. */
double plain_count(double distance, double epsilon, uint64_t *links);

#endif
