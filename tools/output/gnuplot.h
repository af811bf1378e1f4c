/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts by gnuplot. */
#ifndef HR2D_TOOLS_OUTPUT_GNUPLOT_H
#define HR2D_TOOLS_OUTPUT_GNUPLOT_H

#include <stdio.h>

/* A string in single quotes, in which only the quote itself is special. */
void gnuplot_quote(FILE *script, const char *text);

/* The terminal for a file by its suffix; sizes in pixels of a screen. */
void gnuplot_terminal(FILE *script, const char *path, int width, int height);

/* Draws what a script says into a file.  Returns 0 or EXIT_FAILED. */
int gnuplot_draw(const char *path, void (*write_script)(FILE *script, const void *ctx),
                 const void *ctx);

#endif
