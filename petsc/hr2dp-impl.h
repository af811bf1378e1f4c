/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rank's part of a scene.

   Patches are cut on level `cut` of their trees into units, so that there are enough of them to
   share out; the cut is 0 where there are many patches or where something stands in the way.  A
   rank owns units twice: for links, by their first element, a range of units or, without a cut,
   rows that are dealt out; and for unknowns a range of units.  Its
   hierarchy has the elements that its links touch, all elements of the units that it owns, and
   the elements above the cut.

   Images of patches are no units.  Whoever has a link with an image has the element of the
   patch itself, too: before a gather the image gets its radiosity, and behind it gives the
   element what it has received. */
#ifndef HR2D_PETSC_HR2DP_IMPL_H
#define HR2D_PETSC_HR2DP_IMPL_H

#include <hr2d-petsc.h>
#include <petscsf.h>

#include "exact-sum.h"

/* Which rank owns which units: those of rank r are [from[r], from[r + 1]). */
typedef struct hr2dpi_ranges {
  uint64_t *from; /* ranks + 1 */
} hr2dpi_ranges;

typedef struct hr2dpi_units {
  unsigned cut;         /* the level of a unit's root */
  uint64_t count;       /* patches << cut */
  hr2dpi_ranges links;  /* of pairs, by their first element; without a cut, until rows are
                           dealt out */
  hr2dpi_ranges leaves; /* of unknowns */
  double *start;        /* with a cut: per unit, the coordinate where it starts... */
  unsigned char *along; /* ...and per patch, which one: x or y, bit 0; falling, bit 1 */
  unsigned char *rows;  /* without a cut: per patch, whether its row, or a part of it, is of
                           this rank */
  uint32_t *piece;      /* without a cut: the first piece of each row, one more than patches */
  int *owner;           /* of each piece, or NULL before rows are dealt out */
  size_t cuts;          /* pieces that are not the first of their row */
  int placed;           /* the ranges are known */
} hr2dpi_units;

/* The elements of a rank's hierarchy by their part in a sweep. */
typedef struct hr2dpi_trees {
  size_t elements; /* of the hierarchy */
  uint32_t *own;   /* elements of own units, parents before children */
  size_t owned;
  uint32_t *top; /* elements above the cut with children, in the same order on every rank,
                    parents before children */
  size_t tops;
  uint32_t *leaf;     /* own leaves by position */
  uint32_t *original; /* per element: that of which it is an image; NULL: there are no images */
  size_t leaves;
  PetscSF halo; /* from own elements to those of other ranks that links need, and to what
                   stands below the top */
  size_t halos;
  MPI_Datatype unit[2]; /* `bands` doubles, and as many bins */
  int ready;
} hr2dpi_trees;

struct hr2dp {
  MPI_Comm comm;
  int rank, ranks;
  const hr2d_scene *scene;
  hr2d_allocator alloc;
  size_t patches, bands, images; /* patches are those that were given */
  size_t roots;                  /* of the hierarchy: with images, and ends of a period */
  double max; /* exchange areas of a patch are at most so many times its length, together */
  hr2d_oracle oracle;
  hr2d_policy policy;
  void *oracle_ctx, *policy_ctx;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2dpi_units units;
  hr2dpi_trees trees;
  struct hr2dpi_top *top; /* with a cut: links whose first element is above it */
  uint64_t *repeated;     /* numbers of links of which another rank has the same, rising */
  size_t repeats;
  hr2dp_counts counts;
  hr2d_refine_counts long_rows[2]; /* see long-rows.h */
  int directed;
  int refined;   /* there are links */
  uint64_t hash; /* of the scene */
  hr2d_status status;
  char message[400];
};

/* memory.c: as of hr2d_allocator; counts are checked for overflow.  `zero` clears. */
void *hr2dpi_alloc(const hr2dp *p, size_t count, size_t size);
void *hr2dpi_alloc_zero(const hr2dp *p, size_t count, size_t size);
void hr2dpi_free(const hr2dp *p, void *block);

/* agree.c: collective.  If a rank has a status, all take that of the lowest such rank, with its
   message, and get PETSC_ERR_LIB. */
PetscErrorCode hr2dpi_agree(hr2dp *p, hr2d_status status);

/* The element of which another one is an image; itself, if it is none. */
static inline uint32_t hr2dpi_original(const hr2dp *p, uint32_t element) {
  return p->trees.original ? p->trees.original[element] : element;
}

/* Forgets the last failure. */
static inline void hr2dpi_begin(hr2dp *p) {
  p->status = HR2D_OK;
  p->message[0] = 0;
}

/* Keeps a message for the next agreement; returns the status. */
__attribute__((format(printf, 3, 4))) hr2d_status hr2dpi_fail(hr2dp *p, hr2d_status status,
                                                              const char *format, ...);

/* Collective: adds exact sums of all ranks. */
PetscErrorCode hr2dpi_sum_all(hr2dp *p, hr2dpi_sum *sum, size_t count);

/* Collective: the sum of counts, the largest of them. */
PetscErrorCode hr2dpi_add_counts(hr2dp *p, uint64_t *count, int size);
PetscErrorCode hr2dpi_max_counts(hr2dp *p, uint64_t *count, int size);
PetscErrorCode hr2dpi_max_doubles(hr2dp *p, double *value, int size);

#endif
