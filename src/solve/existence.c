/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Light that neither is absorbed nor escapes has nowhere to go: in a component of
   patches linked to each other, closed and with ρ = 1 throughout, ∫(E + ρH − B) = 0
   forces ∫E = 0.  Where E is the flux of patches with thermal properties, ∫E = 0 leaves B
   unknown by a constant: temperatures have no level. */
#include "solve/existence.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/components.h"
#include "links/patch-defect.h"
#include "scene/relit-scene.h"

typedef struct exchange {
  hr2di_components components;
  uint32_t *without_panes; /* their parents, as long as nothing passes through panes */
  hr2di_sum *defect;       /* per patch */
  hr2di_sum *escape;       /* per component the sum of these */
  double *length;
} exchange;

/* Subtracts from the defect of each patch what links of clusters exchange for it. */
static hr2d_status add_clusters(const hr2d_linkset *links, exchange *e, hr2di_watch *watch) {
  const size_t n = links->hierarchy->scene->patches;
  if (!links->roots.clusters) return HR2D_OK;
  double *unit = hr2di_alloc_zero(&links->alloc, 2 * n, sizeof *unit);
  if (!unit) return HR2D_ENOMEM;
  double *power = unit + n;
  for (size_t k = 0; k < n; k++) unit[k] = 1;
  const hr2di_cluster_gather how = {
      .order = 1, .bands = 1, .share = links->share, .threads = 1, .watch = watch};
  const hr2d_status status = hr2di_clusters_gather(links->roots.clusters, &how, unit, power);
  for (size_t k = 0; k < n; k++) hr2di_sum_add(&e->defect[k], -power[k]);
  hr2di_alloc_free(&links->alloc, unit);
  return status;
}

/* Sums over the components of a band, or for SIZE_MAX of all bands together. */
static void sum_up(const hr2d_scene *scene, exchange *e, size_t band) {
  memcpy(e->components.parent, e->without_panes, e->components.count * sizeof(uint32_t));
  hr2di_components_join_panes(&e->components, scene, band);
  for (size_t k = 0; k < scene->patches; k++) {
    e->length[k] = scene->patch[k].length;
    e->escape[k] = e->defect[k];
  }
  for (size_t k = 0; k < scene->patches; k++) {
    const size_t root = hr2di_component(&e->components, k);
    if (root == k) continue;
    hr2di_sum_add(&e->escape[root], hr2di_sum_total(&e->escape[k]));
    e->length[root] += e->length[k];
  }
}

static hr2d_status refuse(hr2d_linkset *links, const hr2d_scene *scene, size_t patch,
                          size_t band) {
  const hr2di_label label = hr2di_patch_label(scene, patch);
  if (hr2di_scene_has_flux(scene, patch))
    return hr2di_message_fail(
        &links->message, HR2D_ENO_SOLUTION,
        "no solution: %s is in a closed part of the scene where no patch has a given "
        "temperature, so that given fluxes cannot tell how hot it is",
        label.text);
  return hr2di_message_fail(&links->message, HR2D_ENO_SOLUTION,
                            "no solution in band %zu: %s emits into a closed part of the scene "
                            "where every reflectance is 1, so that light has nowhere to go",
                            hr2di_scene_known_band(scene, band), label.text);
}

/* Exchange over links of clusters is known to their accuracy only. */
static double closed_below(const hr2d_linkset *links) {
  const double by_clusters = links->roots.clusters ? 10 * links->roots.accuracy : 0;
  return fmax(HR2DI_DEFECT_NO_ESCAPE, by_clusters);
}

/* Checks one band: no patch may emit in a component that is closed and absorbs nothing. */
static hr2d_status check_band(hr2d_linkset *links, const hr2d_scene *scene, exchange *e,
                              size_t band, unsigned char *absorbs) {
  const double closed = closed_below(links);
  if (band == 0 || scene->other_side) sum_up(scene, e, band);
  for (size_t k = 0; k < scene->patches; k++) absorbs[k] = 0;
  for (size_t k = 0; k < scene->patches; k++)
    if (hr2di_scene_absorptance(scene, k, band) > 0)
      absorbs[hr2di_component(&e->components, k)] = 1;
  for (size_t k = 0; k < scene->patches; k++) {
    const size_t root = hr2di_component(&e->components, k);
    if (absorbs[root] || hr2di_sum_total(&e->escape[root]) > closed * e->length[root] ||
        (!(hr2d_scene_emission(scene, k, band) > 0) && !hr2di_scene_has_flux(scene, k)))
      continue;
    return refuse(links, scene, k, band);
  }
  return HR2D_OK;
}

/* Patches of given flux in several bands give in one band what they absorb in another. */
static hr2d_status check_heat(hr2d_linkset *links, const hr2d_scene *scene, exchange *e,
                              unsigned char *absorbs) {
  if (scene->other_side) sum_up(scene, e, SIZE_MAX);
  for (size_t k = 0; k < scene->patches; k++) absorbs[k] = 0;
  for (size_t k = 0; k < scene->patches; k++)
    for (size_t band = 0; band < scene->bands; band++)
      if (hr2di_scene_absorptance(scene, k, band) > 0 && !hr2di_scene_has_flux(scene, k))
        absorbs[hr2di_component(&e->components, k)] = 1;
  for (size_t k = 0; k < scene->patches; k++) {
    const size_t root = hr2di_component(&e->components, k);
    if (!absorbs[root] && hr2di_scene_has_flux(scene, k) && hr2di_scene_lit(scene, k) &&
        !(hr2di_sum_total(&e->escape[root]) > closed_below(links) * e->length[root]))
      return refuse(links, scene, k, 0);
  }
  return HR2D_OK;
}

static int some_patch_absorbs_nothing(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->patches; k++)
    for (size_t band = 0; band < scene->bands; band++)
      if (!(hr2di_scene_absorptance(scene, k, band) > 0)) return 1;
  return 0;
}

static hr2d_status sum_exchange(const hr2d_linkset *links, exchange *e, hr2di_watch *watch) {
  const hr2d_scene *scene = links->hierarchy->scene;
  hr2d_status status = hr2di_components_init(&e->components, links, watch);
  if (!status) {
    e->without_panes =
        hr2di_alloc(&links->alloc, e->components.count, sizeof *e->without_panes);
    status = e->without_panes ? HR2D_OK : HR2D_ENOMEM;
  }
  if (!status)
    memcpy(e->without_panes, e->components.parent, e->components.count * sizeof(uint32_t));
  if (!status) status = hr2di_defect_sum(links, e->defect, watch);
  if (!status) status = add_clusters(links, e, watch);
  return status ? status : hr2di_watch_work(watch, scene->patches / 2);
}

/* Gas absorbs; if its heat is given, it keeps nothing. */
static hr2d_status check_gas(hr2d_linkset *links, const hr2d_scene *scene) {
  int absorbs = 0, sends = hr2di_scene_gas_emits(scene);
  if (!hr2di_scene_has_free_gas(scene)) return HR2D_OK;
  for (size_t k = 0; k < scene->gases.count; k++)
    absorbs |= !hr2di_scene_gas_is_free(scene, k) && hr2d_scene_absorption(scene, k, 0) > 0;
  for (size_t k = 0; k < scene->patches; k++) {
    absorbs |= hr2d_scene_reflectance(scene, k, 0) < 1;
    sends |= hr2d_scene_emission(scene, k, 0) != 0 ||
             hr2d_scene_heat(scene, k, NULL) == HR2D_HEAT_FLUX;
  }
  if (absorbs || !sends) return HR2D_OK;
  return hr2di_message_fail(
      &links->message, HR2D_ENO_SOLUTION,
      "no solution: every reflectance is 1, or a flux is given, and so is "
      "the heat of the gas, so that nothing tells how hot it is");
}

hr2d_status hr2di_existence_check(hr2d_linkset *links, const hr2d_scene *scene,
                                  hr2di_watch *watch) {
  const int heat = scene->found != NULL;
  if (hr2di_scene_has_gas(scene)) return check_gas(links, scene);
  if (!heat && !some_patch_absorbs_nothing(scene)) return HR2D_OK;
  const hr2d_allocator *alloc = &links->alloc;
  exchange e = {.defect = hr2di_alloc(alloc, scene->patches, sizeof *e.defect),
                .escape = hr2di_alloc(alloc, scene->patches, sizeof *e.escape),
                .length = hr2di_alloc(alloc, scene->patches, sizeof *e.length)};
  e.components.alloc = *alloc;
  unsigned char *absorbs = hr2di_alloc(alloc, scene->patches, 1);
  hr2d_status status = HR2D_ENOMEM;
  if (e.defect && e.escape && e.length && absorbs) status = sum_exchange(links, &e, watch);
  if (status)
    hr2di_message_fail(&links->message, status, "%s",
                       watch->refused ? hr2d_strerror(status) : "out of memory for the solve");
  for (size_t band = 0; band < scene->bands && !status; band++)
    status = check_band(links, scene, &e, band, absorbs);
  if (!status && heat) status = check_heat(links, scene, &e, absorbs);
  hr2di_components_clear(&e.components);
  hr2di_alloc_free(alloc, e.without_panes);
  hr2di_alloc_free(alloc, e.defect);
  hr2di_alloc_free(alloc, e.escape);
  hr2di_alloc_free(alloc, e.length);
  hr2di_alloc_free(alloc, absorbs);
  return status;
}
