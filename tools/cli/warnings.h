/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The warnings about a scene, kept until the command writes its result. */
#ifndef HR2D_TOOLS_CLI_WARNINGS_H
#define HR2D_TOOLS_CLI_WARNINGS_H

#include <hr2d/hr2d.h>

#include "cli/options.h"
#include "output/json.h"

typedef struct warnings {
  json_t *list; /* as in JSON output; NULL if memory ran out */
  size_t count[HR2D_WARNING_COUNT];
} warnings;

/* Finds and prints the warnings about a scene, committed or not: some of each code, unless
   --quiet is given without --strict.  At `deadline`, a clock_seconds() or 0 for never, the
   search ends, and that is told.  Returns 0, or EXIT_FAILED after a message, also with --strict
   for any warning or a search that has ended early; the list has to be released or put into a
   document in any case. */
int warnings_find(const options *o, const hr2d_scene *scene, double deadline, warnings *w);

void warnings_release(warnings *w);

#endif
