/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With K⁺ on finer elements and r = E + ρK⁺B_h − B_h the error is
     B − B_h = (I − ρK)⁻¹ r = r + ρKr + … + (ρK)^(n−1) r + (I − ρK)⁻¹ s,   s = (ρK)^n r;
   the error of B' = E + ρKB_h lacks the first term.  The estimate solves for the last term.
   (I − ρK)⁻¹ = Σ (ρK)^k is positive, so the last term is at most (I − ρK)⁻¹ S for S ≥ |s|: the
   bound.  r is orthogonal to the polynomials on elements.  So each term is much smaller than
   the one before, and the bound is close.  S includes possible rounding errors of B, which
   (I − ρK)⁻¹ carries on as it does light.  It does not carry on those of the level of a closed
   component: they are added to the bound. */
#include "accuracy/error-estimate.h"

#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "base/legendre.h"
#include "scene/scene-impl.h"
#include "solution/solution-impl.h"
#include "solve/equation.h"

/* s is sampled at the points of a rule and at the ends.  Between them it may be a little
   larger, and K may be a little larger than K⁺. */
#define BETWEEN  1.25
#define ROUNDING (16 * DBL_EPSILON)

/* Averages below this part of the largest may be rounding errors of other patches' light. */
#define DARK (256 * DBL_EPSILON)

enum { TERMS = 4 };

typedef struct estimator {
  hr2di_equation eq;
  const hr2d_solution *coarse;
  hr2di_basis basis;
  hr2di_rule rule;
  double *kept;     /* the field of B_h */
  double *rest;     /* B_h less the level of closed components, see energy-balance.h */
  double doubt;     /* relative error of the levels of other balanced components */
  double *head;     /* r + … + (ρK)^(n−1) r */
  double *residual; /* r */
  int *exponent;    /* per band, see solve() */
} estimator;

/* Adds a generation of events if elements end at none, or if the target is so small that one
   more may matter. */
hr2di_resolution hr2di_resolution_finer(const hr2di_resolution *f) {
  hr2di_resolution finer = *f;
  const unsigned order = f->order + (f->order < 4 ? 3 : 2);
  finer.order = order < HR2D_MAX_ORDER ? order : HR2D_MAX_ORDER;
  finer.corner_levels += 4;
  finer.cluster_accuracy = fmax(0.1 * f->cluster_accuracy, 1e-14);
  if (f->weight) finer.target *= 0.01;
  if (f->hidden && (f->target < 1e-5 || f->generations == 0)) finer.generations++;
  return finer;
}

/* The largest |value| of a field on a leaf, in a band. */
static double leaf_most(const estimator *e, const double *field, size_t leaf, size_t band) {
  const hr2di_transport *t = &e->eq.transport;
  const double *at = field + leaf * t->width + band;
  double max = fmax(fabs(hr2di_basis_sum(&e->basis, -1, at, t->bands)),
                    fabs(hr2di_basis_sum(&e->basis, 1, at, t->bands)));
  for (size_t q = 0; q < e->rule.points; q++)
    max = fmax(max, fabs(hr2di_basis_sum(&e->basis, e->rule.at[q], at, t->bands)));
  return max;
}

/* field = ρK field, through eq->irradiance. */
static void reflect(hr2di_equation *eq, double *field) {
  hr2di_equation_gather(eq, field);
  for (size_t k = 0; k < eq->field; k++)
    field[k] = eq->root_rho[k] * eq->root_rho[k] * eq->irradiance[k];
}

/* The residual, the head of the series, and the source s of its tail. */
static void set_source(estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  hr2di_solution_restrict(e->coarse, t->hierarchy, t->leaf, t->leaves, t->order, e->kept);
  for (size_t k = 0; k < eq->field; k++)
    e->kept[k] = ldexp(e->kept[k], -eq->exponent[k % t->bands]);
  hr2di_equation_balance(eq);
  hr2di_equation_defect(eq, e->kept, e->residual);
  e->doubt = hr2di_balance_doubt(&eq->balance, t->bands);
  for (size_t k = 0; k < eq->field; k++) {
    const size_t leaf = k / t->width, m = k % t->width;
    const int exact = m < t->bands && hr2di_balance_closed(&eq->balance, leaf);
    e->rest[k] = e->kept[k] - (exact ? hr2di_balance_at(&eq->balance, t, leaf, m) : 0);
  }
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = e->head[k] = e->residual[k];
  eq->background = 0;
  for (int term = 1; term <= TERMS; term++) {
    reflect(eq, eq->source);
    for (size_t k = 0; k < eq->field && term < TERMS; k++) e->head[k] += eq->source[k];
  }
}

/* Replaces the source s by S, constant on each leaf. */
static void set_majorant(estimator *e) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t b = 0; b < t->bands; b++) {
      const double max =
          BETWEEN * leaf_most(e, eq->source, k, b) + ROUNDING * leaf_most(e, e->rest, k, b);
      for (size_t l = 0; l < t->order; l++)
        eq->source[k * t->width + l * t->bands + b] = l == 0 ? max : 0;
    }
  for (size_t k = 0; k < eq->field; k++) eq->y[k] = 0;
}

/* Solves with the source of each band scaled to about 1, by a power of two: squares of the
   unknowns would underflow where the error is tiny. */
static hr2d_status solve(estimator *e, double tolerance) {
  hr2di_equation *eq = &e->eq;
  const size_t bands = eq->transport.bands;
  for (size_t b = 0; b < bands; b++) {
    double max = 0;
    for (size_t k = b; k < eq->field; k += bands) max = fmax(max, fabs(eq->source[k]));
    e->exponent[b] = max > 0 ? ilogb(max) : 0;
    for (size_t k = b; k < eq->field; k += bands)
      eq->source[k] = ldexp(eq->source[k], -e->exponent[b]);
  }
  eq->options.tolerance = tolerance;
  const hr2d_status status = hr2di_equation_solve(eq);
  for (size_t k = 0; k < eq->field; k++) {
    eq->source[k] = ldexp(eq->source[k], e->exponent[k % bands]);
    eq->radiosity[k] = ldexp(eq->radiosity[k], e->exponent[k % bands]);
  }
  return status;
}

/* |average| of a field over each patch; 0 for patches that do not count. */
static void average_errors(estimator *e, const double *field, size_t only, double *error) {
  hr2di_transport *t = &e->eq.transport;
  hr2di_transport_pull(t, field);
  for (size_t k = 0; k < t->hierarchy->scene->patches; k++)
    for (size_t b = 0; b < t->bands; b++) {
      const int counts = only == HR2D_ALL_PATCHES || k == only;
      error[k * t->bands + b] = counts ? fabs(t->up[k * t->width + b]) : 0;
    }
}

/* |average| of B_h over a patch, in the unit of the equation, where nothing is denormal. */
static double average_of(const estimator *e, size_t patch, size_t band) {
  return fabs(ldexp(hr2d_solution_average(e->coarse, patch, band), -e->eq.exponent[band]));
}

/* A patch of a smaller average than this is dark, and has no relative error. */
static double least_average(const estimator *e, size_t band) {
  double max = 0;
  for (size_t k = 0; k < e->eq.transport.hierarchy->scene->patches; k++)
    max = fmax(max, average_of(e, k, band));
  return DARK * max;
}

/* The largest factor·error + more over the patches, relative to their averages of B. */
static double worst_average(const estimator *e, double factor, const double *error,
                            const double *more) {
  const hr2di_transport *t = &e->eq.transport;
  double worst = 0;
  for (size_t b = 0; b < t->bands; b++) {
    const double min = least_average(e, b);
    for (size_t k = 0; k < t->hierarchy->scene->patches; k++) {
      const size_t at = k * t->bands + b;
      const double average = average_of(e, k, b);
      const double sum = factor * error[at] + (more ? more[at] : 0);
      if (sum > 0 && (average > min || sum > min)) worst = fmax(worst, sum / average);
    }
  }
  return worst;
}

/* The largest factor·|field| + |more|, relative to the largest B of the band. */
static double worst_point(const estimator *e, double factor, const double *field,
                          const double *more) {
  const hr2di_transport *t = &e->eq.transport;
  double worst = 0;
  for (size_t b = 0; b < t->bands; b++) {
    double error = 0, max = 0;
    for (size_t k = 0; k < t->leaves; k++) {
      const double rest = more ? leaf_most(e, more, k, b) : 0;
      error = fmax(error, factor * leaf_most(e, field, k, b) + rest);
      max = fmax(max, leaf_most(e, e->kept, k, b));
    }
    if (error > 0) worst = fmax(worst, error / max);
  }
  return worst;
}

static hr2d_status measure(estimator *e, const hr2d_target *target, double *average,
                           hr2di_error_pair *errors) {
  hr2di_equation *eq = &e->eq;
  double *head =
      average + hr2d_scene_patches(eq->transport.hierarchy->scene) * eq->transport.bands;
  set_source(e);
  hr2d_status status = solve(e, 1e-6);
  if (status) return status;
  average_errors(e, e->head, target->importance, head);
  for (size_t k = 0; k < eq->field; k++) eq->radiosity[k] += e->head[k];
  average_errors(e, eq->radiosity, target->importance, average);
  for (size_t k = 0; k < eq->field; k++) {
    eq->radiosity[k] -= e->residual[k];
    e->head[k] -= e->residual[k];
  }
  errors->average.estimate = fmax(worst_average(e, 1, average, NULL), e->doubt);
  errors->sup.estimate = fmax(worst_point(e, 1, eq->radiosity, NULL), e->doubt);
  set_majorant(e);
  status = solve(e, 1e-3);
  average_errors(e, eq->radiosity, target->importance, average);
  const double rounding = eq->balance.count > 0 ? ROUNDING : 0;
  errors->average.bound = worst_average(e, BETWEEN, head, average) + rounding;
  errors->sup.bound = worst_point(e, BETWEEN, e->head, eq->radiosity) + rounding;
  return status;
}

static hr2d_status run(const hr2di_graded *finer, const hr2d_solution *coarse,
                       const hr2d_target *target, hr2di_error_pair *errors) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = target->threads;
  options.progress = target->progress;
  options.progress_ctx = target->progress_ctx;
  estimator e = {.coarse = coarse};
  hr2d_status status = hr2di_equation_init(&e.eq, finer->links, &options);
  if (!status) {
    hr2di_basis_init(&e.basis, e.eq.transport.order);
    hr2di_rule_init(&e.rule, e.eq.transport.order + 2);
    const hr2d_allocator *alloc = &finer->links->alloc;
    const size_t values = hr2d_scene_patches(finer->hierarchy->scene) * e.eq.transport.bands;
    double *space = hr2di_alloc(alloc, 4 * e.eq.field + 2 * values, sizeof *space);
    e.exponent = hr2di_alloc(alloc, e.eq.transport.bands, sizeof *e.exponent);
    e.kept = space;
    if (space && e.exponent) {
      e.head = e.kept + e.eq.field;
      e.residual = e.head + e.eq.field;
      e.rest = e.residual + e.eq.field;
      status = measure(&e, target, e.rest + e.eq.field, errors);
    } else {
      status = HR2D_ENOMEM;
    }
    hr2di_alloc_free(alloc, space);
    hr2di_alloc_free(alloc, e.exponent);
  }
  errors->kernels = e.eq.kernels;
  hr2di_equation_clear(&e.eq);
  return status;
}

/* If nothing reflects, B = E is without error. */
hr2d_status hr2di_error_estimate(const hr2di_graded *answer, const hr2di_resolution *fineness,
                                 const hr2d_target *target, hr2di_error_pair *errors,
                                 hr2di_message *message) {
  const hr2d_scene *scene = answer->hierarchy->scene;
  const hr2di_resolution finer = hr2di_resolution_finer(fineness);
  hr2di_graded held;
  *errors = (hr2di_error_pair){0};
  if (!scene->effect[HR2D_EFFECT_INTERREFLECTION].on) return HR2D_OK;
  hr2d_status status =
      hr2di_graded_refine(&held, scene, answer->hierarchy, &finer, target, message);
  if (!status) {
    status = run(&held, answer->solution, target, errors);
    errors->bytes = hr2di_graded_bytes(&held);
    if (status)
      hr2di_message_fail(message, status, "%s",
                         hr2d_linkset_message(held.links)[0] ? hr2d_linkset_message(held.links)
                                                             : hr2d_strerror(status));
  }
  hr2di_graded_clear(&held);
  return status;
}
