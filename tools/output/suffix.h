/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Picture formats by the end of a file name. */
#ifndef HR2D_TOOLS_OUTPUT_SUFFIX_H
#define HR2D_TOOLS_OUTPUT_SUFFIX_H

typedef enum suffix { SUFFIX_OTHER, SUFFIX_SVG, SUFFIX_PNG, SUFFIX_PDF } suffix;

/* The format of a picture with this file name. */
suffix suffix_of(const char *path);

#endif
