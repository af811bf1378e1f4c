/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The patches that the options of a run name. */
#include <stdlib.h>

#include "cli/scene.h"
#include "output/complain.h"
#include "run/run.h"

int run_find_places(const options *o, const hr2d_scene *scene, size_t **patches) {
  const size_t links = o->at.count, important = links + 1;
  const size_t beams = important + o->importance.count;
  size_t *of = *patches = calloc(beams + o->beams_of.count, sizeof *of);
  if (!of) return complain_memory();
  int status = 0;
  for (size_t k = 0; !status && k < o->at.count; k++)
    status = scene_find_place(scene, "at", &o->at.items[k], &of[k]);
  if (!status && o->links_of.patch)
    status = scene_find_place(scene, "links-of", &o->links_of, &of[links]);
  for (size_t k = 0; !status && k < o->importance.count; k++)
    status = scene_find_place(scene, "importance", &o->importance.items[k], &of[important + k]);
  for (size_t k = 0; !status && k < o->beams_of.count; k++)
    status = scene_find_place(scene, "beams-of", &o->beams_of.items[k], &of[beams + k]);
  return status;
}

const size_t *run_important(const run *r) {
  return r->places ? r->places + r->options->at.count + 1 : NULL;
}

const size_t *run_beamed(const run *r) {
  const size_t *important = run_important(r);
  return important ? important + r->options->importance.count : NULL;
}
