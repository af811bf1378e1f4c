/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the light in all bands to what a picture shows of it. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>

/* So few that a file is small, and that steps are not seen. */
#define LEVELS 192

/* The constant of Stefan and Boltzmann, W/(m² K⁴). */
#define SIGMA 5.670374419e-8

void shade_choose(picture *p) {
  const options *o = p->run->options;
  const int three = hr2d_scene_bands(p->run->scene) == 3;
  p->quantity = o->quantity;
  p->levels = LEVELS;
  p->filled = !o->no_fill && !o->links_of.patch && !o->beams_of.count;
  p->coloured = p->quantity == QUANTITY_MEAN || p->quantity == QUANTITY_TEMPERATURE;
  p->rgb = o->band == BAND_RGB ||
           (o->band == BAND_DEFAULT && three && p->quantity == QUANTITY_MEAN && !o->log_scale &&
            !o->linear_scale);
}

/* The power of all bands makes the temperature; otherwise their mean is shown. */
shade shade_of(const picture *p, shade_value get, const void *ctx, size_t item) {
  const int band = p->run->options->band;
  const size_t bands = hr2d_scene_bands(p->run->scene);
  double sum = 0;
  if (p->rgb) return (shade){{get(ctx, item, 0), get(ctx, item, 1), get(ctx, item, 2)}};
  for (size_t b = 0; b < bands && band < 0; b++) sum += get(ctx, item, b);
  if (band >= 0) sum = get(ctx, item, (size_t)band);
  if (p->quantity == QUANTITY_TEMPERATURE) return (shade){{pow(sum / SIGMA, 0.25), 0, 0}};
  return (shade){{band < 0 ? sum / (double)bands : sum, 0, 0}};
}

static double of_element(const void *ctx, size_t item, size_t band) {
  return hr2d_solution_element(ctx, (uint32_t)item, band);
}

shade shade_of_element(const picture *p, uint32_t element) {
  return shade_of(p, of_element, p->run->solution, element);
}

typedef struct spot {
  const hr2d_solution *solution;
  double t;
} spot;

static double of_point(const void *ctx, size_t item, size_t band) {
  const spot *at = ctx;
  return hr2d_solution_at(at->solution, item, at->t, band);
}

shade shade_of_point(const picture *p, size_t patch, double t) {
  const spot at = {p->run->solution, t};
  return shade_of(p, of_point, &at, patch);
}

double shade_number(const picture *p, shade s) {
  return p->rgb ? (s.v[0] + s.v[1] + s.v[2]) / 3 : s.v[0];
}
#endif
