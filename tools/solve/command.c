/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d solve`: the outputs are checked before the work starts. */
#include <math.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/scene.h"
#include "cli/warnings.h"
#include "draw/draw.h"
#include "output/clock.h"
#include "output/complain.h"
#include "output/progress.h"
#include "run/run.h"
#include "solve/solve.h"

/* A flux that no temperature allows is an error, after the report. */
static int check_heat(const run *r) {
  run_heat heat;
  int status = run_heat_find(r, &heat);
  for (size_t k = 0; heat.exists && !status && k < hr2d_scene_patches(r->scene); k++)
    if (heat.state[k] == HR2D_TEMPERATURE_IMPOSSIBLE)
      status = complain(r->options->scene,
                        "patch %zu (\"%s\") cannot lose so much heat: it would have to be "
                        "colder than 0 K",
                        k, hr2d_scene_name(r->scene, k));
  run_heat_release(&heat);
  return status;
}

/* What the first share does alone. */
static int write_outputs(const run *r, double total) {
  const options *o = r->options;
  int status = 0;
  progress_end();
  if (options_want_table(o)) status = solve_print(r, total);
  if (o->csv && !status) status = solve_write_csv(r, o->csv);
  if (o->vtk && !status) status = solve_write_vtk(r, o->vtk);
  if (o->draw && !status) status = draw_run(r, o->draw);
  if (o->json && !status) status = solve_write_json(r, total, o->json);
  return status;
}

static int report(run *r) {
  const options *o = r->options;
  const int first = run_is_first(r);
  const double total = clock_seconds() - r->start;
  int status = run_agree(r, run_point_links(r));
  if (!status && first) status = write_outputs(r, total);
  if (o->tiles) {
    status = run_agree(r, status);
    if (!status) status = draw_tiles(r, o->tiles);
  }
  if (o->watch) {
    status = run_agree(r, status);
    if (!status) status = draw_watch(r, o->watch);
  }
  return status || !first ? status : check_heat(r);
}

static int run_and_report(run *r) {
  int status = run_solve(r);
  if (!status || r->inaccurate) {
    const int enclosing = run_enclose(r);
    int reporting = run_compare_shares(r);
    if (!reporting) reporting = report(r);
    status = complain_join(status, enclosing);
    status = complain_join(status, reporting);
  }
  run_release(r);
  return status;
}

/* Half of the time that is left: the solution is what was asked for. */
static double warnings_deadline(const options *o, double start) {
  const double now = clock_seconds(), left = start + o->time_budget - now;
  return o->time_budget > 0 ? now + fmax(left, 0) / 2 : 0;
}

int solve_scene(const options *o, const hr2d_scene *scene, size_t cuts, double start,
                const run_shares *shares) {
  warnings w = {0};
  size_t *patches = NULL;
  int status = run_find_places(o, scene, &patches);
  if (!status) status = draw_check_scene(o, scene);
  if (!status) status = warnings_find(o, scene, warnings_deadline(o, start), &w);
  run r = {.options = o,
           .scene = scene,
           .cuts = cuts,
           .start = start,
           .places = patches,
           .warnings = &w,
           .shares = shares,
           .share = shares ? shares->share : NULL};
  if (!status) status = run_and_report(&r);
  warnings_release(&w);
  free(patches);
  return status;
}

int solve_command(const options *o) {
  const double start = clock_seconds();
  hr2d_scene *scene = NULL;
  size_t cuts = 0;
  int status = draw_check(o->draw ? o->draw : o->tiles ? o->tiles : o->watch);
  if (!status) status = options_check_outputs(o);
  if (!status) status = scene_load(o, o->force, &scene, &cuts);
  if (status) return status;
  status = solve_scene(o, scene, cuts, start, NULL);
  hr2d_scene_destroy(scene);
  return status;
}
