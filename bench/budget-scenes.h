/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Twenty kinds of scenes for bench-budgets: those of tests/support/slow-scenes.h, and some with
   light and heat of many bands. */
#ifndef HR2D_BENCH_BUDGET_SCENES_H
#define HR2D_BENCH_BUDGET_SCENES_H

#include <hr2d/hr2d.h>

typedef struct budget_kind {
  const char *name;
  size_t patches; /* at most; 0: as many as are asked for */
  hr2d_status (*add)(hr2d_scene *scene, size_t patches); /* does not commit */
} budget_kind;

enum { BUDGET_KINDS = 20 };
extern const budget_kind budget_kinds[BUDGET_KINDS];

#endif
