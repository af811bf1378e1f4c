/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads a whole file into memory. */
#ifndef HR2D_SRC_BASE_READ_FILE_H
#define HR2D_SRC_BASE_READ_FILE_H

#include <hr2d/memory.h>
#include <hr2d/status.h>
#include <stddef.h>

#include "base/message.h"
#include "base/watch.h"

/* Reads the file `path` into *text: *size bytes without a terminator, which the caller frees by
   hr2di_alloc_free().  Returns HR2D_OK, HR2D_EIO with the system's reason as message,
   HR2D_ENOMEM, or the status of the watch.  On failure there is nothing to free. */
hr2d_status hr2di_file_read(const hr2d_allocator *alloc, const char *path, char **text,
                            size_t *size, hr2di_message *message, hr2di_watch *watch);

#endif
