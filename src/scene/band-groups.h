/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Groups of bands.  Gas that absorbs more in one band than in another has blocks of its own for
   each absorption, and so such bands have nothing in common but patches, elements and links: a
   scene of its own for each group, with the bands of one κ, see relit-scene.h.  Where all bands
   absorb alike there are no groups, and nothing is made.

   Heat that couples bands is refused in gas. */
#ifndef HR2D_SRC_SCENE_BAND_GROUPS_H
#define HR2D_SRC_SCENE_BAND_GROUPS_H

#include "scene/gas.h"
#include "scene/scene-impl.h"

/* As many absorptions as a scene may have. */
enum { HR2DI_BAND_GROUPS = 256 };

/* The last part of commit.  HR2D_OK, HR2D_EUNSUPPORTED with a message, HR2D_ENOMEM or the
   status of the watch. */
hr2d_status hr2di_band_groups_make(hr2d_scene *scene, hr2di_watch *watch);
void hr2di_band_groups_clear(hr2d_scene *scene);

/* 1 where there are none. */
static inline size_t hr2di_band_groups(const hr2d_scene *scene) {
  return scene->groups ? scene->groups : 1;
}

/* The bands of a group, and a scene in whose bands κ of a gas is the same. */
static inline size_t hr2di_band_group_size(const hr2d_scene *scene, size_t group) {
  return scene->groups ? scene->group[group]->bands : scene->bands;
}
static inline size_t hr2di_band_group_at(const hr2d_scene *scene, size_t group, size_t k) {
  return scene->groups ? scene->group[group]->band_of[k] : k;
}
static inline const hr2d_scene *hr2di_band_group_scene(const hr2d_scene *scene, size_t group) {
  return scene->groups ? scene->group[group] : scene;
}
static inline hr2di_gas_range hr2di_band_group_range(const hr2d_scene *scene, size_t group) {
  return hr2di_scene_scaled_range(hr2di_band_group_scene(scene, group));
}

#endif
