/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two patches and their occluders as a scene, and the blocks of the two. */
#ifndef HR2D_TESTS_SUPPORT_BLOCK_STAGE_H
#define HR2D_TESTS_SUPPORT_BLOCK_STAGE_H

#include <hr2d/hr2d.h>

#include "support/visibility-cases.h"

/* After the commit. */
typedef struct block_stage {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_pair pair;
  hr2d_segment i, j;
  hr2d_segment *occluder;
  size_t count;
} block_stage;

/* Patches that cross are split; i and j are the first pieces.  Returns 0 if the scene is
   refused. */
int block_stage_set(block_stage *s, const occluded_pair *p);
void block_stage_end(block_stage *s);

/* The block of i and j in scene lengths, or of j and i; returns whether it is distant. */
int block_stage_make(const block_stage *s, size_t order, int swapped, double *block);

/* That of i and j with fewer points where they are farther apart than distant pairs must be. */
int block_stage_make_fewer(const block_stage *s, size_t order, double *block);

/* The same as an integral over lines, also for distant pairs; nothing may be in the way. */
void block_stage_lines(const block_stage *s, size_t order, double *block);

#endif
