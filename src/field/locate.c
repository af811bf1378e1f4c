/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A walk towards a point: from each triangle through a side that has the point behind it.

   In a triangulation that is not Delaunay's such a walk can go round in circles.  The side that
   is asked first is drawn at random (Devillers, Pion and Teillaud, "Walking in a
   triangulation", 2002), from numbers that are the same at each call. */
#include "field/locate.h"

#include "geometry/orient-sign.h"

/* What is behind side k of a triangle, also through a wall; HR2DI_SKY at the border. */
static int32_t behind(const hr2di_triangulation *t, int32_t at, int k) {
  const int32_t across = t->triangle[at].across[k];
  if (across >= 0 || across == HR2DI_SKY) return across;
  const hr2di_wall_edge *edge = &t->edge[(uint32_t)~across >> 1];
  return edge->half_edge[1 - (~across & 1)];
}

/* The side that x is behind, from side `first` on; 3 if there is none. */
static int side_before(const hr2di_triangulation *t, int32_t at, hr2d_point x, int first) {
  const uint32_t *corner = t->triangle[at].corner;
  for (int n = 0; n < 3; n++) {
    const int k = (first + n) % 3;
    if (hr2di_orient_sign(t->at[corner[k]], t->at[corner[(k + 1) % 3]], x) < 0) return k;
  }
  return 3;
}

int32_t hr2di_locate(const hr2di_triangulation *t, hr2d_point x, int32_t *near,
                     int32_t *border) {
  int32_t at = *near;
  uint32_t random = 1;
  for (;;) {
    random = random * 1664525u + 1013904223u;
    const int k = side_before(t, at, x, (int)((random >> 16) % 3));
    *near = at;
    if (k == 3) return at;
    const int32_t next = behind(t, at, k);
    if (next == HR2DI_SKY) {
      *border = 4 * at + k;
      return HR2DI_BEYOND;
    }
    at = next >> 2;
  }
}
