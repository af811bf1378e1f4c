/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a file name to a committed scene. */
#ifndef HR2D_TOOLS_CLI_LOAD_H
#define HR2D_TOOLS_CLI_LOAD_H

#include <hr2d/hr2d.h>

#include "cli/options.h"

/* Reads the scene of the options, cuts its crossings if that is asked for, turns the
   effects of the mask `force` on and commits it; the caller destroys it.  `cuts` receives
   the number of crossings that were cut.  Returns 0 or EXIT_FAILED. */
int load_scene(const options *o, unsigned force, hr2d_scene **scene, size_t *cuts);

/* The index of the patch a place names: digits are an index, all else a name.
   Returns 0, or EXIT_USAGE after complaining. */
int find_place(const hr2d_scene *scene, const char *option, const place *p, size_t *patch);

/* Complains that a library call failed on a file: with the message of its object, or
   else with what the status means.  Returns the exit status. */
int fail_call(const char *path, const char *message, hr2d_status status);

#endif
