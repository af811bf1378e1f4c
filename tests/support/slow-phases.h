/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The long calls of the library, each on what it needs, with one progress callback. */
#ifndef HR2D_TESTS_SUPPORT_SLOW_PHASES_H
#define HR2D_TESTS_SUPPORT_SLOW_PHASES_H

#include "support/slow-scenes.h"

typedef struct slow_stage {
  const hr2d_allocator *hooks; /* of all that is made; NULL: malloc() */
  slow_kind kind;
  size_t count;   /* patches, about */
  double epsilon; /* of refinements */
  unsigned order; /* of elements */
  double target;  /* of solves to a target; 0: .1, and solutions are made by refinement */
  unsigned threads;
  hr2d_progress_fn ask;   /* of the call itself, not of what is made for it */
  hr2d_progress_fn hurry; /* of what is made for it; NULL: nobody is asked */
  void *ctx;

  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  double *area;
  char *text; /* a scene file, or a state */
  size_t size, at;
} slow_stage;

typedef struct slow_phase {
  const char *name;
  hr2d_status (*prepare)(slow_stage *s); /* without the callback; not timed */
  hr2d_status (*run)(slow_stage *s);     /* may be called again after it was stopped */
} slow_phase;

enum { SLOW_PHASES = 24 };
extern const slow_phase slow_phases[SLOW_PHASES];

void slow_clear(slow_stage *s);

#endif
