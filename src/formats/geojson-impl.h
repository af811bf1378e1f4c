/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the parts of the GeoJSON reader: file, feature, geometry, values. */
#ifndef HR2D_SRC_FORMATS_GEOJSON_IMPL_H
#define HR2D_SRC_FORMATS_GEOJSON_IMPL_H

#include <hr2d/daylight.h>
#include <hr2d/memory.h>
#include <hr2d/scene.h>
#include <hr2d/thermal.h>
#include <jansson.h>
#include <stddef.h>

#include "base/message.h"
#include "base/watch.h"
#include "scene/gas.h"
#include "scene/reading-notes.h"
#include "scene/sky.h"
#include "scene/spectrum.h"
#include "scene/symmetry.h"

/* Bytes of a name that several segments share.  Each segment gets a copy: without this limit a
   file could take memory for the product of the length of a name and the number of segments. */
enum { HR2DI_MOST_NAME = 255 };

enum { HR2DI_LABEL_SIZE = 128, HR2DI_PLACE_SIZE = HR2DI_LABEL_SIZE + 64 };

/* An array that grows and is used again for every feature. */
typedef struct hr2di_values {
  double *value;
  size_t capacity;
} hr2di_values;

typedef struct hr2di_geojson {
  hr2d_scene *scene;
  const hr2d_allocator *alloc;
  hr2di_message *message;
  hr2di_watch *watch;
  hr2di_notes notes; /* those of the scene, and on this file */

  /* The current feature. */
  char label[HR2DI_LABEL_SIZE]; /* feature 3 ("north wall") */
  size_t number;                /* 3, if there are several */
  hr2d_patch patch;             /* the members that its segments have in common */
  hr2d_thermal thermal;         /* theirs, too, unless none is given */
  int has_back;                 /* the other side has properties of its own: */
  hr2d_patch back;
  hr2d_thermal back_thermal;
  size_t first;   /* the patch of its first segment, behind which that of the back comes */
  int is_mirror;  /* it is no patch, */
  hr2d_gas fills; /* nor is it if it is a gas: its polygon is a border */
  int is_gas;
  int faces_out; /* fronts of its polygons look out */
  size_t segments, added;

  /* The wavelengths that the scene had, if this file has others. */
  hr2di_spectrum former;
  int replaced;

  /* What the scene gets once nothing else can fail; NULL without a sun. */
  hr2d_sun *sun;
  size_t suns;
  hr2di_sky sky;     /* the same; without pieces there is none */
  hr2di_gases gases; /* the same */
  hr2d_segment mirror[HR2DI_MIRRORS];
  size_t mirrors;
  hr2d_point period;
  int periodic; /* a period is given */

  /* Buffers that are kept from feature to feature. */
  hr2di_values background, emission, reflectance, transmittance;
  hr2di_values back_emission, back_reflectance, back_transmittance;
  hr2d_point *point;
  size_t point_capacity;
  char *name;
  size_t name_capacity;
  char *written; /* the name of the feature, if it is no string */
  size_t written_capacity;
} hr2di_geojson;

/* Adds the patches of one member of "features", or of a feature or geometry that is a file of
   its own; `number` counts from 1. */
hr2d_status hr2di_geojson_feature(hr2di_geojson *reader, const json_t *feature, size_t number);

/* Sets *text to that of a name, which may be NULL, until the next call; NULL if it has none.
   Returns HR2D_OK or HR2D_ENOMEM. */
hr2d_status hr2di_geojson_name(hr2di_geojson *reader, const json_t *name, const char **text);

/* Adds the patches of the current feature, whose geometry may be NULL. */
hr2d_status hr2di_geojson_geometry(hr2di_geojson *reader, const json_t *geometry);

/* Whether this is an object of the type of a geometry. */
int hr2di_geojson_is_geometry(const json_t *json);

/* Reads what the current feature, or the back of it, emits, reflects and lets through, into
   reader->patch and reader->thermal. */
hr2d_status hr2di_geojson_surface(hr2di_geojson *reader, const json_t *properties);

/* Reads the properties of the back, if it has its own. */
hr2d_status hr2di_geojson_back(hr2di_geojson *reader, const json_t *properties);

/* Reads the thermal properties of the current feature. */
hr2d_status hr2di_geojson_thermal(hr2di_geojson *reader, const json_t *properties);

/* Reads wavelengths, which the scene has from now on, and the temperature of the background
   from the member "hr2d". */
hr2d_status hr2di_geojson_spectrum(hr2di_geojson *reader, const json_t *members,
                                   size_t *background_bands);

/* Read the suns and the sky from the member "hr2d", valid ones. */
hr2d_status hr2di_geojson_sky(hr2di_geojson *reader, const json_t *members);
hr2d_status hr2di_geojson_sun(hr2di_geojson *reader, const json_t *members);

/* Whether a member "sky" has no pieces, and reads it. */
int hr2di_geojson_is_continuous_sky(const json_t *json);
hr2d_status hr2di_geojson_continuous_sky(hr2di_geojson *reader, const json_t *json);

/* Reads the gas from the member "hr2d", or from the properties of the current feature into
   reader->fills, and gives those that were read to the scene, which cannot fail. */
hr2d_status hr2di_geojson_medium(hr2di_geojson *reader, const json_t *members);
hr2d_status hr2di_geojson_region(hr2di_geojson *reader, const json_t *properties);

/* Keeps the gas of the current feature, whose border is reader->point. */
hr2d_status hr2di_geojson_add_region(hr2di_geojson *reader, size_t points);
/* What may fail of it, and goes before. */
hr2d_status hr2di_geojson_prepare_medium(hr2di_geojson *reader);
void hr2di_geojson_give_medium(hr2di_geojson *reader);

/* Reads the period from the member "hr2d". */
hr2d_status hr2di_geojson_period(hr2di_geojson *reader, const json_t *members);

/* Reads the sides of the current feature: the front, both, or those of a mirror. */
hr2d_status hr2di_geojson_sides(hr2di_geojson *reader, const json_t *properties);

/* Keeps a mirror through two points. */
hr2d_status hr2di_geojson_add_mirror(hr2di_geojson *reader, hr2d_point a, hr2d_point b);

/* Gives mirrors and period to the scene, which cannot fail. */
void hr2di_geojson_give_symmetry(hr2di_geojson *reader);

/* Gives the scene its former wavelengths back if the file could not be read. */
void hr2di_geojson_end_spectrum(hr2di_geojson *reader, hr2d_status status);

/* Reads a number or a non-empty array of numbers, each in [0,max], from `json` into `values`.
   *count becomes the number of values; 0 if `json` is NULL, which leaves `values` unchanged.
   Returns HR2D_OK; or HR2D_ESYNTAX, HR2D_ESCENE or HR2D_ENOMEM with a message that names
   `place` and `key`. */
hr2d_status hr2di_geojson_values(hr2di_geojson *reader, const char *place, const char *key,
                                 const json_t *json, double max, hr2di_values *values,
                                 size_t *count);

/* A member of an object.  NULL if it is absent, or null, which tools write for an empty
   attribute. */
const json_t *hr2di_geojson_member(const json_t *object, const char *key);

/* "a string", "missing": for messages. */
const char *hr2di_geojson_kind(const json_t *json);

#endif
