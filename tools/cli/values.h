/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the argument of an option to its value. */
#ifndef HR2D_TOOLS_CLI_VALUES_H
#define HR2D_TOOLS_CLI_VALUES_H

#include <stdint.h>

#include "cli/options.h"

/* What a whole number may be. */
typedef struct value_range {
  uint64_t min, max;
} value_range;

/* Reads `text`, which it may split in place, into a value whose type depends on the reader.
   Returns 0, or EXIT_USAGE after an error message that names the option. */
typedef int value_reader(const char *option, char *text, value_range range, void *value);

value_reader value_flag, value_positive, value_part, value_unsigned, value_count, value_path,
    value_file, value_picture, value_patches, value_place, value_places, value_sequence,
    value_grid, value_box, value_vector, value_oracle, value_policy, value_norm, value_effect,
    value_methods, value_against, value_light, value_band, value_film;

/* The types of the values. */
typedef int type_of_flag;                  /* set to 1; there is no text */
typedef double type_of_positive;           /* greater than 0 */
typedef double type_of_part;               /* greater than 0, at most 1 */
typedef unsigned type_of_unsigned;         /* in the range */
typedef uint64_t type_of_count;            /* in the range */
typedef const char *type_of_path;          /* a file, or - for standard output */
typedef const char *type_of_file;          /* a file that can be read back */
typedef const char *type_of_picture;       /* a file with the suffix of a picture format */
typedef const char *type_of_film;          /* a .png file */
typedef place_list type_of_patches;        /* a patch is appended; there is room for it */
typedef place type_of_place;               /* PATCH:T */
typedef place_list type_of_places;         /* PATCH:T is appended; there is room for it */
typedef sequence type_of_sequence;         /* FROM:RATIO */
typedef grid_size type_of_grid;            /* WxH */
typedef grid_box type_of_box;              /* X0,Y0,X1,Y1 */
typedef vector type_of_vector;             /* X,Y, not both 0 */
typedef const hr2d_oracle *type_of_oracle; /* by its name, as those below */
typedef const hr2d_policy *type_of_policy;
typedef hr2d_norm type_of_norm;
typedef unsigned type_of_effect;      /* the bit of the effect is set */
typedef unsigned type_of_methods;     /* a bit for each method of a list with commas */
typedef against_list type_of_against; /* a list with commas */
typedef light type_of_light;
typedef int type_of_band; /* a number from 0, or BAND_ALL or BAND_RGB */

#endif
