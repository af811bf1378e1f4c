/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The power that escapes is Σ A (B − H) with H from patches, and the power that comes in Σ A s
   L with the form factor s of the background, 1 less that of patches and backs.  Both are off
   by what K is off, the one with B, the other with L.  Averages of H may be off by much less:
   where all is isothermal, what K lacks comes from the background.

   Where a leaf sees backs, they have what is left of the ends, and s is off by the series of
   the sky that shows past these.  At order 1 row sums are off by that. */
#include "solve/power-cut-off.h"

#include <math.h>

#include "base/alloc.h"
#include "scene/scene-impl.h"
#include "solve/row-tails.h"

/* Fields of leaves: a radiosity, what a check leaves of its irradiance, and the largest of
   these over the checks, for B and for L. */
typedef struct fields {
  double *from, *to, *max[2];
  double *sky;  /* per element: what a check leaves of the form factor of the sky, or the series
                   makes of it, */
  double *ends; /* and the form factor of what is past the ends */
} fields;

static void take_largest(const hr2di_transport *t, const double *check, double *max) {
  for (size_t k = 0; k < t->leaves * t->width; k++) max[k] = fmax(max[k], fabs(check[k]));
}

static void set_light(const hr2di_equation *s, double *field) {
  const hr2di_transport *t = &s->transport;
  for (size_t k = 0; k < s->field; k++)
    field[k] = k % t->width < t->bands ? s->light[k % t->width] : 0;
}

/* Adds to |f->to| what the series of the sky leaves, where that counts, times the radiosity. */
static void add_sky(const hr2di_equation *s, const fields *f, const double *radiosity) {
  const hr2di_transport *t = &s->transport;
  const unsigned char *sees = t->links->sees_backs;
  for (size_t k = 0; k < t->leaves; k++) {
    const size_t patch = t->hierarchy->element[t->leaf[k]].patch;
    if (t->order > 1 && !(sees && sees[patch])) continue;
    for (size_t b = 0; b < t->bands; b++)
      f->to[k * t->width + b] = fabs(f->to[k * t->width + b]) +
                                fabs(f->sky[t->leaf[k]] * radiosity[k * t->width + b]);
  }
}

static void run_check(hr2di_equation *s, int check, const fields *f, const double *radiosity,
                      double *max) {
  hr2di_transport_check(&s->transport, check, radiosity, f->to);
  add_sky(s, f, radiosity);
  take_largest(&s->transport, f->to, max);
}

/* The largest radiosity of a band. */
static double brightest(const hr2di_equation *s, size_t band) {
  const hr2di_transport *t = &s->transport;
  double max = 0;
  for (size_t k = 0; k < t->leaves; k++) {
    double sum = 0;
    for (size_t l = 0; l < t->order; l++)
      sum += fabs(s->radiosity[k * t->width + l * t->bands + band]) * sqrt(2 * (double)l + 1);
    max = fmax(max, sum);
  }
  return max;
}

/* Adds what may be past the ends. */
static void add_ends(const hr2di_equation *s, const fields *f) {
  const hr2di_transport *t = &s->transport;
  for (size_t b = 0; b < t->bands; b++) {
    const double light[] = {brightest(s, b), t->sky ? s->light[b] : 0};
    for (size_t k = 0; k < t->leaves; k++)
      for (int m = 0; m < 2; m++) f->max[m][k * t->width + b] += f->ends[t->leaf[k]] * light[m];
  }
}

static hr2d_status run_all(hr2di_equation *s, const fields *f) {
  hr2di_transport *t = &s->transport;
  const hr2d_status status = hr2di_row_tails_seen(t->hierarchy, f->ends, f->sky, t->watch);
  for (size_t k = 0; k < s->field; k++) f->max[0][k] = f->max[1][k] = 0;
  if (status) return status;
  run_check(s, HR2DI_CHECK_ALL, f, s->radiosity, f->max[0]);
  if (t->sky) run_check(s, HR2DI_CHECK_ALL, f, f->from, f->max[1]);
  add_ends(s, f);
  return hr2di_transport_status(t);
}

static hr2d_status run_checks(hr2di_equation *s, const fields *f) {
  hr2di_transport *t = &s->transport;
  const int looks = t->order == 1 || t->links->sees_backs;
  hr2d_status status = HR2D_OK;
  if (t->sky) set_light(s, f->from);
  for (int check = 0; check < HR2DI_TAIL_CHECKS && !status; check++) {
    if (looks) status = hr2di_row_tails_check(t->hierarchy, check, f->sky, t->watch);
    if (!status) run_check(s, check, f, s->radiosity, f->max[0]);
    if (!status && t->sky) run_check(s, check, f, f->from, f->max[1]);
    if (!status) status = hr2di_transport_status(t);
  }
  return status;
}

static double power_of(const hr2di_equation *s, const double *max, size_t band) {
  const hr2di_transport *t = &s->transport;
  const size_t cell = hr2di_scene_cell(t->scene);
  double sum = 0;
  for (size_t k = 0; k < t->leaves; k++)
    if (t->hierarchy->element[t->leaf[k]].patch < cell)
      sum += s->weight[k * t->order] * max[k * t->width + band];
  return sum;
}

hr2d_status hr2di_power_cut_off(hr2di_equation *s, double *off) {
  hr2di_transport *t = &s->transport;
  const double unit = hr2d_scene_unit(t->scene);
  double *room = hr2di_alloc_zero(&t->alloc, 4 * s->field + 2 * t->elements, sizeof *room);
  if (!room) return HR2D_ENOMEM;
  const fields f = {.from = room,
                    .to = room + s->field,
                    .max = {room + 2 * s->field, room + 3 * s->field},
                    .sky = room + 4 * s->field,
                    .ends = room + 4 * s->field + t->elements};
  hr2d_status status = run_checks(s, &f);
  for (size_t b = 0; b < t->bands && !status; b++)
    off[b] = HR2DI_TAIL_BOUND * fmax(power_of(s, f.max[0], b), power_of(s, f.max[1], b));
  const int few = t->scene->symmetry.copies <= HR2DI_FEW_COPIES;
  if (!status && few) status = run_all(s, &f);
  for (size_t b = 0; b < t->bands && !status; b++) {
    const double all = fmax(power_of(s, f.max[0], b), power_of(s, f.max[1], b));
    off[b] = ldexp(unit * (few ? fmin(off[b], all) : off[b]), s->exponent[b]);
  }
  hr2di_alloc_free(&t->alloc, room);
  return status;
}
