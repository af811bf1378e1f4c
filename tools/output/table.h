/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text in columns, for the reports on standard output. */
#ifndef HR2D_TOOLS_OUTPUT_TABLE_H
#define HR2D_TOOLS_OUTPUT_TABLE_H

#include <hr2d/hr2d.h>
#include <stdint.h>

/* A counter and the name of the things that it counts. */
typedef struct effort {
  const char *what;
  uint64_t count;
} effort;

/* Prints the counters that are not 0, in lines of at most 79 columns. */
void table_print_work(const effort *list, size_t count);

/* The width of a column of names, and of that of patch names. */
int table_names_width(const char *const *name, size_t count);
int table_name_width(const hr2d_scene *scene);

/* The titles of the first columns of a table of patches: index, name and length. */
void table_patch_titles(int name_width);

/* The first columns of the row of patch k.  A table of many patches shows only the first and
   the last ones: returns 0 for the others, and prints one row in their place that has their
   number. */
int table_patch(const hr2d_scene *scene, size_t k, int name_width);

/* The same for row k of `count` that are no patches. */
int table_row(size_t k, size_t count, const char *name, double length, int name_width);

#endif
