/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which ends of patches, and which walls, a patch sees past all others. */
#ifndef HR2D_SRC_MESH_VISIBLE_VERTICES_H
#define HR2D_SRC_MESH_VISIBLE_VERTICES_H

#include "visibility/beam-cache.h"

/* Work space of one thread, and what the last patch sees. */
typedef struct hr2di_visible_vertices {
  hr2di_beam_tracer tracer;
  uint32_t *first;     /* per vertex: where its ends begin in `end`; one more */
  uint32_t *end;       /* 2·patch for its start, 2·patch + 1 for its last point */
  uint32_t *end_seen;  /* per end: 1 + the patch that saw it last */
  uint32_t *side_seen; /* the same per side of a wall edge */
  uint32_t *wall_seen;
  uint32_t patch; /* 1 + the last one */
} hr2di_visible_vertices;

/* For a committed scene with the effect of occlusion; the cache may be NULL. HR2D_OK,
   HR2D_ENOMEM or the status of the watch; to be ended by hr2di_visible_vertices_clear() in any
   case.
 */
hr2d_status hr2di_visible_vertices_init(hr2di_visible_vertices *seen, const hr2d_scene *scene,
                                        hr2di_beam_cache *beam_cache,
                                        const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_visible_vertices_clear(hr2di_visible_vertices *seen);

/* Looks from all of a patch; HR2D_OK, HR2D_ENOMEM or the status of the watch.  The cost is that
   of the beams from the patch. */
hr2d_status hr2di_visible_vertices_look(hr2di_visible_vertices *seen, uint32_t patch);

/* Whether the patch that looked last sees an end in front of it.  Of a wall of which it sees a
   part, all ends of patches between those of the wall count as seen, and so do a few ends that
   only other patches of its own wall see. */
static inline int hr2di_visible_vertices_has(const hr2di_visible_vertices *seen, uint32_t patch,
                                             int last) {
  return seen->end_seen[2 * patch + (last != 0)] == seen->patch;
}

/* Whether it sees the front of a patch on a wall. */
static inline int hr2di_visible_vertices_has_wall(const hr2di_visible_vertices *seen,
                                                  uint32_t wall) {
  return seen->wall_seen[wall] == seen->patch;
}

#endif
