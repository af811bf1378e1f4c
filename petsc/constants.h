/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Effects that one constant per element, shared out with its field, does not support. */
#ifndef HR2D_PETSC_CONSTANTS_H
#define HR2D_PETSC_CONSTANTS_H

#include <hr2d/hr2d.h>

/* Whether patches of given flux divide what they emit among bands by their temperatures. */
static inline int hr2dpi_has_spectra(const hr2d_scene *scene) {
  size_t k = 0;
  while (k < hr2d_scene_patches(scene) && hr2d_scene_heat(scene, k, NULL) != HR2D_HEAT_FLUX)
    k++;
  return k < hr2d_scene_patches(scene) && hr2d_scene_bands(scene) > 1;
}

/* Whether light from outside depends on its direction. */
static inline int hr2dpi_has_daylight(const hr2d_scene *scene) {
  size_t band = 0;
  while (band < hr2d_scene_bands(scene) && !(hr2d_scene_sun(scene, band).irradiance > 0))
    band++;
  return band < hr2d_scene_bands(scene) || hr2d_scene_sky_pieces(scene) > 0;
}

#endif
