/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d study`: the paper's Figures 7 and 8 as a table, a fit and a chart. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "chart.h"
#include "commands.h"
#include "complain.h"
#include "load.h"
#include "output.h"
#include "progress.h"
#include "report.h"
#include "run.h"

typedef struct study {
  const options *options;
  hr2d_study_row *rows; /* options->steps of them */
  hr2d_study_fit fit;
  int fitted;
  int quiet; /* no table */
} study;

/* A geometric sequence; through logarithms to base 2, so that powers of two are exact. */
static double step_epsilon(const options *o, unsigned step) {
  if (step == 0) return o->from;
  if (step + 1 == o->steps) return o->to;
  const double fraction = (double)step / (o->steps - 1);
  return exp2(log2(o->from) + fraction * (log2(o->to) - log2(o->from)));
}

static void print_row(const hr2d_study_row *row) {
  const hr2d_refine_counts *n = &row->counts;
  printf("%12.6g %12llu %12llu %14llu %14llu %10.4f\n", row->epsilon,
         (unsigned long long)n->elements, (unsigned long long)n->leaves,
         (unsigned long long)n->links, (unsigned long long)n->oracle_calls, row->seconds);
  fflush(stdout);
}

static hr2d_status measure(study *s, hr2d_linkset *links, progress *p) {
  const options *o = s->options;
  hr2d_refine_options refine = refine_options(o);
  refine.progress = progress_show;
  refine.progress_ctx = p;
  hr2d_status status = HR2D_OK;
  if (!s->quiet)
    printf("%12s %12s %12s %14s %14s %10s\n", "epsilon", "N", "leaves", "L", "oracle calls",
           "seconds");
  for (p->steps = o->steps; !status && p->step < p->steps; p->step++) {
    const double epsilon = step_epsilon(o, p->step);
    status = hr2d_study_run(links, &refine, &epsilon, 1, &s->rows[p->step], NULL);
    progress_clear(p);
    if (!status && !s->quiet) print_row(&s->rows[p->step]);
  }
  return status;
}

static int run_study(study *s, const hr2d_scene *scene) {
  const options *o = s->options;
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  progress p;
  hr2d_status status = hr2d_hierarchy_create(scene, &hierarchy);
  if (!status)
    status = hr2d_linkset_create(hierarchy, o->oracle, NULL, o->policy, NULL, &links);
  progress_start(&p, o->quiet);
  if (!status) status = measure(s, links, &p);
  const int code = status
                       ? fail_call(o->scene, links ? hr2d_linkset_message(links) : "", status)
                       : EXIT_DONE;
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

static json_t *row_entry(const hr2d_study_row *row) {
  json_t *entry = json_object();
  json_put(&entry, "epsilon", json_number(row->epsilon));
  json_put(&entry, "elements", json_count(row->counts.elements));
  json_put(&entry, "leaves", json_count(row->counts.leaves));
  json_put(&entry, "links", json_count(row->counts.links));
  json_put(&entry, "oracle_calls", json_count(row->counts.oracle_calls));
  json_put(&entry, "seconds", json_number(row->seconds));
  return entry;
}

static json_t *fit_entry(const hr2d_study_fit *fit) {
  json_t *entry = json_object();
  json_put(&entry, "a", json_number(fit->a));
  json_put(&entry, "b", json_number(fit->b));
  json_put(&entry, "c", json_number(fit->c));
  json_put(&entry, "r2", json_number(fit->r2));
  json_put(&entry, "slope", json_number(fit->slope));
  return entry;
}

static int write_json(const study *s) {
  const options *o = s->options;
  json_t *root = json_object(), *rows = json_array();
  for (unsigned k = 0; k < o->steps; k++) json_push(&rows, row_entry(&s->rows[k]));
  json_put(&root, "scene", json_text(o->scene));
  json_put(&root, "oracle", json_text(o->oracle->name));
  json_put(&root, "variant", json_text(o->policy->name));
  json_put(&root, "rows", rows);
  json_put(&root, "fit", s->fitted ? fit_entry(&s->fit) : json_null());
  return json_write(root, o->json);
}

static int write_csv(const study *s) {
  output out;
  const int status = output_open(&out, s->options->csv);
  if (status) return status;
  fputs("epsilon,elements,leaves,links,oracle_calls,seconds\n", out.stream);
  for (unsigned k = 0; k < s->options->steps; k++) {
    const hr2d_refine_counts *n = &s->rows[k].counts;
    fprintf(out.stream, "%.17g,%llu,%llu,%llu,%llu,%.17g\n", s->rows[k].epsilon,
            (unsigned long long)n->elements, (unsigned long long)n->leaves,
            (unsigned long long)n->links, (unsigned long long)n->oracle_calls,
            s->rows[k].seconds);
  }
  return output_close(&out, 0);
}

static int report(study *s) {
  const options *o = s->options;
  int status = 0;
  const hr2d_status fitting = hr2d_study_fit_rows(s->rows, o->steps, &s->fit);
  if (fitting && fitting != HR2D_EINVAL) return fail_call(o->scene, "", fitting);
  s->fitted = !fitting;
  if (!s->quiet) print_fit(s);
  if (o->csv) status = write_csv(s);
  if (o->json && !status) status = write_json(s);
  if (o->plot && !status)
    status = chart_study(o, s->rows, o->steps, s->fitted ? &s->fit : NULL);
  return status;
}

int study_command(const options *o) {
  hr2d_scene *scene = NULL;
  int status = output_check(o->json);
  if (!status) status = output_check(o->csv);
  if (!status) status = output_check(o->plot);
  if (!status) status = load_scene(o->scene, &scene);
  if (status) return status;
  study s = {.options = o, .quiet = o->quiet || to_stdout(o->json) || to_stdout(o->csv)};
  s.rows = calloc(o->steps, sizeof *s.rows);
  status = s.rows ? run_study(&s, scene) : fail_memory();
  if (!status) status = report(&s);
  free(s.rows);
  hr2d_scene_destroy(scene);
  return status;
}
