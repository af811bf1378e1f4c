/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The values of bands: of a patch, its emission, reflectance and transmittance, and of the
   background. */
#ifndef HR2D_SRC_SCENE_PATCH_LIGHT_H
#define HR2D_SRC_SCENE_PATCH_LIGHT_H

#include "scene/scene-impl.h"

/* What a light takes before its values, in doubles. */
enum { HR2DI_LIGHT_HEAD = (sizeof(hr2di_light) + sizeof(double) - 1) / sizeof(double) };

/* Makes a light with one user, for a patch and its thermal properties, or NULL, which are
   valid. NULL if there is no memory. */
hr2di_light *hr2di_light_make(const hr2d_allocator *alloc, const hr2d_patch *patch,
                              const hr2d_thermal *thermal);

/* Lets a light of given power, which is of a flux, know a patch that has it: q is the power per
   length of all of these.  Nothing happens to other lights. */
void hr2di_light_add_length(hr2di_light *light, hr2d_segment patch);

/* Ends one use of a light; the last frees it.  NULL is allowed. */
void hr2di_light_release(const hr2d_allocator *alloc, hr2di_light *light);

/* The value of a band: a single value holds for every band, no value means 0. */
static inline double hr2di_band_value(const double *value, size_t bands, size_t band) {
  if (bands < 2) return bands ? *value : 0;
  return band < bands ? value[band] : NAN;
}

#endif
