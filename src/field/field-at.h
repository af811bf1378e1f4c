/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One call for the field of a solution. */
#ifndef HR2D_SRC_FIELD_FIELD_AT_H
#define HR2D_SRC_FIELD_FIELD_AT_H

#include "field/field-impl.h"
#include "field/look.h"

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

/* A call for so many points.  HR2D_OK, or the status with which it ends; then, too, it is to be
   closed. */
hr2d_status hr2di_field_open(hr2di_field_call *f, const hr2d_solution *solution, size_t count,
                             const hr2d_field_options *options,
                             const hr2d_field_values *values);
void hr2di_field_close(hr2di_field_call *f);

/* irradiance.c: writes the irradiance of a plane through point k, at x, if that is wanted, with
   one view of its own or two.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_field_irradiance(hr2di_field_worker *w, const hr2di_field_call *f,
                                   hr2d_point x, hr2d_place place, size_t k);

/* Writes it as point k of what is wanted. */
void hr2di_field_keep(const hr2d_field_values *v, size_t k, size_t bands,
                      const hr2di_field_look_at *seen);

#endif
