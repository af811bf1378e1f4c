/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON values.  The names beside these, such as json_object(), are of the library jansson. */
#ifndef HR2D_TOOLS_OUTPUT_JSON_H
#define HR2D_TOOLS_OUTPUT_JSON_H

#include <hr2d/hr2d.h>
#include <jansson.h>
#include <stdint.h>

/* A JSON number, or null if x is not finite. */
json_t *json_number(double x);

json_t *json_count(uint64_t n);

/* A JSON string.  File names may hold bytes that are not UTF-8: these become U+FFFD. */
json_t *json_text(const char *text);

/* An array of numbers. */
json_t *json_numbers(const double *x, size_t count);

/* Set a member, append an item.  They take over the value.  If an allocation failed, also that
   of the value, *container becomes NULL and stays so. */
void json_put(json_t **object, const char *key, json_t *value);
void json_push(json_t **array, json_t *value);

/* {name: true|false} for every effect. */
json_t *json_effects(const hr2d_scene *scene);

/* {index, name, length} of a patch, to which each report adds what it knows. */
json_t *json_patch(const hr2d_scene *scene, size_t k);

/* Writes a value on one line with 17 significant digits and takes it over; NULL means that an
   allocation failed.  Returns 0 or EXIT_FAILED. */
int json_write_value(FILE *stream, json_t *value);

/* Writes a document with 17 significant digits and takes it over; NULL means that an allocation
   failed.  Returns 0 or EXIT_FAILED. */
int json_write(json_t *document, const char *path);

#endif
