/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes of many walls, of any number of them. */
#ifndef HR2D_BENCH_PLANS_H
#define HR2D_BENCH_PLANS_H

#include <hr2d/hr2d.h>
#include <stdint.h>

/* Segments to make a scene of. */
typedef struct plan {
  hr2d_segment *segment;
  size_t count, capacity;
} plan;

/* Adds about n segments. */
typedef void (*plan_fn)(plan *p, int n);

void plan_squares(plan *p, int n); /* n/8 of them, any way round */
void plan_fibres(plan *p, int n);  /* sections of n/8 of them */
void plan_city(plan *p, int n);    /* n/4 houses between streets that are not quite straight */
void plan_occ(plan *p, int n);     /* half on the room, half on 16 blockers */
void plan_round(plan *p, int n);   /* the same, with no two segments on one line */
void plan_thin(plan *p, int n);    /* squares that are small beside the space between them */
void plan_tiny(plan *p, int n);
void plan_open(plan *p, int n);     /* a round room with nothing in it */
void plan_segments(plan *p, int n); /* of length 0.3/√n, each with one front */

/* A scene that is not committed, of which the first `lamps` patches emit; 0: all. */
hr2d_scene *plan_patches(plan_fn draw, int n, int lamps);

/* A committed scene; with `forced`, occlusion is on in any case. */
hr2d_scene *plan_scene(plan_fn draw, int n, int forced);

/* A number in [least, most) of the generator that plans draw from. */
double plan_random(double min, double max);
void plan_random_start(uint64_t seed);

/* Kinds of scenes whose figures have bars. */
typedef struct plan_family {
  const char *name;
  plan_fn draw;
  int size;      /* at which crossed strings are the measure */
  double ratio;  /* times their seconds allowed there */
  double growth; /* exponent allowed from 5120 to 102,400; 0: not measured */
} plan_family;

enum { PLAN_FAMILIES = 5 };
extern const plan_family plan_families[PLAN_FAMILIES];

#endif
