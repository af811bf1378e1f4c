/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With K⁺ of two coefficients more on the same elements and links, and r = E + ρK⁺B_h − B_h,
     B − B_h = (I − ρK)⁻¹ r = r + ρKr + … + (ρK)^(n−1) r + (I − ρK)⁻¹ (ρK)^n r.
   r is orthogonal to the polynomials on elements, so each term is much smaller than the one
   before, and the first ones are formed, not solved for.  Averages of the sum are the errors of
   averages of B.  Those of H = KB are off by K⁺B_h − H_h + K(B − B_h), and points after a
   gather by K(B − B_h) in H and ρ times that in B. */
#include "estimate/residual-series.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/closure.h"

enum { TERMS = 5, FEW_TERMS = 2, ROUNDS = 6 };

/* The relative accuracy of a solve for what the first terms leave; less is enough where what is
   left is solved for again. */
#define REST  1e-6
#define ROUND 1e-2

/* The part of the error that may be left, and how much less is left after a round at least. */
#define ENOUGH  0.05
#define SLOWEST 0.5

void hr2di_residual_reflect(hr2di_equation *eq, double *field) {
  hr2di_equation_gather(eq, field);
  memcpy(field, eq->irradiance, eq->field * sizeof *field);
  hr2di_equation_scatter(eq, field);
}

/* K⁺B_h − H_h in averages, |H| in e->own, and the largest B and H; of H on leaves, as it may
   not be resolved on those of patches that reflect nothing. */
static void compare_irradiance(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  hr2di_equation_gather(eq, e->kept);
  hr2di_closure_move_mean(t, e->kept, eq->irradiance);
  hr2di_estimator_averages(e, eq->irradiance, e->average[1]);
  for (size_t k = 0; k < e->values; k++)
    e->average[1][k] -= ldexp(hr2d_solution_irradiance(e->coarse, k / t->bands, k % t->bands),
                              -eq->exponent[k % t->bands]);
  for (size_t b = 0; b < t->bands; b++) e->largest[0][b] = e->largest[1][b] = 0;
  for (size_t k = 0; k < t->leaves && !hr2di_estimator_stopped(e); k++)
    for (size_t b = 0; b < t->bands; b++) {
      const double h = hr2di_estimator_max(e, eq->irradiance, k, b);
      e->largest[0][b] = fmax(e->largest[0][b], hr2di_estimator_max(e, e->kept, k, b));
      e->largest[1][b] = fmax(e->largest[1][b], eq->irradiance[k * t->width + b]);
      e->own[t->leaf[k] * t->bands + b] = h;
      e->off[0][k * t->bands + b] = hr2di_estimator_rounding(e) * h;
      e->off[1][k * t->bands + b] = hr2di_estimator_rounding(e) * h;
    }
}

void hr2di_residual_set(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  hr2di_solution_restrict(e->coarse, t->hierarchy, t->leaf, t->leaves, t->order, e->kept,
                          t->watch);
  for (size_t k = 0; k < eq->field; k++)
    e->kept[k] = ldexp(e->kept[k], -eq->exponent[k % t->bands]);
  hr2di_equation_balance(eq);
  compare_irradiance(e);
  hr2di_equation_defect(eq, e->kept, e->residual);
  e->level_uncertainty = hr2di_balance_doubt(&eq->balance, t);
  for (size_t k = 0; k < eq->field; k++) {
    const size_t leaf = k / t->width, m = k % t->width;
    const double level = m < t->bands ? hr2di_balance_at(&eq->balance, t, leaf, m) : 0;
    const int exact = hr2di_balance_closed(&eq->balance, leaf);
    e->rest[k] = e->kept[k] - (exact ? level : 0);
    if (m < t->bands) e->level[leaf * t->bands + m] = exact ? 0 : fabs(level);
    e->error[k] = eq->irradiance[k] = 0;
  }
  eq->background = 0;
}

/* The largest average of a field, relative to that of B. */
static double worst_average(hr2di_estimator *e, const double *field) {
  const size_t bands = e->eq.transport.bands;
  double *average = e->rounding[0], worst = 0;
  hr2di_estimator_averages(e, field, average);
  for (size_t k = 0; k < e->values; k++) {
    const double min = hr2di_estimator_min(e, 0, k / bands, k % bands);
    if (min > 0) worst = fmax(worst, fabs(average[k]) / min);
  }
  return worst;
}

/* Sets the source to r + ρK(B − B_h) − (B − B_h), what is left to solve for, and H to that of
   B − B_h. */
static void set_rest(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  hr2di_equation_gather(eq, e->error);
  memcpy(eq->source, eq->irradiance, eq->field * sizeof *eq->source);
  hr2di_equation_scatter(eq, eq->source);
  for (size_t k = 0; k < eq->field; k++)
    eq->source[k] = e->residual[k] + eq->source[k] - e->error[k];
}

/* Sets e->error to the first terms, and the source to the last of them. */
static void sum_terms(hr2di_estimator *e, int terms) {
  hr2di_equation *eq = &e->eq;
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = e->error[k] = e->residual[k];
  for (int term = 1; term < terms; term++) {
    hr2di_residual_reflect(eq, eq->source);
    for (size_t k = 0; k < eq->field; k++) e->error[k] += eq->source[k];
  }
}

/* Adds to e->error what is left to solve for, by the part of the equation, and by it again
   while that makes what is left smaller.  Returns HR2D_OK with e->whole set if it does not:
   light that is reflected many times in a narrow gap or corner has too many coefficients. */
static hr2d_status add_rest(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  double *const irradiance = eq->b;
  double before = HUGE_VAL;
  set_rest(e);
  for (int round = 0; round < ROUNDS; round++) {
    memcpy(irradiance, eq->irradiance, eq->field * sizeof *irradiance);
    const hr2d_status status = hr2di_estimator_solve_part(e, ROUND, HR2DI_AIM_ERRORS);
    if (status || e->whole) return status;
    memcpy(eq->irradiance, irradiance, eq->field * sizeof *irradiance);
    const double all = worst_average(e, e->error), more = worst_average(e, eq->radiosity);
    if (round > 0 && more > SLOWEST * before) break;
    if (round > 0 && more <= ENOUGH * all) return HR2D_OK;
    for (size_t k = 0; k < eq->field; k++) e->error[k] += eq->radiosity[k];
    set_rest(e);
    before = more;
  }
  e->whole = 1;
  return hr2di_watch_status(eq->transport.watch);
}

static hr2d_status sum_series(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  sum_terms(e, FEW_TERMS);
  hr2d_status status = add_rest(e);
  if (status || !e->whole) return status;
  sum_terms(e, TERMS);
  for (size_t k = 0; k < eq->field; k++) e->error[k] -= eq->source[k];
  status = hr2di_estimator_solve(e, REST);
  for (size_t k = 0; k < eq->field; k++) e->error[k] += eq->radiosity[k];
  hr2di_equation_gather(eq, e->error);
  return status;
}

/* Of the effect of a kink inside an element, which falls like p⁻³, coefficients p and p + 1
   show 1 − (p/(p+2))³.  Kinks count where they make a good part of these. */
#define KINK 0.5

static void saturate_kinks(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t order = e->coarse->order;
  const double ratio = (double)order / (double)t->order, theta = 1 - ratio * ratio * ratio;
  for (size_t b = 0; b < t->bands; b++) {
    const double largest = e->largest[0][b];
    for (size_t k = 0; k < t->leaves; k++) {
      double *residual = e->residual + k * t->width + b, seen = 0;
      for (size_t l = order; l < t->order; l++) seen = hypot(seen, residual[l * t->bands]);
      const size_t of = t->leaf[k] * e->jump_bands + b % e->jump_bands;
      const double kinks = largest * e->unresolved_jump[of];
      if (!(kinks > 0) || kinks < KINK * seen) continue;
      for (size_t l = order; l < t->order; l++) residual[l * t->bands] /= theta;
    }
  }
}

hr2d_status hr2di_residual_solve(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  hr2d_status status = hr2di_contacts_init(&e->contacts, &eq->transport);
  if (!status && e->target->points)
    status = hr2di_contacts_gather(&e->contacts, eq, e->coarse, e->residual, e->kept);
  if (!status)
    status = hr2di_contacts_saturate(&e->contacts, &eq->transport, e->coarse->order,
                                     e->exponent, e->residual);
  if (!status && e->unresolved_jump) saturate_kinks(e);
  return status ? status : sum_series(e);
}

/* At a vertex half of all directions or so are those of the other patch: H beside it is off by
   vb, with v = ½(1 + cos α) and b = B − B_h of that patch at the vertex. */
static void add_contacts(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t bands = t->bands;
  for (size_t k = 0; k < e->contacts.gathered; k++)
    for (size_t side = 0; side < 2; side++)
      for (size_t b = 0; b < bands; b++) {
        const hr2di_contact *c = &e->contacts.contact[k];
        const double other = e->contacts.residual[(2 * k + 1 - side) * bands + b];
        const size_t patch = t->hierarchy->element[t->leaf[c->leaf[side]]].patch;
        hr2di_estimator_off(e, e->point, patch, b, c->view * fabs(other));
      }
}

/* Patches that reflect nothing are not divided where others are, so that polynomials on them do
   not follow H from near elements: of B − B_h there, about this part arrives. */
#define NEARBY 0.7

static void add_nearby(hr2di_estimator *e, uint32_t receiver, uint32_t source) {
  const hr2di_transport *t = &e->eq.transport;
  const uint32_t patch = t->hierarchy->element[receiver].patch;
  double rho = 0;
  for (size_t b = 0; b < t->bands; b++)
    rho = fmax(rho, hr2di_scene_scattered(t->hierarchy->scene, patch, b));
  for (size_t b = 0; b < t->bands && !(rho > 0); b++)
    hr2di_estimator_off(e, e->point, patch, b, NEARBY * e->max[source * t->bands + b]);
}

static void add_all_nearby(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  hr2di_estimator_set_max(e, e->error);
  for (uint64_t k = 0; k < t->links->store.count; k++) {
    const hr2d_pair pair = hr2di_store_at(&t->links->store, k)->pair;
    if (t->order > 1 && t->links->blocks.distant[k]) continue;
    add_nearby(e, pair.first, pair.second);
    add_nearby(e, pair.second, pair.first);
  }
}

static hr2d_status measure_points(hr2di_estimator *e) {
  const hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  for (size_t b = 0; b < t->bands; b++) {
    e->point[0][b] = e->point[1][b] = 0;
    e->narrow[0][b] = e->narrow[1][b] = 0;
    e->stray[0][b] = e->stray[1][b] = 0;
  }
  for (size_t k = 0; k < t->leaves && !hr2di_estimator_stopped(e); k++)
    for (size_t b = 0; b < t->bands; b++)
      hr2di_estimator_off(e, e->point, t->hierarchy->element[t->leaf[k]].patch, b,
                          hr2di_estimator_max(e, eq->irradiance, k, b));
  add_contacts(e);
  add_all_nearby(e);
  if (!t->links->share) return HR2D_OK;
  return hr2di_share_combine(t->links->share, hr2di_transport_status(t), HR2D_COMBINE_MOST,
                             e->point[1], t->bands);
}

hr2d_status hr2di_residual_measure(hr2di_estimator *e) {
  const hr2di_equation *eq = &e->eq;
  hr2di_estimator_averages(e, eq->irradiance, e->average[0]);
  for (size_t k = 0; k < e->values; k++) e->average[1][k] += e->average[0][k];
  hr2di_estimator_averages(e, e->error, e->average[0]);
  return e->target->points ? measure_points(e) : HR2D_OK;
}
