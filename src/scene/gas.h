/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The gases of a scene, and which calls do without one. */
#ifndef HR2D_SRC_SCENE_GAS_H
#define HR2D_SRC_SCENE_GAS_H

#include <hr2d/gas.h>
#include <stdint.h>

#include "base/message.h"
#include "base/watch.h"

#define HR2DI_NO_GAS SIZE_MAX

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
  size_t border_points;                      /* 0: it is where no other gas is */
  double values[];                           /* κ, then E_g, then x and y of its border */
} hr2di_gas;

typedef struct hr2di_gases {
  hr2di_gas **gas;
  size_t count, capacity;
} hr2di_gases;

/* Point k of a border, as it was given. */
static inline hr2d_point hr2di_gas_border(const hr2di_gas *gas, size_t k) {
  const double *at = gas->values + gas->absorption_bands + gas->emission_bands + 2 * k;
  return (hr2d_point){at[0], at[1]};
}

/* The most values that a gas has of κ or of E_g. */
size_t hr2di_scene_gas_bands(const hr2d_scene *scene);

/* Whether light of some band passes through gas: a scene has one with κ > 0.  Everything asks
   this, and so a scene without gas takes the way that it always took. */
int hr2di_scene_has_gas(const hr2d_scene *scene);

/* κ of all bands and gases as it was given. */
hr2di_gas_range hr2di_scene_given_range(const hr2d_scene *scene);

/* κ of all bands and gases per unit of the scaled coordinates; 0 without gas. */
hr2di_gas_range hr2di_scene_scaled_range(const hr2d_scene *scene);

/* κ of a gas, likewise, in a scene in whose bands it is the same; 0 of HR2DI_NO_GAS. */
double hr2di_scene_scaled_absorption(const hr2d_scene *scene, size_t gas);

/* Whether all gases absorb in one band as in another. */
int hr2di_scene_absorbs_alike(const hr2d_scene *scene, size_t band, size_t other);

/* The gas that fills what is in no border, or HR2DI_NO_GAS. */
size_t hr2di_scene_gas_around(const hr2d_scene *scene);

/* Of a scene with gas. */
hr2d_section hr2di_scene_section(const hr2d_scene *scene);

/* Whether light comes from gas: it reaches every patch. */
int hr2di_scene_gas_emits(const hr2d_scene *scene);

/* Whether the heat of a gas is given, and it: in the unit of E times scene lengths. */
int hr2di_scene_gas_is_free(const hr2d_scene *scene, size_t gas);
double hr2di_scene_gas_heat(const hr2d_scene *scene, size_t gas);

/* Whether that is so for some gas. */
int hr2di_scene_has_free_gas(const hr2d_scene *scene);

/* E_g of a gas in a band, also of one in which nothing absorbs; 0 without gas, and if its heat
   is given. */
double hr2di_scene_gas_emission(const hr2d_scene *scene, size_t gas, size_t band);

/* HR2D_EUNSUPPORTED with a message if the scene has gas, through which `what` does not go; else
   HR2D_OK.  `message` may be NULL. */
hr2d_status hr2di_gas_refuses(const hr2d_scene *scene, const char *what,
                              hr2di_message *message);

/* Makes a gas from the hooks of a scene, which does not have it yet, if it is valid.  For
   readers. */
hr2d_status hr2di_scene_make_gas(hr2d_scene *scene, const hr2d_gas *given, hr2di_gas **gas);

/* Gives a gas to those of a scene, or of its reader, which own it from now on; fails with the
   message of the scene if it does not go with them. */
hr2d_status hr2di_gases_take(hr2di_gases *gases, hr2d_scene *scene, hr2di_gas *gas);
void hr2di_gases_clear(hr2di_gases *gases, const hr2d_allocator *alloc);

/* The part of commit: bands, and what gas does not go with.  Symmetry is known. */
hr2d_status hr2di_scene_check_gas(hr2d_scene *scene, hr2di_watch *watch);

/* Refuses gas where images of a period are seen that are cut off: what they send is
   extrapolated by a law that gas does not follow. */
hr2d_status hr2di_scene_check_far_gas(hr2d_scene *scene);

#endif
