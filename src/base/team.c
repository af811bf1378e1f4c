/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif

#include "base/team.h"

#include <hr2d/options.h>
#include <sched.h>
#include <time.h>

#ifdef _OPENMP
#include <omp.h>
#endif

/* A thread that waits gives way so many times, some 10 µs, before it sleeps between two
   looks. */
enum { PATIENCE = 50, NAP = 100000 /* ns */ };

/* More threads than any machine has processors; an int has room for it. */
enum { MOST = 4096 };

typedef struct team {
  size_t tasks;
  hr2di_team_fn run;
  void *ctx;
  hr2di_watch *watch;
  atomic_size_t next; /* the first task that nobody has taken */
  atomic_size_t busy; /* threads that may still work */
} team;

size_t hr2di_team_threads(unsigned asked) {
#ifdef _OPENMP
  const size_t count = asked == HR2D_ALL_THREADS ? (size_t)omp_get_max_threads() : asked;
  return count < 1 ? 1 : count < MOST ? count : MOST;
#else
  (void)asked;
  return 1;
#endif
}

static void work(team *t, size_t worker) {
  for (size_t k; (k = atomic_fetch_add(&t->next, 1)) < t->tasks;) t->run(t->ctx, worker, k);
}

#ifdef _OPENMP
static void wait_for_others(team *t) {
  const struct timespec nap = {0, NAP};
  for (unsigned turns = 0; atomic_load(&t->busy) > 0; turns++) {
    if (turns < PATIENCE) {
      sched_yield();
      continue;
    }
    nanosleep(&nap, NULL);
    if (turns % 8 == 0) hr2di_watch_ask(t->watch);
  }
}

static void run_together(team *t, size_t threads) {
#pragma omp parallel num_threads((int)threads)
  {
    const size_t worker = (size_t)omp_get_thread_num();
    if (worker > 0) {
      atomic_fetch_add(&t->busy, 1);
      work(t, worker);
      atomic_fetch_sub(&t->busy, 1);
    } else {
      work(t, worker);
      if (t->watch && t->watch->ask) wait_for_others(t);
    }
  }
}
#endif

void hr2di_team_run(size_t threads, size_t tasks, hr2di_team_fn run, void *ctx,
                    hr2di_watch *watch) {
  team t = {.tasks = tasks, .run = run, .ctx = ctx, .watch = watch};
#ifdef _OPENMP
  if (threads > 1 && tasks > 1) {
    run_together(&t, threads);
    return;
  }
#endif
  (void)threads;
  work(&t, 0);
}
