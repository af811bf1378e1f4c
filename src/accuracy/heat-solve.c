/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches of given flux in several bands: temperatures, a solve with them, and the errors.

   A coarse solve gives temperatures, and how errors of H grow.  A solve for the target follows
   with them; the heat balance is settled again on its links, which changes the temperatures by
   about the error of the coarse solve.

   Errors.  Let the account state |δH̄| ≤ eN for a given E, with N_kb = max(H̄, floor·max H̄).
   Then g is off by at most e·n, n_k = Σ_b a_kb N_kb, and by what is left of it; as g is an
   M-function, |δS| ≤ J⁻¹(en + |g|).  The emissions E'|δS| make further errors of B and H, which
   one more solve gives, for K and J⁻¹ have no negative entry.  At points they are at most
   max E'|δS|/a: a radiosity of this size everywhere covers its reflections. */
#include "accuracy/heat-solve.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "accuracy/solve-to.h"
#include "accuracy/target.h"
#include "base/alloc.h"
#include "base/clock.h"
#include "base/share.h"
#include "base/sized-struct.h"
#include "estimate/importance.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/linkset-impl.h"
#include "scene/panes.h"
#include "solution/solution-impl.h"
#include "solve/heat-scene.h"

/* The least target of the coarse solve; the relative change of E beyond which the solve and its
   account are made anew; the part of the target that is used, the rest is a reserve. */
#define COARSE     1e-5
#define MAX_CHANGE 0.1
#define USED_PART  0.9

enum { FINE_SOLVES = 4 };

/* The further relative errors, through the temperatures, per relative error of H: in averages
   of B, in averages of H, and at points. */
typedef struct growth {
  double average, irradiance, sup;
} growth;

typedef struct heat_search {
  const hr2d_scene *scene;
  hr2d_scene *frozen;
  hr2d_target given; /* complete */
  hr2d_target how;   /* for solves: the patches of given flux are important, too */
  size_t *important;
  double start;
  hr2d_solution *solution;
  hr2d_account account; /* of it, with the work of all */
  growth growth;
  double moved; /* the largest relative change of E since the account */
  double left;  /* the largest |g|/n: the residual of the heat balance */
} heat_search;

/* Makes patches of given flux important, too: the errors of all others depend on theirs. */
static hr2d_status set_important(heat_search *s) {
  const size_t patches = hr2di_scene_cell(s->scene);
  size_t count = 0;
  s->how.important = NULL;
  s->how.important_count = 0;
  if (!s->given.important) return HR2D_OK;
  s->important = hr2di_alloc(&s->scene->alloc, patches, sizeof *s->important);
  if (!s->important) return HR2D_ENOMEM;
  for (size_t k = 0; k < patches; k++)
    if (hr2di_is_important(&s->given, k) || hr2di_scene_has_flux(s->scene, k))
      s->important[count++] = k;
  s->how.important = s->important;
  s->how.important_count = count;
  return HR2D_OK;
}

static hr2d_status fail(heat_search *s, hr2d_status status, const char *why) {
  hr2di_message_copy(s->account.reason, sizeof s->account.reason,
                     why && *why ? why : hr2d_strerror(status));
  return status;
}

static hr2d_solve_options options_of(const hr2d_target *target) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = target->threads;
  options.progress = target->progress;
  options.progress_ctx = target->progress_ctx;
  return options;
}

static void add_work(hr2d_account *sum, const hr2d_account *more) {
  sum->solves += more->solves;
  sum->kernels += more->kernels;
  sum->refine_seconds += more->refine_seconds;
  sum->coefficients_seconds += more->coefficients_seconds;
  sum->solve_seconds += more->solve_seconds;
  sum->error_seconds += more->error_seconds;
}

/* Solves with the present temperatures; the solution replaces the last one. */
static hr2d_status solve(heat_search *s, double part_of_time) {
  const hr2d_account before = s->account;
  hr2d_solution_destroy(s->solution);
  s->solution = NULL;
  s->how.seconds = 0;
  if (s->given.seconds > 0)
    s->how.seconds =
        fmax(1e-3, part_of_time * (s->start + s->given.seconds - hr2di_clock_now()));
  const hr2d_status status = hr2di_solve_to(s->frozen, &s->how, &s->solution, &s->account);
  add_work(&s->account, &before);
  if (s->solution && s->solution->own_links->counts.elements == 0) {
    hr2d_solution_destroy(s->solution);
    s->solution = NULL;
    return fail(s, HR2D_EACCURACY,
                "the time does not suffice for the temperatures of patches of given flux");
  }
  return status;
}

static double largest(const double *average, size_t patches, size_t bands, size_t band) {
  double max = 0;
  for (size_t k = 0; k < patches; k++) max = fmax(max, average[k * bands + band]);
  return max;
}

/* n, in h->old, from the averages of H after a solve. */
static void set_unit_errors(heat_search *s, hr2di_heat_balance *h) {
  const size_t bands = s->scene->bands;
  for (size_t k = 0; k < h->count; k++) h->old[k] = 0;
  for (size_t b = 0; b < bands; b++) {
    const double min = s->given.floor * largest(h->average, s->scene->patches, bands, b);
    for (size_t m = 0; m < h->sides; m++)
      h->old[h->of[m]] += (1 - hr2d_scene_reflectance(s->frozen, h->patch[m], b)) *
                          fmax(h->average[h->patch[m] * bands + b], min);
  }
  s->left = 0;
  for (size_t k = 0; k < h->count; k++)
    if (h->size[k] > 0)
      s->left = fmax(s->left, (fabs(h->defect[k]) + 4 * DBL_EPSILON * h->size[k]) / h->old[k]);
}

/* The largest error of a patch that counts, relative to averages but to no less than the
   floor. */
static double worst_of(const heat_search *s, const double *off, const double *average) {
  const size_t bands = s->scene->bands;
  double worst = 0;
  for (size_t b = 0; b < bands; b++) {
    const double min = s->given.floor * largest(average, s->scene->patches, bands, b);
    for (size_t k = 0; k < s->scene->patches; k++)
      if (hr2di_is_important(&s->given, k) && off[k * bands + b] > 0)
        worst = fmax(worst, off[k * bands + b] / fmax(average[k * bands + b], min));
  }
  return worst;
}

static double worst_point(const heat_search *s, const hr2di_heat_balance *h,
                          const double *radiosity) {
  const size_t bands = s->scene->bands;
  double worst = 0;
  for (size_t b = 0; b < bands; b++) {
    double off = 0;
    for (size_t m = 0; m < h->sides; m++)
      off = fmax(off, fabs(h->rise[m * bands + b]) * h->step[h->of[m]] /
                          (1 - hr2d_scene_reflectance(s->frozen, h->patch[m], b)));
    if (off > 0) worst = fmax(worst, off / largest(radiosity, s->scene->patches, bands, b));
  }
  return worst;
}

/* Sets the growth; h->step becomes J⁻¹n. */
static hr2d_status measure_growth(heat_search *s, hr2di_heat_balance *h) {
  const size_t values = s->scene->patches * s->scene->bands;
  double *space = hr2di_alloc(&s->scene->alloc, 4 * values, sizeof *space);
  if (!space) return HR2D_ENOMEM;
  double *b = space, *irradiance = space + values, *db = space + 2 * values,
         *dh = space + 3 * values;
  set_unit_errors(s, h);
  memcpy(irradiance, h->average, values * sizeof *irradiance);
  for (size_t k = 0; k < values; k++) {
    const size_t patch = k / s->scene->bands, band = k % s->scene->bands;
    const size_t other = hr2di_scene_other_side(s->frozen, patch) * s->scene->bands + band;
    b[k] = hr2d_scene_emission(s->frozen, patch, band) +
           hr2di_pane_sum(s->frozen, patch, band, irradiance[k], irradiance[other]);
  }
  hr2d_status status = hr2di_heat_balance_spread(h, h->old, h->step);
  for (size_t k = 0; k < h->count; k++) h->step[k] = fmax(h->step[k], 0);
  if (!status) status = hr2di_heat_balance_respond(h, h->step, db, dh);
  if (!status)
    s->growth = (growth){worst_of(s, db, b), worst_of(s, dh, irradiance), worst_point(s, h, b)};
  hr2di_alloc_free(&s->scene->alloc, space);
  return status;
}

static void keep_emission(const heat_search *s, const hr2di_heat_balance *h, double *emission) {
  const size_t bands = s->scene->bands;
  for (size_t m = 0; m < h->sides * bands; m++)
    emission[m] = hr2d_scene_emission(s->frozen, h->patch[m / bands], m % bands);
}

static void measure_move(heat_search *s, const hr2di_heat_balance *h, const double *before) {
  const size_t bands = s->scene->bands;
  s->moved = 0;
  for (size_t b = 0; b < bands; b++) {
    double max = 0;
    for (size_t k = 0; k < s->scene->patches; k++)
      max = fmax(max, hr2d_scene_emission(s->frozen, k, b));
    for (size_t m = 0; m < h->sides; m++) {
      const double is = hr2d_scene_emission(s->frozen, h->patch[m], b);
      const double change = fabs(is - before[m * bands + b]);
      if (change > 0) s->moved = fmax(s->moved, change / fmax(is, s->given.floor * max));
    }
  }
}

/* The errors of the balance go to the patches. */
static void put_errors(heat_search *s, const hr2di_heat_balance *h) {
  const hr2d_error e = s->account.irradiance;
  for (size_t m = 0; m < h->sides; m++) {
    hr2di_found *found = &s->frozen->found[h->patch[m]];
    found->estimate = e.estimate * h->step[h->of[m]];
    found->bound = (e.bound + s->left) * h->step[h->of[m]];
  }
}

/* Settles the temperatures on the links of the solution, and measures what errors make. */
static hr2d_status settle_own(heat_search *s) {
  hr2di_heat_balance h;
  const double start = hr2di_clock_now();
  hr2d_linkset *links = s->solution->own_links;
  const hr2d_solve_options options = options_of(&s->how);
  hr2d_status status = hr2di_heat_balance_init(&h, s->frozen, links, &options);
  double *before = hr2di_alloc(&s->scene->alloc, h.sides * s->scene->bands + 1, sizeof *before);
  if (!status && !before) status = HR2D_ENOMEM;
  if (!status) {
    keep_emission(s, &h, before);
    status = hr2di_heat_balance_settle(&h);
  }
  if (!status) measure_move(s, &h, before);
  if (!status) status = hr2di_heat_scene_check(&h);
  if (status) fail(s, status, hr2d_linkset_message(links));
  s->account.solves += h.solves;
  s->account.solve_seconds += hr2di_clock_now() - start;
  if (!status && !s->given.no_error) status = measure_growth(s, &h);
  if (!status && !s->given.no_error) put_errors(s, &h);
  hr2di_alloc_free(&s->scene->alloc, before);
  hr2di_heat_balance_clear(&h);
  return status;
}

/* All shares settle, or none. */
static hr2d_status settle(heat_search *s) {
  hr2di_share_begin(s->given.share);
  const hr2d_status own = settle_own(s);
  const hr2d_status status = hr2di_share_agree(s->given.share, own);
  return own ? status : status ? fail(s, status, NULL) : HR2D_OK;
}

/* The solution with the frozen temperatures, on the same links. */
static hr2d_status renew(heat_search *s) {
  const hr2d_solve_options options = options_of(&s->how);
  hr2d_solution *made = NULL, *old = s->solution;
  const hr2d_status status = hr2d_solve(old->own_links, &options, &made);
  if (status) return fail(s, status, hr2d_linkset_message(old->own_links));
  made->own_links = old->own_links;
  made->own_hierarchy = old->own_hierarchy;
  made->own_scene = s->frozen;
  old->own_links = NULL;
  old->own_hierarchy = NULL;
  hr2d_solution_destroy(old);
  s->solution = made;
  s->account.solves++;
  return HR2D_OK;
}

/* Errors of E that the account does not know; it was made for slightly other E. */
static void raise_errors(heat_search *s) {
  const hr2d_error e = s->account.irradiance;
  hr2d_error *const error[] = {&s->account.average, &s->account.irradiance, &s->account.sup,
                               &s->account.irradiance_sup};
  const double by[] = {s->growth.average, s->growth.irradiance, s->growth.sup, s->growth.sup};
  for (int k = 0; k < 4; k++) {
    error[k]->estimate *= 1 + s->moved;
    error[k]->bound *= 1 + 10 * s->moved;
    if (!(by[k] > 0)) continue;
    error[k]->estimate += e.estimate * by[k];
    error[k]->bound += (e.bound + s->left) * by[k];
  }
}

static double growth_of(const heat_search *s) {
  return s->given.norm == HR2D_NORM_SUP ? s->growth.sup
                                        : fmax(s->growth.average, s->growth.irradiance);
}

static int is_usable(const heat_search *s, hr2d_status status) {
  return s->solution && (!status || status == HR2D_EACCURACY);
}

/* Coarse temperatures, and how errors grow. */
static hr2d_status approach(heat_search *s) {
  s->how.no_error = 1;
  s->how.norm = HR2D_NORM_AVERAGE;
  s->how.error = fmax(s->given.error, COARSE);
  hr2d_status status = solve(s, 0.3);
  if (is_usable(s, status)) status = settle(s);
  s->how.no_error = s->given.no_error;
  s->how.norm = s->given.norm;
  s->how.error = s->given.error > 0 ? USED_PART * s->given.error / (1 + growth_of(s))
                                    : HR2D_SMALLEST_ERROR;
  return status;
}

static hr2d_status reach(heat_search *s) {
  hr2d_status status = approach(s), settled = status;
  for (int k = 0; k < FINE_SOLVES && !settled; k++) {
    status = solve(s, 0.6);
    settled = is_usable(s, status) ? settle(s) : status;
    if (!settled && s->moved <= MAX_CHANGE) break;
  }
  if (!settled) settled = renew(s);
  if (settled) return settled;
  if (!s->given.no_error) raise_errors(s);
  return status;
}

hr2d_status hr2di_heat_solve(const hr2d_scene *scene, const hr2d_target *target,
                             hr2d_solution **solution, hr2d_account *account) {
  heat_search s = {.scene = scene, .start = hr2di_clock_now(), .how = HR2D_TARGET_INIT};
  hr2d_status status = hr2di_target_init(&s.given, scene, target, HR2D_DEFAULT_ERROR);
  hr2di_share_begin(s.given.share);
  s.how = s.given;
  if (!status) status = set_important(&s);
  if (!status)
    status =
        hr2di_heat_scene_create(scene, NULL, s.how.progress, s.how.progress_ctx, &s.frozen);
  status = hr2di_share_agree(s.given.share, status);
  if (!status)
    status = reach(&s);
  else
    fail(&s, status, hr2di_heat_scene_failure(status));
  s.account.seconds = hr2di_clock_now() - s.start;
  if (status && status != HR2D_EACCURACY) {
    hr2d_solution_destroy(s.solution);
    s.solution = NULL;
  }
  if (s.solution)
    *solution = s.solution;
  else
    hr2di_relit_destroy(s.frozen);
  if (account) *account = s.account;
  hr2di_alloc_free(&scene->alloc, s.important);
  hr2di_target_clear(&s.given, &scene->alloc);
  return status;
}
