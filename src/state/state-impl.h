/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The format of a state, for its writer and its reader:

     a line that names the format; then, as words, the head and the counts of refinement and
     solve;
     for each division, in their order, the element that was divided, as a half word;
     for each link its elements, as half words, and its exchange area;
     the powers of each band, then B and H, as doubles;
     the hash of all that. */
#ifndef HR2D_SRC_STATE_STATE_IMPL_H
#define HR2D_SRC_STATE_STATE_IMPL_H

#include <hr2d/state.h>
#include <stdint.h>

#include "base/watch.h"

#define HR2DI_STATE_TITLE "libhr2d state 1\n"

enum { HR2DI_STATE_TITLE_BYTES = sizeof HR2DI_STATE_TITLE - 1, HR2DI_STATE_COUNTERS = 16 };

typedef struct hr2di_state_head {
  uint64_t scene, method; /* hashes of the scene and the method that the state belongs to */
  uint64_t elements, links;
  uint64_t solved; /* elements that the solution has */
  uint64_t order, bands, directed;
  double epsilon, residual;
} hr2di_state_head;

enum { HR2DI_STATE_HEAD_BYTES = 8 * (10 + HR2DI_STATE_COUNTERS) };

/* Sets pointers to all counters, in the order of the format. */
void hr2di_state_counters(hr2d_refine_counts *counts, hr2d_solve_work *work,
                          uint64_t *counter[HR2DI_STATE_COUNTERS]);

/* The hash of everything in a committed scene that can change a result; of a part of it once
   the watch has stopped. */
uint64_t hr2di_state_scene(const hr2d_scene *scene, hr2di_watch *watch);

/* The hash of the names of the oracle and the policy. */
uint64_t hr2di_state_method(const hr2d_linkset *links);

#endif
