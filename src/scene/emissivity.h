/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Emissivities that depend on the temperature of a patch of given flux.  On others ε is that of
   the temperature that is given. */
#ifndef HR2D_SRC_SCENE_EMISSIVITY_H
#define HR2D_SRC_SCENE_EMISSIVITY_H

#include <hr2d/thermal.h>

int hr2di_emissivity_depends(const hr2d_scene *scene, size_t patch);

/* Of a description of thermal properties, which may have a table or a function. */
double hr2di_emissivity_of(const hr2d_thermal *thermal, size_t band, double kelvin);

/* T dε/dT, by a difference. */
double hr2di_emissivity_slope(const hr2d_scene *scene, size_t patch, size_t band,
                              double kelvin);

/* σT⁴ of a patch of given flux that receives H in the only band.  Below 0: it cannot lose so
   much.  NaN: a function said no emissivity. */
double hr2di_emissivity_radiance(const hr2d_scene *scene, size_t patch, double irradiance);

/* σT⁴ of a shield that receives H on one side, and on the other, in the only band. */
double hr2di_shield_radiance(const hr2d_scene *scene, size_t patch, double irradiance,
                             double other);

#endif
