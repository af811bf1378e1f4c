/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CSV files (RFC 4180). */
#ifndef HR2D_TOOLS_OUTPUT_CSV_H
#define HR2D_TOOLS_OUTPUT_CSV_H

#include <stdio.h>

/* Begins a file: with a comment that has the provenance, if `comment` is not 0.  RFC 4180 has
   no comments, and many readers would take it for the header.  Returns 0 or EXIT_FAILED after
   an error message. */
int csv_begin(FILE *stream, int comment);

/* Writes one field. */
void csv_text(FILE *stream, const char *text);

#endif
