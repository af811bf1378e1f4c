/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef HR2D_PETSC_SPECTRA_H
#define HR2D_PETSC_SPECTRA_H

#include <hr2d/hr2d.h>

/* Whether patches of given flux divide what they emit among bands by their temperatures. */
static inline int hr2dpi_has_spectra(const hr2d_scene *scene) {
  size_t k = 0;
  while (k < hr2d_scene_patches(scene) && hr2d_scene_heat(scene, k, NULL) != HR2D_HEAT_FLUX)
    k++;
  return k < hr2d_scene_patches(scene) && hr2d_scene_bands(scene) > 1;
}

#endif
