/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the package of npm and the page ask: `hr2d solve` as a call, by the program's own files.
   The JavaScript side is npm/index.js, and page/library.js.  One solve is kept at a time, until
   package_end(). */
#include <getopt.h>
#include <malloc.h>
#include <stdlib.h>
#include <string.h>

#include "cli/warnings.h"
#include "glue.h"
#include "host.h"
#include "output/clock.h"
#include "output/complain.h"
#include "output/provenance.h"
#include "solve/solve.h"

static struct {
  options options;
  hr2d_scene *scene;
  size_t cuts;
  size_t *patches;
  warnings warnings;
  run run;
  char *json;
} job;

void PAGE(package_end)(void) {
  run_release(&job.run);
  warnings_release(&job.warnings);
  free(job.patches);
  free(job.json);
  hr2d_scene_destroy(job.scene);
  options_release(&job.options);
  memset(&job, 0, sizeof job);
}

glue_solve glue_take(void) {
  const glue_solve made = {job.scene, job.run.own_hierarchy, job.run.own_links,
                           job.run.solution, job.run.account};
  job.run = (run){0};
  job.scene = NULL;
  return made;
}

/* What is allocated, in bytes: tests look for leaks. */
size_t PAGE(package_bytes)(void) {
  return (size_t)mallinfo().uordblks;
}

/* The words of a command line, a zero behind each. */
static int read_words(char *words, size_t count) {
  char **argv = calloc(count + 1, sizeof *argv);
  if (!argv) return complain_memory();
  for (size_t k = 0; k < count; k++, words += strlen(words) + 1) argv[k] = words;
  optind = 0; /* from the beginning again */
  const int status = options_read((int)count, argv, &job.options);
  job.options.quiet = 1;
  free(argv);
  return status;
}

static hr2d_status prepare(const char *text, size_t size, progress *p) {
  const options *o = &job.options;
  hr2d_snap_report snapped;
  hr2d_status status = hr2d_scene_create(NULL, &job.scene);
  if (status) return status;
  hr2d_scene_set_progress(job.scene, progress_show, p);
  provenance_scene(o->scene, text, size);
  status = hr2d_scene_parse(job.scene, text, size);
  if (!status && o->snap > 0) status = hr2d_scene_snap(job.scene, o->snap, &snapped);
  if (!status && o->split_crossings) status = hr2d_scene_split_crossings(job.scene, &job.cuts);
  if (!status) status = hr2d_scene_commit(job.scene);
  hr2d_scene_set_progress(job.scene, NULL, NULL);
  return status;
}

/* Half of a budget of time; the solution is what was asked for. */
static double warnings_deadline(double start) {
  return job.options.time_budget > 0 ? start + job.options.time_budget / 2 : 0;
}

/* Warnings may tell why a scene is refused. */
static int open_scene(const char *text, size_t size, double start) {
  const options *o = &job.options;
  progress p;
  progress_start(&p, 1);
  p.deadline = o->time_budget > 0 ? start + o->time_budget : 0;
  const hr2d_status status = prepare(text, size, &p);
  const int code =
      !status ? 0
      : p.late
          ? complain_call(o->scene, "the time does not suffice to read the scene", status)
          : complain_call(o->scene, job.scene ? hr2d_scene_message(job.scene) : "", status);
  if (!status || (status != HR2D_STOPPED && status != HR2D_ENOMEM))
    warnings_find(o, job.scene, warnings_deadline(start), &job.warnings);
  return code;
}

static int keep_json(double start) {
  json_t *root = solve_json(&job.run, clock_seconds() - start);
  job.json = root ? json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
  json_decref(root);
  return job.json ? EXIT_DONE : complain_memory();
}

static int solve(double start) {
  int code = run_find_places(&job.options, job.scene, &job.patches);
  if (code) return code;
  job.run = (run){.options = &job.options,
                  .scene = job.scene,
                  .cuts = job.cuts,
                  .start = start,
                  .places = job.patches,
                  .warnings = &job.warnings};
  code = run_solve(&job.run);
  if (code && !job.run.inaccurate) return code;
  run_enclose(&job.run);
  return keep_json(start);
}

/* Solves the text of a scene file as the command line of `count` words says, each with a zero
   behind it.  A solution that is not as exact as it should be is one, too: its JSON says so. */
hr2d_status PAGE(package_solve)(const char *text, size_t size, char *words, size_t count) {
  const double start = clock_seconds();
  package_end();
  host_forget();
  const int failed = read_words(words, count) || open_scene(text, size, start) || solve(start);
  return failed ? host_status() : HR2D_OK;
}

/* Why a call has failed. */
const char *PAGE(package_message)(void) {
  return host_message();
}

/* The document of `hr2d solve --json`. */
const char *PAGE(package_json)(void) {
  return job.json;
}

/* The warnings about a scene, as an array in JSON; where the document is missing. */
const char *PAGE(package_warnings)(void) {
  if (!job.json && job.warnings.list)
    job.json = json_dumps(job.warnings.list, JSON_COMPACT | JSON_REAL_PRECISION(17));
  return job.json ? job.json : "[]";
}

/* The mean radiosity of the solution at the nodes of a grid, and the place of each node. */
hr2d_status PAGE(package_field)(double x0, double y0, double x1, double y1, size_t columns,
                                size_t rows, double tolerance, double *mean,
                                unsigned char *place) {
  host_forget();
  const hr2d_status status =
      glue_field(job.run.solution, (hr2d_point){x0, y0}, (hr2d_point){x1, y1}, columns, rows,
                 tolerance, mean, place);
  if (status) complain_call(NULL, "", status);
  return status;
}
