/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A solved scene, and the same patches for the sweep. */
#ifndef HR2D_TESTS_SUPPORT_FIELD_STAGE_H
#define HR2D_TESTS_SUPPORT_FIELD_STAGE_H

#include "independent/open-sweep.h"
#include "support/links.h"

typedef struct field_stage {
  test_links t;
  hr2d_solution *solution;
  sweep_patches all;
  double (*at)[4];
  sweep_span *span;
} field_stage;

/* Of a committed scene, which it takes over: one element for each patch, order 1; the first is
   for scenes in which nothing reflects, the second refines to ε at an order. */
field_stage field_stage_flat(hr2d_scene *scene);
field_stage field_stage_of(hr2d_scene *scene, double epsilon, unsigned order);
void field_stage_clear(field_stage *s);

/* The field at one point; what is wanted of it. */
typedef struct field_sample {
  double mean, flux[2], sky, back;
  unsigned char place;
} field_sample;

/* Of the first band, by the library. */
field_sample field_sample_at(const hr2d_solution *solution, double x, double y);

/* The same by the sweep, with one value of B for each patch. */
field_sample field_sample_sweep(const field_stage *s, double x, double y);

/* How much two samples differ, in units of `max`; infinite if one of them is not a number. */
double field_sample_distance(const field_sample *one, const field_sample *other, double max);

#endif
