/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of a run of fuzz_api, and the calls from which it chooses. */
#ifndef HR2D_FUZZ_API_H
#define HR2D_FUZZ_API_H

#include "fuzz.h"

enum { API_SLOTS = 4 };

/* A set of links and a solution from it. */
typedef struct api_slot {
  hr2d_linkset *links;
  hr2d_solution *solution;
  unsigned order; /* of the solution */
  int closure;
  int ordered;
  int owners; /* how many contexts the set is to destroy */
  const hr2d_oracle *oracle;
  const hr2d_policy *policy;
  fuzz_callbacks callbacks;
} api_slot;

typedef struct api_run {
  fuzz_input *in;
  fuzz_memory memory;
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy[API_SLOTS / 2]; /* of slots 0 and 1, and of slots 2 and 3 */
  api_slot slot[API_SLOTS];
  long failures; /* of memory, when it began to run out */
} api_run;

typedef void (*api_call)(api_run *, api_slot *);
extern const api_call api_calls[];
extern const unsigned api_call_count;

/* From here on memory may fail, as the input says. */
void api_memory_runs_out(api_run *r);

/* Whether it has failed since. */
int api_memory_is_back(api_run *r);

hr2d_hierarchy *api_hierarchy(api_run *r, const api_slot *s);

/* Writes the scene as bytes and reads it back; reads damaged bytes. */
void api_bytes(api_run *r);

/* The calls, grouped by the object on which they work. */
void api_refine(api_run *r, api_slot *s);
void api_compare(api_run *r, api_slot *s);
void api_solve(api_run *r, api_slot *s);
void api_read(api_run *r, api_slot *s);
void api_matrix(api_run *r, api_slot *s);
void api_occluded(api_run *r, api_slot *s);
void api_target(api_run *r, api_slot *s);
void api_study(api_run *r, api_slot *s);
void api_misuse(api_run *r, api_slot *s);

/* Options that keep a run short; the input sets the budgets. */
hr2d_refine_options api_refine_options(api_run *r, const api_slot *s);

#endif
