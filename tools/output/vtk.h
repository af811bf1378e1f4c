/* SPDX-License-Identifier: GPL-3.0-or-later */
/* XML files of VTK.  Arrays are in base64, as text cannot hold NaN: the length in bytes as 8
   bytes, and then the numbers, in the byte order of the machine. */
#ifndef HR2D_TOOLS_OUTPUT_VTK_H
#define HR2D_TOOLS_OUTPUT_VTK_H

#include <stddef.h>
#include <stdio.h>

typedef enum vtk_type { VTK_DOUBLE, VTK_INTEGER } vtk_type;

/* Number k of an array, component by component. */
typedef double vtk_item(const void *ctx, size_t k);

/* The beginning of a file whose data set is called `type`, for instance PolyData. */
void vtk_begin(FILE *stream, const char *type);

/* The provenance as field data, which stands before the pieces.  Returns 0 or EXIT_FAILED after
   an error message. */
int vtk_provenance(FILE *stream);

/* Writes an array of count × components numbers; integers are whole. */
void vtk_array(FILE *stream, const char *name, vtk_type type, size_t count, size_t components,
               vtk_item *item, const void *ctx);

/* The end of a file. */
void vtk_end(FILE *stream, const char *type);

#endif
