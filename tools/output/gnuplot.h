/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts by gnuplot. */
#ifndef HR2D_TOOLS_OUTPUT_GNUPLOT_H
#define HR2D_TOOLS_OUTPUT_GNUPLOT_H

#include <stdio.h>

/* Writes text as a string of gnuplot's language, in single quotes. */
void gnuplot_quote(FILE *script, const char *text);

/* Writes the title of a chart. */
void gnuplot_title(FILE *script, const char *title);

/* Chooses gnuplot's terminal by the suffix of the file; sizes in pixels of a screen. */
void gnuplot_terminal(FILE *script, const char *path, int width, int height);

/* Runs the script that write_script() writes; its picture becomes the file.  Returns 0 or
   EXIT_FAILED. */
int gnuplot_draw(const char *path, void (*write_script)(FILE *script, const void *ctx),
                 const void *ctx);

#endif
