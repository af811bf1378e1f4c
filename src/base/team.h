/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threads that share tasks.  The calling thread is one of them, and the only one that asks its
   watch: also while it waits for the others at the end. */
#ifndef HR2D_SRC_BASE_TEAM_H
#define HR2D_SRC_BASE_TEAM_H

#include "base/watch.h"

/* Does one task.  `worker` is the number of the thread, 0 for the calling one. */
typedef void (*hr2di_team_fn)(void *ctx, size_t worker, size_t task);

/* The number of threads that options ask for: 0 is one, and HR2D_ALL_THREADS all.  At least 1;
   1 in a library without threads. */
size_t hr2di_team_threads(unsigned asked);

/* Does tasks 0, 1, … each once.  If the system gives fewer threads, these do all of them: POSIX
   threads, as OpenMP's runtime ends the program where a thread cannot be had.  Allocates
   nothing. */
void hr2di_team_run(size_t threads, size_t tasks, hr2di_team_fn run, void *ctx,
                    hr2di_watch *watch);

#endif
