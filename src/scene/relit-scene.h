/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene with other light: E and ρ of its patches and the light from outside are its own, and
   can be changed although it is committed.  It shares everything else with a committed scene,
   its lender, which must outlive it.  Images have the light of their patches.

   It may have a multiple of the lender's bands: several lights in one, one after the other.
   What is not changed repeats.  Or it has some of these bands. */
#ifndef HR2D_SRC_SCENE_RELIT_SCENE_H
#define HR2D_SRC_SCENE_RELIT_SCENE_H

#include "scene/scene-impl.h"

/* Makes one with the light of `scene`, which may be one itself, `times` times as many bands as
   its lender's.  No patch counts as dark, and light is always reflected: so elements and links
   do for any light.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_relit_create(const hr2d_scene *scene, size_t times, hr2d_scene **relit);

/* Makes one with some bands of a committed scene: band b is band_of[b] of it.  Patches have no
   temperatures; what is dark is so, and effects are those of the scene.  HR2D_OK or
   HR2D_ENOMEM. */
hr2d_status hr2di_relit_create_bands(const hr2d_scene *scene, const size_t *band_of,
                                     size_t bands, hr2d_scene **relit);

/* The band of the lender that a band is. */
static inline size_t hr2di_relit_band(const hr2d_scene *relit, size_t band) {
  return relit->band_of ? relit->band_of[band] : band % relit->lender->bands;
}

/* For messages: the number that the caller of the library knows a band by. */
static inline size_t hr2di_scene_known_band(const hr2d_scene *scene, size_t band) {
  return scene->lender ? hr2di_relit_band(scene, band) : band;
}

/* Takes the light of a scene of as many bands, or of a part of them, which repeat.  HR2D_OK or
   the status of the watch, which may be NULL. */
hr2d_status hr2di_relit_renew(hr2d_scene *relit, const hr2d_scene *scene, hr2di_watch *watch);

/* Also for scenes of frozen temperatures; NULL is allowed. */
void hr2di_relit_destroy(hr2d_scene *relit);

/* The values of a patch, bands each; those of an image are its patch's. */
double *hr2di_relit_emission(hr2d_scene *relit, size_t patch);
double *hr2di_relit_reflectance(hr2d_scene *relit, size_t patch);

#endif
