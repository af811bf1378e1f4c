/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exchange areas of the patches of a scene with images. */
#ifndef HR2D_SRC_VISIBILITY_IMAGE_MATRIX_H
#define HR2D_SRC_VISIBILITY_IMAGE_MATRIX_H

#include <hr2d/visibility.h>

#include "base/watch.h"

/* Sets `area` to n × n exchange areas in scene lengths, for the n patches of the cell: those of
   patch i with patch k and all its images, with what those of a period add that are cut off. A
   patch may see its own images.  What that may be off goes to where `how` says, which has zeros
   before.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_image_matrix(const hr2d_scene *scene, const hr2d_matrix_options *how,
                               hr2di_watch *watch, double *area, hr2d_matrix_counts *counts);

/* Nothing is cut off from so many rows. */
void hr2di_image_matrix_complete(const hr2d_matrix_options *how, size_t rows);

#endif
