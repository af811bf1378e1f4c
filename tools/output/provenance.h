/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a result comes from: program, version, command, the options that its numbers depend on,
   and the hash of the scene.  Each writer puts this record into its file; it has no date and no
   path, so that the same run writes the same bytes. */
#ifndef HR2D_TOOLS_OUTPUT_PROVENANCE_H
#define HR2D_TOOLS_OUTPUT_PROVENANCE_H

#include <jansson.h>
#include <stdio.h>

/* The command begins; it is the name of one and outlives the record. */
void provenance_begin(const char *command);

/* An option that was given; `text` is NULL if it has no argument.  Both are copied. */
void provenance_option(const char *name, const char *text);

/* The bytes of the scene, and the name of its file, whose folders are left out. */
void provenance_scene(const char *path, const void *bytes, size_t size);

void provenance_release(void);

/* The record for JSON, or NULL if an allocation failed. */
json_t *provenance_json(void);

/* The record in one line, which the caller frees, or NULL if an allocation failed:
   "hr2d VERSION: COMMAND LINE; SHA-256 of the scene: HASH".  It is UTF-8 without control
   characters. */
char *provenance_text(void);

/* Writes the line between two texts.  Returns 0 or EXIT_FAILED after an error message. */
int provenance_print(FILE *stream, const char *before, const char *after);

#endif
