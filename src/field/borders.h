/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Borders of light: where the gradient of M jumps. */
#ifndef HR2D_SRC_FIELD_BORDERS_H
#define HR2D_SRC_FIELD_BORDERS_H

#include "field/light.h"

/* A ray from a vertex v, away from an end w of something that is seen past v: on one side of
   the ray w is in sight, on the other side it is not. */
typedef struct hr2di_border {
  hr2d_point from, along; /* v, and a unit vector; scaled, as all lengths here */
  double reach;           /* how long the ray is; may be infinite */
  double behind;          /* how far w is from v */
  double jump;            /* of B at w, as a part of what is allowed; HUGE_VAL: of a wall */
  int lit;                /* there is a front, or a sky with light, on one side of w alone */
} hr2di_border;

typedef struct hr2di_borders {
  hr2d_allocator alloc;
  hr2di_border *border;
  size_t count, room;
  size_t max; /* of them, */
  int many;   /* and whether there are more: then this is not all */
} hr2di_borders;

/* What a jump is measured by. */
typedef struct hr2di_border_scale {
  const double *band; /* per band: what is allowed of M */
  double share;       /* what is allowed of the shares; HUGE_VAL: they are not wanted */
} hr2di_border_scale;

/* How many points there are that may be the w of a border. */
size_t hr2di_borders_sources(const hr2di_light_source *of);

/* All borders, and all walls, but at most so many.  HR2D_OK, HR2D_ENOMEM or the status of the
   watch; to be ended by hr2di_borders_clear() in any case. */
hr2d_status hr2di_borders_find(hr2di_borders *b, const hr2di_light_source *of,
                               const hr2di_border_scale *scale, size_t max, hr2di_watch *watch);
void hr2di_borders_clear(hr2di_borders *b);

#endif
