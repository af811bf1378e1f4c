/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which parts of which patches each sun of a scene lights, and which see the edges of the
   pieces of its sky. */
#ifndef HR2D_SRC_SCENE_SUNLIGHT_H
#define HR2D_SRC_SCENE_SUNLIGHT_H

#include <hr2d/daylight.h>

#include "base/watch.h"

/* A part of a patch that is lit, fractions of the patch, from < to. */
typedef struct hr2di_lit_part {
  uint32_t patch;
  double from, to;
} hr2di_lit_part;

/* A border of the light inside a patch: H_sun jumps there. */
typedef struct hr2di_sun_border {
  uint32_t patch;
  double at; /* a fraction of the patch, inside (0,1) */
  hr2d_point point;
} hr2di_sun_border;

/* By sun, then by patch, then along the patch.  Between two parts of one patch is a shadow. */
typedef struct hr2di_sunlight {
  hr2di_lit_part *part;
  size_t parts, capacity;
  size_t *of_sun; /* the parts of sun k are [of_sun[k], of_sun[k + 1]); NULL without suns */
  size_t suns;    /* 1 if all bands have the same */
  hr2di_sun_border *border; /* of all suns, by patch and along it; none where there are too
                               many for elements to end at all */
  size_t borders, border_room;
  hr2di_sun_border *kink; /* where an edge of a piece of the sky comes into sight: there H of
                             the sky has a kink; of too many those of the largest jumps */
  size_t kinks, kink_room;
} hr2di_sunlight;

/* Finds the lit parts of a scene with a plane and suns.  HR2D_OK, HR2D_ENOMEM or the status of
   the watch; to be ended by hr2di_sunlight_clear() in any case. */
hr2d_status hr2di_sunlight_init(hr2di_sunlight *light, const hr2d_scene *scene,
                                hr2di_watch *watch);
void hr2di_sunlight_clear(hr2di_sunlight *light, const hr2d_allocator *alloc);

/* The lit parts of a patch in a band, in their order; *count may be 0. */
const hr2di_lit_part *hr2di_sunlight_of(const hr2d_scene *scene, size_t patch, size_t band,
                                        size_t *count);

/* The borders inside a patch; *count may be 0. */
const hr2di_sun_border *hr2di_sunlight_borders(const hr2d_scene *scene, size_t patch,
                                               size_t *count);

/* What the sun of a band makes where it lights a patch: irradiance·cos θ. */
double hr2di_sunlight_full(const hr2d_scene *scene, size_t patch, size_t band);

/* Whether the light of a band's sun falls on fraction t of a patch. */
int hr2di_sunlight_at(const hr2d_scene *scene, size_t patch, size_t band, double t);

#endif
