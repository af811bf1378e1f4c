/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The answer of last resort: one constant per patch, over the factors that are ready when a
   budget is spent. */
#ifndef HR2D_SRC_ACCURACY_FALLBACK_SOLVE_H
#define HR2D_SRC_ACCURACY_FALLBACK_SOLVE_H

#include "estimate/graded-solve.h"

/* How long a fallback solve may take: its factors until one time of the clock, all until
   another. Infinite: no limit. */
typedef struct hr2di_fallback_solve_times {
  double factors, all;
} hr2di_fallback_solve_times;

/* Links whole patches with each other in their order, and iterates B = E + ρ(ΣFB + sL), with
   s = 1 − ΣF where there is a background.  *late receives 1 if the time for factors ended
   first.  The callback of the target is asked.  Of its budgets `max_links` and `max_bytes`
   count.  Returns HR2D_OK, HR2D_ENOMEM or the status of the callback; only after HR2D_OK there
   is a solution. Call hr2di_graded_clear() in any case. */
hr2d_status hr2di_fallback_solve(hr2di_graded *answer, const hr2d_scene *scene,
                                 const hr2d_target *target, hr2di_fallback_solve_times until,
                                 int *out_of_time);

#endif
