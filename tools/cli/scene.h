/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene of the command line, from the file name to the committed scene. */
#ifndef HR2D_TOOLS_CLI_SCENE_H
#define HR2D_TOOLS_CLI_SCENE_H

#include <hr2d/hr2d.h>

#include "cli/options.h"

/* Reads the scene, cuts its crossings if the options say so, turns the effects of the mask
   `force` on and commits it; the caller destroys it.  `cuts` receives the number of crossings
   that were cut.  Returns 0 or EXIT_FAILED. */
int scene_load(const options *o, unsigned force, hr2d_scene **scene, size_t *cuts);

/* Whether light passes through gas. */
int scene_has_gas(const hr2d_scene *scene);

/* Complains of a call on the scene that failed, as complain_call() does: of gas, if that is
   what the call does not go through. */
int scene_complain(const options *o, const hr2d_scene *scene, hr2d_status status);

/* The head of a summary: the scene, and with --split-crossings the number of cuts.  Titles are
   `width` columns wide. */
void scene_print(const options *o, int width, size_t cuts);

/* The index of the patch that a place names: digits are an index, all other text is a name.
   `option` is the option for the error message.  Returns 0 or EXIT_USAGE. */
int scene_find_place(const hr2d_scene *scene, const char *option, const place *p,
                     size_t *patch);

/* The file name of the scene without its folders. */
const char *scene_file_name(const options *o);

/* The length of the longest patch. */
double scene_longest_patch(const hr2d_scene *scene);

#endif
