/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference, and predictions. */
#include <stdlib.h>

#include "cost/cost.h"
#include "output/clock.h"
#include "output/complain.h"

/* Well below the errors of all methods but the automatic ones. */
#define REFERENCE_ERROR 1e-14

double cost_prediction_target(int k) {
  static const double target[COST_PREDICTIONS] = {1e-3, 1e-6, 1e-9, 1e-12};
  return target[k];
}

static hr2d_target make_target(cost *c, double error) {
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = error;
  target.threads = options_threads(c->options);
  target.progress = progress_show;
  target.progress_ctx = &c->line;
  return target;
}

/* If 1e-14 is out of reach, the best solution that doubles and time allow is used.  It may take
   as long as all methods together. */
int cost_make_reference(cost *c) {
  const size_t patches = hr2d_scene_patches(c->scene), bands = hr2d_scene_bands(c->scene);
  hr2d_target target = make_target(c, REFERENCE_ERROR);
  hr2d_solution *solution = NULL;
  target.seconds = c->options->most_seconds;
  const hr2d_status status = hr2d_solve_to(c->scene, &target, &solution, &c->reference);
  progress_clear(&c->line);
  if (status && status != HR2D_EACCURACY) return complain_call(c->options->scene, "", status);
  if (!solution) return complain(c->options->scene, "the time was too short for a reference");
  c->average = calloc(patches, bands * sizeof *c->average);
  for (size_t k = 0; c->average && k < patches * bands; k++)
    c->average[k] = hr2d_solution_average(solution, k / bands, k % bands);
  hr2d_solution_destroy(solution);
  return c->average ? EXIT_DONE : complain_memory();
}

/* Without --predict they end after a tenth of the time, so that expensive ones are left out. */
int cost_predict(cost *c) {
  const double start = clock_seconds();
  for (int k = 0; k < COST_PREDICTIONS; k++) {
    const hr2d_target target = make_target(c, cost_prediction_target(k));
    if (!c->options->predict && clock_seconds() - start > 0.1 * c->options->most_seconds) break;
    const hr2d_status status = hr2d_predict(c->scene, &target, &c->prediction[k]);
    progress_clear(&c->line);
    if (status) return complain_call(c->options->scene, "", status);
    c->predictions++;
  }
  return EXIT_DONE;
}
