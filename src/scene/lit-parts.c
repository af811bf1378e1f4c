/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads what sunlight.c has found: parts and borders are sorted by patch. */
#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "scene/sun-beams.h"
#include "scene/sunlight.h"

void hr2di_sunlight_clear(hr2di_sunlight *light, const hr2d_allocator *alloc) {
  hr2di_alloc_free(alloc, light->part);
  hr2di_alloc_free(alloc, light->of_sun);
  hr2di_alloc_free(alloc, light->border);
  hr2di_alloc_free(alloc, light->kink);
  *light = (hr2di_sunlight){0};
}

const hr2di_lit_part *hr2di_sunlight_of(const hr2d_scene *scene, size_t patch, size_t band,
                                        size_t *count) {
  const hr2di_sunlight *l = &scene->sunlight;
  *count = 0;
  if (l->suns == 0) return NULL;
  const size_t sun = band % l->suns, end = l->of_sun[sun + 1];
  size_t low = l->of_sun[sun], high = end;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (l->part[middle].patch < patch)
      low = middle + 1;
    else
      high = middle;
  }
  while (low + *count < end && l->part[low + *count].patch == patch) ++*count;
  return *count > 0 ? l->part + low : NULL;
}

const hr2di_sun_border *hr2di_sunlight_borders(const hr2d_scene *scene, size_t patch,
                                               size_t *count) {
  const hr2di_sunlight *l = &scene->sunlight;
  size_t low = 0, high = l->borders;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (l->border[middle].patch < patch)
      low = middle + 1;
    else
      high = middle;
  }
  for (*count = 0; low + *count < l->borders && l->border[low + *count].patch == patch;)
    ++*count;
  return *count > 0 ? l->border + low : NULL;
}

double hr2di_sunlight_full(const hr2d_scene *scene, size_t patch, size_t band) {
  const hr2d_sun sun = hr2d_scene_sun(scene, band);
  if (!(sun.irradiance > 0)) return 0;
  return sun.irradiance * fmax(hr2di_sun_cosine(sun.direction, scene->patch[patch].scaled), 0);
}

int hr2di_sunlight_at(const hr2d_scene *scene, size_t patch, size_t band, double t) {
  size_t count;
  const hr2di_lit_part *part = hr2di_sunlight_of(scene, patch, band, &count);
  size_t k = 0;
  while (k + 1 < count && t >= part[k].to) k++;
  return k < count && t >= part[k].from && t <= part[k].to;
}
