/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result of `hr2d field`, in three forms. */
#ifndef HR2D_TOOLS_FIELD_FIELD_H
#define HR2D_TOOLS_FIELD_FIELD_H

#include "run/run.h"

typedef struct field {
  const options *options;
  const hr2d_scene *scene;
  size_t cuts, bands, count;
  hr2d_field_grid grid; /* 0 columns: points of a file */
  hr2d_point *at;
  hr2d_point *normal; /* of each point; NULL: one for all, or none */
  double *mean, *flux, *sky;
  double *error; /* bounds of those of `mean`; NaN: not measured; of the flux π times that */
  double *irradiance, *irradiance_error; /* NULL without normals */
  unsigned char *place;
  int heat;                 /* some patch has a temperature or a flux: T is written, too */
  hr2d_field_counts counts; /* of a grid with a tolerance */
} field;

/* temperature.c: the mean radiant temperature at a point, σT⁴ = ΣM over the bands. */
double field_temperature(const field *f, size_t point);

/* points.c: reads points "x y", or all of them with normals "x y nx ny", one a line; blank
   lines and lines that start with # are skipped. Returns 0 or the exit status, as the others
   do. */
int field_read_points(field *f, const char *path);

/* csv.c: a row for each point and band: x,y,band,mean,flux_x,flux_y,sky, with heat
   temperature, error, and with normals irradiance and its error; no numbers outside, and no
   error that is not measured. */
int field_write_csv(const field *f, const char *path);

/* factors.c: point,x,y,share,patch,name for each patch that a point sees, and for the sky and
   backs without a patch; the shares of a point sum to 1. */
int field_write_factors(const field *f, const char *path);

/* json.c */
int field_write_json(const field *f, const char *path);

/* pfm.c: a grid as float map, of one band or three; outside the numbers are NaN.  With --pfm
   the box is divided into pixels, and the nodes of the grid are their centres. */
int field_check_pfm(const field *f);
void field_to_pixel_centres(hr2d_field_grid *g);
int field_write_pfm(const field *f, const char *path);

/* vtk.c: a grid as VTK image data; outside the numbers are NaN. */
int field_write_vtk(const field *f, const char *path);

#endif
