/* SPDX-License-Identifier: GPL-3.0-or-later */
/* (I − ρK)⁻¹ = Σ(ρK)^k maps nothing positive to anything negative, so it carries a bound of
   roundings as it does light.  Roundings of the level of a closed component are no more than
   that.  In a component from which little escapes B = c + z has those of c, also on a patch
   that nothing lights.

   Closure d makes K1 + d the exact row sum, and the form factor s of the background is
   1 − K1 − d: what is off in K is off in these, too, with the other sign.  With z = B − c in a
   closed component of level c, and z = B − L where the background has radiosity L,

     H_i = Σ K_ij B_j + d_i B_i + s_i L   is off by   Σ δK_ij z_j + δd_i z_i.

   Exchange areas have a relative error of ε, so that |δK_ij| ≤ εK_ij and |δd_i| ≤ εr_i for the
   row sum r_i that d_i corrects: of all links on closed patches, of distant links on others.
   ε is larger where blocks are of floats, see block-numbers.h.
   On a patch that shines and sees the dark r_i|z_i| is much more than H_i.  But in H as it is
   told the mean of H takes the place of that of B (closure-mean.c), and z_i that of

     z̄' + z_i − z̄,   where z' = H − c, or H − L.

   Where no background shows, B may stand for z: in a closed room of dark walls, whose level is
   far above all B, that is much less.

   A difference from 1 has some roundings of 1, however small it is. */
#include "estimate/rounding-bound.h"

#include <float.h>
#include <math.h>

#include "estimate/coordinate-rounding.h"
#include "scene/panes.h"
#include "solve/closure.h"

/* Of 1 − Σ. */
#define DIFFERENCE (4 * DBL_EPSILON)

/* The largest |value| of a field on a leaf without its constant, which is set to 0. */
static double fluctuation(hr2di_estimator *e, double *field, size_t leaf, size_t band) {
  field[leaf * e->eq.transport.width + band] = 0;
  return hr2di_estimator_max(e, field, leaf, band);
}

/* Whether H as it is told has the mean of H in the place of that of B. */
static int is_moved(const hr2di_transport *t, size_t leaf) {
  return t->mean && hr2di_closure_is_error(t, t->hierarchy->element[t->leaf[leaf]].patch);
}

/* |z̄' + z_i − z̄| at most, for z̄ over the patch, with B̄ of patches in e->rounding[0]; |z_i|
   where the mean of closure stays.  `from` is z_i − B_i. */
static double moved(const hr2di_estimator *e, size_t leaf, size_t band, double from, double max,
                    double rest) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
  if (!is_moved(t, leaf)) return max;
  const double mean_shift =
      e->kept[leaf * t->width + band] - e->rounding[0][patch * t->bands + band];
  return fabs(hr2di_estimator_value(e, 1, patch, band) + from + mean_shift) + rest;
}

/* Sets `max`, `rest` and `reported` to constants on leaves: |z| at most, |z − z̄| over the leaf,
   and moved(). */
static void set_fields(hr2di_estimator *e, double *max, double *rest, double *reported) {
  const hr2di_transport *t = &e->eq.transport;
  for (size_t k = 0; k < e->eq.field; k++) {
    const size_t m = k % t->width;
    const int lit =
        t->sky && m < t->bands && !hr2di_balance_closed(&e->eq.balance, k / t->width);
    rest[k] = e->rest[k] - (lit ? e->eq.light[m] : 0);
    max[k] = 0;
  }
  for (size_t leaf = 0; leaf < t->leaves && !hr2di_estimator_stopped(e); leaf++) {
    double *at = rest + leaf * t->width;
    for (size_t b = 0; b < t->bands; b++) {
      const size_t k = leaf * t->width + b;
      const double from = at[b] - e->kept[k];
      max[k] = hr2di_estimator_max(e, rest, leaf, b);
      at[b] = fluctuation(e, rest, leaf, b);
      reported[k] = moved(e, leaf, b, from, max[k], at[b]);
    }
  }
}

/* Whether any of the coefficients of a leaf is not 0. */
static int is_set(const double *field, size_t leaf, size_t count) {
  for (size_t k = 0; k < count && field; k++)
    if (field[leaf * count + k] != 0) return 1;
  return 0;
}

/* r_i|z_i| at most, for the row sum `row` of distant links.  An average of d z is d̄ z̄ and what
   both fluctuate; d̄ is not 0 if it is above the noise of closure.  Below that d is 0, which is
   no more than a rounding of doubles, but of floats it is. */
static double corrected(const hr2di_estimator *e, const double *row, size_t leaf, size_t band,
                        double max, double rest) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t square = t->order * t->order;
  const double mean = row[leaf * t->width + band];
  if (t->closed[t->hierarchy->element[t->leaf[leaf]].patch]) return max;
  if (!t->blocks.single && !is_set(t->closure, leaf, square)) return 0;
  const int shifted = fabs(t->closure[leaf * square]) > 0.5 * hr2di_closure_noise(t) * mean;
  return hr2di_estimator_max(e, row, leaf, band) * (shifted ? max : rest);
}

/* r_i|B_i| at most, of H as B has it and as it is told. */
static double corrected_own(const hr2di_estimator *e, const double *row, size_t leaf,
                            size_t band, int reported, double rest) {
  const double max = hr2di_estimator_max(e, e->kept, leaf, band);
  return corrected(e, row, leaf, band, reported ? moved(e, leaf, band, 0, max, rest) : max,
                   rest);
}

/* e->off is εH so far.  Without closure d is a part of s alone. */
static void add_rows(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  hr2di_transport *t = &eq->transport;
  double *const max = e->error, *const rest = eq->radiosity, *const unit = eq->work;
  double *const received = eq->source, *const row = eq->irradiance, *const reported = eq->y;
  const double rounding = hr2di_estimator_rounding(e);
  if (!t->closure && !t->sky) return;
  hr2di_estimator_averages(e, e->kept, e->rounding[0]);
  set_fields(e, max, rest, reported);
  for (size_t k = 0; k < eq->field; k++) unit[k] = k % t->width < t->bands;
  hr2di_transport_apply_part(t, HR2DI_ALL_LINKS, max, received);
  if (!t->all_closed) hr2di_transport_apply_part(t, HR2DI_DISTANT_LINKS, unit, row);
  for (size_t leaf = 0; leaf < t->leaves && !hr2di_estimator_stopped(e); leaf++) {
    const int sky = is_set(t->sky, leaf, t->order);
    for (size_t b = 0; b < t->bands && (t->closure || sky); b++) {
      const size_t at = leaf * t->width + b;
      if (!sky && e->largest[0][b] == 0) continue; /* nothing sends to it */
      const double all = hr2di_estimator_max(e, received, leaf, b);
      const double light = t->closure ? 0 : hr2di_estimator_max(e, row, leaf, b) * eq->light[b];
      for (int h = 0; h < 2; h++) {
        const double z = h ? reported[at] : max[at];
        const double own = t->closure ? corrected(e, row, leaf, b, z, rest[at]) : light;
        double *off = e->off[h] + leaf * t->bands + b;
        const double by_b =
            sky ? HUGE_VAL : *off + rounding * corrected_own(e, row, leaf, b, h, rest[at]);
        *off = fmin(fmax(*off, rounding * (all + own)), by_b);
        *off += sky ? DIFFERENCE * eq->light[b] : 0;
      }
    }
  }
}

/* A border of sunlight is off its place by ACROSS at most, across the light, of coordinates
   below 2: the mean of H_sun by that part of the irradiance. */
#define ACROSS (4 * DBL_EPSILON)

/* Of the factor of an arc of the sky. */
#define ARC (16 * DBL_EPSILON)

static void add_sun(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_scene *scene = t->hierarchy->scene;
  for (size_t leaf = 0; leaf < t->leaves && !hr2di_estimator_stopped(e); leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
      size_t parts;
      hr2di_sunlight_of(scene, patch, b, &parts);
      const int seen =
          scene->sky.pieces > 0 && e->eq.outside && e->eq.outside[leaf * t->width + b] != 0;
      const double sky = seen ? hr2di_sky_max(scene, b) : 0;
      for (int h = 0; h < 2 && sky > 0; h++)
        e->off[h][leaf * t->bands + b] += ARC * ldexp(sky, -e->eq.exponent[b]);
      if (parts == 0) continue;
      const double borders = 2 * (double)parts * ACROSS / scene->patch[patch].length;
      const double off = ldexp(hr2d_scene_sun(scene, b).irradiance, -e->eq.exponent[b]) *
                         fmin(borders + DIFFERENCE, 1);
      for (int h = 0; h < 2; h++) e->off[h][leaf * t->bands + b] += off;
    }
}

/* Sets e->own from |H|: to what stands for |B_i| where H is told. */
static void set_own(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  for (size_t leaf = 0; leaf < t->leaves; leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const size_t at = t->leaf[leaf] * t->bands + b;
      const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
      e->own[at] = is_moved(t, leaf) ? fmax(e->own[at], hr2di_estimator_value(e, 1, patch, b))
                                     : e->max[at];
    }
  hr2di_estimator_lift(e, e->own);
}

/* What a point receives from slivers of the ends of a period, at most; 0 where nobody receives
   anything. */
static double slivers(const hr2di_estimator *e, size_t b) {
  const hr2d_scene *scene = e->eq.transport.hierarchy->scene;
  const double sliver = hr2di_symmetry_sliver(scene);
  if (sliver == 0 || e->largest[1][b] == 0) return 0;
  return sliver * fmax(e->largest[0][b], hr2di_estimator_sky(e, b));
}

/* Roundings at points of a band, with those of H in eq->irradiance. */
static void add_points(hr2di_estimator *e, size_t b) {
  const hr2di_equation *eq = &e->eq;
  const double own = HR2DI_ESTIMATOR_ROUNDING * e->largest[1][b] + slivers(e, b);
  for (size_t leaf = 0; leaf < eq->transport.leaves && !hr2di_estimator_stopped(e); leaf++) {
    const double h = hr2di_estimator_max(e, eq->irradiance, leaf, b) + own;
    e->stray[1][b] = fmax(e->stray[1][b], h);
    /* Where light from outside is absorbed at once, nothing is rounded. */
    if (e->largest[0][b] > 0)
      e->stray[0][b] = fmax(e->stray[0][b], hr2di_estimator_rho(e, leaf, b) * h);
  }
}

/* Adds to eq->irradiance the roundings that are H's alone. */
static void add_own(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  for (size_t leaf = 0; leaf < t->leaves; leaf++)
    for (size_t b = 0; b < t->bands; b++)
      eq->irradiance[leaf * t->width + b] +=
          e->off[1][leaf * t->bands + b] +
          HR2DI_ESTIMATOR_ROUNDING * e->level[leaf * t->bands + b];
}

/* Of B on a leaf: ρ times that of H, with τ of a pane, and its own, as B or as c + z. */
static double rounding_of_b(const hr2di_estimator *e, size_t leaf, size_t band) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t at = leaf * t->bands + band,
               other = (t->other_leaf ? t->other_leaf[leaf] : leaf) * t->bands + band;
  const double terms = hr2di_estimator_max(e, e->rest, leaf, band) + e->level[at];
  return hr2di_pane_sum(t->hierarchy->scene, t->hierarchy->element[t->leaf[leaf]].patch, band,
                        e->off[0][at], e->off[0][other]) +
         HR2DI_ESTIMATOR_ROUNDING * terms;
}

hr2d_status hr2di_rounding_bound(hr2di_estimator *e, int reflects) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  add_rows(e);
  if (hr2di_scene_has_sun(t->hierarchy->scene) || t->hierarchy->scene->sky.pieces) add_sun(e);
  hr2di_estimator_set_max(e, e->kept);
  set_own(e);
  const hr2di_levels levels = {e->max, e->own, eq->light};
  hr2d_status status = hr2di_coordinates_add(t, &levels, e->off);
  for (size_t k = 0; k < eq->field && !status; k++) {
    const size_t leaf = k / t->width, m = k % t->width;
    eq->source[k] = m < t->bands ? rounding_of_b(e, leaf, m) : 0;
    eq->radiosity[k] = eq->source[k]; /* where nothing reflects */
  }
  if (!status && reflects) status = hr2di_estimator_solve(e, 1e-3);
  for (size_t k = 0; k < eq->field && !status; k++) e->error[k] = eq->radiosity[k];
  if (status) return status;
  hr2di_estimator_averages(e, e->error, e->rounding[0]);
  hr2di_equation_gather(eq, e->error);
  for (size_t b = 0; b < t->bands && e->target->points; b++) add_points(e, b);
  add_own(e);
  hr2di_estimator_averages(e, eq->irradiance, e->rounding[1]);
  return HR2D_OK;
}
