/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threads that refine on hierarchies of their own. */
#ifndef HR2D_SRC_REFINE_WORKER_H
#define HR2D_SRC_REFINE_WORKER_H

#include "refine/projector.h"

typedef struct hr2di_worker {
  hr2d_linkset links; /* a copy with a hierarchy and a message of its own, without links */
  hr2d_hierarchy *clone;
  hr2di_projector *projector; /* NULL: not hired */
  hr2di_watch own;            /* but the calling thread has that of the team */
  void *task;                 /* what is under way, for the sink */
  hr2d_status status;
} hr2di_worker;

/* The number of workers for the threads that options ask for: 1 if threads may not call the
   oracle or the policy. */
size_t hr2di_worker_count(const hr2d_linkset *links, unsigned threads);

/* Worker k gets a copy of `from` as it is now, and a projector on it.  The first one is of the
   calling thread.  `what` is to be made, for a message.  Returns the status, which the worker
   has, too. */
hr2d_status hr2di_worker_hire(hr2di_worker *worker, size_t k, const hr2d_linkset *links,
                              const hr2d_hierarchy *from, const hr2di_refine_how *how,
                              const hr2d_refine_options *options, hr2di_watch *watch,
                              const char *what);

/* HR2D_OK if no worker has failed.  Otherwise the status of the first one with a message, which
   becomes that of the links: one that stopped because another one failed has none. */
hr2d_status hr2di_worker_status(const hr2di_worker *worker, size_t count, hr2d_linkset *links);

/* Adds what a worker has done, but its links and elements. */
void hr2di_worker_add_counts(const hr2di_worker *worker, hr2d_refine_counts *sum);

/* Releases workers that were hired, or are all zero, and the array. */
void hr2di_worker_destroy(hr2di_worker *worker, size_t count, const hr2d_allocator *alloc);

#endif
