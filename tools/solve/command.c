/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d solve`: what is asked for is checked before the work starts. */
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/load.h"
#include "draw/draw.h"
#include "output/complain.h"
#include "output/output.h"
#include "output/progress.h"
#include "run/run.h"

/* The patches that --at, --links-of and --importance name, in this order. */
static int find_places(const options *o, const hr2d_scene *scene, size_t *patches) {
  int status = 0;
  for (size_t k = 0; !status && k < o->at_count; k++)
    status = find_place(scene, "at", &o->at[k], &patches[k]);
  if (!status && o->links_of.patch)
    status = find_place(scene, "links-of", &o->links_of, &patches[o->at_count]);
  if (!status && o->importance.patch)
    status = find_place(scene, "importance", &o->importance, &patches[o->at_count + 1]);
  return status;
}

static int check_outputs(const options *o) {
  int status = o->draw ? draw_check(o->draw) : 0;
  if (!status) status = output_check(o->json);
  if (!status) status = output_check(o->csv);
  if (!status) status = output_check(o->state);
  return status ? status : output_check(o->draw);
}

static int report(const run *r) {
  const options *o = r->options;
  int status = 0;
  const double total = seconds() - r->start;
  progress_end();
  if (!o->quiet && !to_stdout(o->json) && !to_stdout(o->csv)) status = print_run(r, total);
  if (o->csv && !status) status = write_leaves(r, o->csv);
  if (o->draw && !status) status = draw_run(r, o->draw);
  if (o->json && !status) status = write_run(r, total, o->json);
  return status;
}

static int solve_scene(const options *o, const hr2d_scene *scene, size_t cuts, double start,
                       size_t *patches) {
  int status = find_places(o, scene, patches);
  if (status) return status;
  run r = {.options = o, .scene = scene, .cuts = cuts, .start = start, .places = patches};
  status = run_solve(&r);
  if (!status || r.inaccurate) {
    const int reporting = report(&r);
    if (!status) status = reporting;
  }
  run_release(&r);
  return status;
}

int solve_command(const options *o) {
  const double start = seconds();
  hr2d_scene *scene = NULL;
  size_t cuts = 0;
  int status = check_outputs(o);
  if (!status) status = load_scene(o, o->force, &scene, &cuts);
  if (status) return status;
  size_t *patches = calloc(o->at_count + 2, sizeof *patches);
  status = patches ? solve_scene(o, scene, cuts, start, patches) : fail_memory();
  free(patches);
  hr2d_scene_destroy(scene);
  return status;
}
