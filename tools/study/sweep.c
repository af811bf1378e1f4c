/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a sweep is: its fraction by steps, and ε, N and L of the count under way. */
#include <stdio.h>
#include <string.h>

#include "study/study.h"

/* progress_show() then only listens for the interrupt. */
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
  progress *p = &w->line;
  char line[128];
  const double fraction = ((double)w->step + now->fraction) / (double)w->steps;
  snprintf(line, sizeof line, "%5.1f %%  %zu/%zu  epsilon %.4g  N %llu  L %llu", 100 * fraction,
           w->step + 1, w->steps, w->epsilon, (unsigned long long)now->elements,
           (unsigned long long)now->links);
  const int width = (int)strlen(line);
  fprintf(stderr, "\r%-*s", p->width > width ? p->width : width, line);
  fflush(stderr);
  p->width = width;
}

hr2d_status sweep_show(void *ctx, const hr2d_progress *now) {
  sweep *w = ctx;
  progress *p = &w->line;
  const hr2d_status status = progress_show(p, now);
  if (status || !w->wanted) return status;
  const double time = seconds();
  if (time - p->start > 1 && time - p->last > 0.1) {
    p->last = time;
    show(w, now);
  }
  return HR2D_OK;
}
