/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What patches see of each other, as sights: the look from a patch is kept for its pairs. */
#ifndef HR2D_SRC_VISIBILITY_PATCH_SIGHTS_H
#define HR2D_SRC_VISIBILITY_PATCH_SIGHTS_H

#include "sight/sight-list.h"
#include "visibility/looks.h"

/* Work space of one thread, and the last look. */
typedef struct hr2di_patch_sights {
  hr2di_looker looker;
  hr2di_sight_list all; /* from the walls of the patch that looked */
  uint32_t *next;       /* per sight: 1 + the one before it that ends at the same side, or 0 */
  uint32_t *side;       /* per sight: where it ends */
  size_t next_capacity, side_capacity;
  uint32_t *last;  /* per side: 1 + the last sight that ends there, or 0 */
  uint32_t looked; /* 1 + the patch; 0 if none has */
  int later;       /* it may lack sights of patches with lower numbers */
  uint32_t taken;  /* 1 + the patch to which those of the pair under way lead; 0: none */
  hr2di_sight_list turned; /* these, with the near ends on the patch of the lower number */
  uint64_t restricted;     /* sights so far */
} hr2di_patch_sights;

/* For a committed scene with the effect of occlusion; looks that are kept may be NULL.  HR2D_OK
   or HR2D_ENOMEM; to be ended by hr2di_patch_sights_clear() in any case. */
hr2d_status hr2di_patch_sights_init(hr2di_patch_sights *sights, const hr2d_scene *scene,
                                    hr2di_looks *looks, const hr2d_allocator *alloc,
                                    hr2di_watch *watch);
void hr2di_patch_sights_clear(hr2di_patch_sights *sights);

/* Parts of two patches. */
typedef struct hr2di_patch_pair {
  uint32_t patch[2];
  hr2d_segment part[2];
} hr2di_patch_pair;

/* Appends to `list` what the parts see of each other, with the near ends on the patch of the
   lower number, whichever comes first, and to `whole`, which may be NULL, the sights between
   walls of which that is a part.  Looks from the first patch, unless it has looked last.
   HR2D_OK, HR2D_ENOMEM, HR2D_EMAX_BYTES at the limit of a list, or the status of the watch. */
hr2d_status hr2di_patch_sights_between(hr2di_patch_sights *sights, const hr2di_patch_pair *pair,
                                       hr2di_sight_list *list, hr2di_sight_list *whole);

/* Looks from a patch, unless it has looked last, if hr2di_patch_sights_between() would do so
   for parts of these patches.  Returns likewise. */
hr2d_status hr2di_patch_sights_look(hr2di_patch_sights *sights, uint32_t from, uint32_t to);

/* How sights [first, count) of a list see a far part from a near one. */
hr2di_visibility_class hr2di_sights_classify(const hr2di_sight_list *list, size_t first,
                                             hr2d_segment near, hr2d_segment far);

/* Triangles that beams have passed and sights that were restricted so far. */
uint64_t hr2di_patch_sights_tests(const hr2di_patch_sights *sights);

/* The bytes that its lists hold. */
uint64_t hr2di_patch_sights_bytes(const hr2di_patch_sights *sights);

#endif
