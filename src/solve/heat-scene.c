/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/heat-scene.h"

#include <math.h>

#include "links/linkset-impl.h"
#include "solution/solution-impl.h"

/* Of the heat of a patch: it is at 0 K. */
#define ROUND 1e-9

/* What the hottest patch emits, or the largest flux if nothing else gives heat. */
static double brightest(const hr2d_scene *scene) {
  double max = 0, heat = 0;
  for (size_t b = 0; b < scene->bands; b++) max += hr2d_scene_background(scene, b);
  for (size_t k = 0; k < scene->patches; k++) {
    double sum = 0, value;
    const hr2d_heat given = hr2d_scene_heat(scene, k, &value);
    for (size_t b = 0; b < scene->bands && given == HR2D_HEAT_NONE; b++)
      sum += hr2d_scene_emission(scene, k, b);
    max = fmax(max, given == HR2D_HEAT_TEMPERATURE ? hr2d_black_body(value) : sum);
    if (given == HR2D_HEAT_FLUX) heat = fmax(heat, fabs(value));
  }
  return max > 0 ? max : heat;
}

hr2d_status hr2di_heat_scene_create(const hr2d_scene *scene, const hr2d_solution *start,
                                    hr2d_progress_fn progress, void *progress_ctx,
                                    hr2d_scene **frozen) {
  hr2d_scene *made = NULL;
  const hr2di_found *former = start && start->own_scene ? start->own_scene->found : NULL;
  hr2d_status status = hr2di_frozen_create(scene, &made);
  if (status) return status;
  const double max = brightest(scene);
  double flux;
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, progress, progress_ctx, "solve");
  for (size_t k = 0; k < hr2di_scene_cell(scene) && !status; k++) {
    if (!hr2di_scene_has_flux(scene, k)) continue;
    hr2d_scene_heat(scene, k, &flux);
    const double bright = hr2di_scene_lit(scene, k) ? max + fmax(flux, 0) : 0;
    status = hr2di_watch_work(&watch, 10 * scene->bands);
    if (!status) status = hr2di_frozen_set(made, k, former ? former[k].radiance : bright);
  }
  if (status)
    hr2di_relit_destroy(made);
  else
    *frozen = made;
  return status;
}

const char *hr2di_heat_scene_failure(hr2d_status status) {
  return status == HR2D_ECALLBACK
             ? "a function of emissivity gives a value that is not in (0,1]"
             : hr2d_strerror(status);
}

hr2d_status hr2di_heat_scene_check(hr2di_heat_balance *h) {
  size_t min = 0;
  for (size_t k = 0; k < h->count; k++) {
    if (h->radiance[k] < h->radiance[min]) min = k;
    for (int m = 0; hr2di_heat_side(h, k, m) != HR2DI_NO_BACK; m++)
      if (h->radiance[k] < 0 && h->radiance[k] >= -ROUND * h->size[k])
        hr2di_frozen_set(h->scene, h->patch[hr2di_heat_side(h, k, m)], 0);
  }
  if (!h->count || h->radiance[min] >= -ROUND * h->size[min]) return HR2D_OK;
  return hr2di_message_fail(
      &h->eq.links->message, HR2D_ENO_SOLUTION,
      "no solution: %.80s cannot lose so much heat: it would have to be colder than 0 K",
      hr2di_patch_label(h->scene, h->patch[min]).text);
}
