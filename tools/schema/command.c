/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d schema`: the JSON Schemas of scenes and results. */
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/suggest.h"
#include "output/complain.h"
#include "schema/texts.h"

static int refuse(const char *name) {
  suggestion near = suggest_for(name, strlen(name));
  for (const schema_text *s = schema_texts; s->name; s++) suggest_offer(&near, s->name);
  return near.best
             ? complain_usage("there is no schema '%s' (did you mean %s?)", name, near.best)
             : complain_usage("there is no schema '%s'", name);
}

int schema_command(const options *o) {
  for (const schema_text *s = schema_texts; s->name; s++) {
    if (!o->schema) {
      printf("%-10s %s\n", s->name, s->title);
      continue;
    }
    if (strcmp(s->name, o->schema) != 0) continue;
    for (const char *const *line = s->line; *line; line++) puts(*line);
    return EXIT_DONE;
  }
  return o->schema ? refuse(o->schema) : EXIT_DONE;
}
