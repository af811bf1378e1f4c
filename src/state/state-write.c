/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the state of a solve. */
#include <string.h>

#include "hierarchy/hierarchy-impl.h"
#include "links/linkset-impl.h"
#include "scene/emissivity.h"
#include "scene/frozen-temperatures.h"
#include "solution/solution-impl.h"
#include "state/byte-stream.h"
#include "state/state-impl.h"

/* Where patches of given flux have temperatures, E and ρ do not tell their spectra. */
static hr2di_hash add_spectra(hr2di_hash hash, const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->spectrum.wavelengths; k++)
    hash = hr2di_hash_double(hash, scene->spectrum.wavelength[k]);
  for (size_t k = 0; k < scene->patches; k++)
    for (size_t b = 0; b < scene->bands && hr2di_scene_has_flux(scene, k); b++)
      hash = hr2di_hash_double(hash, hr2d_scene_emissivity(scene, k, b));
  return hash;
}

/* Images are patches, too.  That they are images, and how much they count, is told here. */
static hr2di_hash add_images(hr2di_hash hash, const hr2di_symmetry *s) {
  hash = hr2di_hash_word(hash, s->cell);
  for (size_t k = 0; k < s->motions; k++) {
    hash = hr2di_hash_word(hash, s->motion[k].inverse);
    hash = hr2di_hash_double(hash, s->motion[k].weight);
  }
  return hash;
}

uint64_t hr2di_state_scene(const hr2d_scene *scene, hr2di_watch *watch) {
  hr2di_hash hash = hr2di_hash_word(HR2DI_HASH_INIT, scene->patches);
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++)
    if (e != HR2D_EFFECT_PANES || scene->other_side) /* scenes without panes keep their hash */
      hash = hr2di_hash_word(hash, (uint64_t)scene->effect[e].on);
  for (size_t k = 0; k < scene->patches; k++) {
    if (hr2di_watch_work(watch, 1 + scene->bands / 2)) break;
    const hr2d_segment s = scene->patch[k].given;
    const double coordinate[] = {s.a.x, s.a.y, s.b.x, s.b.y};
    for (int c = 0; c < 4; c++) hash = hr2di_hash_double(hash, coordinate[c]);
    for (size_t band = 0; band < scene->bands; band++) {
      hash = hr2di_hash_double(hash, hr2d_scene_emission(scene, k, band));
      hash = hr2di_hash_double(hash, hr2d_scene_reflectance(scene, k, band));
      if (scene->other_side)
        hash = hr2di_hash_double(hash, hr2d_scene_transmittance(scene, k, band));
    }
  }
  for (size_t band = 0; band < scene->bands; band++)
    hash = hr2di_hash_double(hash, hr2d_scene_background(scene, band));
  for (size_t k = 0; k < scene->sun_bands; k++) {
    const hr2d_sun sun = scene->sun[k];
    hash = hr2di_hash_double(hash, sun.direction.x);
    hash = hr2di_hash_double(hash, sun.direction.y);
    hash = hr2di_hash_double(hash, sun.irradiance);
  }
  for (size_t k = 0; k < scene->sky.pieces; k++) {
    hash = hr2di_hash_double(hash, scene->sky.piece[k].from);
    hash = hr2di_hash_double(hash, scene->sky.piece[k].to);
    const size_t values = scene->sky.terms * scene->sky.bands;
    for (size_t m = 0; m < values; m++)
      hash = hr2di_hash_double(hash, scene->sky.value[k * values + m]);
    if (scene->sky.goes_on) hash = hr2di_hash_double(hash, scene->sky.goes_on[k]);
  }
  if (scene->symmetry.motion) hash = add_images(hash, &scene->symmetry);
  return hr2di_scene_is_unsettled(scene) ? add_spectra(hash, scene) : hash;
}

uint64_t hr2di_state_method(const hr2d_linkset *links) {
  const char *oracle = links->oracle.name, *policy = links->policy.name;
  const hr2di_hash hash = hr2di_hash_bytes(HR2DI_HASH_INIT, oracle, strlen(oracle) + 1);
  return hr2di_hash_bytes(hash, policy, strlen(policy));
}

void hr2di_state_counters(hr2d_refine_counts *counts, hr2d_solve_work *work,
                          uint64_t *counter[HR2DI_STATE_COUNTERS]) {
  uint64_t *all[HR2DI_STATE_COUNTERS] = {&counts->elements,
                                         &counts->leaves,
                                         &counts->links,
                                         &counts->limited_links,
                                         &counts->oracle_calls,
                                         &counts->facing_tests,
                                         &counts->visibility_tests,
                                         &counts->exchange_areas,
                                         &counts->partial_links,
                                         &counts->blocked_pairs,
                                         &counts->dark_pairs,
                                         &work->gathers,
                                         &work->iterations,
                                         &work->row_sums,
                                         &work->background_rows,
                                         &work->kernels};
  memcpy(counter, all, sizeof all);
}

static void put_head(hr2di_writer *w, const hr2d_solution *s, hr2di_watch *watch) {
  const hr2d_linkset *links = s->links;
  hr2d_refine_counts counts = links->counts;
  hr2d_solve_work work = s->work;
  uint64_t *counter[HR2DI_STATE_COUNTERS];
  const uint64_t head[] = {hr2di_state_scene(s->hierarchy->scene, watch),
                           hr2di_state_method(links),
                           s->hierarchy->elements,
                           links->store.count,
                           s->elements,
                           s->order,
                           s->bands,
                           (uint64_t)links->directed};
  hr2di_writer_text(w, HR2DI_STATE_TITLE, HR2DI_STATE_TITLE_BYTES);
  for (size_t k = 0; k < sizeof head / sizeof *head; k++) hr2di_writer_word(w, head[k]);
  hr2di_writer_double(w, links->epsilon);
  hr2di_writer_double(w, s->residual);
  hr2di_state_counters(&counts, &work, counter);
  for (int k = 0; k < HR2DI_STATE_COUNTERS; k++) hr2di_writer_word(w, *counter[k]);
}

/* Items between two declarations of work. */
enum { BATCH = 256 };

/* Asks the watch before some items of `bytes` each; its status becomes that of the writer. */
static void declare(hr2di_writer *w, hr2di_watch *watch, uint64_t item, size_t bytes) {
  if (item % BATCH == 0 && !w->status) w->status = hr2di_watch_work(watch, BATCH * bytes / 64);
}

static void put_links(hr2di_writer *w, const hr2di_store *store, hr2di_watch *watch) {
  for (uint64_t k = 0; k < store->count && !w->status; k++) {
    declare(w, watch, k, 16);
    const hr2d_link *link = hr2di_store_at(store, k);
    hr2di_writer_half(w, link->pair.first);
    hr2di_writer_half(w, link->pair.second);
    hr2di_writer_double(w, link->exchange_area);
  }
}

static void put_fields(hr2di_writer *w, const hr2d_solution *s, hr2di_watch *watch) {
  const size_t count = s->elements * s->order * s->bands;
  for (size_t band = 0; band < s->bands; band++) {
    const hr2d_power *p = &s->power[band];
    hr2di_writer_double(w, p->emitted);
    hr2di_writer_double(w, p->received);
    hr2di_writer_double(w, p->absorbed);
    hr2di_writer_double(w, p->escaped);
    if (s->power_cut_off) hr2di_writer_double(w, s->power_cut_off[band]);
  }
  for (size_t k = 0; k < 2 * count && !w->status; k++) {
    declare(w, watch, k, 8);
    hr2di_writer_double(w, k < count ? s->value[k] : s->irradiance[k - count]);
  }
}

static void put_temperatures(hr2di_writer *w, const hr2d_solution *s, hr2di_watch *watch) {
  for (size_t k = 0; s->own_scene && k < hr2di_scene_cell(s->own_scene) && !w->status; k++) {
    declare(w, watch, k, 8);
    if (hr2di_scene_has_flux(s->own_scene, k))
      hr2di_writer_double(w, s->own_scene->found[k].radiance);
  }
}

/* A solution to a target is no stage, nor is one of an operator, and a function of emissivity
   cannot be compared. */
static int has_state(const hr2d_solution *s) {
  if (s->own_links || s->kept) return 0;
  for (size_t k = 0; s->own_scene && k < s->own_scene->patches; k++)
    if (hr2di_emissivity_depends(s->hierarchy->scene, k)) return 0;
  return 1;
}

hr2d_status hr2d_state_write(const hr2d_solution *solution, hr2d_write_fn write, void *ctx) {
  if (!solution || !write) return HR2D_EINVAL;
  const hr2d_hierarchy *h = solution->hierarchy;
  hr2di_writer w;
  if (!has_state(solution) || hr2di_scene_has_gas(h->scene)) return HR2D_EUNSUPPORTED;
  hr2di_watch watch;
  hr2di_scene_watch(h->scene, &watch, NULL, NULL, "state");
  hr2di_writer_init(&w, write, ctx);
  put_head(&w, solution, &watch);
  if (!w.status) w.status = watch.status;
  for (size_t k = h->scene->patches; k < h->elements && !w.status; k += 2) {
    declare(&w, &watch, k / 2, 4);
    hr2di_writer_half(&w, h->parent[k]);
  }
  put_links(&w, &solution->links->store, &watch);
  put_fields(&w, solution, &watch);
  put_temperatures(&w, solution, &watch);
  return hr2di_writer_end(&w);
}
