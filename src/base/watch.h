/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A watch asks the progress callback of a call whether to go on, after equal amounts of work.

   Loops declare their work in units of about 0.1 µs.  After HR2DI_WATCH_SPAN of them, about a
   millisecond, the callback is asked.  So no loop looks at a clock, and the questions of one
   thread come at the same places every time.

   A status that is not HR2D_OK stays: from then on every declaration returns it.  A loop that
   cannot return a status may therefore end, and its caller asks hr2di_watch_status(). */
#ifndef HR2D_SRC_BASE_WATCH_H
#define HR2D_SRC_BASE_WATCH_H

#include <hr2d/progress.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

enum { HR2DI_WATCH_SPAN = 10000 };

typedef struct hr2di_watch hr2di_watch;

/* Brings `told` up to date. */
typedef void (*hr2di_watch_describe_fn)(void *of, hr2d_progress *report);

struct hr2di_watch {
  hr2d_progress report; /* what the callback gets; the first member, for hr2di_watch_of() */
  hr2d_progress_fn ask;
  void *ctx;
  hr2di_watch_describe_fn describe; /* NULL: `told` is as it should be */
  void *of;                         /* given to `describe` */
  uint64_t work;                    /* since the callback was asked last */
  uint64_t span;
  uint64_t max, total; /* the largest `work` at a question, and the sum of all */
  hr2d_status status;  /* what stopped it, or HR2D_OK */
  int refused;         /* that is the status of the callback */
  atomic_int stopped;  /* the status, for other threads and by them */
  hr2di_watch *leader; /* of the calling thread, if this is the watch of another thread */
};

/* Without a callback nobody is asked, and nothing stops. */
void hr2di_watch_init(hr2di_watch *watch, hr2d_progress_fn ask, void *ctx, const char *phase);

/* For another thread than the calling one, of a team whose calling thread has `leader`, which
   may be NULL.  It asks nobody, and stops soon after the leader did. */
void hr2di_watch_follow(hr2di_watch *watch, hr2di_watch *leader);

/* Stops the watches of a whole team, for a failure that is none of theirs; from any thread. */
void hr2di_watch_stop(hr2di_watch *watch, hr2d_status status);

/* Begins a phase, at fraction 0. */
void hr2di_watch_phase(hr2di_watch *watch, const char *phase);

/* Sets the function that describes what was done so far; NULL for none. */
void hr2di_watch_describe(hr2di_watch *watch, hr2di_watch_describe_fn describe, void *of);

/* Asks now.  Returns HR2D_OK, or the status that stops the call. */
hr2d_status hr2di_watch_ask(hr2di_watch *watch);

/* Declares work that is about to be done.  Returns HR2D_OK, or the status that stops the call.
   NULL: nobody watches. */
static inline hr2d_status hr2di_watch_work(hr2di_watch *watch, uint64_t units) {
  if (!watch) return HR2D_OK;
  watch->work += units;
  return watch->work < watch->span ? watch->status : hr2di_watch_ask(watch);
}

static inline hr2d_status hr2di_watch_status(const hr2di_watch *watch) {
  return watch ? watch->status : HR2D_OK;
}

/* Whether the callback has stopped it. */
static inline int hr2di_watch_refused(const hr2di_watch *watch) {
  return watch && watch->refused;
}

/* The watch that calls a callback back, for tests. */
static inline hr2di_watch *hr2di_watch_of(const hr2d_progress *report) {
  return (hr2di_watch *)(uintptr_t)report;
}

#endif
