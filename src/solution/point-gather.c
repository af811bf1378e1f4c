/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One more gather at single points: H' = ∫ G V B_h with G and V exact, and B' = E + ρH'. */
#include "base/alloc.h"
#include "geometry/predicates.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/panes.h"
#include "solution/gatherer.h"

static hr2d_status gather_at(hr2di_gatherer *g, size_t patch, double t, double *irradiance) {
  double wedge, others;
  int closed;
  const double step = HR2DI_TOUCH / g->solution->hierarchy->scene->patch[patch].length;
  const double at = t <= step ? 0 : t >= 1 - step ? 1 : t;
  const hr2d_status status = hr2di_gatherer_close_wedge(g, patch, at, irradiance, &closed);
  return status || closed ? status
                          : hr2di_gatherer_look(g, patch, t, NULL, irradiance, &wedge, &others);
}

hr2d_status hr2di_solution_gather_irradiance(const hr2d_solution *solution, size_t patch,
                                             const double *t, size_t count, double *value,
                                             hr2di_watch *watch) {
  hr2di_gatherer g;
  hr2d_status status = hr2di_gatherer_init(&g, solution, watch);
  for (size_t k = 0; k < count && !status; k++) {
    if (watch) watch->report.fraction = (double)k / (double)count;
    status = gather_at(&g, patch, t[k], value + k * solution->bands);
  }
  hr2di_gatherer_clear(&g);
  return status;
}

hr2d_status hr2di_solution_gather_past(const hr2d_solution *solution, size_t patch,
                                       const double *t, size_t count, double *past,
                                       double *ends, hr2di_watch *watch) {
  hr2di_gatherer g;
  hr2d_status status = hr2di_gatherer_init(&g, solution, watch);
  for (size_t k = 0; k < count && !status; k++)
    status = hr2di_gatherer_look_past(&g, patch, t[k],
                                      past + k * HR2DI_GATHER_PAST * solution->bands, ends + k);
  hr2di_gatherer_clear(&g);
  return status;
}

/* Adds what passes a pane from the other side to values at points of a patch. */
static hr2d_status add_passed(const hr2d_solution *solution, size_t patch, const double *t,
                              size_t count, double *value, hr2di_watch *watch) {
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  const hr2d_allocator *alloc = &solution->alloc;
  if (!hr2di_pane_is(scene, patch)) return HR2D_OK;
  double *place = hr2di_alloc(alloc, count, sizeof *place);
  double *other = hr2di_alloc(alloc, count, solution->bands * sizeof *other);
  hr2d_status status = place && other ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < count && !status; k++) place[k] = 1 - t[k];
  if (!status)
    status = hr2di_solution_gather_irradiance(solution, hr2di_scene_other_side(scene, patch),
                                              place, count, other, watch);
  for (size_t k = 0; k < count * solution->bands && !status; k++)
    value[k] += hr2d_scene_transmittance(scene, patch, k % solution->bands) * other[k];
  hr2di_alloc_free(alloc, place);
  hr2di_alloc_free(alloc, other);
  return status;
}

hr2d_status hr2di_solution_gather(const hr2d_solution *solution, size_t patch, const double *t,
                                  size_t count, double *value, hr2di_watch *watch) {
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  const hr2d_status status =
      hr2di_solution_gather_irradiance(solution, patch, t, count, value, watch);
  for (size_t k = 0; k < count * solution->bands && !status; k++) {
    const size_t band = k % solution->bands;
    value[k] = hr2d_scene_emission(scene, patch, band) +
               hr2d_scene_reflectance(scene, patch, band) * value[k];
  }
  return status ? status : add_passed(solution, patch, t, count, value, watch);
}

/* The callback of the scene is asked between the points. */
static void watch_gather(const hr2d_solution *solution, hr2di_watch *watch) {
  hr2di_scene_watch(solution->hierarchy->scene, watch, NULL, NULL, "gather");
}

hr2d_status hr2d_solution_gather(const hr2d_solution *solution, size_t patch, const double *t,
                                 size_t count, double *value) {
  if (!hr2di_solution_has(solution, patch, 0) || (count && (!t || !value))) return HR2D_EINVAL;
  hr2di_watch watch;
  watch_gather(solution, &watch);
  return hr2di_solution_gather(solution, patch, t, count, value, &watch);
}

hr2d_status hr2d_solution_gather_irradiance(const hr2d_solution *solution, size_t patch,
                                            const double *t, size_t count, double *value) {
  if (!hr2di_solution_has(solution, patch, 0) || (count && (!t || !value))) return HR2D_EINVAL;
  hr2di_watch watch;
  watch_gather(solution, &watch);
  return hr2di_solution_gather_irradiance(solution, patch, t, count, value, &watch);
}

hr2d_status hr2d_solution_gather_net_flux(const hr2d_solution *solution, size_t patch,
                                          const double *t, size_t count, double *value) {
  if (!hr2di_solution_has(solution, patch, 0) || (count && (!t || !value))) return HR2D_EINVAL;
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  hr2di_watch watch;
  watch_gather(solution, &watch);
  const hr2d_status status =
      hr2di_solution_gather_irradiance(solution, patch, t, count, value, &watch);
  for (size_t k = 0; k < count * solution->bands && !status; k++) {
    const size_t band = k % solution->bands;
    value[k] = hr2d_scene_emission(scene, patch, band) +
               (hr2d_scene_reflectance(scene, patch, band) - 1) * value[k];
  }
  return status ? status : add_passed(solution, patch, t, count, value, &watch);
}
