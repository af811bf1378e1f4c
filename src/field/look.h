/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One look from a point, all round or above a plane. */
#ifndef HR2D_SRC_FIELD_LOOK_H
#define HR2D_SRC_FIELD_LOOK_H

#include "field/field-impl.h"
#include "field/light.h"

/* The field at a point, in the room of a worker. */
typedef struct hr2di_field_look_at {
  const double *mean, *flux, *error;
  double sky, back, cut_off;
  double clearance; /* scaled */
  hr2d_place place;
} hr2di_field_look_at;

/* What a plane through a point gets from above, in the room of a worker. */
typedef struct hr2di_field_above {
  const double *flux;  /* per band, x and y: ∫ (B/2) ω dω */
  const double *error; /* per band: a bound of its error; 0 where that is not known */
} hr2di_field_above;

/* Doubles that a look needs for each band, and with those that hr2di_field_irradiance() keeps
   of its first one. */
enum { HR2DI_FIELD_LOOK = 22, HR2DI_FIELD_ROOM = HR2DI_FIELD_LOOK + 3 };

/* Looks from x, in scaled coordinates.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_field_look(hr2di_field_worker *w, const hr2di_light_source *of, hr2d_point x,
                             hr2di_field_look_at *seen);

/* Looks from x at what is above the plane through it with a normal.  Likewise. */
hr2d_status hr2di_field_look_above(hr2di_field_worker *w, const hr2di_light_source *of,
                                   hr2d_point x, hr2d_point normal, hr2di_field_above *seen);

#endif
