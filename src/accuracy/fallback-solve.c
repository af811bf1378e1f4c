/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "accuracy/fallback-solve.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/clock.h"
#include "links/linkset-impl.h"
#include "scene/panes.h"
#include "solution/solution-impl.h"

/* Sweeps end when B changes by less than this part of the largest, or after MOST_SWEEPS. */
#define CHANGE 1e-6
enum { MOST_SWEEPS = 1000 };

typedef struct fallback {
  const hr2d_scene *scene;
  const hr2d_target *target;
  hr2di_fallback_solve_times until;
  int out_of_time;             /* the time for what is done now is up */
  double limit;                /* this time */
  hr2d_status progress_status; /* of the caller's callback */
  hr2d_linkset *links;
  size_t bands;
  double *row;        /* patches: ΣF */
  double *external;   /* patches × bands: irradiance from outside */
  hr2di_watch polled; /* with `limit` */
} fallback;

/* Ends what is done now when its time is up. */
static hr2d_status watch(void *ctx, const hr2d_progress *progress) {
  fallback *s = ctx;
  s->out_of_time = hr2di_clock_now() >= s->limit;
  if (s->out_of_time) return HR2D_STOPPED;
  if (s->target->progress)
    s->progress_status = s->target->progress(s->target->progress_ctx, progress);
  return s->progress_status;
}

/* A visitor that keeps the links that were made before the time was up. */
static hr2d_status keep(void *ctx, const hr2d_link *links, size_t count) {
  fallback *s = ctx;
  const double unit = hr2d_scene_unit(s->scene);
  hr2d_status status = HR2D_OK;
  if (s->target->max_bytes && 2 * hr2di_store_bytes(&s->links->store) > s->target->max_bytes)
    return HR2D_EMAX_BYTES;
  for (size_t k = 0; k < count && !status; k++) {
    const double area = links[k].exchange_area / unit;
    status = hr2di_store_add(&s->links->store, &s->links->alloc, &links[k].pair, &area, 1);
  }
  return status;
}

static hr2d_status make_sets(fallback *s, hr2di_graded *a) {
  hr2d_status status = hr2d_hierarchy_create(s->scene, &a->hierarchy);
  if (!status) status = hr2d_linkset_create(a->hierarchy, NULL, NULL, NULL, NULL, &a->links);
  s->links = a->links;
  return status;
}

static hr2d_status make_links(fallback *s) {
  hr2d_linkset *maker = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_refine_counts counts;
  options.max_level = HR2D_NO_SUBDIVISION;
  options.max_links = s->target->max_links;
  options.max_bytes = s->target->max_bytes / 2; /* the other half is for the links */
  options.progress = watch;
  options.progress_ctx = s;
  s->limit = s->until.factors;
  hr2d_status status = hr2d_linkset_create(s->links->hierarchy, NULL, NULL, NULL, NULL, &maker);
  if (!status) status = hr2d_refine_visit(maker, &options, keep, s, &counts);
  hr2d_linkset_destroy(maker);
  s->links->counts.links = s->links->store.count;
  if (status == HR2D_EMAX_LINKS || status == HR2D_EMAX_BYTES || s->out_of_time)
    status = HR2D_OK;
  return s->progress_status ? s->progress_status : status;
}

/* What an answer cannot do without: only the caller's callback ends it. */
static hr2d_status must(fallback *s, uint64_t units) {
  s->limit = HUGE_VAL;
  return hr2di_watch_work(&s->polled, units);
}

static hr2d_status sum_rows(fallback *s) {
  const hr2di_store *store = &s->links->store;
  const hr2d_element *patch = s->links->hierarchy->element;
  hr2d_status status = HR2D_OK;
  for (uint64_t k = 0; k < store->count && !status; k++) {
    const hr2d_link *link = hr2di_store_at(store, k);
    const size_t i = hr2di_scene_original(s->scene, link->pair.first),
                 j = hr2di_scene_original(s->scene, link->pair.second);
    if (k % 64 == 0) status = must(s, 8);
    s->row[i] += link->exchange_area / patch[i].length;
    s->row[j] += link->exchange_area / patch[j].length;
  }
  for (size_t k = hr2di_scene_cell(s->scene); k < s->scene->patches; k++)
    s->row[k] = s->row[hr2di_scene_original(s->scene, k)];
  return status;
}

/* The irradiance of a patch from the background, the sun, and the sky as if it saw the same
   part of each piece. */
static void find_external_of(const fallback *s, size_t patch, double *light) {
  const hr2d_scene *scene = s->scene;
  const double seen = fmax(1 - s->row[patch], 0);
  for (size_t m = 0; m < s->bands; m++) light[m] = hr2d_scene_background(scene, m);
  for (size_t k = 0; k < scene->sky.pieces; k++) {
    hr2di_sky_front front;
    hr2di_sky_front_of(scene, patch, k, &front);
    for (size_t l = 0; l < scene->sky.terms; l++)
      for (size_t m = 0; m < s->bands; m++)
        light[m] += front.full[l] * hr2di_sky_beyond(scene, k * scene->sky.terms + l, m);
  }
  for (size_t m = 0; m < s->bands; m++)
    light[m] = seen * light[m] + hr2d_scene_sunlight(scene, patch, m);
}

static hr2d_status find_external(fallback *s) {
  hr2d_status status = HR2D_OK;
  if (!s->scene->effect[HR2D_EFFECT_BACKGROUND].on) return HR2D_OK;
  for (size_t k = 0; k < s->scene->patches && !status; k++) {
    status = must(s, 1 + 4 * hr2di_sky_rows(&s->scene->sky) +
                         s->bands * (2 + hr2di_sky_rows(&s->scene->sky) / 16));
    if (!status) find_external_of(s, k, s->external + k * s->bands);
  }
  return status;
}

/* H = ΣFB + sL.  Returns HR2D_OK or the status of the watch. */
static hr2d_status gather(fallback *s, const double *b, double *h) {
  const hr2di_store *store = &s->links->store;
  const hr2d_element *patch = s->links->hierarchy->element;
  const size_t bands = s->bands;
  hr2d_status status = HR2D_OK;
  memcpy(h, s->external, s->scene->patches * bands * sizeof *h);
  for (uint64_t k = 0; k < store->count && !status; k++) {
    const hr2d_link *link = hr2di_store_at(store, k);
    const size_t i = hr2di_scene_original(s->scene, link->pair.first),
                 j = hr2di_scene_original(s->scene, link->pair.second);
    if (k % 64 == 0) status = hr2di_watch_work(&s->polled, 8 + 4 * bands);
    for (size_t m = 0; m < bands; m++) {
      h[i * bands + m] += link->exchange_area / patch[i].length * b[j * bands + m];
      h[j * bands + m] += link->exchange_area / patch[j].length * b[i * bands + m];
    }
  }
  for (size_t k = hr2di_scene_cell(s->scene); k < s->scene->patches; k++)
    for (size_t m = 0; m < bands; m++)
      h[k * bands + m] = h[hr2di_scene_original(s->scene, k) * bands + m];
  return status;
}

/* B = E + ρH.  *worst is the largest change, relative to the largest B of the band. */
static hr2d_status reflect(fallback *s, const double *h, double *b, double *worst) {
  hr2d_status status = HR2D_OK;
  *worst = 0;
  for (size_t m = 0; m < s->bands && !status; m++) {
    double change = 0, max = 0;
    for (size_t k = 0; k < s->scene->patches && !status; k++) {
      const size_t at = k * s->bands + m;
      const size_t other = hr2di_scene_other_side(s->scene, k) * s->bands + m;
      const double next =
          hr2d_scene_emission(s->scene, k, m) + hr2di_pane_sum(s->scene, k, m, h[at], h[other]);
      if (k % 64 == 0) status = must(s, 16);
      change = fmax(change, fabs(next - b[at]));
      max = fmax(max, fabs(next));
      b[at] = next;
    }
    if (change > 0) *worst = fmax(*worst, change / max);
  }
  return status;
}

/* Sweeps until B stands or the time is up.  A sweep that is not ended is not used. */
static hr2d_status sweep(fallback *s, hr2d_solution *made, double *next) {
  const size_t values = s->scene->patches * s->bands;
  hr2d_status status = HR2D_OK;
  made->residual = HUGE_VAL;
  for (int k = 0; k < MOST_SWEEPS && !status && made->residual > CHANGE; k++) {
    s->limit = s->until.all;
    status = hr2di_watch_work(&s->polled, values / 32);
    if (!status) status = gather(s, made->value, next);
    if (status) break;
    memcpy(made->irradiance, next, values * sizeof *next);
    status = reflect(s, made->irradiance, made->value, &made->residual);
    made->work.gathers++;
  }
  return s->progress_status;
}

/* Emitted + received = absorbed + escaped holds to the last change of B. */
static void sum_power(const fallback *s, hr2d_solution *made) {
  const hr2d_element *patch = s->links->hierarchy->element;
  const double unit = hr2d_scene_unit(s->scene);
  for (size_t m = 0; m < s->bands; m++) {
    hr2d_power *p = &made->power[m];
    *p = (hr2d_power){0};
    for (size_t k = 0; k < hr2di_scene_cell(s->scene); k++) {
      const size_t at = k * s->bands + m;
      const double length = unit * patch[k].length;
      p->emitted += length * hr2d_scene_emission(s->scene, k, m);
      p->received += length * s->external[at];
      p->absorbed += length * hr2di_scene_absorptance(s->scene, k, m) * made->irradiance[at];
      p->escaped += length * fmax(1 - s->row[k], 0) * made->value[at];
    }
  }
}

static hr2d_status reserve(const fallback *s, hr2di_graded *a) {
  const hr2d_allocator *alloc = &a->links->alloc;
  const size_t patches = s->scene->patches, values = patches * s->bands;
  hr2d_solution *made = a->solution = hr2di_alloc_zero(alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  *made = (hr2d_solution){.alloc = *alloc,
                          .links = a->links,
                          .hierarchy = a->hierarchy,
                          .elements = patches,
                          .order = 1,
                          .bands = s->bands};
  made->value = hr2di_alloc_zero(alloc, values, sizeof *made->value);
  made->irradiance = hr2di_alloc_zero(alloc, values, sizeof *made->irradiance);
  made->power = hr2di_alloc_zero(alloc, s->bands, sizeof *made->power);
  return made->value && made->irradiance && made->power ? HR2D_OK : HR2D_ENOMEM;
}

static hr2d_status solve(fallback *s, hr2di_graded *a) {
  const hr2d_allocator *alloc = &a->links->alloc;
  const size_t patches = s->scene->patches, values = patches * s->bands;
  hr2d_solution *made = a->solution;
  double *space = hr2di_alloc_zero(alloc, 2 * values + patches, sizeof *space);
  double change;
  if (!space) return HR2D_ENOMEM;
  s->external = space + values;
  s->row = s->external + values;
  hr2di_scene_watch(s->scene, &s->polled, watch, s, "solve");
  hr2d_status status = sum_rows(s);
  if (!status) status = find_external(s);
  if (!status) {
    memcpy(made->irradiance, s->external, values * sizeof *made->irradiance);
    status = reflect(s, made->irradiance, made->value, &change);
  }
  if (!status) status = sweep(s, made, space);
  if (!status) sum_power(s, made);
  hr2di_alloc_free(alloc, space);
  return status;
}

/* Of several shares the first one solves, as time ends it anywhere; the others get what it
   has found. */
static hr2d_status hand_out(const fallback *s, hr2di_graded *a, int *out_of_time,
                            hr2d_status status) {
  hr2d_share *share = s->target->share;
  hr2d_solution *made = a->solution;
  const size_t values = s->scene->patches * s->bands;
  double report[] = {*out_of_time, made ? made->residual : 0,
                     a->links ? (double)a->links->counts.links : 0};
  status = hr2di_share_combine(share, status, HR2D_COMBINE_SUM, report, 3);
  if (status) return status;
  *out_of_time = report[0] > 0;
  made->residual = report[1];
  a->links->counts.links = (uint64_t)report[2];
  status = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_SUM, made->value, values);
  if (!status)
    status = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_SUM, made->irradiance, values);
  if (!status)
    status = hr2di_share_combine(share, HR2D_OK, HR2D_COMBINE_SUM, &made->power->emitted,
                                 4 * s->bands);
  return status;
}

hr2d_status hr2di_fallback_solve(hr2di_graded *answer, const hr2d_scene *scene,
                                 const hr2d_target *target, hr2di_fallback_solve_times until,
                                 int *out_of_time) {
  fallback s = {.scene = scene, .target = target, .until = until, .bands = scene->bands};
  const double start = hr2di_clock_now();
  const int works = !target->share || target->share->number == 0;
  *answer = (hr2di_graded){0};
  hr2d_status status = make_sets(&s, answer);
  if (!status && works) status = make_links(&s);
  *out_of_time = s.out_of_time;
  answer->refine_seconds = hr2di_clock_now() - start;
  if (!status) status = reserve(&s, answer);
  if (!status && works) status = solve(&s, answer);
  if (target->share) status = hand_out(&s, answer, out_of_time, status);
  answer->solve_seconds = hr2di_clock_now() - start - answer->refine_seconds;
  return status;
}
