/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times all exchange areas of a scene, held or visited, and weighs their rows. */
#ifndef HR2D_BENCH_ROWS_H
#define HR2D_BENCH_ROWS_H

#include <hr2d/hr2d.h>

typedef struct measured {
  size_t patches;
  double seconds, strings, row;
  uint64_t entries;
  hr2d_matrix_counts counts;
} measured;

/* Seconds of one call that holds the rows; the first one of a scene looks at them, too. */
double rows_hold(const hr2d_scene *scene, measured *m);

typedef struct balance {
  const hr2d_scene *scene;
  double worst; /* row */
  uint64_t entries;
} balance;

void rows_visit(const hr2d_scene *scene, unsigned threads, balance *b);

#endif
