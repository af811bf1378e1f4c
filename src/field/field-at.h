/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One call for the field of a solution, and one look from a point. */
#ifndef HR2D_SRC_FIELD_FIELD_AT_H
#define HR2D_SRC_FIELD_FIELD_AT_H

#include "field/field-impl.h"
#include "field/light.h"

/* Copies of what the caller gave, and what all points need. */
typedef struct hr2di_field_call {
  hr2d_field_options options;
  hr2d_field_values values;
  hr2di_watch watch;
  hr2di_with_plane scene;
  hr2di_light_source source;
  hr2di_field_team team; /* without the task */
  int opened;
} hr2di_field_call;

/* HR2D_OK, or the status with which the call ends; then, too, it is to be closed. */
hr2d_status hr2di_field_open(hr2di_field_call *f, const hr2d_solution *solution,
                             const hr2d_field_options *options,
                             const hr2d_field_values *values);
void hr2di_field_close(hr2di_field_call *f);

/* The field at a point, in the room of a worker. */
typedef struct hr2di_field_look_at {
  const double *mean, *flux, *error;
  double sky, back, cut_off;
  double clearance; /* scaled */
  hr2d_place place;
} hr2di_field_look_at;

/* Doubles that a look needs for each band. */
enum { HR2DI_FIELD_ROOM = 22 };

/* Looks from x, in scaled coordinates.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_field_look(hr2di_field_worker *w, const hr2di_light_source *of, hr2d_point x,
                             hr2di_field_look_at *seen);

/* Writes it as point k of what is wanted. */
void hr2di_field_keep(const hr2d_field_values *v, size_t k, size_t bands,
                      const hr2di_field_look_at *seen);

#endif
