/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The line of a sweep: the fraction of its steps, and ε, N and L of the count under way. */
#include <stdio.h>

#include "study/study.h"

/* `line.wanted` is off, so that progress_show() only looks for the interrupt. */
void sweep_start(sweep *w, const study *s) {
  *w = (sweep){.steps = s->count};
  progress_start(&w->line, s->options->quiet);
  w->wanted = w->line.wanted;
  w->line.wanted = 0;
}

hr2d_status sweep_next(sweep *w, const study *s, size_t step) {
  const hr2d_progress nothing = {.struct_size = sizeof nothing, .phase = "refine"};
  w->step = step;
  w->epsilon = s->rows[step].epsilon;
  return sweep_show(w, &nothing);
}

static void show(sweep *w, const hr2d_progress *now) {
  char line[128];
  const double fraction = ((double)w->step + now->fraction) / (double)w->steps;
  snprintf(line, sizeof line, "%5.1f %%  %zu/%zu  epsilon %.4g  N %llu  L %llu", 100 * fraction,
           w->step + 1, w->steps, w->epsilon, (unsigned long long)now->elements,
           (unsigned long long)now->links);
  progress_line(&w->line, line);
}

hr2d_status sweep_show(void *ctx, const hr2d_progress *now) {
  sweep *w = ctx;
  const hr2d_status status = progress_show(&w->line, now);
  if (!status && w->wanted && progress_due(&w->line)) show(w, now);
  return status;
}
