/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves with elements on every rank, and links and blocks shared out: to a target, at an order
   above 1, or where a result needs all elements.  It is the run of `hr2d solve`, made by all
   ranks; rank 0 reports. */
#include "../constants.h"
#include "output/complain.h"
#include "program.h"
#include "solve/solve.h"

int job_follows_brightness(const options *o) {
  return o->oracle->flags & HR2D_ORACLE_NEEDS_BRIGHTNESS;
}

int job_is_whole(const options *o, const hr2d_scene *scene) {
  return job_follows_brightness(o) || options_targeted(o) || o->order > 1 || o->at.count > 0 ||
         o->csv || o->vtk || o->draw || o->tiles || o->watch || o->error || o->enclose > 0 ||
         hr2dpi_has_spectra(scene) || hr2dpi_has_daylight(scene);
}

int job_solve_whole(job *j) {
  hr2d_share *share;
  if (j->options->state && hr2dpi_has_spectra(j->scene))
    return complain(j->options->scene,
                    "a state of ranks cannot keep temperatures of patches of given flux in "
                    "several bands: solve without --state, or by hr2d solve");
  const PetscErrorCode code = hr2dp_share_create(PETSC_COMM_WORLD, &share);
  if (code) return job_complain(j, code);
  const run_shares shares = {share, stages_load, stages_save};
  const int status = solve_scene(j->options, j->scene, j->cuts, j->start, &shares);
  (void)hr2dp_share_destroy(&share);
  return job_agree(status);
}
