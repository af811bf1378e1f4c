/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With K⁺ of two coefficients more on the same elements and links, and r = E + ρK⁺B_h − B_h,
     B − B_h = (I − ρK)⁻¹ r = r + ρKr + … + (ρK)^(n−1) r + (I − ρK)⁻¹ (ρK)^n r.
   r is orthogonal to what elements carry, so that each term is much smaller than the one
   before, and the first ones are formed, not solved for. Averages of the sum are the errors of
   averages of B. Those of H = KB are off by K⁺B_h − H_h + K(B − B_h), and points after a gather
   by K(B − B_h) in H and ρ times that in B.

   The estimate is the largest of these. What K⁺ lacks itself is a part of it, but for corners,
   where residuals are divided by what coefficients see of them, or gathered (see
   corner-residuals.h). The bound is MARGIN times the estimate, and what roundings may be, of B,
   of H, and of coordinates: (I − ρK)⁻¹ = Σ(ρK)^k maps nothing positive to anything negative, so
   that it carries a bound of roundings as it does light. Roundings of the level of a closed
   component are no more than that. */
#include "accuracy/error-estimate.h"

#include <float.h>
#include <math.h>

#include "accuracy/coordinate-rounding.h"
#include "accuracy/corner-residuals.h"
#include "accuracy/importance.h"
#include "base/alloc.h"
#include "base/legendre.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/equation.h"

/* Estimates were 0.93 to 4.3 times the errors, over rooms, corners, gaps and occluders. */
#define MARGIN 1.5
/* Where views change, coefficients p and p + 1 of a kink inside an element show 1 − (p/(p+2))³
   of what it does, and visibility events leave kinks of later generations. */
#define HIDDEN 5
/* Points are sampled, and coefficients show less of B than of averages. */
#define POINTS 3
/* What of the mean over patches of errors without signs may be left where signs cancel. */
#define SIGNS    0.1
#define ROUNDING (16 * DBL_EPSILON)

enum { TERMS = 4, MORE = 2 };

typedef struct estimator {
  hr2di_equation eq;
  const hr2d_solution *coarse;
  const hr2d_target *target;
  double exponent; /* γ, the least of the corners */
  double margin;   /* of bounds over estimates */
  hr2di_contacts contacts;
  hr2di_basis basis;
  hr2di_rule rule;
  double doubt;        /* of the levels of components, see energy-balance.h */
  size_t values;       /* patches × bands */
  double *kept;        /* the field of B_h */
  double *rest;        /* of B_h less the level of closed components */
  double *error;       /* B − B_h */
  double *residual;    /* r */
  double *average[2];  /* patches × bands: errors of averages, of B and of H */
  double *rounding[2]; /* likewise what roundings may be */
  double *most;        /* elements × bands: |field| at most */
  double *off;         /* leaves × bands: what roundings may do to H */
  double *floor;       /* 2 × bands, of B and of H: no average counts as less */
  double *safe;        /* likewise: errors of averages without signs */
  double *largest[2];  /* per band: B and H at a point */
  double *point[2];    /* per band: errors at points, of B and of H */
  double *stray[2];    /* per band: what roundings may be at points */
  int *exponent_of;    /* per band, see solve() */
} estimator;

/* The order has to tell, and clusters of another accuracy. */
hr2di_resolution hr2di_resolution_finer(const hr2di_resolution *f) {
  hr2di_resolution finer = *f;
  const unsigned order = f->order + MORE;
  finer.order = order < HR2D_MAX_ORDER ? order : HR2D_MAX_ORDER;
  finer.cluster_accuracy = fmax(0.1 * f->cluster_accuracy, 1e-14);
  return finer;
}

/* Once the watch has stopped, fields have no meaning. */
static int is_stopped(const estimator *e) {
  return e->eq.transport.failed || hr2di_watch_status(e->eq.transport.watch);
}

/* The largest |value| of a field on a leaf, in a band. */
static double leaf_most(const estimator *e, const double *field, size_t leaf, size_t band) {
  const hr2di_transport *t = &e->eq.transport;
  const double *at = field + leaf * t->width + band;
  hr2di_watch_work(t->watch, 1 + e->rule.points * t->order / 32);
  double max = fmax(fabs(hr2di_basis_sum(&e->basis, -1, at, t->bands)),
                    fabs(hr2di_basis_sum(&e->basis, 1, at, t->bands)));
  for (size_t q = 0; q < e->rule.points; q++)
    max = fmax(max, fabs(hr2di_basis_sum(&e->basis, e->rule.at[q], at, t->bands)));
  return max;
}

static double rho_of(const estimator *e, size_t leaf, size_t band) {
  const hr2di_transport *t = &e->eq.transport;
  return hr2d_scene_reflectance(t->hierarchy->scene, t->hierarchy->element[t->leaf[leaf]].patch,
                                band);
}

/* field = ρK field, through eq->irradiance. */
static void reflect(hr2di_equation *eq, double *field) {
  hr2di_equation_gather(eq, field);
  for (size_t k = 0; k < eq->field; k++)
    field[k] = eq->root_rho[k] * eq->root_rho[k] * eq->irradiance[k];
}

/* Averages of a field over the patches. */
static void take_averages(estimator *e, const double *field, double *average) {
  hr2di_transport *t = &e->eq.transport;
  hr2di_transport_pull(t, field);
  for (size_t k = 0; k < t->hierarchy->scene->patches; k++)
    for (size_t b = 0; b < t->bands; b++) average[k * t->bands + b] = t->up[k * t->width + b];
}

/* K⁺B_h − H_h in averages, and the largest B and H; of H on leaves, as it may not be resolved
   on those of patches that reflect nothing. */
static void compare_irradiance(estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  hr2di_equation_gather(eq, e->kept);
  take_averages(e, eq->irradiance, e->average[1]);
  for (size_t k = 0; k < e->values; k++)
    e->average[1][k] -= ldexp(hr2d_solution_irradiance(e->coarse, k / t->bands, k % t->bands),
                              -eq->exponent[k % t->bands]);
  for (size_t b = 0; b < t->bands; b++) e->largest[0][b] = e->largest[1][b] = 0;
  for (size_t k = 0; k < t->leaves && !is_stopped(e); k++)
    for (size_t b = 0; b < t->bands; b++) {
      const double h = leaf_most(e, eq->irradiance, k, b);
      e->largest[0][b] = fmax(e->largest[0][b], leaf_most(e, e->kept, k, b));
      e->largest[1][b] = fmax(e->largest[1][b], eq->irradiance[k * t->width + b]);
      e->off[k * t->bands + b] = ROUNDING * h;
    }
}

static void set_residual(estimator *e) {
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

/* Solves with the source of each band scaled to about 1, by a power of two: squares of the
   unknowns would underflow where the error is tiny. */
static hr2d_status solve(estimator *e, double tolerance) {
  hr2di_equation *eq = &e->eq;
  const size_t bands = eq->transport.bands;
  for (size_t k = 0; k < eq->field; k++) eq->y[k] = 0;
  for (size_t b = 0; b < bands; b++) {
    double max = 0;
    for (size_t k = b; k < eq->field; k += bands) max = fmax(max, fabs(eq->source[k]));
    e->exponent_of[b] = max > 0 ? ilogb(max) : 0;
    for (size_t k = b; k < eq->field; k += bands)
      eq->source[k] = ldexp(eq->source[k], -e->exponent_of[b]);
  }
  eq->options.tolerance = tolerance;
  const hr2d_status status = hr2di_equation_solve(eq);
  for (size_t k = 0; k < eq->field; k++)
    eq->radiosity[k] = ldexp(eq->radiosity[k], e->exponent_of[k % bands]);
  return status;
}

/* B − B_h: the first terms of the series, and its tail. */
static hr2d_status sum_series(estimator *e) {
  hr2di_equation *eq = &e->eq;
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = e->error[k] = e->residual[k];
  for (int term = 1; term <= TERMS; term++) {
    reflect(eq, eq->source);
    for (size_t k = 0; k < eq->field && term < TERMS; k++) e->error[k] += eq->source[k];
  }
  const hr2d_status status = solve(e, 1e-6);
  for (size_t k = 0; k < eq->field; k++) e->error[k] += eq->radiosity[k];
  return status;
}

static hr2d_status find_error(estimator *e) {
  hr2di_equation *eq = &e->eq;
  hr2d_status status = hr2di_contacts_init(&e->contacts, &eq->transport);
  if (!status)
    status = hr2di_contacts_gather(&e->contacts, eq, e->coarse, e->residual, e->kept);
  if (!status)
    status = hr2di_contacts_saturate(&e->contacts, &eq->transport, e->coarse->order,
                                     e->exponent, e->residual);
  return status ? status : sum_series(e);
}

/* An average of the solution, in the unit of the equation, where nothing is denormal. */
static double average_of(const estimator *e, int irradiance, size_t patch, size_t band) {
  const double value = irradiance ? hr2d_solution_irradiance(e->coarse, patch, band)
                                  : hr2d_solution_average(e->coarse, patch, band);
  return fabs(ldexp(value, -e->eq.exponent[band]));
}

/* What the error of an average is relative to: that, but no less than the floor. */
static double least_of(const estimator *e, int irradiance, size_t patch, size_t band) {
  return fmax(average_of(e, irradiance, patch, band),
              e->floor[(size_t)irradiance * e->eq.transport.bands + band]);
}

static void set_floors(estimator *e) {
  const size_t bands = e->eq.transport.bands;
  const double part = e->target->floor > 0 ? e->target->floor : HR2D_FLOOR;
  for (int h = 0; h < 2; h++)
    for (size_t b = 0; b < bands; b++) {
      double max = 0;
      for (size_t k = 0; k < e->values / bands; k++) max = fmax(max, average_of(e, h, k, b));
      e->floor[(size_t)h * bands + b] = part * max;
    }
}

/* Averages sum up what residuals do everywhere, with signs, and may be small by chance. With
   the importance Z of all averages together, Z = s + KρZ, the sum Σ A |⟨r,Z⟩| over leaves has
   no signs. For averages of B, s is 1/(A B̄) on each patch; Y = ρZ is the radiosity of a source
   ρs. For those of H, s is K of 1/(A H̄); Y = 1/(A H̄) + ρZ is the radiosity of a source 1/(A H̄),
   and Z is KY. */
static hr2d_status find_safe_sum(estimator *e, int irradiance) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  double min = HUGE_VAL, max = 0;
  for (size_t k = 0; k < eq->field; k++) {
    const size_t leaf = k / t->width, band = k % t->bands;
    const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
    const double least = least_of(e, irradiance, patch, band);
    if (least > 0) min = fmin(min, least);
    max = fmax(max, least);
    const int counts =
        k % t->width < t->bands && least > 0 && hr2di_is_important(e->target, patch);
    eq->source[k] = counts ? (irradiance ? 1 : rho_of(e, leaf, band)) / least /
                                 t->hierarchy->element[patch].length
                           : 0;
  }
  /* The norm of a solve has the largest ones: dark patches. */
  const hr2d_status status = solve(e, max > 0 ? fmax(1e-4 * min / max, 1e-14) : 1);
  if (status) return status;
  for (size_t leaf = 0; leaf < t->leaves && !is_stopped(e); leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const double rho = rho_of(e, leaf, b);
      double sum = 0;
      for (size_t l = 0; l < t->order; l++) {
        const size_t k = leaf * t->width + l * t->bands + b;
        const double z = ldexp(eq->irradiance[k], e->exponent_of[b]);
        const double s =
            irradiance || !(rho > 0) ? 0 : ldexp(eq->source[k], e->exponent_of[b]) / rho;
        sum += (z + s) * e->residual[k];
      }
      e->safe[irradiance * t->bands + b] += fabs(sum) * eq->weight[leaf * t->order];
    }
  return HR2D_OK;
}

/* At a vertex half of all directions or so are those of the other patch: H beside it is off by
   vb, with v = ½(1 + cos α) and b = B − B_h of that patch at the vertex. */
static void add_contacts(estimator *e) {
  const size_t bands = e->eq.transport.bands;
  for (size_t k = 0; k < e->contacts.gathered; k++)
    for (size_t side = 0; side < 2; side++)
      for (size_t b = 0; b < bands; b++) {
        const hr2di_contact *c = &e->contacts.contact[k];
        const double other = e->contacts.residual[(2 * k + 1 - side) * bands + b];
        const double h = c->view * fabs(other);
        e->point[1][b] = fmax(e->point[1][b], h);
        e->point[0][b] = fmax(e->point[0][b], rho_of(e, c->leaf[side], b) * h);
      }
}

/* The largest |field| on elements. */
static void set_most(estimator *e, const double *field) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_element *element = t->hierarchy->element;
  for (size_t k = 0; k < t->leaves && !is_stopped(e); k++)
    for (size_t b = 0; b < t->bands; b++)
      e->most[t->leaf[k] * t->bands + b] = leaf_most(e, field, k, b);
  for (size_t k = t->elements; k-- > 0;)
    for (size_t b = 0; b < t->bands && element[k].child; b++) {
      const double *child = e->most + element[k].child * t->bands + b;
      e->most[k * t->bands + b] = fmax(child[0], child[t->bands]);
    }
}

/* Patches that reflect nothing are not divided where others are, so that polynomials on them do
   not follow H from near elements: of B − B_h there, about so much arrives. */
#define NEARBY 0.7

static void add_nearby(estimator *e, uint32_t receiver, uint32_t source) {
  const hr2di_transport *t = &e->eq.transport;
  const uint32_t patch = t->hierarchy->element[receiver].patch;
  double rho = 0;
  for (size_t b = 0; b < t->bands; b++)
    rho = fmax(rho, hr2d_scene_reflectance(t->hierarchy->scene, patch, b));
  for (size_t b = 0; b < t->bands && !(rho > 0); b++)
    e->point[1][b] = fmax(e->point[1][b], NEARBY * e->most[source * t->bands + b]);
}

static void add_all_nearby(estimator *e) {
  const hr2di_transport *t = &e->eq.transport;
  set_most(e, e->error);
  for (uint64_t k = 0; k < t->links->store.count; k++) {
    const hr2d_pair pair = hr2di_store_at(&t->links->store, k)->pair;
    if (t->order > 1 && t->links->blocks.distant[k]) continue;
    add_nearby(e, pair.first, pair.second);
    add_nearby(e, pair.second, pair.first);
  }
}

/* Errors of averages and points, from B − B_h. */
static void find_errors(estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  hr2di_equation_gather(eq, e->error);
  take_averages(e, eq->irradiance, e->average[0]);
  for (size_t k = 0; k < e->values; k++) e->average[1][k] += e->average[0][k];
  take_averages(e, e->error, e->average[0]);
  for (size_t b = 0; b < t->bands; b++) {
    e->point[0][b] = e->point[1][b] = 0;
    e->stray[0][b] = e->stray[1][b] = 0;
  }
  for (size_t k = 0; k < t->leaves && !is_stopped(e); k++)
    for (size_t b = 0; b < t->bands; b++) {
      const double h = leaf_most(e, eq->irradiance, k, b);
      e->point[1][b] = fmax(e->point[1][b], h);
      e->point[0][b] = fmax(e->point[0][b], rho_of(e, k, b) * h);
    }
  add_contacts(e);
  add_all_nearby(e);
}

/* What roundings may be: of H on each leaf, of B, and what comes of both. */
static hr2d_status find_rounding(estimator *e, int reflects) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  set_most(e, e->kept);
  hr2d_status status = hr2di_coordinates_add(t, e->most, e->off);
  for (size_t k = 0; k < eq->field && !status; k++) {
    const size_t leaf = k / t->width, m = k % t->width;
    const double b = m < t->bands ? ROUNDING * leaf_most(e, e->rest, leaf, m) : 0;
    eq->source[k] = m < t->bands ? rho_of(e, leaf, m) * e->off[leaf * t->bands + m] + b : 0;
    eq->radiosity[k] = 0;
  }
  if (!status && reflects) status = solve(e, 1e-3);
  for (size_t k = 0; k < eq->field && !status; k++) e->error[k] = eq->radiosity[k];
  if (status) return status;
  take_averages(e, e->error, e->rounding[0]);
  hr2di_equation_gather(eq, e->error);
  for (size_t leaf = 0; leaf < t->leaves && !is_stopped(e); leaf++)
    for (size_t b = 0; b < t->bands; b++) {
      const double h = leaf_most(e, eq->irradiance, leaf, b) + ROUNDING * e->largest[1][b];
      e->stray[1][b] = fmax(e->stray[1][b], h);
      e->stray[0][b] = fmax(e->stray[0][b], rho_of(e, leaf, b) * h);
      eq->irradiance[leaf * t->width + b] += e->off[leaf * t->bands + b];
    }
  take_averages(e, eq->irradiance, e->rounding[1]);
  return HR2D_OK;
}

/* The largest error of an average of B or H, relative to the average as corrected by it, or to
   the floor: factor·|error| + `more`, if that is not NULL, and then relative to the least that
   the average may be. */
static double worst_average(const estimator *e, int irradiance, double factor,
                            const double *more) {
  const size_t bands = e->eq.transport.bands, patches = e->values / bands;
  double worst = 0;
  for (size_t b = 0; b < bands; b++) {
    const double floor = e->floor[(size_t)irradiance * bands + b];
    for (size_t k = 0; k < patches; k++) {
      if (!hr2di_is_important(e->target, k)) continue;
      const size_t at = k * bands + b;
      const double error = e->average[irradiance][at], is = average_of(e, irradiance, k, b);
      const double sum = factor * fabs(error) + (more ? fabs(more[at]) : 0);
      const double least = more ? is - sum : is + error;
      if (sum > 0) worst = fmax(worst, sum / fmax(least, floor));
    }
  }
  return worst;
}

/* The largest error at a point, relative to the largest value of the band. */
static double worst_point(const estimator *e, int irradiance, double factor, double rounding) {
  double worst = 0;
  for (size_t b = 0; b < e->eq.transport.bands; b++) {
    const double sum = factor * e->point[irradiance][b] + rounding * e->stray[irradiance][b];
    if (sum > 0) worst = fmax(worst, sum / e->largest[irradiance][b]);
  }
  return worst;
}

static double signless(const estimator *e, int irradiance) {
  const size_t bands = e->eq.transport.bands;
  double max = 0;
  for (size_t b = 0; b < bands; b++) max = fmax(max, e->safe[(size_t)irradiance * bands + b]);
  const hr2d_scene *scene = e->eq.transport.hierarchy->scene;
  return SIGNS * max / (double)hr2di_important_count(e->target, scene);
}

static hr2d_error bounded(double estimate, double bound) {
  return (hr2d_error){estimate, fmax(estimate, bound)};
}

static hr2d_status measure(estimator *e, hr2di_error_pair *errors) {
  hr2di_equation *eq = &e->eq;
  const int reflects = eq->transport.hierarchy->scene->effect[HR2D_EFFECT_INTERREFLECTION].on;
  set_residual(e);
  set_floors(e);
  hr2d_status status = reflects ? find_error(e) : HR2D_OK;
  if (status) return status;
  find_errors(e);
  for (int h = 0; h < 2 && reflects && !status; h++) status = find_safe_sum(e, h);
  if (status) return status;
  status = find_rounding(e, reflects);
  if (status) return status;
  const double level = eq->balance.count > 0 ? ROUNDING : 0;
  for (int h = 0; h < 2; h++) {
    const double average_off = worst_average(e, h, 0, e->rounding[h]) + level;
    errors->rounding[0] = fmax(errors->rounding[0], fmax(average_off, e->doubt));
    errors->rounding[1] =
        fmax(errors->rounding[1], fmax(worst_point(e, h, 0, 1) + level, e->doubt));
  }
  hr2d_error *const average[] = {&errors->average, &errors->irradiance};
  hr2d_error *const sup[] = {&errors->sup, &errors->irradiance_sup};
  for (int h = 0; h < 2; h++) {
    const double doubt = h == 0 || reflects ? e->doubt : 0;
    *average[h] =
        bounded(fmax(worst_average(e, h, 1, NULL), doubt),
                worst_average(e, h, e->margin, e->rounding[h]) + signless(e, h) + level);
    *sup[h] = bounded(fmax(worst_point(e, h, 1, 0), doubt),
                      worst_point(e, h, fmax(e->margin, POINTS), 1) + level);
  }
  return eq->transport.failed ? eq->transport.failed : hr2di_watch_status(eq->transport.watch);
}

/* Work space: NULL where there is no memory. */
static double *reserve(estimator *e, const hr2d_allocator *alloc) {
  const hr2di_transport *t = &e->eq.transport;
  const size_t field = e->eq.field, rows = t->leaves * t->bands;
  e->values = t->hierarchy->scene->patches * t->bands;
  double *space = hr2di_alloc(
      alloc, 4 * field + 4 * e->values + t->elements * t->bands + rows + 10 * t->bands,
      sizeof *space);
  e->exponent_of = hr2di_alloc(alloc, t->bands, sizeof *e->exponent_of);
  if (!space || !e->exponent_of) {
    hr2di_alloc_free(alloc, space);
    return NULL;
  }
  double *next = space;
  double **const fields[] = {&e->kept, &e->rest, &e->error, &e->residual};
  for (int k = 0; k < 4; k++, next += field) *fields[k] = next;
  for (int h = 0; h < 2; h++, next += 2 * e->values) {
    e->average[h] = next;
    e->rounding[h] = next + e->values;
  }
  e->most = next;
  e->off = next + t->elements * t->bands;
  next = e->off + rows;
  for (int h = 0; h < 2; h++, next += 3 * t->bands) {
    e->largest[h] = next;
    e->point[h] = next + t->bands;
    e->stray[h] = e->point[h] + t->bands;
  }
  e->floor = next;
  e->safe = next + 2 * t->bands;
  for (size_t k = 0; k < 2 * t->bands; k++) e->safe[k] = 0;
  return space;
}

static double margin_of(const hr2di_resolution *f) {
  const double ratio = (double)f->order / (f->order + MORE);
  if (!f->hidden) return MARGIN;
  return HIDDEN / (1 - ratio * ratio * ratio);
}

static hr2d_status run(const hr2di_graded *finer, const hr2di_graded *answer,
                       const hr2di_resolution *fineness, const hr2d_target *target,
                       hr2di_error_pair *errors) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = target->threads;
  options.progress = target->progress;
  options.progress_ctx = target->progress_ctx;
  estimator e = {.coarse = answer->solution,
                 .target = target,
                 .exponent = answer->survey.exponent,
                 .margin = margin_of(fineness),
                 .contacts.alloc = finer->links->alloc};
  hr2d_status status = hr2di_equation_init(&e.eq, finer->links, &options);
  if (!status) {
    const hr2d_allocator *alloc = &finer->links->alloc;
    hr2di_basis_init(&e.basis, e.eq.transport.order);
    hr2di_rule_init(&e.rule, e.eq.transport.order + 2);
    double *space = reserve(&e, alloc);
    status = space ? measure(&e, errors) : HR2D_ENOMEM;
    hr2di_contacts_clear(&e.contacts);
    hr2di_alloc_free(alloc, space);
    hr2di_alloc_free(alloc, e.exponent_of);
  }
  errors->kernels = e.eq.kernels;
  hr2di_equation_clear(&e.eq);
  return status;
}

hr2d_status hr2di_error_estimate(const hr2di_graded *answer, const hr2di_resolution *fineness,
                                 const hr2d_target *target, hr2di_error_pair *errors,
                                 hr2di_message *message) {
  const hr2di_resolution finer = hr2di_resolution_finer(fineness);
  hr2di_graded held;
  *errors = (hr2di_error_pair){0};
  hr2d_status status =
      hr2di_graded_reorder(&held, answer, &finer, finer.order, target, message);
  if (!status) {
    status = run(&held, answer, fineness, target, errors);
    errors->bytes = hr2di_graded_bytes(&held);
    if (status)
      hr2di_message_fail(message, status, "%s",
                         hr2d_linkset_message(held.links)[0] ? hr2d_linkset_message(held.links)
                                                             : hr2d_strerror(status));
  }
  hr2di_graded_clear(&held);
  return status;
}
