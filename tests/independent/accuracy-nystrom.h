/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radiosity of two patches that face each other, by a method that shares nothing with the
   library: Nyström with composite Gauss-Legendre rules, G written out for the configuration. */
#ifndef HR2D_TESTS_INDEPENDENT_ACCURACY_NYSTROM_H
#define HR2D_TESTS_INDEPENDENT_ACCURACY_NYSTROM_H

#include <hr2d/hr2d.h>

typedef struct nystrom {
  double patch[2][6];           /* ax ay bx by E ρ, as test_scene() takes them */
  double average[2];            /* of B */
  double place[3], value[2][3]; /* B at some fractions of the patches */
} nystrom;

/* A floor from (0,0) to (1,0) with E = 1, and a wall of a length that ends on (0,0) at an angle
   in degrees, with E = 0. */
nystrom nystrom_corner(double angle, double length, double rho);

/* A floor as above, and a ceiling with E = 0 at a height, from x = `to` back to x = `from`. */
nystrom nystrom_parallel(double height, double from, double to, double rho);

#endif
