/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs to a target error or a time budget; the errors of other runs; B and H at points. */
#include <math.h>

#include "cli/scene.h"
#include "output/clock.h"
#include "output/complain.h"
#include "run/run.h"

/* Up to this many patches the error is measured by default. */
enum { FEW_PATCHES = 200 };

static hr2d_target make_target(const run *r, progress *p) {
  const options *o = r->options;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = o->target_error > 0 ? o->target_error : HR2D_SMALLEST_ERROR;
  target.norm = o->norm;
  target.points = options_want_points(o);
  target.important = run_important(r);
  target.important_count = o->importance.count;
  target.floor = o->floor;
  target.no_error = o->no_error;
  target.threads = options_threads(o);
  target.max_elements = o->max_elements;
  target.max_links = o->max_links;
  target.progress = progress_show;
  target.progress_ctx = p;
  target.share = r->share;
  /* The scene was read within the budget.  What is left must not be 0, which means no limit. */
  if (o->time_budget > 0)
    target.seconds = fmax(1e-3, o->time_budget - (clock_seconds() - r->start));
  return target;
}

/* Reports the error that was reached, of B or of H, in the norm of the target. */
static int complain_of_error(const run *r) {
  const hr2d_account *a = &r->account;
  const int sup = r->options->norm == HR2D_NORM_SUP;
  const hr2d_error *b = sup ? &a->sup : &a->average;
  const hr2d_error *h = sup ? &a->irradiance_sup : &a->irradiance;
  const char *reason = *a->reason ? a->reason : "the target error was not reached";
  if (!isfinite(b->estimate)) return complain(r->options->scene, "%s", reason);
  return complain(r->options->scene, "%s; the error is about %.1e, at most %.1e", reason,
                  fmax(b->estimate, h->estimate), fmax(b->bound, h->bound));
}

int run_assumes_kinks(const run *r) {
  return options_targeted(r->options) && isfinite(r->account.average.bound) &&
         (hr2d_scene_effect(r->scene, HR2D_EFFECT_OCCLUSION, NULL) ||
          hr2d_scene_effect(r->scene, HR2D_EFFECT_FACING, NULL) ||
          hr2d_scene_effect(r->scene, HR2D_EFFECT_BACKGROUND, NULL));
}

/* Errors that nobody asked for are not known. */
static void forget_errors(hr2d_account *a) {
  a->average = a->sup = a->irradiance = a->irradiance_sup = (hr2d_error){NAN, NAN};
}

int run_target(run *r, progress *p) {
  const hr2d_target target = make_target(r, p);
  const hr2d_status status = hr2d_solve_to(r->scene, &target, &r->solution, &r->account);
  progress_clear(p);
  r->inaccurate = status == HR2D_EACCURACY && r->solution;
  if (status == HR2D_EUNSUPPORTED) return scene_complain(r->options, r->scene, status);
  if (status && status != HR2D_EACCURACY)
    return complain_call(r->options->scene, r->account.reason, status);
  if (!r->solution) return complain_call(r->options->scene, r->account.reason, status);
  if (r->options->no_error) forget_errors(&r->account);
  r->links = hr2d_solution_links(r->solution);
  r->hierarchy = hr2d_linkset_hierarchy(r->links);
  r->work = hr2d_solution_work(r->solution);
  r->work.kernels = r->account.kernels;
  return r->inaccurate ? complain_of_error(r) : EXIT_DONE;
}

/* The bound includes the error of the finer solution that this one is compared with.  The finer
   one is improved until its error is small against the difference. */
static hr2d_status compare(run *r, progress *p) {
  hr2d_target how = HR2D_TARGET_INIT;
  hr2d_account *a = &r->account;
  how.floor = r->options->floor;
  how.threads = options_threads(r->options);
  how.progress = progress_show;
  how.progress_ctx = p;
  how.share = r->share;
  how.points = options_want_points(r->options);
  for (how.error = 1e-6; how.error > 0.5e-12; how.error *= 1e-3) {
    hr2d_account found;
    const hr2d_status status = hr2d_solution_account(r->solution, &how, &found);
    if (status) return status;
    a->average = found.average;
    a->sup = found.sup;
    a->irradiance = found.irradiance;
    a->irradiance_sup = found.irradiance_sup;
    if (a->average.estimate > 0.5 * a->average.bound) break;
  }
  return HR2D_OK;
}

int run_error(run *r, progress *p) {
  const options *o = r->options;
  forget_errors(&r->account);
  if (o->no_error || (!o->error && hr2d_scene_patches(r->scene) > FEW_PATCHES)) return 0;
  const double start = clock_seconds();
  const hr2d_status status = compare(r, p);
  r->account.error_seconds = clock_seconds() - start;
  progress_clear(p);
  if (!status) return EXIT_DONE;
  if (status == HR2D_STOPPED) return complain_call(o->scene, "", status);
  r->inaccurate = 1;
  return complain(o->scene, "the error is not known: %s", hr2d_strerror(status));
}

int run_enclose(run *r) {
  const options *o = r->options;
  progress p;
  hr2d_enclose_options how = HR2D_ENCLOSE_OPTIONS_INIT;
  if (!(o->enclose > 0) || !run_is_first(r)) return EXIT_DONE;
  how.gap = o->enclose;
  how.max_links = o->max_links;
  how.progress = progress_show;
  how.progress_ctx = &p;
  progress_start(&p, o->quiet);
  const hr2d_status status = hr2d_enclose(r->scene, &how, &r->enclosure, &r->enclosed);
  progress_clear(&p);
  if (!status) return EXIT_DONE;
  if (!*r->enclosed.reason) return scene_complain(o, r->scene, status);
  return complain(o->scene, "--enclose: %s", r->enclosed.reason);
}

void run_enclosed_errors(const run *r, double *average, double *irradiance) {
  *average = *irradiance = INFINITY;
  if (r->enclosure)
    hr2d_enclosure_error(r->enclosure, r->solution, r->options->floor, average, irradiance);
}

int run_gathers(const run *r) {
  return r->account.order > 1 || options_targeted(r->options);
}

int run_point(const run *r, size_t patch, double t, double *b, double *h) {
  const size_t bands = hr2d_scene_bands(r->scene);
  const int gather = run_gathers(r);
  if (gather && (hr2d_solution_gather(r->solution, patch, &t, 1, b) ||
                 hr2d_solution_gather_irradiance(r->solution, patch, &t, 1, h)))
    return complain_memory();
  for (size_t band = 0; band < bands && !gather; band++) {
    b[band] = hr2d_solution_at(r->solution, patch, t, band);
    h[band] = hr2d_solution_irradiance_at(r->solution, patch, t, band);
  }
  return EXIT_DONE;
}

int run_place(const run *r, size_t k, double *b, double *h) {
  return run_point(r, r->places[k], r->options->at.items[k].t, b, h);
}
