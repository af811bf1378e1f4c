/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gas of a scene, and which calls do without one. */
#ifndef HR2D_SRC_SCENE_GAS_H
#define HR2D_SRC_SCENE_GAS_H

#include <hr2d/gas.h>

#include "base/message.h"
#include "base/watch.h"

/* κ of all bands, from the least to the most. */
typedef struct hr2di_gas_range {
  double least, most;
} hr2di_gas_range;

/* As it was given, with values in memory of its own. */
typedef struct hr2di_gas {
  size_t absorption_bands, emission_bands;
  hr2d_heat given;
  double value; /* as `given` says */
  hr2d_section section;
  hr2di_gas_range given_range, scaled_range; /* of κ; the latter is set by commit */
  double values[];                           /* κ, then E_g */
} hr2di_gas;

/* The most values that it has of κ or of E_g. */
size_t hr2di_scene_gas_bands(const hr2d_scene *scene);

/* Whether light of some band passes through gas: a scene has one with κ > 0.  Everything asks
   this, and so a scene without gas takes the way that it always took. */
int hr2di_scene_has_gas(const hr2d_scene *scene);

/* κ of all bands per unit of the scaled coordinates; 0 without gas. */
hr2di_gas_range hr2di_scene_scaled_range(const hr2d_scene *scene);

/* Of a scene with gas. */
hr2d_section hr2di_scene_section(const hr2d_scene *scene);

/* Whether light comes from gas: it reaches every patch. */
int hr2di_scene_gas_emits(const hr2d_scene *scene);

/* Whether the heat of the gas is given, and it: in the unit of E times scene lengths. */
int hr2di_scene_gas_is_free(const hr2d_scene *scene);
double hr2di_scene_gas_heat(const hr2d_scene *scene);

/* E_g of a band, also of one in which nothing absorbs; 0 without gas, and if its heat is given.
 */
double hr2di_scene_gas_emission(const hr2d_scene *scene, size_t band);

/* HR2D_EUNSUPPORTED with a message if the scene has gas, through which `what` does not go; else
   HR2D_OK.  `message` may be NULL. */
hr2d_status hr2di_gas_refuses(const hr2d_scene *scene, const char *what,
                              hr2di_message *message);

/* Whether a gas is valid.  The scene owns `gas` on success, from its hooks.  For readers. */
hr2d_status hr2di_scene_make_gas(hr2d_scene *scene, const hr2d_gas *given, hr2di_gas **gas);

/* The part of commit: bands, and what gas does not go with.  Symmetry is known. */
hr2d_status hr2di_scene_check_gas(hr2d_scene *scene, hr2di_watch *watch);

/* Refuses gas where images of a period are seen that are cut off: what they send is
   extrapolated by a law that gas does not follow. */
hr2d_status hr2di_scene_check_far_gas(hr2d_scene *scene);

#endif
