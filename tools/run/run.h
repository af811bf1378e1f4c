/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A whole run of `hr2d solve`, from links to radiosity, with its counts and times. */
#ifndef HR2D_TOOLS_RUN_RUN_H
#define HR2D_TOOLS_RUN_RUN_H

#include <hr2d/hr2d.h>
#include <stdint.h>

#include "cli/options.h"
#include "cli/warnings.h"
#include "output/progress.h"

struct run;

/* Several processes that make one run together, and keep its stages. */
typedef struct run_shares {
  hr2d_share *share;
  int (*load)(struct run *r); /* as state_load() and state_save() */
  int (*save)(struct run *r);
} run_shares;

/* A link, from one of its elements to the other. */
typedef struct run_link {
  uint32_t near, far;
  double exchange_area;
} run_link;

typedef struct run_links {
  run_link *items;
  size_t count;
} run_links;

typedef struct run {
  const options *options;
  const hr2d_scene *scene;
  size_t cuts;              /* of --split-crossings */
  double start;             /* clock_seconds() when the command began */
  const size_t *places;     /* the patches of --at, --links-of, --importance and --beams-of */
  const warnings *warnings; /* about the scene */
  const run_shares *shares; /* NULL: this process is alone */
  hr2d_share *share;        /* of this process; NULL likewise */
  uint64_t max_links;       /* with shares: of the share that has most */
  uint64_t max_tests;       /* likewise: tests of visibility */
  uint64_t max_bytes;       /* likewise, at the peak */
  const hr2d_hierarchy *hierarchy;
  const hr2d_linkset *links;
  hr2d_solution *solution;
  hr2d_hierarchy *own_hierarchy; /* NULL if the solution owns its hierarchy and links */
  hr2d_linkset *own_links;
  unsigned rounds;                 /* of the last stage, until links and light agree */
  hr2d_solve_work work;            /* over all stages and rounds */
  hr2d_account account;            /* order, L, seconds, and errors, NaN if unknown */
  double resumed;                  /* ε of the state that the run started from; 0: none */
  double kept;                     /* ε of the state in the file of --state; 0: none */
  run_links point_links;           /* of --links-of: `near` holds the point */
  hr2d_enclosure *enclosure;       /* of --enclose; NULL: none */
  hr2d_enclosure_account enclosed; /* how far it came */
  int inaccurate; /* there is a solution, but its error is too large or unknown */
} run;

/* Refines and solves a run that has its options, scene, places and start.  Returns 0, or the
   exit status after an error message; in both cases the run has to be released.  If it is
   `inaccurate`, the solution can be reported although the status is not 0. */
int run_solve(run *r);

void run_release(run *r);

/* Learns what the share that has most has; all shares call it.  Returns 0 or the exit status.
 */
int run_compare_shares(run *r);

/* Whether this process reads and writes: it is alone, or the first of the shares. */
static inline int run_is_first(const run *r) {
  return !r->share || r->share->number == 0;
}

/* The largest of the exit statuses of all shares, which all call it. */
int run_agree(const run *r, int status);

/* all-links.c: all links of all shares but those of images, on the first share in an order that
   does not depend on their number; all shares call it, and release the items.  Returns 0 or the
   exit status, which may not be the same on all. */
int run_all_links(const run *r, run_links *links);

/* The links that serve the point of --links-of, if there is one; likewise. */
int run_point_links(run *r);

/* target.c: solves to the target error, or as well as the budget allows; otherwise like
   run_solve(). */
int run_target(run *r, progress *p);

/* Whether bounds rest on an assumption on kinks inside elements, see accuracy.h. */
int run_assumes_kinks(const run *r);

/* The error of a solution that had no target, unless the options say not to measure it. */
int run_error(run *r, progress *p);

/* Encloses the averages, if the options say so; in the first share alone. */
int run_enclose(run *r);

/* The errors of the averages of B and of H, for certain; infinite where nothing is known. */
void run_enclosed_errors(const run *r, double *average, double *irradiance);

/* The limits of refinement in the options. */
hr2d_refine_options run_refine_options(const options *o);

/* places.c: the patches that --at, --links-of, --importance and --beams-of name, in this order,
   as a run has them; the caller frees them, also after a failure.  Returns 0 or the exit
   status. */
int run_find_places(const options *o, const hr2d_scene *scene, size_t **patches);

/* The patches of --importance, in the order given. */
const size_t *run_important(const run *r);

/* Those of --beams-of. */
const size_t *run_beamed(const run *r);

/* Whether values at points are gathered once more; constants of elements at order 1 stay what
   they are. */
int run_gathers(const run *r);

/* B and H at a fraction of a patch, in all bands.  Returns 0 or the exit status. */
int run_point(const run *r, size_t patch, double t, double *radiosity, double *irradiance);

/* The same at the point of --at number k. */
int run_place(const run *r, size_t k, double *radiosity, double *irradiance);

/* Temperatures and heat of all patches, for scenes in which some patch has a temperature or a
   flux. */
typedef struct run_heat {
  int exists;     /* 0 for other scenes */
  double *kelvin; /* the first of six arrays in one block */
  unsigned char *state;
  hr2d_temperatures of; /* where they are */
} run_heat;

/* Asks the solution.  Returns 0 or the exit status; in both cases the heat has to be
   released. */
int run_heat_find(const run *r, run_heat *heat);
void run_heat_release(run_heat *heat);

/* Whether some patch of a scene has a temperature or a flux. */
int run_heat_exists(const hr2d_scene *scene);

/* T at fraction t of a patch where H arrives, in the only band if there is one; in several
   bands a patch has one T.  NaN if it is not known. */
double run_heat_at(const run *r, size_t patch, double t, double irradiance);

/* "found" */
const char *run_heat_word(unsigned char state);

/* The difference of incoming and outgoing power of a band, relative to the incoming power. */
double run_power_error(const hr2d_power *p);

/* The peak memory of the process. */
uint64_t run_peak_bytes(void);

/* Whether a sun lights the scene. */
int run_sun_exists(const hr2d_scene *scene);

#endif
