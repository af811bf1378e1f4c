/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms with a screen in several surroundings, whose light is drawn at random, and operators of
   them. */
#ifndef HR2D_TESTS_SUPPORT_RELIT_ROOMS_H
#define HR2D_TESTS_SUPPORT_RELIT_ROOMS_H

#include <hr2d/hr2d.h>

#include "support/random.h"

/* Open, periodic and sunny rooms have no ceiling, mirrored ones no left wall. */
typedef enum relit_kind {
  RELIT_CLOSED,
  RELIT_OPEN,
  RELIT_MIRRORED,
  RELIT_PERIODIC,
  RELIT_SUNNY,
  RELIT_KINDS
} relit_kind;

/* The most walls; a closed room has all. */
enum { RELIT_WALLS = 6 };

/* Emission and reflectance of each wall in each of up to two bands. */
typedef struct relit_paint {
  double emission[RELIT_WALLS * 2], reflectance[RELIT_WALLS * 2], background[2];
} relit_paint;

void relit_draw(relit_paint *p, randoms *r);
int relit_walls(relit_kind kind);

/* Whether a room has a background, whose radiosity the paint has. */
int relit_has_sky(relit_kind kind);

/* The ends of a wall, ax ay bx by; the last two are the sides of the screen. */
extern const double relit_wall[RELIT_WALLS][4];

/* A committed scene. */
hr2d_scene *relit_scene(relit_kind kind, const relit_paint *p, size_t bands);

/* An operator for a target error, whether its scene reaches that or not. */
hr2d_operator *relit_operator(const hr2d_scene *scene, double error);

/* The paint as light, which it must outlive. */
hr2d_light relit_light(relit_kind kind, const relit_paint *p);

/* A solution, whether it reaches the target or not; `account` may be NULL. */
hr2d_solution *relit_solve(hr2d_operator *op, const hr2d_light *light, hr2d_account *account);

/* The largest differences of averages of B and H, as parts of averages that are no less than
   the floor. */
double relit_distance(const hr2d_solution *s, const hr2d_solution *is, int walls, size_t bands);

#endif
