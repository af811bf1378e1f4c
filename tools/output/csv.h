/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text in CSV files. */
#ifndef HR2D_TOOLS_OUTPUT_CSV_H
#define HR2D_TOOLS_OUTPUT_CSV_H

#include <stdio.h>

/* Writes one field. */
void csv_text(FILE *stream, const char *text);

#endif
