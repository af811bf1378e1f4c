/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The engine of ProjectKernel: pairs go in, links come out of a sink. */
#ifndef HR2D_SRC_REFINE_PROJECTOR_H
#define HR2D_SRC_REFINE_PROJECTOR_H

#include <hr2d/refine.h>

#include "base/watch.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/linkset-impl.h"
#include "refine/refine-how.h"
#include "visibility/pair-visibility.h"

enum {
  HR2DI_BATCH = 256,                 /* pairs subdivided at a time */
  HR2DI_CANDIDATES = 4 * HR2DI_BATCH /* pairs proposed at a time: both elements split */
};

/* Receives accepted pairs, which see each other at least in part.  `area` is NULL, unless their
   exchange areas are integrated already, past the walls in the way. */
typedef hr2d_status (*hr2di_sink)(void *ctx, const hr2d_pair *pairs, const double *area,
                                  size_t count);

typedef struct hr2di_stack {
  hr2d_pair *pair;
  size_t count, capacity;
} hr2di_stack;

/* A stack of pairs with walls in the way.  The line classes of a pair are in `list`, behind
   those of the pair below it on the stack. */
typedef struct hr2di_occluded_pairs {
  hr2di_stack stack;
  size_t *first; /* per pair: where its line classes begin in `list` */
  size_t first_capacity;
  hr2di_line_class_list list;
} hr2di_occluded_pairs;

/* The slot under way, if it has several pieces, see refine/part-rows.h. */
typedef struct hr2di_part_row {
  const unsigned char *mine; /* per piece */
  size_t count;              /* of pieces; at most 1: none is under way */
  size_t next;               /* the piece of the next link */
  uint64_t areas;            /* of links that are kept */
  hr2d_refine_counts before; /* the slot */
  uint64_t tests;            /* of visibility, before the slot */
  uint64_t others;           /* tests that other shares count */
} hr2di_part_row;

typedef struct hr2di_projector hr2di_projector;

struct hr2di_projector {
  hr2d_linkset *links;
  hr2d_hierarchy *hierarchy;
  hr2di_refine_how how;
  hr2d_refine_options options;
  hr2di_sink sink; /* NULL: links are only counted */
  void *sink_ctx;
  hr2d_refine_counts counts; /* of this refinement alone; elements and levels unused */
  int directed;              /* links carry light from second to first only */
  int check_levels;          /* elements deeper than max_level exist already */
  int weighs;                /* some exchange areas count in part, or more than once */
  int test_all;              /* facing is tested although no horizon cuts a pair */
  double *brightness;        /* per element, or NULL; as long as brightness_capacity */
  size_t brightness_capacity;
  uint64_t bytes;           /* memory held besides the hierarchy and the stacks */
  uint64_t budget;          /* bytes, for messages; options.max_bytes may be a part of it */
  double roots, roots_done; /* root pairs, all and done so far, for progress */
  double fraction;          /* of them, when it was measured last; see rounds.h */
  unsigned ticks;           /* rounds since then */
  hr2d_row_counts *rows;    /* per patch, or per slot of how.pieces; NULL: nobody asks */
  hr2di_part_row part;
  uint64_t other_tests; /* of visibility, that another share counts, by all workers */
  hr2di_watch *watch;   /* of the thread that uses this */

  hr2di_stack facing;  /* refused pairs that face each other fully */
  hr2di_stack clipped; /* refused pairs that one horizon still cuts */

  /* Empty unless the scene calls for occlusion. */
  hr2di_pair_visibility *visibility;
  hr2di_occluded_pairs occluded; /* refused pairs with walls in the way */
  hr2di_stack unoccluded[2];     /* child pairs without walls, not yet proposed: facing fully,
                                    and in part */
  hr2di_line_class_list found;   /* line classes of pairs that are not yet estimated */
  hr2di_line_class_list parts;   /* what one pair sees of them */
  const unsigned char *partial;  /* per pair to be estimated: it has walls in the way; NULL: no
                                    pair has any */

  /* the round under way */
  hr2d_pair candidate[HR2DI_CANDIDATES];
  hr2d_pair sorted[2][HR2DI_CANDIDATES]; /* facing fully, in part */
  hr2d_pair accepted[HR2DI_CANDIDATES];
  double error[HR2DI_CANDIDATES];
  unsigned char flag[HR2DI_CANDIDATES];
  unsigned char split[HR2DI_BATCH];
};

/* Fills in default options and checks the options against the set.  Returns HR2D_OK,
   HR2D_EINVAL or HR2D_ESTATE. */
hr2d_status hr2di_projector_check_options(hr2d_linkset *links, const hr2d_refine_options *given,
                                          hr2d_refine_options *options);

/* Creates a projector for checked options; the caller destroys it.  Returns HR2D_OK,
   HR2D_ENOMEM, HR2D_EMAX_BYTES or the status of the watch, and leaves a message on failure. */
hr2d_status hr2di_projector_create(hr2d_linkset *links, const hr2di_refine_how *how,
                                   const hr2d_refine_options *options, hr2di_watch *watch,
                                   hr2di_projector **made);
void hr2di_projector_destroy(hr2di_projector *p);

/* Proposes a patch with all later patches, or with all others if links are directed.  Refused
   pairs are left on the stacks. */
hr2d_status hr2di_projector_row(hr2di_projector *p, size_t patch);

/* Proposes all pairs of patches, and subdivides until no refused pair is left. */
hr2d_status hr2di_projector_all(hr2di_projector *p);

/* Proposes up to HR2DI_CANDIDATES pairs.  Drops pairs that do not face each other; refused
   pairs that do so in part are pushed on p->clipped, the other refused ones on p->facing. */
hr2d_status hr2di_projector_propose_clipped(hr2di_projector *p, const hr2d_pair *pairs,
                                            size_t count);

/* Removes the pairs that the claim drops.  Sets p->flag. */
hr2d_status hr2di_projector_claim(hr2di_projector *p, hr2d_pair *pairs, size_t *count);

/* How many rows, or slots of rows, have counts of their own. */
static inline size_t hr2di_projector_rows(const hr2di_projector *p) {
  const size_t rows = hr2di_scene_cell(p->hierarchy->scene);
  return p->how.pieces ? p->how.pieces->slot[rows] : rows;
}

/* Counts links, or tests of visibility, of a pair of patches, if anybody asks. */
static inline void hr2di_projector_in_row(hr2di_projector *p, size_t patch, size_t other,
                                          uint64_t links, uint64_t tests) {
  if (!p->rows) return;
  const hr2di_row_pieces *pieces = p->how.pieces;
  hr2d_row_counts *row = &p->rows[pieces ? hr2di_row_slot(pieces, patch, other) : patch];
  row->links += links;
  row->visibility_tests += tests;
}

/* Adds what a projector has counted in rows to `sum`, if it has. */
void hr2di_projector_add_rows(const hr2di_projector *p, hr2d_row_counts *sum);

/* Asks the oracle about pairs; p->partial says which have walls in the way.  Sets p->flag to 1
   for pairs that are acceptable, else to 0. */
hr2d_status hr2di_projector_estimate(hr2di_projector *p, const hr2d_pair *pairs, size_t count);

/* Proposes pairs: links the accepted ones, pushes the others on the stack `refused`. */
hr2d_status hr2di_projector_propose(hr2di_projector *p, const hr2d_pair *pairs, size_t count,
                                    hr2di_stack *refused);

/* Asks the policy about refused pairs: sets p->split, and p->flag to 1 for pairs that the
   policy's own limit stops. */
hr2d_status hr2di_projector_choose_split(hr2di_projector *p, const hr2d_pair *pairs,
                                         size_t count);

/* Halves the elements that are to be split and have no children yet.  Pairs that a limit stops
   go to p->accepted; the others stay in `pairs`, and *count is their number. */
hr2d_status hr2di_projector_prepare(hr2di_projector *p, hr2d_pair *pairs, size_t *count,
                                    size_t *limited);

/* Halves a leaf within the budgets. */
hr2d_status hr2di_projector_halve(hr2di_projector *p, uint32_t element);

/* Writes the child pairs of `pairs` to p->candidate.  Returns their number, or 0 if some
   element to be split has no children yet. */
size_t hr2di_projector_children(hr2di_projector *p, const hr2d_pair *pairs, size_t count);

/* Multiplies exchange areas by the weights of their pairs. */
static inline void hr2di_projector_weigh(const hr2di_projector *p, const hr2d_pair *pairs,
                                         size_t count, double *area) {
  const hr2d_element *e = p->hierarchy->element;
  for (size_t k = 0; p->weighs && k < count; k++)
    area[k] *= hr2di_symmetry_weight(&p->hierarchy->scene->symmetry, e[pairs[k].first].patch,
                                     e[pairs[k].second].patch, p->directed);
}

/* Declares work.  Returns HR2D_OK, or the status that stops the refinement. */
static inline hr2d_status hr2di_projector_work(hr2di_projector *p, uint64_t units) {
  return hr2di_watch_work(p->watch, units);
}

/* Leaves a message for a status that the watch may have caused, else HR2D_ENOMEM for `what`;
   none if another thread has stopped this one.  Returns the status. */
hr2d_status hr2di_projector_fail(hr2di_projector *p, hr2d_status status, const char *what);

/* Leaves a message if a callback has failed; returns the status of the callback. */
hr2d_status hr2di_projector_check_callback(hr2di_projector *p, hr2d_status status,
                                           const char *kind, const char *name);

/* Puts a pair on a stack, for the next hr2di_rounds_run(). */
hr2d_status hr2di_projector_push(hr2di_projector *p, hr2di_stack *stack, hr2d_pair pair);

/* Hands the first `count` of p->accepted to the sink. */
hr2d_status hr2di_projector_accept(hr2di_projector *p, const double *area, size_t count);

/* Subdivides one pair into p->candidate.  If a limit holds, there are 0 candidates, and
   `limited` receives 1. */
hr2d_status hr2di_projector_subdivide(hr2di_projector *p, hr2d_pair pair, size_t *candidates,
                                      int *limited);

/* Counts `more` links.  Returns HR2D_OK, or HR2D_EMAX_LINKS if that exceeds the budget. */
hr2d_status hr2di_projector_count_links(hr2di_projector *p, size_t more);

/* What is left of the budget; UINT64_MAX if there is none. */
uint64_t hr2di_projector_left(const hr2di_projector *p);

/* Returns HR2D_OK, or HR2D_EMAX_BYTES if `more` bytes would exceed the budget. */
hr2d_status hr2di_projector_check_budget(hr2di_projector *p, uint64_t more);

/* Leaves a message; returns HR2D_EMAX_BYTES. */
hr2d_status hr2di_projector_fail_budget(hr2d_linkset *links, uint64_t budget, uint64_t made);

/* Sets the counts of elements. */
void hr2di_projector_count_elements(const hr2d_hierarchy *hierarchy,
                                    hr2d_refine_counts *counts);

#endif
