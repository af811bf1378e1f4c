/* SPDX-License-Identifier: GPL-3.0-or-later */
/* L against N over a sequence of ε, and the fits. */
#include <float.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_linalg.h>
#include <hr2d/study.h>
#include <math.h>

#include "base/alloc.h"
#include "base/clock.h"
#include "base/sized-struct.h"
#include "base/team.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/linkset-impl.h"

/* Counts once on a hierarchy of its own, with the oracle and policy of `links`, which
   keeps owning their contexts. */
static hr2d_status count_once(hr2d_linkset *links, const hr2d_refine_options *options,
                              hr2d_study_row *row) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *empty = NULL;
  hr2d_oracle oracle = links->oracle;
  hr2d_policy policy = links->policy;
  oracle.struct_size = sizeof oracle;
  policy.struct_size = sizeof policy;
  oracle.destroy = NULL;
  policy.destroy = NULL;
  hr2d_status status = hr2d_hierarchy_create(links->hierarchy->scene, &hierarchy);
  if (!status)
    status = hr2d_linkset_create(hierarchy, &oracle, links->oracle_ctx, &policy,
                                 links->policy_ctx, &empty);
  if (status) {
    hr2di_message_fail(&links->message, status, "out of memory for the study");
  } else {
    const double start = hr2di_clock_now();
    status = hr2d_refine_count(empty, options, &row->counts);
    row->seconds = hr2di_clock_now() - start;
    if (status)
      hr2di_message_fail(&links->message, status, "at epsilon %g: %s", row->epsilon,
                         hr2d_linkset_message(empty));
  }
  hr2d_linkset_destroy(empty);
  hr2d_hierarchy_destroy(hierarchy);
  return status;
}

hr2d_status hr2d_study_run(hr2d_linkset *links, const hr2d_refine_options *options,
                           const double *epsilon, size_t count, hr2d_study_row *rows,
                           size_t *done) {
  if (!links || (count && (!epsilon || !rows))) return HR2D_EINVAL;
  hr2d_refine_options used = HR2D_REFINE_OPTIONS_INIT;
  hr2d_status status = HR2D_OK;
  size_t k = 0;
  if (done) *done = 0;
  if (hr2di_sized_copy(&used, sizeof used, options))
    return hr2di_message_fail(&links->message, HR2D_EINVAL, "struct_size is not set");
  used.threads = (unsigned)hr2di_team_threads(used.threads);
  used.brightness = NULL; /* every count begins on a new hierarchy */
  if (links->store.count > 0)
    return hr2di_message_fail(&links->message, HR2D_ESTATE, "the set has links already");
  for (; k < count && !status; k++) {
    /* Among options 0 would be the default. */
    if (!(epsilon[k] >= 0))
      return hr2di_message_fail(&links->message, HR2D_EINVAL, "epsilon %g is not a number ≥ 0",
                                epsilon[k]);
    used.epsilon = epsilon[k] > 0 ? epsilon[k] : HR2D_EPSILON_ZERO;
    rows[k].epsilon = epsilon[k];
    status = count_once(links, &used, &rows[k]);
    if (!status && done) *done = k + 1;
  }
  return status;
}

static size_t distinct_sizes(const hr2d_study_row *rows, size_t count) {
  uint64_t seen[3] = {0};
  size_t distinct = 0;
  for (size_t k = 0; k < count && distinct < 3; k++) {
    size_t m = 0;
    while (m < distinct && seen[m] != rows[k].counts.elements) m++;
    if (m == distinct) seen[distinct++] = rows[k].counts.elements;
  }
  return distinct;
}

/* N = middle + half·x with x in [−1,1].  So the columns 1, x, x² are far from parallel, no
   matter how close the N are. */
typedef struct scale {
  uint64_t min;
  double middle, half;
} scale;

static scale scale_of(const hr2d_study_row *rows, size_t count) {
  uint64_t min = UINT64_MAX, max = 0;
  for (size_t k = 0; k < count; k++) {
    const uint64_t n = rows[k].counts.elements;
    if (n < min) min = n;
    if (n > max) max = n;
  }
  const double half = 0.5 * (double)(max - min);
  return (scale){min, (double)min + half, half};
}

/* n − m, for integers that may be equal as doubles. */
static double difference(uint64_t n, uint64_t m) {
  return n >= m ? (double)(n - m) : -(double)(m - n);
}

/* L is counted from the L of the first row, so that equal L have no spread by rounding. */
static void fill(const hr2d_study_row *rows, size_t count, scale n, gsl_matrix *powers,
                 gsl_vector *links) {
  for (size_t k = 0; k < count; k++) {
    const double x = ((double)(rows[k].counts.elements - n.min) - n.half) / n.half;
    gsl_matrix_set(powers, k, 0, 1);
    gsl_matrix_set(powers, k, 1, x);
    gsl_matrix_set(powers, k, 2, x * x);
    gsl_vector_set(links, k, difference(rows[k].counts.links, rows[0].counts.links));
  }
}

/* Whether three N are so far apart that x, rounded to 2^-53, keeps nine digits of their
   distances.  Of 1, 2 and 10^18 the first two count as one. */
static int are_spread(const hr2d_study_row *rows, size_t count, scale n) {
  const double margin = 0x1p-23 * n.half;
  for (size_t k = 0; k < count; k++) {
    const double above = (double)(rows[k].counts.elements - n.min);
    if (above > margin && 2 * n.half - above > margin) return 1;
  }
  return 0;
}

/* 1 − Σe²/Σd², with d the distances from the mean. */
static double determination(const gsl_vector *links, const gsl_vector *residual) {
  double mean = 0, errors = 0, spread = 0;
  for (size_t k = 0; k < links->size; k++)
    mean += gsl_vector_get(links, k) / (double)links->size;
  for (size_t k = 0; k < links->size; k++) {
    const double e = gsl_vector_get(residual, k), d = gsl_vector_get(links, k) - mean;
    errors += e * e;
    spread += d * d;
  }
  return spread > 0 ? 1 - errors / spread : 1;
}

/* log(n/m), accurate also where n and m are close. */
static double log_ratio(uint64_t n, uint64_t m) {
  const double ratio = (double)n / (double)m;
  return ratio > 0.5 && ratio < 2 ? log1p(difference(n, m) / (double)m) : log(ratio);
}

static double slope_of_logs(const hr2d_study_row *rows, size_t count, double *x, double *y) {
  double c0, c1, cov00, cov01, cov11, sum;
  for (size_t k = 0; k < count; k++) {
    x[k] = log_ratio(rows[k].counts.elements, rows[0].counts.elements);
    y[k] = log_ratio(rows[k].counts.links, rows[0].counts.links);
  }
  gsl_fit_linear(x, 1, y, 1, count, &c0, &c1, &cov00, &cov01, &cov11, &sum);
  return c1;
}

/* GSL's routines work on views of our memory here: if GSL allocated and failed, it would call
   its error handler, which aborts. */
hr2d_status hr2d_study_fit_rows(const hr2d_study_row *rows, size_t count, hr2d_study_fit *fit) {
  if (!rows || !fit) return HR2D_EINVAL;
  if (distinct_sizes(rows, count) < 3) return HR2D_EINVAL;
  for (size_t k = 0; k < count; k++)
    if (rows[k].counts.links == 0 || rows[k].counts.elements == 0) return HR2D_EINVAL;
  const scale n = scale_of(rows, count);
  if (!are_spread(rows, count, n)) return HR2D_EINVAL;
  const hr2d_allocator alloc = hr2di_alloc_default();
  double *space = hr2di_alloc(&alloc, count, 5 * sizeof *space);
  if (!space) return HR2D_ENOMEM;
  double tau[3], solution[3];
  gsl_matrix_view powers = gsl_matrix_view_array(space, count, 3);
  gsl_vector_view links = gsl_vector_view_array(space + 3 * count, count);
  gsl_vector_view residual = gsl_vector_view_array(space + 4 * count, count);
  gsl_vector_view tau_view = gsl_vector_view_array(tau, 3);
  gsl_vector_view x = gsl_vector_view_array(solution, 3);
  fill(rows, count, n, &powers.matrix, &links.vector);
  gsl_linalg_QR_decomp(&powers.matrix, &tau_view.vector);
  gsl_linalg_QR_lssolve(&powers.matrix, &tau_view.vector, &links.vector, &x.vector,
                        &residual.vector);
  const double r2 = determination(&links.vector, &residual.vector);
  const double slope = slope_of_logs(rows, count, space, space + count);
  hr2di_alloc_free(&alloc, space);
  const double m = n.middle / n.half, first = (double)rows[0].counts.links;
  const hr2d_study_fit made = {.a = first + solution[0] - m * (solution[1] - m * solution[2]),
                               .b = (solution[1] - 2 * m * solution[2]) / n.half,
                               .c = solution[2] / n.half / n.half,
                               .r2 = r2,
                               .slope = slope};
  if (!isfinite(made.a) || !isfinite(made.b) || !isfinite(made.c) || !isfinite(slope))
    return HR2D_EINVAL;
  *fit = made;
  return HR2D_OK;
}
