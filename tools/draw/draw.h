/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a solved scene. */
#ifndef HR2D_TOOLS_DRAW_DRAW_H
#define HR2D_TOOLS_DRAW_DRAW_H

#include "run/run.h"

/* Whether this program can draw: it may be built without cairo, and loads it here.  Returns 0,
   also for NULL, or EXIT_FAILED after an error message.  Called before anything is drawn. */
int draw_check(const char *path);

/* Whether the scene has the bands that a picture is to show.  Returns 0, or EXIT_USAGE after an
   error message. */
int draw_check_scene(const options *o, const hr2d_scene *scene);

/* Draws the scene coloured by B and filled with its light, and if they are given the links of
   --links-of and the beams of
   --beams-of.  Returns 0 or the exit status. */
int draw_run(const run *r, const char *path);

/* tiles.c: the links as tiles of the rectangle of two patches, or of the square of all.  All
   shares call it, and the first one draws.  Returns 0 or the exit status. */
int draw_tiles(const run *r, const char *path);

/* watch.c: an animation for falling epsilon, of elements, links, tiles and light; `r` is the
   run with --eps.  All shares call it, and the first one draws.  Returns 0 or the exit status.
 */
int draw_watch(const run *r, const char *path);

#endif
