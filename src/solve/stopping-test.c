/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a solve may end although its norm says no.

   The norm ∫B² has the brightest patches.  Where the darkest have a millionth of their light, a
   tolerance for these would be 10⁻⁶ times what is asked for.  But (I − ρK)⁻¹ = Σ(ρK)^k maps
   nothing positive to anything negative: if the residual is nowhere more than ε times the light
   that is reflected there, the error is nowhere more than ε times the light that is reflected
   once more, twice more and so on, a few times ε. */
#include <math.h>

#include "hierarchy/hierarchy-impl.h"
#include "solve/equation.h"

/* |field| on a leaf at most, but for the factors √(2l+1). */
static double size_of(const hr2di_equation *s, const double *field, size_t leaf, size_t band) {
  const hr2di_transport *t = &s->transport;
  double sum = 0;
  for (size_t l = 0; l < t->order; l++)
    sum += fabs(field[leaf * t->width + l * t->bands + band]);
  return sum;
}

static double scattered(const hr2di_transport *t, size_t leaf, size_t band) {
  return hr2di_scene_scattered(t->scene, t->hierarchy->element[t->leaf[leaf]].patch, band);
}

/* What a residual of y on a leaf makes of B.  On a pane that is Lr, and the squares of a row of
   L add up to an entry of |S|, which is at most the largest ρ + τ. */
static double size_in_radiosity(const hr2di_equation *s, const double *r, size_t leaf,
                                size_t band) {
  const hr2di_transport *t = &s->transport;
  const size_t other = t->other_leaf ? t->other_leaf[leaf] : leaf;
  if (other != leaf)
    return sqrt(fmax(scattered(t, leaf, band), scattered(t, other, band))) *
           hypot(size_of(s, r, leaf, band), size_of(s, r, other, band));
  return s->root_rho[leaf * s->transport.width + band] * size_of(s, r, leaf, band);
}

/* The light that a leaf reflects. */
static double reflected(const hr2di_equation *s, size_t leaf, size_t band) {
  const size_t k = leaf * s->transport.width + band;
  return fabs(s->radiosity[k] - s->source[k]);
}

static int is_small_everywhere(const hr2di_equation *s, const double *r, size_t band) {
  const hr2di_transport *t = &s->transport;
  double max = 0;
  for (size_t k = 0; k < t->leaves; k++) max = fmax(max, reflected(s, k, band));
  for (size_t k = 0; k < t->leaves; k++) {
    const double off = size_in_radiosity(s, r, k, band);
    const double min = fmax(reflected(s, k, band), s->enough.floor * max);
    if (!(off <= s->enough.part * min)) return 0;
  }
  return 1;
}

/* Whether the largest part of what an average may be off by has been solved for. */
static int is_small_at_max(const hr2di_equation *s, const double *r, size_t band) {
  const hr2di_transport *t = &s->transport;
  double off = 0, all = 0;
  for (size_t k = 0; k < t->leaves; k++) {
    const double weight = s->enough.weight[k * t->bands + band];
    off = fmax(off, weight * (size_in_radiosity(s, r, k, band)));
    all = fmax(all, weight * size_of(s, s->radiosity, k, band));
  }
  return off <= s->enough.part * all;
}

/* The same of the sum over all leaves, where what is solved for is an importance: it will be
   multiplied by errors like 1/weight. */
static int is_small_in_sum(const hr2di_equation *s, const double *r, size_t band) {
  const hr2di_transport *t = &s->transport;
  double off = 0, all = 0;
  for (size_t k = 0; k < t->leaves; k++) {
    const double weight = s->enough.weight[k * t->bands + band];
    const double size = weight > 0 ? s->weight[k * t->order] / weight : 0;
    off += size * (size_in_radiosity(s, r, k, band));
    all += size * size_of(s, s->radiosity, k, band);
  }
  return off <= s->enough.part * all;
}

int hr2di_equation_is_enough(const hr2di_equation *s, const double *r) {
  if (!(s->enough.part > 0)) return 0;
  if (hr2di_watch_work(s->transport.watch, s->field / 4)) return 0;
  int enough = 1;
  for (size_t b = 0; b < s->transport.bands && enough; b++)
    enough = !s->enough.weight  ? is_small_everywhere(s, r, b)
             : s->enough.summed ? is_small_in_sum(s, r, b)
                                : is_small_at_max(s, r, b);
  return enough;
}
