/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/watch.h"

void hr2di_watch_init(hr2di_watch *w, hr2d_progress_fn ask, void *ctx, const char *phase) {
  *w = (hr2di_watch){.report = {.struct_size = sizeof w->report, .phase = phase},
                     .ask = ask,
                     .ctx = ctx,
                     .span = HR2DI_WATCH_SPAN};
}

void hr2di_watch_follow(hr2di_watch *w, hr2di_watch *leader) {
  hr2di_watch_init(w, NULL, NULL, NULL);
  w->leader = leader;
}

void hr2di_watch_stop(hr2di_watch *w, hr2d_status status) {
  if (!w) return;
  int none = HR2D_OK;
  atomic_compare_exchange_strong(w->leader ? &w->leader->stopped : &w->stopped, &none,
                                 (int)status);
}

void hr2di_watch_phase(hr2di_watch *w, const char *phase) {
  if (!w) return;
  w->report.phase = phase;
  w->report.fraction = w->report.residual = 0;
  w->describe = NULL;
}

void hr2di_watch_describe(hr2di_watch *w, hr2di_watch_describe_fn describe, void *of) {
  if (!w) return;
  w->describe = describe;
  w->of = of;
}

hr2d_status hr2di_watch_ask(hr2di_watch *w) {
  if (!w || w->status) return hr2di_watch_status(w);
  if (w->work > w->max) w->max = w->work;
  w->total += w->work;
  w->work = 0;
  w->status = (hr2d_status)atomic_load(w->leader ? &w->leader->stopped : &w->stopped);
  if (w->status || !w->ask) return w->status;
  if (w->describe) w->describe(w->of, &w->report);
  w->status = w->ask(w->ctx, &w->report);
  w->refused = w->status != HR2D_OK;
  if (w->refused) atomic_store(&w->stopped, (int)w->status);
  return w->status;
}
