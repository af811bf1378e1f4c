/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The members that the tables of all built-in oracles have in common. */
#ifndef HR2D_SRC_ORACLE_BUILT_IN_H
#define HR2D_SRC_ORACLE_BUILT_IN_H

#include <hr2d/oracle.h>
#include <stdint.h>

#define HR2DI_BUILT_IN(NAME, FLAGS)                                                            \
  .struct_size = sizeof(hr2d_oracle), .name = (NAME), .flags = HR2D_ORACLE_THREAD_SAFE | (FLAGS)

/* The work of one estimate, in the units of base/watch.h: of one pair of a batch for an oracle
   that integrates, 0 for any other. */
uint64_t hr2di_oracle_work(const hr2d_oracle *oracle, const hr2d_batch *batch, size_t pair);

#endif
