/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cairo is loaded when the first picture is asked for: it and what it brings along take longer
   to load than a small scene takes to solve. */
#ifndef HR2D_TOOLS_DRAW_CAIRO_LATE_H
#define HR2D_TOOLS_DRAW_CAIRO_LATE_H

/* Before any function of cairo is called.  Returns NULL, also where the program is linked with
   cairo, or why there are no pictures. */
const char *cairo_late_load(void);

#endif
