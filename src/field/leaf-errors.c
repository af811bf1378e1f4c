/* SPDX-License-Identifier: GPL-3.0-or-later */
/* |B_h − B| ≤ |B_h − B'| + |B' − B|, with B' as points gather it.  The account of a solution
   bounds the last term.  The one before is looked at: B_h has p coefficients, so that it
   differs from B' by about a multiple of the next polynomial, which is largest at the ends of
   the leaf. Beside them points are the extrema of a Chebyshev polynomial. */
#include "field/leaf-errors.h"

#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "scene/scene-impl.h"

/* Points of a leaf besides its coefficients, so that there is one between the zeros of the next
   polynomial; how far inside of the leaf the first of them is, as a part of it; and a factor
   for what lies between them, which tests/unit/field/check-field-errors.c holds. */
enum { MORE = 3 };
#define INSET  1e-9
#define MISSED 2

typedef struct observer {
  const hr2di_leaves *leaves;
  const hr2d_solution *solution;
  hr2di_watch *watch;
  double *t, *value; /* of the points of a leaf */
  double *largest;   /* per band: of B */
  double *error;
} observer;

static hr2d_status sample(observer *l, size_t patch, size_t leaf) {
  const hr2d_solution *s = l->solution;
  const double from = l->leaves->leaf[leaf].from, to = hr2di_leaf_end(l->leaves, patch, leaf);
  const size_t points = s->order + MORE, last = points - 1;
  double *error = l->error + l->leaves->leaf[leaf].element * s->bands;
  for (size_t k = 0; k < points; k++) {
    const double x = (1 - 2 * INSET) * cos(HR2DI_PI * (double)k / (double)last);
    l->t[k] = from + (0.5 - 0.5 * x) * (to - from);
  }
  const hr2d_status status = hr2di_solution_gather(s, patch, l->t, points, l->value, l->watch);
  for (size_t k = 0; k < points * s->bands && !status; k++) {
    const size_t band = k % s->bands;
    const double is = hr2d_solution_at(s, patch, l->t[k / s->bands], band);
    error[band] = fmax(error[band], MISSED * fabs(is - l->value[k]));
    l->largest[band] = fmax(l->largest[band], fmax(is, l->value[k]));
  }
  return status;
}

/* Adds the last term, and takes the largest of the children, which have higher numbers. */
static void join(observer *l, double sup) {
  const hr2d_solution *s = l->solution;
  const size_t cell = hr2di_scene_cell(s->hierarchy->scene);
  for (size_t e = s->elements; e-- > 0;) {
    const hr2d_element *element = &s->hierarchy->element[e];
    const uint32_t child = element->child;
    const int is_leaf = !child || child >= s->elements;
    for (size_t b = 0; b < s->bands && element->patch < cell; b++)
      l->error[e * s->bands + b] =
          is_leaf ? l->error[e * s->bands + b] + sup * l->largest[b]
                  : fmax(l->error[child * s->bands + b], l->error[(child + 1) * s->bands + b]);
  }
}

hr2d_status hr2di_leaf_errors(const hr2di_leaves *leaves, const hr2d_solution *solution,
                              double sup, hr2di_watch *watch, double **error) {
  const size_t points = solution->order + MORE, bands = solution->bands;
  const hr2d_allocator *alloc = &solution->alloc;
  observer l = {.leaves = leaves, .solution = solution, .watch = watch};
  l.error = hr2di_alloc_zero(alloc, solution->elements * bands, sizeof *l.error);
  l.t = hr2di_alloc_zero(alloc, points + (points + 1) * bands, sizeof *l.t);
  hr2d_status status = l.error && l.t ? HR2D_OK : HR2D_ENOMEM;
  if (!status) {
    l.value = l.t + points;
    l.largest = l.value + points * bands;
  }
  for (size_t k = 0; k < hr2di_scene_cell(solution->hierarchy->scene) && !status; k++)
    for (size_t m = leaves->of_patch[k]; m < leaves->of_patch[k + 1] && !status; m++)
      status = sample(&l, k, m);
  if (!status) join(&l, sup);
  hr2di_alloc_free(alloc, l.t);
  if (status) hr2di_alloc_free(alloc, l.error);
  *error = status ? NULL : l.error;
  return status;
}
