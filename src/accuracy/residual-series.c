/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With K⁺ of two coefficients more on the same elements and links, and r = E + ρK⁺B_h − B_h,
     B − B_h = (I − ρK)⁻¹ r = r + ρKr + … + (ρK)^(n−1) r + (I − ρK)⁻¹ (ρK)^n r.
   r is orthogonal to the polynomials on elements, so each term is much smaller than the one
   before, and the first ones are formed, not solved for.  Averages of the sum are the errors of
   averages of B.  Those of H = KB are off by K⁺B_h − H_h + K(B − B_h), and points after a
   gather by K(B − B_h) in H and ρ times that in B. */
#include "accuracy/residual-series.h"

#include <float.h>
#include <math.h>

#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/closure.h"

enum { TERMS = 4 };

void hr2di_residual_reflect(hr2di_equation *eq, double *field) {
  hr2di_equation_gather(eq, field);
  for (size_t k = 0; k < eq->field; k++)
    field[k] = eq->root_rho[k] * eq->root_rho[k] * eq->irradiance[k];
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
      const double h = hr2di_estimator_most(e, eq->irradiance, k, b);
      e->largest[0][b] = fmax(e->largest[0][b], hr2di_estimator_most(e, e->kept, k, b));
      e->largest[1][b] = fmax(e->largest[1][b], eq->irradiance[k * t->width + b]);
      e->own[t->leaf[k] * t->bands + b] = h;
      e->off[0][k * t->bands + b] = HR2DI_ESTIMATOR_ROUNDING * h;
      e->off[1][k * t->bands + b] = HR2DI_ESTIMATOR_ROUNDING * h;
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
  e->doubt = hr2di_balance_doubt(&eq->balance, t->bands);
  for (size_t k = 0; k < eq->field; k++) {
    const size_t leaf = k / t->width, m = k % t->width;
    const int exact = m < t->bands && hr2di_balance_closed(&eq->balance, leaf);
    e->rest[k] = e->kept[k] - (exact ? hr2di_balance_at(&eq->balance, t, leaf, m) : 0);
    e->error[k] = 0;
  }
  eq->background = 0;
}

/* B − B_h: the first terms of the series, and its tail. */
static hr2d_status sum_series(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = e->error[k] = e->residual[k];
  for (int term = 1; term <= TERMS; term++) {
    hr2di_residual_reflect(eq, eq->source);
    for (size_t k = 0; k < eq->field && term < TERMS; k++) e->error[k] += eq->source[k];
  }
  const hr2d_status status = hr2di_estimator_solve(e, 1e-6);
  for (size_t k = 0; k < eq->field; k++) e->error[k] += eq->radiosity[k];
  return status;
}

hr2d_status hr2di_residual_solve(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  hr2d_status status = hr2di_contacts_init(&e->contacts, &eq->transport);
  if (!status)
    status = hr2di_contacts_gather(&e->contacts, eq, e->coarse, e->residual, e->kept);
  if (!status)
    status = hr2di_contacts_saturate(&e->contacts, &eq->transport, e->coarse->order,
                                     e->exponent, e->residual);
  return status ? status : sum_series(e);
}

/* At a vertex half of all directions or so are those of the other patch: H beside it is off by
   vb, with v = ½(1 + cos α) and b = B − B_h of that patch at the vertex. */
static void add_contacts(hr2di_estimator *e) {
  const size_t bands = e->eq.transport.bands;
  for (size_t k = 0; k < e->contacts.gathered; k++)
    for (size_t side = 0; side < 2; side++)
      for (size_t b = 0; b < bands; b++) {
        const hr2di_contact *c = &e->contacts.contact[k];
        const double other = e->contacts.residual[(2 * k + 1 - side) * bands + b];
        const double h = c->view * fabs(other);
        e->point[1][b] = fmax(e->point[1][b], h);
        e->point[0][b] = fmax(e->point[0][b], hr2di_estimator_rho(e, c->leaf[side], b) * h);
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
    rho = fmax(rho, hr2d_scene_reflectance(t->hierarchy->scene, patch, b));
  for (size_t b = 0; b < t->bands && !(rho > 0); b++)
    e->point[1][b] = fmax(e->point[1][b], NEARBY * e->most[source * t->bands + b]);
}

static void add_all_nearby(hr2di_estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  hr2di_estimator_set_most(e, e->error);
  for (uint64_t k = 0; k < t->links->store.count; k++) {
    const hr2d_pair pair = hr2di_store_at(&t->links->store, k)->pair;
    if (t->order > 1 && t->links->blocks.distant[k]) continue;
    add_nearby(e, pair.first, pair.second);
    add_nearby(e, pair.second, pair.first);
  }
}

/* Errors of averages and points, from B − B_h. */
void hr2di_residual_measure(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  hr2di_equation_gather(eq, e->error);
  hr2di_estimator_averages(e, eq->irradiance, e->average[0]);
  for (size_t k = 0; k < e->values; k++) e->average[1][k] += e->average[0][k];
  hr2di_estimator_averages(e, e->error, e->average[0]);
  for (size_t b = 0; b < t->bands; b++) {
    e->point[0][b] = e->point[1][b] = 0;
    e->narrow[0][b] = e->narrow[1][b] = 0;
    e->stray[0][b] = e->stray[1][b] = 0;
  }
  for (size_t k = 0; k < t->leaves && !hr2di_estimator_stopped(e); k++)
    for (size_t b = 0; b < t->bands; b++) {
      const double h = hr2di_estimator_most(e, eq->irradiance, k, b);
      e->point[1][b] = fmax(e->point[1][b], h);
      e->point[0][b] = fmax(e->point[0][b], hr2di_estimator_rho(e, k, b) * h);
    }
  add_contacts(e);
  add_all_nearby(e);
}
