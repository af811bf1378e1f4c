/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms that are hard to solve, the methods of textbooks for them, and a method that shares
   nothing with the library. */
#ifndef HR2D_TESTS_SUPPORT_HARD_ROOMS_H
#define HR2D_TESTS_SUPPORT_HARD_ROOMS_H

#include <hr2d/hr2d.h>

enum { HARD_WALLS = 300 };

/* Walls as test_scene() takes them: ax ay bx by E ρ. */
typedef struct hard_room {
  const char *name;
  size_t walls;
  double wall[HARD_WALLS][6];
} hard_room;

/* A closed room of corners in counter-clockwise order; wall `lit` has E = 1. */
hard_room hard_polygon(const char *name, const double (*corner)[2], size_t corners, size_t lit,
                       double rho);

hard_room hard_square(double rho);
hard_room hard_l_shape(double rho);
hard_room hard_circle(double rho);        /* 300 walls */
hard_room hard_with_occluder(double rho); /* a square in a square */

hr2d_scene *hard_scene(const hard_room *room);

/* Where form factors come from. */
typedef enum hard_factors {
  HARD_MIDPOINTS, /* G of the centres times length, not normalised */
  HARD_STRINGS    /* ½(|ad| + |bc| − |ac| − |bd|) as it stands */
} hard_factors;

typedef struct hard_sweeps {
  unsigned count; /* sweeps done: `limit` if it never ended */
  double total;   /* ∫B */
  int finite;
} hard_sweeps;

/* Gauss-Seidel on `parts` equal elements per wall of a convex room, until no B changes by more
   than 1e-6 of itself. */
hard_sweeps hard_gauss_seidel(const hard_room *room, hard_factors factors, size_t parts,
                              unsigned limit);

/* Averages of B in a convex closed room: Galerkin with constants on elements as long as
   their distance from other walls, or `parts` times shorter; exchange areas by strings in
   long double, rows scaled to 1, and conjugate gradients. */
void hard_averages(const hard_room *room, size_t parts, double *average);

#endif
