/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What patches see, by beams from their walls.  A trace may be kept, and the next one from the
   same patch walks no beams. */
#ifndef HR2D_SRC_VISIBILITY_BEAM_CACHE_H
#define HR2D_SRC_VISIBILITY_BEAM_CACHE_H

#include <stdatomic.h>

#include "beams/walk.h"
#include "scene/scene-impl.h"

typedef struct hr2di_cached_beams hr2di_cached_beams;

typedef struct hr2di_beam_cache_slot {
  _Atomic(hr2di_cached_beams *) beams; /* NULL: none is kept */
} hr2di_beam_cache_slot;

/* Looks that are kept, by any number of threads. */
typedef struct hr2di_beam_cache {
  hr2d_allocator alloc;
  hr2di_beam_cache_slot *of; /* per patch */
  size_t patches;
  uint32_t *highest; /* per side of a wall edge: the patch of the highest number along it */
  size_t max_bytes;  /* per patch: the order of traces does not decide what is kept */
} hr2di_beam_cache;

/* For a committed scene with the effect of occlusion.  All traces together take up to `bytes`.
   HR2D_OK or HR2D_ENOMEM; to be ended by hr2di_beam_cache_clear() in any case. */
hr2d_status hr2di_beam_cache_init(hr2di_beam_cache *beam_cache, const hr2d_scene *scene,
                                  uint64_t bytes);
void hr2di_beam_cache_clear(hr2di_beam_cache *beam_cache);

/* Takes a line class between two sides.  The chains are lost when it returns. */
typedef hr2d_status (*hr2di_beam_fn)(void *ctx, const hr2di_line_class *s, hr2di_wall_side from,
                                     hr2di_wall_side to);

/* A line class, and its points, that are to be kept. */
typedef struct hr2di_cached_line_class {
  hr2di_wall_side from, to;
  uint32_t lefts, rights, ends;
} hr2di_cached_line_class;

/* One thread that traces. */
typedef struct hr2di_beam_tracer {
  const hr2d_scene *scene;
  hr2di_beam_cache *beam_cache; /* NULL: nothing is kept */
  hr2di_beam_fn take;
  void (*see)(void *ctx, uint32_t vertex); /* see hr2di_walk; may be NULL */
  void *ctx;
  hr2di_walk walk;
  uint64_t steps; /* triangles that beams of all traces entered; a replayed trace counts as when
                     it was made, so that the count does not depend on the cache */
  /* The trace under way. */
  uint32_t patch;
  hr2di_wall_side from;
  int keeps;
  hr2di_cached_line_class *line_class;
  hr2d_point *point;
  uint32_t *vertex;
  size_t classes, points, vertices;
  size_t class_room, point_room, vertex_room;
} hr2di_beam_tracer;

/* To be ended by hr2di_beam_tracer_clear(). */
hr2di_beam_tracer hr2di_beam_tracer_make(const hr2d_scene *scene, hr2di_beam_cache *beam_cache,
                                         const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_beam_tracer_clear(hr2di_beam_tracer *tracer);

/* Gives tracer->take the line classes from all parts of a patch, and tracer->see the vertices.
   With `later` the caller needs only patches with higher numbers.  Then a cached trace may be
   replayed; `take` gets NULL for line classes to sides where all patches have lower numbers, as
   the cache has no chains for them.  Returns HR2D_OK, HR2D_ENOMEM, the status of the watch or
   of `take`.  The cost is that of the beams, or a tenth of it if the trace was cached. */
hr2d_status hr2di_beam_tracer_trace(hr2di_beam_tracer *tracer, uint32_t patch, int later);

#endif
