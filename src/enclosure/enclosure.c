/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hr2d_enclose(): rounds of links between all leaves that see each other, sweeps, and halving.
   Ranges of one round hold in the next, and so do those of patches. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/alloc.h"
#include "base/clock.h"
#include "base/sized-struct.h"
#include "enclosure/enclosure-impl.h"
#include "enclosure/enclosure-marks.h"
#include "enclosure/enclosure-refused.h"
#include "mesh/admissibility.h"
#include "oracle/built-in.h"
#include "scene/scene-impl.h"
#include "visibility/back-visibility.h"

/* Links that are made between two questions of the watch: some 1 µs each. */
enum { SOME_LINKS = 256 };

typedef struct encloser {
  hr2di_enclosing e;
  hr2d_enclose_options options;
  hr2di_watch watch;
  hr2d_enclosure *to;
  hr2d_enclosure_account account;
  double *scale;       /* per band, see hr2di_enclosing_mark() */
  unsigned char *mark; /* per element */
} encloser;

/* No pair is linked before both of its elements are leaves. */
static hr2d_status refuse(void *ctx, const hr2d_batch *batch, double *error) {
  (void)ctx;
  for (size_t k = 0; k < batch->count; k++) error[k] = INFINITY;
  return HR2D_OK;
}

static const hr2d_oracle leaves = {HR2DI_BUILT_IN("leaves", HR2D_ORACLE_SYMMETRIC),
                                   .estimate = refuse};

static hr2d_status begin(encloser *all) {
  hr2di_enclosing *e = &all->e;
  hr2d_status status = hr2d_hierarchy_create(e->scene, &e->hierarchy);
  if (!status)
    status = hr2d_linkset_create(e->hierarchy, &leaves, NULL,
                                 hr2di_admissibility_fixed_leaves(), NULL, &e->links);
  all->scale = hr2di_alloc_zero(&e->alloc, e->bands, sizeof *all->scale);
  if (!status && !all->scale) status = HR2D_ENOMEM;
  if (status) return status;
  if (e->scene->parts.wanted)
    return hr2di_back_visibility(e->scene, &e->alloc, 1, &e->sees_backs, e->watch);
  /* Without a plane nobody knows. */
  e->sees_backs = hr2di_alloc(&e->alloc, e->scene->patches, 1);
  if (e->sees_backs) memset(e->sees_backs, 1, e->scene->patches);
  return e->sees_backs ? HR2D_OK : HR2D_ENOMEM;
}

static hr2d_status find_originals(hr2di_enclosing *e) {
  if (!e->scene->symmetry.motion) return HR2D_OK;
  hr2di_alloc_free(&e->alloc, e->original);
  e->original = hr2di_alloc(&e->alloc, e->hierarchy->elements, sizeof *e->original);
  return e->original ? hr2d_hierarchy_originals(e->hierarchy, e->original) : HR2D_ENOMEM;
}

static hr2d_status make_links(hr2di_enclosing *e) {
  const uint64_t count = hr2d_linkset_size(e->links);
  if (hr2di_alloc_reserve(&e->alloc, &e->link, &e->room, count, sizeof *e->link))
    return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  hr2di_watch_phase(e->watch, "coefficients");
  for (e->count = 0; e->count < count && !status;) {
    const uint64_t left = count - e->count;
    const size_t some = left < SOME_LINKS ? (size_t)left : SOME_LINKS;
    hr2di_enclosed_links_make(e->links, e->original, e->count, some, e->link + e->count);
    e->count += some;
    e->watch->report.links = e->count;
    e->watch->report.fraction = (double)e->count / (double)count;
    status = hr2di_watch_work(e->watch, 10 * some);
  }
  return status;
}

static hr2d_status refine(encloser *all) {
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.max_links = all->options.max_links;
  options.progress = all->options.progress;
  options.progress_ctx = all->options.progress_ctx;
  hr2d_status status = hr2d_refine(all->e.links, &options);
  if (!status) status = find_originals(&all->e);
  if (!status) status = make_links(&all->e);
  hr2di_watch_phase(&all->watch, "solve");
  if (!status) status = hr2di_enclosing_begin(&all->e);
  return status ? status : hr2di_enclosing_sweep(&all->e);
}

/* Adds the mean over a leaf to that of its patch. */
static void add_leaf(hr2di_range *mean, hr2di_range of, double part) {
  mean->lower += part * of.lower;
  mean->upper += part * of.upper;
}

static void narrow(hr2di_range *known, hr2di_range now, double margin) {
  known->lower = fmax(known->lower, now.lower * (1 - margin));
  known->upper = fmin(known->upper, now.upper * (1 + margin));
}

/* The means over patches; a sum of N numbers is off by N roundings of it. */
static hr2d_status take_means(encloser *all) {
  const hr2di_enclosing *e = &all->e;
  const size_t values = all->to->patches * e->bands;
  hr2di_range *now = hr2di_alloc_zero(&e->alloc, 2 * values, sizeof *now);
  if (!now) return HR2D_ENOMEM;
  for (uint32_t k = 0; k < e->elements; k++) {
    const hr2d_element *at = &e->hierarchy->element[k];
    const double part = at->length / e->hierarchy->element[at->patch].length;
    for (size_t b = 0; b < e->bands && hr2di_enclosing_has(e, k); b++) {
      add_leaf(&now[at->patch * e->bands + b], e->b[k * e->bands + b].mean, part);
      add_leaf(&now[values + at->patch * e->bands + b], e->h[k * e->bands + b].mean, part);
    }
  }
  const double margin = ((double)e->elements + 4) * DBL_EPSILON;
  for (size_t k = 0; k < values; k++) {
    narrow(&all->to->b[k], now[k], margin);
    narrow(&all->to->h[k], now[values + k], margin);
  }
  hr2di_alloc_free(&e->alloc, now);
  return hr2di_watch_work(e->watch, e->elements * e->bands / 8);
}

/* The largest distance of ends in a band, relative to the largest lower end. */
static double gap_of(const hr2d_enclosure *to, const hr2di_range *range, size_t band,
                     double *scale) {
  double upper = 0, widest = 0;
  for (size_t k = 0; k < to->patches; k++) {
    const hr2di_range r = range[k * to->bands + band];
    upper = fmax(upper, r.lower);
    widest = fmax(widest, r.upper - r.lower);
  }
  *scale = upper;
  return widest > 0 ? widest / upper : 0;
}

static void measure(encloser *all) {
  all->account.gap = 0;
  for (size_t b = 0; b < all->e.bands; b++) {
    double of_b, of_h;
    const double gap =
        fmax(gap_of(all->to, all->to->b, b, &of_b), gap_of(all->to, all->to->h, b, &of_h));
    /* Without any lower end all leaves count by what they may have. */
    all->scale[b] =
        fmax(of_b, of_h) > 0 ? fmax(of_b, of_h) : hr2di_enclosing_max(all->e.scene, b);
    if (gap <= all->options.gap) all->scale[b] = 0;
    all->account.gap = fmax(all->account.gap, gap);
  }
}

/* Halves marked leaves and their images. */
static hr2d_status halve(encloser *all) {
  hr2di_enclosing *e = &all->e;
  const size_t before = e->hierarchy->elements;
  hr2d_status status = HR2D_OK;
  for (uint32_t k = 0; k < before && !status; k++) {
    const uint32_t of = e->original ? e->original[k] : k;
    if (e->hierarchy->element[k].child || !all->mark[of]) continue;
    status = hr2di_hierarchy_reserve(e->hierarchy);
    if (!status) hr2di_element_halve(e->hierarchy, k);
    if (!status) status = hr2di_watch_work(e->watch, 1);
  }
  return status;
}

static hr2d_status divide(encloser *all, size_t *marked) {
  hr2di_enclosing *e = &all->e;
  all->mark = hr2di_alloc_zero(&e->alloc, e->elements, 1);
  hr2d_status status =
      all->mark ? hr2di_enclosing_mark(e, all->scale, all->options.max_links, all->mark, marked)
                : HR2D_ENOMEM;
  if (!status && *marked) status = halve(all);
  hr2di_alloc_free(&e->alloc, all->mark);
  all->mark = NULL;
  return status;
}

/* A patch under a background that sees black backs, or patches that no light reaches. */
static const char *unclear_sky(const hr2di_enclosing *e, size_t *patch) {
  int has_light = 0;
  for (size_t b = 0; b < e->bands; b++) has_light |= hr2d_scene_background(e->scene, b) > 0;
  for (*patch = 0; has_light && *patch < hr2di_scene_cell(e->scene); ++*patch) {
    if (e->sees_backs && e->sees_backs[*patch])
      return "may see black backs before the background: give these walls a black patch on "
             "their other side";
    if (e->scene->dark && e->scene->dark[*patch])
      return "gets no light, so that nobody knows how much of the background it covers: leave "
             "it out, or give it a reflectance or an emission";
  }
  return NULL;
}

static void give_reason(encloser *all) {
  hr2d_enclosure_account *a = &all->account;
  const double needed = (double)a->links * a->gap / all->options.gap;
  size_t patch;
  const char *why = unclear_sky(&all->e, &patch);
  int at = snprintf(a->reason, sizeof a->reason, "%llu links leave a gap of %.1e",
                    (unsigned long long)a->links, a->gap);
  if (at < 0) return;
  if (why)
    snprintf(a->reason + at, sizeof a->reason - (size_t)at, "; %s %s",
             hr2di_patch_label(all->e.scene, patch).text, why);
  else if (isfinite(needed))
    snprintf(a->reason + at, sizeof a->reason - (size_t)at,
             "; for %.1e allow some %.0e of them", all->options.gap, needed);
  else
    snprintf(a->reason + at, sizeof a->reason - (size_t)at,
             ": whether there is light at all is not known yet; allow more of them");
}

static hr2d_status play_rounds(encloser *all) {
  size_t marked = 0;
  do {
    hr2d_status status = refine(all);
    if (!status) status = take_means(all);
    if (status) return status;
    measure(all);
    all->account.links = all->e.count;
    all->account.elements = all->e.hierarchy->elements;
    if (all->account.gap <= all->options.gap) return HR2D_OK;
    status = divide(all, &marked);
    if (status) return status;
    all->account.rounds += marked > 0;
  } while (marked);
  give_reason(all);
  return HR2D_EACCURACY;
}

static hr2d_status make_object(encloser *all) {
  const hr2di_enclosing *e = &all->e;
  hr2d_enclosure *to = hr2di_alloc_zero(&e->alloc, 1, sizeof *to);
  if (!to) return HR2D_ENOMEM;
  all->to = to;
  to->alloc = e->alloc;
  to->scene = e->scene;
  to->patches = hr2di_scene_cell(e->scene);
  to->bands = e->bands;
  to->b = hr2di_alloc(&e->alloc, to->patches, e->bands * sizeof *to->b);
  to->h = hr2di_alloc(&e->alloc, to->patches, e->bands * sizeof *to->h);
  if (!to->b || !to->h) return HR2D_ENOMEM;
  for (size_t k = 0; k < to->patches * e->bands; k++)
    to->b[k] = to->h[k] = (hr2di_range){0, INFINITY};
  return HR2D_OK;
}

static void clear(encloser *all) {
  hr2di_enclosing *e = &all->e;
  hr2di_enclosing_forget(e);
  hr2di_alloc_free(&e->alloc, e->link);
  hr2di_alloc_free(&e->alloc, e->original);
  hr2di_alloc_free(&e->alloc, e->sees_backs);
  hr2di_alloc_free(&e->alloc, all->scale);
  hr2d_linkset_destroy(e->links);
  hr2d_hierarchy_destroy(e->hierarchy);
}

static hr2d_status take_options(encloser *all, const hr2d_enclose_options *given) {
  hr2d_enclose_options *o = &all->options;
  *o = (hr2d_enclose_options)HR2D_ENCLOSE_OPTIONS_INIT;
  const hr2d_status status = hr2di_sized_copy(o, sizeof *o, given);
  if (status) return status;
  if (!(o->gap >= 0)) return HR2D_EINVAL;
  if (!(o->gap > 0)) o->gap = HR2D_DEFAULT_GAP;
  if (!o->max_links) o->max_links = HR2D_DEFAULT_ENCLOSURE_LINKS;
  hr2di_scene_choose_progress(all->e.scene, &o->progress, &o->progress_ctx);
  return HR2D_OK;
}

static hr2d_status enclose(encloser *all) {
  hr2di_enclosing *e = &all->e;
  hr2di_watch_init(&all->watch, all->options.progress, all->options.progress_ctx, "refine");
  e->watch = &all->watch;
  hr2d_status status =
      hr2di_enclosure_refused(e->scene, all->account.reason, sizeof all->account.reason);
  if (!status) status = make_object(all);
  if (!status) status = begin(all);
  if (!status) status = play_rounds(all);
  if (e->hierarchy) all->account.leaves = hr2d_hierarchy_count(e->hierarchy).leaves;
  all->account.sweeps = e->sweeps;
  clear(all);
  return status;
}

hr2d_status hr2d_enclose(const hr2d_scene *scene, const hr2d_enclose_options *options,
                         hr2d_enclosure **enclosure, hr2d_enclosure_account *account) {
  if (enclosure) *enclosure = NULL;
  if (account) *account = (hr2d_enclosure_account){.gap = INFINITY};
  if (!scene || !enclosure) return HR2D_EINVAL;
  if (!scene->committed) return HR2D_ESTATE;
  if (hr2di_scene_has_gas(scene)) return HR2D_EUNSUPPORTED;
  const double start = hr2di_clock_now();
  encloser all = {.e = {.scene = scene, .alloc = scene->alloc, .bands = scene->bands},
                  .account = {.gap = INFINITY}};
  hr2d_status status = take_options(&all, options);
  if (!status) status = enclose(&all);
  all.account.seconds = hr2di_clock_now() - start;
  if (account) *account = all.account;
  if (!status || status == HR2D_EACCURACY)
    *enclosure = all.to;
  else
    hr2d_enclosure_destroy(all.to);
  return status;
}
