/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Averages sum up what residuals do everywhere, with signs, and may be small by chance.  With
   the importance Z of one average, Z = s + KρZ, the sum Σ A |⟨r,Z⟩| over leaves has no signs.
   Where views change the coefficients from p on count with the product of their norms, as those
   of a kink at a bad place cancel, too.  The root of the sum of the squares of these products
   is the size of the error with random signs.

   For an average of B, s is 1/(A B̄) on the patch; Y = ρZ is the radiosity of a source ρs.  For
   one of H, s is K of 1/(A H̄); Y = 1/(A H̄) + ρZ is the radiosity of a source 1/(A H̄), and Z is
   KY.

   With M of one row per patch, M_ij = A_j ⟨r_j, Z_i⟩ on leaf j, the largest sum is ‖M‖∞, the
   largest |Mσ| for any signs σ.  It is looked for as Hager (1984) and Higham (1988) do: the row
   where |Mσ| is largest for some σ mostly has the largest sum, or one nearly as large.  Mσ are
   the errors of all averages for residuals σ_j r_j; a row is one more solve.  σ is random, and
   all signs +, which are the errors themselves, are a second sample. */
#include "estimate/unsigned-error.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "estimate/importance.h"
#include "estimate/residual-series.h"
#include "scene/panes.h"

/* The relative accuracy of the solve for a row, and of that for a sample. */
#define ROW    3e-2
#define SAMPLE 1e-1

/* A random bit, the same on every machine (the finalizer of MurmurHash3). */
static int is_turned(uint64_t k) {
  uint64_t x = k + 1;
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdU;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53U;
  return (int)((x ^ (x >> 33)) & 1);
}

/* Sets e->rounding, used as work space here, to √(a² + s²) for the averages of B and of H: a is
   the error itself, s that of the residuals with random signs, Mσ.  The error s of B is the
   average of σr plus ρ times that of H.  Changes e->max and e->error. */
static hr2d_status sample(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  hr2di_transport *t = &eq->transport;
  double *const own = e->max, *const first = e->error;
  for (size_t k = 0; k < eq->field; k++)
    eq->source[k] = is_turned(k / t->width) ? -e->residual[k] : e->residual[k];
  hr2di_estimator_averages(e, eq->source, own);
  hr2di_residual_reflect(eq, eq->source);
  hr2di_estimator_averages(e, eq->irradiance, first);
  const hr2d_status status = hr2di_estimator_solve_part(e, SAMPLE, HR2DI_AIM_ERRORS);
  if (status) return status;
  hr2di_transport_pull(t, eq->irradiance);
  for (size_t k = 0; k < e->values; k++) {
    const size_t patch = k / t->bands, b = k % t->bands;
    const size_t other = hr2di_scene_other_side(t->hierarchy->scene, patch);
    const double h = first[k] + t->up[patch * t->width + b];
    const double passed = first[other * t->bands + b] + t->up[other * t->width + b];
    const double reflected = hr2di_pane_sum(t->hierarchy->scene, patch, b, h, passed);
    e->rounding[0][k] = hypot(e->average[0][k], own[k] + reflected);
    e->rounding[1][k] = hypot(e->average[1][k], h);
  }
  return HR2D_OK;
}

/* The important patch with the largest relative error in both samples; any if all are 0. */
static size_t worst_patch(const hr2di_estimator *e, int irradiance, size_t band) {
  const size_t bands = e->eq.transport.bands, patches = e->values / bands;
  size_t found = 0;
  double worst = 0;
  for (size_t k = 0; k < patches; k++) {
    const double error = e->rounding[irradiance][k * bands + band];
    const double min = hr2di_estimator_min(e, irradiance, k, band);
    if (!(error > worst * min) || !(min > 0) || !hr2di_is_important(e->target, k)) continue;
    found = k;
    worst = error / min;
  }
  return found;
}

/* A row, of the worst patch for one quantity in a band.  On a pane Y for the average of B is
   the radiosity of a source Ss on both sides, so that each quantity has a row of its own. */
typedef struct row {
  size_t patch;
  int pane;
  int choice;  /* 1: the patch is the worst one of H */
  double unit; /* s for the average of H on the patch, 1/(A H̄); 0 if no light falls there */
  double part; /* of Y for that of H is Y for that of B; on a pane of s */
} row;

static row row_of(const hr2di_estimator *e, int choice, size_t b) {
  const hr2di_transport *t = &e->eq.transport;
  const hr2d_scene *scene = t->hierarchy->scene;
  row r = {.patch = worst_patch(e, choice, b), .choice = choice};
  const double min_b = hr2di_estimator_min(e, 0, r.patch, b),
               min_h = hr2di_estimator_min(e, 1, r.patch, b);
  r.pane = hr2di_pane_is(scene, r.patch);
  if (min_h > 0) r.unit = 1 / min_h / t->hierarchy->element[r.patch].length;
  const double rho = r.pane ? 1 : hr2d_scene_reflectance(scene, r.patch, b);
  if (min_b > 0) r.part = rho * (min_h / min_b);
  return r;
}

/* What a row of B on a pane has on either side. */
static double passed(const hr2d_scene *scene, const row *r, size_t patch, size_t b) {
  if (patch == r->patch) return hr2d_scene_reflectance(scene, patch, b) * r->unit;
  return patch == hr2di_scene_other_side(scene, r->patch)
             ? hr2d_scene_transmittance(scene, patch, b) * r->unit
             : 0;
}

/* Sets the source to 1/(A H̄) of a patch in each band. */
static void set_source(hr2di_estimator *e, int choice) {
  hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  for (size_t k = 0; k < eq->field; k++) eq->source[k] = 0;
  for (size_t b = 0; b < t->bands; b++) {
    const row r = row_of(e, choice, b);
    for (size_t leaf = 0; leaf < t->leaves && r.unit > 0; leaf++) {
      const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
      if (r.pane && !choice)
        eq->source[leaf * t->width + b] = passed(t->hierarchy->scene, &r, patch, b);
      else if (patch == r.patch)
        eq->source[leaf * t->width + b] = r.unit;
    }
  }
}

/* A |⟨r,Z⟩| on a leaf, for the averages of B and of H.  `left` is that of the coefficients
   below p, which the solve has left.  `high` is that of the coefficients from p on, or an upper
   bound of it if there may be kinks. */
static void term_of(const hr2di_estimator *e, size_t leaf, size_t b, const row *r,
                    double left[2], double high[2]) {
  const hr2di_equation *eq = &e->eq;
  const hr2di_transport *t = &eq->transport;
  const double rho = hr2di_estimator_rho(e, leaf, b), area = eq->weight[leaf * t->order];
  const int own = t->hierarchy->element[t->leaf[leaf]].patch == r->patch;
  double rest = 0, inner[2] = {0, 0};
  for (int h = 0; h < 2; h++) left[h] = high[h] = 0;
  for (size_t l = 0; l < t->order; l++) {
    const size_t k = leaf * t->width + l * t->bands + b;
    const double s = r->pane   ? (own && l == 0 ? r->unit : 0)
                     : rho > 0 ? eq->source[k] / rho
                               : 0;
    const double z[2] = {r->part * (eq->irradiance[k] + s), eq->irradiance[k]};
    for (int h = 0; h < 2; h++) {
      double *const sum = l < e->coarse->order ? left : inner;
      sum[h] += z[h] * e->residual[k];
      if (l >= e->coarse->order) high[h] = hypot(high[h], z[h]);
    }
    if (l >= e->coarse->order) rest = hypot(rest, e->residual[k]);
  }
  for (int h = 0; h < 2; h++) {
    left[h] = area * fabs(left[h]);
    high[h] = area * (e->blind > 0 ? high[h] * rest : fabs(inner[h]));
  }
}

/* The sums over the row of the last solve in one band, for the averages of B and of H, and the
   roots of the sums of squares.  The last solve gave Y for the average of H; Y for that of B is
   this times a factor, ρH̄/B̄ of the patch of the row.
 */
static void sum_row(hr2di_estimator *e, size_t b, const row *r, double sum[2],
                    double scatter[2]) {
  const hr2di_transport *t = &e->eq.transport;
  for (int h = 0; h < 2; h++) sum[h] = scatter[h] = 0;
  for (size_t leaf = 0; leaf < t->leaves && !hr2di_estimator_stopped(e); leaf++) {
    double left[2], high[2];
    term_of(e, leaf, b, r, left, high);
    for (int h = 0; h < 2; h++) {
      sum[h] += left[h] + high[h];
      scatter[h] = hypot(scatter[h], high[h]);
    }
  }
}

/* Residuals have the coefficients that the part of the equation lacks.  Z has them from two
   gathers, between which the part takes on what is left. */
static hr2d_status complete(hr2di_estimator *e) {
  hr2di_equation *eq = &e->eq;
  double *const first = e->error;
  memcpy(first, eq->radiosity, eq->field * sizeof *first);
  hr2di_residual_reflect(eq, eq->radiosity);
  for (size_t k = 0; k < eq->field; k++) eq->source[k] += eq->radiosity[k] - first[k];
  const hr2d_status status = hr2di_estimator_solve_part(e, ROW, HR2DI_AIM_IMPORTANCE);
  if (status) return status; /* other shares learn it at the next agreement, not in a gather */
  for (size_t k = 0; k < eq->field; k++) first[k] += eq->radiosity[k];
  hr2di_equation_gather(eq, first);
  return hr2di_transport_status(&eq->transport);
}

hr2d_status hr2di_unsigned_row(hr2di_estimator *e) {
  const hr2d_status status = hr2di_estimator_solve_part(e, ROW, HR2DI_AIM_IMPORTANCE);
  return status || e->whole ? status : complete(e);
}

/* Raises the sums of B and of H by those of the patches chosen for one of them. */
static hr2d_status sum_rows(hr2di_estimator *e, int choice) {
  const size_t bands = e->eq.transport.bands;
  set_source(e, choice);
  const hr2d_status status = hr2di_unsigned_row(e);
  set_source(e, choice);
  for (size_t b = 0; b < bands && !status; b++) {
    const row r = row_of(e, choice, b);
    double sum[2], scatter[2];
    sum_row(e, b, &r, sum, scatter);
    for (int h = 0; h < 2; h++) {
      const size_t at = (size_t)h * bands + b;
      if (r.pane && h != choice) continue;
      e->safe[at] = fmax(e->safe[at], sum[h]);
      e->scatter[at] = fmax(e->scatter[at], scatter[h]);
    }
  }
  return status;
}

/* Whether the worst averages of B and of H are those of the same patches, and one row does. */
static int same_choice(const hr2di_estimator *e) {
  const hr2d_scene *scene = e->eq.transport.hierarchy->scene;
  for (size_t b = 0; b < e->eq.transport.bands; b++) {
    const size_t patch = worst_patch(e, 0, b);
    if (patch != worst_patch(e, 1, b) || hr2di_pane_is(scene, patch)) return 0;
  }
  return 1;
}

/* The row of one patch serves both its averages, and either may be the larger one. */
hr2d_status hr2di_unsigned_error(hr2di_estimator *e) {
  hr2d_status status = sample(e);
  if (!status) status = sum_rows(e, 1);
  return status || same_choice(e) ? status : sum_rows(e, 0);
}
