/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a file name to a committed scene. */
#ifndef HR2D_TOOLS_LOAD_H
#define HR2D_TOOLS_LOAD_H

#include <hr2d/hr2d.h>

#include "options.h"

/* Reads and commits a scene, which the caller destroys.  Returns 0 or EXIT_FAILED. */
int load_scene(const char *path, hr2d_scene **scene);

/* The index of the patch a place names: digits are an index, all else a name.
   Returns 0, or EXIT_USAGE after complaining. */
int find_place(const hr2d_scene *scene, const char *option, const place *p, size_t *patch);

/* Complains that a library call failed on a file: with the message of its object, or
   else with what the status means.  Returns the exit status. */
int fail_call(const char *path, const char *message, hr2d_status status);

#endif
