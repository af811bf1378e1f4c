/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of schemas/, which the program carries. */
#ifndef HR2D_TOOLS_SCHEMA_TEXTS_H
#define HR2D_TOOLS_SCHEMA_TEXTS_H

typedef struct schema_text {
  const char *name, *title;
  const char *const *line; /* up to NULL */
} schema_text;

/* Ends with a name that is NULL. */
extern const schema_text schema_texts[];

#endif
