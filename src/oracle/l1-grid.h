/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The L¹ error on the paper's grid of 1024×1024 samples of G per pair of patches. */
#ifndef HR2D_SRC_ORACLE_L1_GRID_H
#define HR2D_SRC_ORACLE_L1_GRID_H

#include <hr2d/oracle.h>
#include <stdint.h>

/* The number of samples in a pair. */
uint64_t hr2di_l1_grid_samples(const hr2d_batch *batch, hr2d_pair pair);

/* Σ |G(x_c,y_c) − G(x,y)|·(area of a cell) over the samples in a pair, in the unit
   of the elements.  If the sum is above `enough`, any number above `enough` may be returned.
   The order of the pair changes no bit. */
double hr2di_l1_grid(const hr2d_batch *batch, hr2d_pair pair, double enough);

#endif
