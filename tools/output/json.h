/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces that the reports share: JSON values and text in columns. */
#ifndef HR2D_TOOLS_OUTPUT_JSON_H
#define HR2D_TOOLS_OUTPUT_JSON_H

#include <hr2d/hr2d.h>
#include <jansson.h>
#include <stdint.h>
#include <stdio.h>

#include "cli/options.h"

/* A JSON number, or null where it would not be finite. */
json_t *json_number(double x);

json_t *json_count(uint64_t n);

/* A JSON string; bytes that are not UTF-8, as file names may have, become U+FFFD. */
json_t *json_text(const char *text);

/* Set a member, append an item.  The value is taken over; where an allocation failed,
   also that of the value, *container becomes NULL and stays so. */
void json_put(json_t **object, const char *key, json_t *value);
void json_push(json_t **array, json_t *value);

/* {name: true|false} for every effect. */
json_t *json_effects(const hr2d_scene *scene);

/* Writes a document with 17 significant digits and takes it over; NULL is a failed
   allocation.  Returns 0 or EXIT_FAILED. */
int json_write(json_t *document, const char *path);

/* The head of a summary: the scene, and what --split-crossings did; titles are `width`
   columns wide. */
void print_scene(const options *o, int width, size_t cuts);

/* A counter and what it counts. */
typedef struct effort {
  const char *what;
  uint64_t count;
} effort;

/* Prints the counters that are not 0, as many in a line as fit: what a scene does without
   was not worked at. */
void print_work(const effort *list, size_t count);

/* Tables of many patches show the first and the last ones.  Whether patch k has no row of
   its own; for the first of these, a row that says how many there are is printed. */
int is_skipped(size_t k, size_t count);

/* How many columns a UTF-8 text takes, one per character. */
int columns(const char *text);

/* Prints text and blanks up to `width` columns. */
void print_padded(FILE *stream, const char *text, int width);

/* The width of the column of patch names. */
int name_width(const hr2d_scene *scene);

#endif
