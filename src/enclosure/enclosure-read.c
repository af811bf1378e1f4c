/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an enclosure says: ends of averages, and the error of a solution. */
#include <math.h>

#include "base/alloc.h"
#include "enclosure/enclosure-impl.h"
#include "links/linkset-impl.h"
#include "scene/frozen-temperatures.h"

void hr2d_enclosure_destroy(hr2d_enclosure *enclosure) {
  if (!enclosure) return;
  const hr2d_allocator alloc = enclosure->alloc;
  hr2di_alloc_free(&alloc, enclosure->b);
  hr2di_alloc_free(&alloc, enclosure->h);
  hr2di_alloc_free(&alloc, enclosure);
}

static hr2di_range read(const hr2d_enclosure *e, const hr2di_range *from, size_t patch,
                        size_t band) {
  if (!from || patch >= e->patches || band >= e->bands) return (hr2di_range){NAN, NAN};
  return from[patch * e->bands + band];
}

double hr2d_enclosure_lower(const hr2d_enclosure *e, size_t patch, size_t band) {
  return read(e, e ? e->b : NULL, patch, band).lower;
}

double hr2d_enclosure_upper(const hr2d_enclosure *e, size_t patch, size_t band) {
  return read(e, e ? e->b : NULL, patch, band).upper;
}

double hr2d_enclosure_lower_irradiance(const hr2d_enclosure *e, size_t patch, size_t band) {
  return read(e, e ? e->h : NULL, patch, band).lower;
}

double hr2d_enclosure_upper_irradiance(const hr2d_enclosure *e, size_t patch, size_t band) {
  return read(e, e ? e->h : NULL, patch, band).upper;
}

typedef double read_mean(const hr2d_solution *solution, size_t patch, size_t band);

/* The largest relative distance of means from the farther ends. */
static double error_of(const hr2d_enclosure *e, const hr2di_range *range,
                       const hr2d_solution *solution, read_mean *mean, double floor) {
  double error = 0;
  for (size_t b = 0; b < e->bands; b++) {
    double upper = 0;
    for (size_t k = 0; k < e->patches; k++) upper = fmax(upper, range[k * e->bands + b].lower);
    for (size_t k = 0; k < e->patches; k++) {
      const hr2di_range r = range[k * e->bands + b];
      const double m = mean(solution, k, b), off = fmax(m - r.lower, r.upper - m);
      if (off > 0) error = fmax(error, off / fmax(r.lower, floor * upper));
    }
  }
  return error;
}

hr2d_status hr2d_enclosure_error(const hr2d_enclosure *e, const hr2d_solution *solution,
                                 double floor, double *average, double *irradiance) {
  if (!e || !solution || !(floor >= 0 && floor <= 1)) return HR2D_EINVAL;
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(hr2d_solution_links(solution));
  if (hr2di_scene_origin(h->scene) != e->scene) return HR2D_EINVAL;
  if (!(floor > 0)) floor = HR2D_FLOOR;
  if (average) *average = error_of(e, e->b, solution, hr2d_solution_average, floor);
  if (irradiance) *irradiance = error_of(e, e->h, solution, hr2d_solution_irradiance, floor);
  return HR2D_OK;
}
