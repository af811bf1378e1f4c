/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif

#include "base/team.h"

#include <hr2d/options.h>

#ifdef HR2D_THREADS
#include <pthread.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>
#endif

/* A thread that waits gives way so many times, some 10 µs, before it sleeps between two
   looks. */
enum { PATIENCE = 50, NAP = 100000 /* ns */, MOST_THREADS = 256 };

typedef struct team {
  size_t tasks;
  hr2di_team_fn run;
  void *ctx;
  hr2di_watch *watch;
  atomic_size_t next; /* the first task that nobody has taken */
  atomic_size_t busy; /* threads that may still work */
} team;

#ifdef HR2D_THREADS
static long processors(void) {
#ifdef _WIN32
  return pthread_num_processors_np();
#else
  return sysconf(_SC_NPROCESSORS_ONLN);
#endif
}
#endif

size_t hr2di_team_threads(unsigned asked) {
#ifdef HR2D_THREADS
  const long all = asked == HR2D_ALL_THREADS ? processors() : 0;
  const size_t count = asked == HR2D_ALL_THREADS ? (all > 0 ? (size_t)all : 1) : asked;
  return count < 1 ? 1 : count < MOST_THREADS ? count : MOST_THREADS;
#else
  (void)asked;
  return 1;
#endif
}

static void work(team *t, size_t worker) {
  for (size_t k; (k = atomic_fetch_add(&t->next, 1)) < t->tasks;) t->run(t->ctx, worker, k);
}

#ifdef HR2D_THREADS
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

typedef struct member {
  team *team;
  size_t number;
  pthread_t thread;
} member;

static void *join_in(void *arg) {
  const member *m = arg;
  work(m->team, m->number);
  atomic_fetch_sub(&m->team->busy, 1);
  return NULL;
}

/* Threads are made for each call, some 20 µs each, for tasks of milliseconds. */
static void run_together(team *t, size_t threads) {
  member m[MOST_THREADS];
  size_t count = 1;
  for (; count < threads && count < t->tasks && count < MOST_THREADS; count++) {
    m[count] = (member){.team = t, .number = count};
    atomic_fetch_add(&t->busy, 1);
    if (pthread_create(&m[count].thread, NULL, join_in, &m[count])) {
      atomic_fetch_sub(&t->busy, 1);
      break;
    }
  }
  work(t, 0);
  if (t->watch && t->watch->ask) wait_for_others(t);
  while (count > 1) pthread_join(m[--count].thread, NULL);
}
#endif

void hr2di_team_run(size_t threads, size_t tasks, hr2di_team_fn run, void *ctx,
                    hr2di_watch *watch) {
  team t = {.tasks = tasks, .run = run, .ctx = ctx, .watch = watch};
#ifdef HR2D_THREADS
  if (threads > 1 && tasks > 1) {
    run_together(&t, threads);
    return;
  }
#endif
  (void)threads;
  work(&t, 0);
}
