/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What patches see, by beams from their walls.  A look may be kept, and the next one from the
   same patch walks no beams. */
#ifndef HR2D_SRC_VISIBILITY_LOOKS_H
#define HR2D_SRC_VISIBILITY_LOOKS_H

#include <stdatomic.h>

#include "scene/scene-impl.h"
#include "sight/walk.h"

typedef struct hr2di_look hr2di_look;

typedef struct hr2di_look_place {
  _Atomic(hr2di_look *) look; /* NULL: none is kept */
} hr2di_look_place;

/* Looks that are kept, by any number of threads. */
typedef struct hr2di_looks {
  hr2d_allocator alloc;
  hr2di_look_place *of; /* per patch */
  size_t patches;
  uint32_t *highest; /* per side of a wall edge: the patch of the highest number along it */
  size_t most_bytes; /* a look that takes more is not kept, so that no order matters */
} hr2di_looks;

/* For a committed scene with the effect of occlusion.  All looks together take up to `bytes`.
   HR2D_OK or HR2D_ENOMEM; to be ended by hr2di_looks_clear() in any case. */
hr2d_status hr2di_looks_init(hr2di_looks *looks, const hr2d_scene *scene, uint64_t bytes);
void hr2di_looks_clear(hr2di_looks *looks);

/* Takes a sight between two sides.  The chains are lost when it returns. */
typedef hr2d_status (*hr2di_look_fn)(void *ctx, const hr2di_sight *s, hr2di_wall_side from,
                                     hr2di_wall_side to);

/* A sight, and its points, that are to be kept. */
typedef struct hr2di_look_sight {
  hr2di_wall_side from, to;
  uint32_t lefts, rights, ends;
} hr2di_look_sight;

/* One thread that looks. */
typedef struct hr2di_looker {
  const hr2d_scene *scene;
  hr2di_looks *looks; /* NULL: nothing is kept */
  hr2di_look_fn take;
  void (*see)(void *ctx, uint32_t vertex); /* see hr2di_walk; may be NULL */
  void *ctx;
  hr2di_walk walk;
  uint64_t steps; /* triangles that beams of all looks enter, or entered when a look was kept:
                     no count depends on what is kept */
  /* The look under way. */
  uint32_t patch;
  hr2di_wall_side from;
  int keeps;
  hr2di_look_sight *sight;
  hr2d_point *point;
  uint32_t *vertex;
  size_t sights, points, vertices;
  size_t sight_room, point_room, vertex_room;
} hr2di_looker;

/* To be ended by hr2di_looker_clear(). */
hr2di_looker hr2di_looker_make(const hr2d_scene *scene, hr2di_looks *looks,
                               const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_looker_clear(hr2di_looker *looker);

/* Gives looker->take the sights from all parts of a patch, and looker->see the vertices.  With
   `later`, sights to sides where all patches have lower numbers may be NULL: looks that are
   kept have no chains for them.  HR2D_OK, HR2D_ENOMEM, the status of the watch or of `take`.
   The cost is that of the beams, or a tenth of it where the look was kept. */
hr2d_status hr2di_looker_look(hr2di_looker *looker, uint32_t patch, int later);

#endif
