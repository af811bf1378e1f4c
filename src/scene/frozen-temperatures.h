/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene of several bands in which patches of given flux have temperatures.

   In one band B = H + q is an equation of its own.  In several bands only the sum over them is
   given, Σ(B_b − H_b) = q, and the temperature of the patch divides its emission among them:
   B_b = (1−ρ_b) f_b(T)σT⁴ + ρ_b H_b.  A scene of frozen temperatures is the scene with such E
   and ρ for one guess of all T: a scene with other light, see relit-scene.h. */
#ifndef HR2D_SRC_SCENE_FROZEN_TEMPERATURES_H
#define HR2D_SRC_SCENE_FROZEN_TEMPERATURES_H

#include "scene/relit-scene.h"

/* What is known of the temperature of a patch of given flux. */
typedef struct hr2di_found {
  double radiance;        /* σT⁴; below 0 where the patch cannot lose so much */
  double estimate, bound; /* the errors of it; NaN: not known */
} hr2di_found;

/* Whether a committed scene has patches of given flux, or shields, in several bands, without
   temperatures. */
int hr2di_scene_is_unsettled(const hr2d_scene *scene);

/* The scene that a scene of frozen temperatures is of; others are their own. */
const hr2d_scene *hr2di_scene_origin(const hr2d_scene *scene);

/* Makes a scene of frozen temperatures, which hr2di_relit_destroy() frees; its patches of given
   flux have no E and ρ yet.  HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_frozen_create(const hr2d_scene *scene, hr2d_scene **frozen);

/* Gives a patch of given flux its σT⁴, and ε, E and ρ that follow.  HR2D_ECALLBACK if the
   function of its emissivity gives none. */
hr2d_status hr2di_frozen_set(hr2d_scene *frozen, size_t patch, double radiance);

/* ∂E_b/∂(σT⁴) with this ε, which is not negative: Planck's spectrum rises with T everywhere. */
double hr2di_frozen_rise(const hr2d_scene *frozen, size_t patch, size_t band);

#endif
