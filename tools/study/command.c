/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d study`: the paper's Figures 7 and 8 as a table, a fit and a chart. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/scene.h"
#include "output/clock.h"
#include "output/complain.h"
#include "run/run.h"
#include "study/study.h"

/* A row with at most this many links is counted again in a moment. */
enum { FEW_LINKS = 10000 };

/* A CSV on disk lags behind the sweep by at most this many seconds and one row. */
#define CSV_EVERY 1.0

static void print_row(const hr2d_study_row *row) {
  const hr2d_refine_counts *n = &row->counts;
  printf("%12.6g %12llu %12llu %14llu %14llu %10.4f\n", row->epsilon,
         (unsigned long long)n->elements, (unsigned long long)n->leaves,
         (unsigned long long)n->links, (unsigned long long)n->oracle_calls, row->seconds);
  fflush(stdout);
}

static hr2d_status count(const study *s, hr2d_linkset *links, sweep *w, size_t step,
                         hr2d_study_row *row) {
  hr2d_refine_options refine = run_refine_options(s->options);
  refine.threads = options_threads(s->options);
  refine.progress = sweep_show;
  refine.progress_ctx = w;
  hr2d_status status = sweep_next(w, s, step);
  if (!status) status = hr2d_study_run(links, &refine, &w->epsilon, 1, row, NULL);
  progress_clear(&w->line);
  return status;
}

/* The error message of a failed count; returns the exit status. */
static int fail_count(const study *s, const hr2d_linkset *links, hr2d_status status) {
  size_t done = 0;
  for (size_t k = 0; k < s->count; k++) done += s->rows[k].counts.elements > 0;
  if (status != HR2D_STOPPED || !done)
    return complain_call(s->options->scene, hr2d_linkset_message(links), status);
  complain(s->options->scene, "%zu of %zu steps done when interrupted", done, s->count);
  return EXIT_INTERRUPTED;
}

/* Counts a row of the CSV again: its numbers must be those of this study.  Only cheap rows and
   the first one are tried.  Returns 0 or the exit status. */
static int verify_row(const study *s, hr2d_linkset *links, sweep *w, size_t step, int first) {
  const hr2d_study_row *known = &s->rows[step];
  const hr2d_refine_counts *was = &known->counts;
  hr2d_study_row row;
  if (!was->elements || (!first && was->links > FEW_LINKS)) return 0;
  const hr2d_status status = count(s, links, w, step, &row);
  if (status) return complain_call(s->options->scene, hr2d_linkset_message(links), status);
  const hr2d_refine_counts *is = &row.counts;
  if (is->elements == was->elements && is->leaves == was->leaves && is->links == was->links)
    return 0;
  return complain(
      s->options->csv,
      "cannot be resumed: it has N = %llu and L = %llu at epsilon %.17g, where this "
      "study counts %llu and %llu",
      (unsigned long long)was->elements, (unsigned long long)was->links, known->epsilon,
      (unsigned long long)is->elements, (unsigned long long)is->links);
}

static int verify(study *s, hr2d_linkset *links, sweep *w) {
  int status = 0, first = 1;
  for (size_t k = 0; !status && s->known && k < s->count; k++) {
    status = verify_row(s, links, w, k, first);
    first = first && !s->rows[k].counts.elements;
  }
  if (status) s->count = 0; /* nothing to report */
  return status;
}

static int measure(study *s, hr2d_linkset *links, sweep *w) {
  const int rewrites = study_can_rewrite_csv(s);
  double written = clock_seconds();
  int code = 0;
  if (!s->quiet && s->options->split_crossings) printf("crossings %zu cut\n", s->cuts);
  if (!s->quiet)
    printf("%12s %12s %12s %14s %14s %10s\n", "epsilon", "N", "leaves", "L", "oracle calls",
           "seconds");
  for (size_t k = 0; !code && k < s->count; k++) {
    hr2d_study_row *row = &s->rows[k];
    if (!row->counts.elements) {
      const double epsilon = row->epsilon;
      const hr2d_status status = count(s, links, w, k, row);
      if (status) {
        *row = (hr2d_study_row){.epsilon = epsilon};
        return fail_count(s, links, status);
      }
      if (rewrites && clock_seconds() - written > CSV_EVERY) {
        code = study_write_csv(s);
        if (code) s->count = 0; /* the next write would fail, too */
        written = clock_seconds();
      }
    }
    if (!s->quiet) print_row(row);
  }
  s->complete = !code;
  return code;
}

static int run_study(study *s, const hr2d_scene *scene) {
  const options *o = s->options;
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  sweep w;
  hr2d_status status = hr2d_hierarchy_create(scene, &hierarchy);
  if (!status)
    status = hr2d_linkset_create(hierarchy, o->oracle, NULL, o->policy, NULL, &links);
  int code = status ? complain_call(o->scene, "", status) : 0;
  sweep_start(&w, s);
  if (!code) code = study_find_law(s, links, &w);
  if (!code) code = verify(s, links, &w);
  if (!code) code = measure(s, links, &w);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  return code;
}

static void print_fit(const study *s) {
  const hr2d_study_fit *f = &s->fit;
  if (!s->fitted) {
    puts("\nno fit: it takes three different N");
    return;
  }
  printf("\nL ≈ %.6g %c %.6g N %c %.6g N²\n", f->a, f->b < 0 ? '-' : '+', fabs(f->b),
         f->c < 0 ? '-' : '+', fabs(f->c));
  printf("R² = %.9f, slope of log L on log N = %.4f\n", f->r2, f->slope);
}

/* Prints and writes the rows that are there. */
static int report(study *s) {
  const options *o = s->options;
  int status = 0;
  progress_end();
  const hr2d_status fitting = hr2d_study_fit_rows(s->rows, s->count, &s->fit);
  if (fitting && fitting != HR2D_EINVAL) return complain_call(o->scene, "", fitting);
  s->fitted = !fitting;
  if (!s->quiet) print_fit(s);
  if (!s->quiet && s->lawful) study_print_law(s);
  if (o->csv) status = study_write_csv(s);
  if (o->json && !status) status = study_write_json(s);
  if (o->plot && !status) status = study_draw(s);
  return status;
}

int study_command(const options *o) {
  /* Patches that no light reaches would have no links; a study counts theirs, too. */
  const unsigned force = o->force | 1U << HR2D_EFFECT_EMISSION;
  hr2d_scene *scene = NULL;
  size_t cuts = 0;
  int status = options_check_outputs(o);
  if (!status) status = scene_load(o, force, &scene, &cuts);
  if (status) return status;
  study s = {.options = o, .cuts = cuts, .quiet = !options_want_table(o)};
  status = study_plan(&s, scene);
  if (!status) {
    status = run_study(&s, scene);
    study_drop_uncounted(&s);
    if (s.count) {
      const int reporting = report(&s);
      if (!status) status = reporting;
    }
  }
  free(s.rows);
  hr2d_scene_destroy(scene);
  return status;
}
