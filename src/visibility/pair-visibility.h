/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What patches see of each other, as line classes: the trace from a patch is kept for its
 * pairs.
 */
#ifndef HR2D_SRC_VISIBILITY_PAIR_VISIBILITY_H
#define HR2D_SRC_VISIBILITY_PAIR_VISIBILITY_H

#include "beams/line-class-list.h"
#include "visibility/beam-cache.h"

/* Work space of one thread, and the last trace. */
typedef struct hr2di_pair_visibility {
  hr2di_beam_tracer tracer;
  hr2di_line_class_list all; /* from the walls of the patch that looked */
  uint32_t *next; /* per line class: 1 + the one before it that ends at the same side, or 0 */
  uint32_t *side; /* per line class: where it ends */
  size_t next_capacity, side_capacity;
  uint32_t *last;  /* per side: 1 + the last line class that ends there, or 0 */
  uint32_t looked; /* 1 + the patch from which `all` was traced; 0: none */
  int later;       /* `all` may lack line classes to patches with lower numbers */
  uint32_t taken;  /* 1 + the patch to which the line classes in `turned` lead; 0: none */
  hr2di_line_class_list turned; /* of one pair, near ends on the patch of the lower number */
  uint64_t restricted;          /* line classes so far */
} hr2di_pair_visibility;

/* For a committed scene with the effect of occlusion; the cache may be NULL.  HR2D_OK
   or HR2D_ENOMEM; to be ended by hr2di_pair_visibility_clear() in any case. */
hr2d_status hr2di_pair_visibility_init(hr2di_pair_visibility *visibility,
                                       const hr2d_scene *scene, hr2di_beam_cache *beam_cache,
                                       const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_pair_visibility_clear(hr2di_pair_visibility *visibility);

/* Parts of two patches. */
typedef struct hr2di_patch_pair {
  uint32_t patch[2];
  hr2d_segment part[2];
} hr2di_patch_pair;

/* Appends to `list` the line classes between the two parts.  Their near ends are on the patch
   with the lower number, whatever the order of the parts.  Appends to `whole`, which may be
   NULL, the line classes between walls from which those were restricted.  Traces beams from the
   first patch, unless the last trace was from it.  HR2D_OK, HR2D_ENOMEM, HR2D_EMAX_BYTES at the
   limit of a list, or the status of the watch. */
hr2d_status hr2di_pair_visibility_between(hr2di_pair_visibility *visibility,
                                          const hr2di_patch_pair *pair,
                                          hr2di_line_class_list *list,
                                          hr2di_line_class_list *whole);

/* Looks from a patch, unless it has looked last, if hr2di_pair_visibility_between() would do so
   for parts of these patches.  Returns likewise. */
hr2d_status hr2di_pair_visibility_look(hr2di_pair_visibility *visibility, uint32_t from,
                                       uint32_t to);

/* How line classes [first, count) of a list see a far part from a near one. */
hr2di_visibility_class hr2di_line_classes_classify(const hr2di_line_class_list *list,
                                                   size_t first, hr2d_segment near,
                                                   hr2d_segment far);

/* Triangles that beams have passed and line classes that were restricted so far. */
uint64_t hr2di_pair_visibility_tests(const hr2di_pair_visibility *visibility);

/* The bytes that its lists hold. */
uint64_t hr2di_pair_visibility_bytes(const hr2di_pair_visibility *visibility);

#endif
