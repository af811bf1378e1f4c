/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "estimate/points-gather.h"

#include "base/team.h"

enum { MOST_WORKERS = 64 };

typedef struct team {
  const hr2d_solution *solution;
  const hr2di_place *place;
  double *value;
  hr2di_watch *watch;            /* of the calling thread */
  hr2di_watch own[MOST_WORKERS]; /* of the others */
  hr2d_status status[MOST_WORKERS];
  atomic_int failed;
} team;

static void gather_one(void *ctx, size_t worker, size_t k) {
  team *t = ctx;
  if (atomic_load(&t->failed)) return;
  t->status[worker] = hr2di_solution_gather(t->solution, t->place[k].patch, &t->place[k].at, 1,
                                            t->value + k * t->solution->bands,
                                            worker == 0 ? t->watch : &t->own[worker]);
  if (t->status[worker]) atomic_store(&t->failed, 1);
}

hr2d_status hr2di_points_gather(const hr2d_solution *solution, const hr2di_place *place,
                                size_t count, unsigned threads, double *value,
                                hr2di_watch *watch) {
  team t = {.solution = solution, .place = place, .value = value, .watch = watch};
  const size_t asked = hr2di_team_threads(threads);
  const size_t workers = asked < MOST_WORKERS ? asked : MOST_WORKERS;
  for (size_t k = 1; k < workers; k++) hr2di_watch_follow(&t.own[k], watch);
  hr2di_team_run(workers, count, gather_one, &t, watch);
  for (size_t k = 0; k < workers; k++)
    if (t.status[k]) return t.status[k];
  return hr2di_watch_status(watch);
}
