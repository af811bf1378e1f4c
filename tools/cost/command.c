/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d cost`: a reference first, then each method for as long as its share of time lasts. */
#include <math.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/scene.h"
#include "cost/cost.h"
#include "output/clock.h"
#include "output/complain.h"

/* A row that is cut off is not missed, unless it is the first one. */
static int tell_late(const cost *c, const cost_method *m, size_t first) {
  if (c->count == first)
    complain(
        c->options->scene,
        "%s has no row: its share of the time, %.3g s, does not suffice for one; give more "
        "by --max-seconds",
        cost_method_name(m), c->share);
  return EXIT_DONE;
}

static int run_method(cost *c, const cost_method *m) {
  const size_t first = c->count;
  *c->message = '\0';
  c->line.late = 0;
  c->line.deadline = clock_seconds() + c->share;
  const hr2d_status status = m->run(c, m);
  progress_clear(&c->line);
  if (!c->quiet && m->most_links) cost_print_exponent(c, m);
  if (!c->quiet && !m->most_links) cost_print_rows(c, first);
  if (status == HR2D_STOPPED && c->line.late) return tell_late(c, m, first);
  if (status == HR2D_STOPPED) return complain_call(c->options->scene, "", status);
  return status ? complain(c->options->scene, "%s: %s", cost_method_name(m),
                           *c->message ? c->message : hr2d_strerror(status))
                : EXIT_DONE;
}

/* If a method fails, the others still run. */
static int run_methods(cost *c) {
  int status = 0;
  c->share =
      c->options->exponents ? INFINITY : c->options->most_seconds / (double)c->method_count;
  c->line.steps = (unsigned)c->method_count;
  for (size_t k = 0; k < c->method_count && status != EXIT_INTERRUPTED; k++) {
    const int code = run_method(c, &c->methods[k]);
    if (code) status = code;
    c->line.step++;
  }
  c->incomplete = status != 0;
  return status;
}

static int report(const cost *c) {
  const options *o = c->options;
  int status = 0;
  progress_end();
  if (!c->quiet && !o->predict && !o->exponents) cost_print_fits(c);
  if (o->csv) status = cost_write_csv(c);
  if (o->json && !status) status = cost_write_json(c);
  if (o->plot && !status) status = cost_draw(c);
  return status;
}

static int measure(cost *c) {
  int status = c->options->exponents ? 0 : cost_predict(c);
  if (!status && !c->options->predict) status = cost_make_reference(c);
  if (status) return status;
  if (!c->quiet) cost_print_head(c);
  if (!c->options->predict) status = run_methods(c);
  return complain_join(status, report(c));
}

int cost_command(const options *o) {
  hr2d_scene *scene = NULL;
  cost c = {.options = o, .quiet = !options_want_table(o)};
  int status = options_check_outputs(o);
  if (!status) status = scene_load(o, o->force, &scene, &c.cuts);
  if (status) return status;
  if (scene_has_gas(scene)) {
    status = scene_complain(o, scene, HR2D_EUNSUPPORTED);
    hr2d_scene_destroy(scene);
    return status;
  }
  c.scene = scene;
  cost_choose_methods(&c);
  progress_start(&c.line, o->quiet);
  status = measure(&c);
  free(c.rows);
  free(c.average);
  hr2d_scene_destroy(scene);
  return status;
}
