/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Radiosity in a convex room, by a method that shares nothing with the library: Nyström with
   Gauss rules on panels that shrink by halves towards both ends of every patch. */
#ifndef HR2D_TESTS_INDEPENDENT_CONVEX_NYSTROM_H
#define HR2D_TESTS_INDEPENDENT_CONVEX_NYSTROM_H

#include <stddef.h>

typedef struct convex_room {
  size_t patches;
  const double (*patch)[6]; /* ax ay bx by E ρ, counter-clockwise, each begins where the last
                               one ends */
} convex_room;

/* How fine: Gauss points of a panel, and the halvings of the shorter neighbour at a vertex
   before the last panel. */
typedef struct convex_mesh {
  size_t points;
  int levels;
} convex_mesh;

typedef struct convex_solution convex_solution;

/* To be destroyed by the caller. */
convex_solution *convex_solve(const convex_room *room, convex_mesh mesh);
void convex_destroy(convex_solution *solution);

/* Averages over a patch. */
double convex_radiosity(const convex_solution *solution, size_t patch);
double convex_irradiance(const convex_solution *solution, size_t patch);

/* H at a distance from the start of a patch, or from its end if `from_end`; d times as
   far as the last panel is long, it is known to a part of 1e-4/d². */
double convex_irradiance_at(const convex_solution *solution, size_t patch, double distance,
                            int from_end);

#endif
