/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures that tell where they come from. */
#ifndef HR2D_TOOLS_OUTPUT_METADATA_H
#define HR2D_TOOLS_OUTPUT_METADATA_H

#include <stddef.h>
#include <stdio.h>

#include "output/suffix.h"

/* Writes a picture, or its beginning, that is in memory, with the provenance in it: a text
   chunk of PNG, the element metadata of SVG.  Others are written as they are.  Returns 0 or
   EXIT_FAILED after an error message; errors of the stream stay in it. */
int metadata_write(FILE *stream, suffix format, const char *bytes, size_t size);

/* Writes text as XML has it. */
void metadata_put_xml(FILE *stream, const char *text);

#endif
