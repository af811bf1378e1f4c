/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The members that the tables of all built-in oracles have in common. */
#ifndef HR2D_SRC_ORACLE_BUILT_IN_H
#define HR2D_SRC_ORACLE_BUILT_IN_H

#include <hr2d/oracle.h>

#define HR2DI_BUILT_IN(NAME, FLAGS)                                                            \
  .struct_size = sizeof(hr2d_oracle), .name = (NAME), .flags = HR2D_ORACLE_THREAD_SAFE | (FLAGS)

#endif
