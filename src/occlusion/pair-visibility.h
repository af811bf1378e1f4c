/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What two segments exchange with walls in the way, and whether anything at all. */
#ifndef HR2D_SRC_OCCLUSION_PAIR_VISIBILITY_H
#define HR2D_SRC_OCCLUSION_PAIR_VISIBILITY_H

#include "occlusion/line-classes.h"
#include "occlusion/shaft.h"
#include "occlusion/walls.h"
#include "sight/sight-list.h"

/* The numbers of walls, of which each has a capacity of its own. */
typedef struct hr2di_wall_list {
  uint32_t *wall;
  size_t count, capacity;
} hr2di_wall_list;

/* Those from number `first` on; NULL where there never were any. */
static inline uint32_t *hr2di_wall_list_from(const hr2di_wall_list *list, size_t first) {
  return list->wall ? list->wall + first : NULL;
}

/* Which sides of a shaft a body was seen to reach: 1 right, 2 left. */
enum { HR2DI_REACHES = 16 };

typedef struct hr2di_reach {
  uint64_t look; /* hr2di_visibility::looks, of when it was seen */
  uint32_t body;
  unsigned beyond;
} hr2di_reach;

/* Work space of one thread. */
typedef struct hr2di_visibility {
  const hr2di_walls *walls;
  hr2d_allocator alloc;
  hr2di_watch *watch; /* of the same thread; NULL: nobody watches */
  uint64_t tests;     /* of walls and boxes against a shaft, so far */
  uint32_t last;      /* the wall found last to be in the way, or one of its body */
  uint64_t looks;
  hr2di_reach reach[HR2DI_REACHES];
  hr2di_classes classes;
  hr2di_wall_list list; /* of the parts of a pair under way */
} hr2di_visibility;

void hr2di_visibility_init(hr2di_visibility *sight, const hr2di_walls *walls,
                           const hr2d_allocator *alloc, hr2di_watch *watch);
void hr2di_visibility_clear(hr2di_visibility *sight);

/* The functions below return HR2D_OK, HR2D_ENOMEM or the status of the watch. */

/* Appends to `found` the walls in the way, of those in the scene, by their numbers.  Nothing is
   appended unless the view is partial.  One wall across is noticed here, what several block
   together by hr2di_visibility_area(). */
hr2d_status hr2di_visibility_collect(hr2di_visibility *sight, const hr2di_shaft *shaft,
                                     hr2di_wall_list *found, hr2di_visibility_class *view);

/* The same of the `count` walls from number `first` on in `from`, which may be `found`. */
hr2d_status hr2di_visibility_shrink(hr2di_visibility *sight, const hr2di_shaft *shaft,
                                    const hr2di_wall_list *from, size_t first, size_t count,
                                    hr2di_wall_list *found, hr2di_visibility_class *view);

/* The exchange area past the walls in the way, and whether some light passes. */
hr2d_status hr2di_visibility_area(hr2di_visibility *sight, const hr2di_shaft *shaft,
                                  const uint32_t *wall, size_t count, double *area, int *open);

#endif
