/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes that take long: of as many patches as are asked for, each kind slow in another phase.
 */
#ifndef HR2D_TESTS_SUPPORT_SLOW_SCENES_H
#define HR2D_TESTS_SUPPORT_SLOW_SCENES_H

#include <hr2d/hr2d.h>

typedef enum slow_kind {
  SLOW_SQUARES, /* small squares in a square room */
  SLOW_SPOKES,  /* a fan of two-sided walls that point to the middle of a room */
  SLOW_COMB,    /* a floor with teeth, under a lamp */
  SLOW_CITY,    /* a section of houses under the sky */
  SLOW_ROUND,   /* a round room */
  SLOW_SOUP,    /* short two-sided walls anywhere in a room */
  SLOW_MIRRORS, /* short walls between two perpendicular mirrors, under the sky */
  SLOW_PERIODS, /* short walls over a ground, in a period, under the sky */
  SLOW_SLIVERS, /* long plates so near each other that each is a narrow gap, under the sky */
  SLOW_STAR,    /* two-sided walls from one point to a circle, under the sky */
  SLOW_FANS,    /* walls from some points of a floor, in small angles, under the sky */
  SLOW_KINDS
} slow_kind;

const char *slow_name(slow_kind kind);

/* Adds about `count` patches; the scene is not committed.  HR2D_OK, or what the library says.
 */
hr2d_status slow_add(hr2d_scene *scene, slow_kind kind, size_t count);

/* Adds a room with walls of given temperature and of given flux in three bands. */
hr2d_status slow_add_heated(hr2d_scene *scene);

/* Adds `count` segments of which many cross. */
hr2d_status slow_add_crossing(hr2d_scene *scene, size_t count);

/* The scene as text in GeoJSON, which the caller frees; NULL if there is no memory. */
char *slow_text(const hr2d_scene *scene, size_t *size);

#endif
