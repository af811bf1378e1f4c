/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exchange areas of the patches of a scene with images, as compressed rows: time and memory
   grow with the pairs that see each other. */
#ifndef HR2D_SRC_VISIBILITY_IMAGE_ROWS_H
#define HR2D_SRC_VISIBILITY_IMAGE_ROWS_H

#include <hr2d/visibility.h>

#include "base/watch.h"

/* The entries of row i are [start[i], start[i + 1]), with their columns in order. */
typedef struct hr2di_image_rows {
  uint64_t *start;
  uint32_t *column;
  double *area;
} hr2di_image_rows;

/* Makes the rows of the n patches of the cell: exchange areas in scene lengths of patch i with
   patch k and all its images, with what those of a period add that are cut off.  A patch may
   see its own images.  What that may be off goes to where `how` says, which has zeros before.
   HR2D_OK, HR2D_ENOMEM or the status of the watch; to be ended by hr2di_image_rows_clear() in
   any case. */
hr2d_status hr2di_image_rows_init(hr2di_image_rows *rows, const hr2d_scene *scene,
                                  const hr2d_matrix_options *how, hr2di_watch *watch,
                                  hr2d_matrix_counts *counts);
void hr2di_image_rows_clear(hr2di_image_rows *rows, const hr2d_allocator *alloc);

/* Nothing is cut off from so many rows. */
void hr2di_image_rows_complete(const hr2d_matrix_options *how, size_t rows);

#endif
