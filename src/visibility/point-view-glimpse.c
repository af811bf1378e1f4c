/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A glimpse: the part of a patch that a point sees between two directions, and its form
   factor. */
#include <float.h>
#include <math.h>

#include "visibility/point-view-impl.h"

/* (u−x)×(v−x).  Vectors are good to 2^-104 of their lengths: of a small angle the shorter one
   and v−u say more. */
static double cross(const hr2di_viewer *w, uint32_t u, uint32_t v) {
  const hr2di_bearing *p = &w->bearing[u], *q = &w->bearing[v];
  const double det = hr2di_det(&p->to, &q->to);
  if (fabs(det) >= 0x1p-40 * p->distance * q->distance) return det;
  const hr2di_vector uv = hr2di_vector_difference(w->vertex[v], w->vertex[u]);
  return hr2di_det(p->distance < q->distance ? &p->to : &q->to, &uv);
}

/* ½(1 − s) with s the sine towards the horizon. */
static double to_horizon(double s, double cosine) {
  return s > 0 ? cosine * cosine / (2 * (1 + s)) : (1 - s) / 2;
}

/* ½(sin u − sin v) = cos((u+v)/2) sin((u−v)/2).  With unit vectors the first factor is the
   height of their sum over its length, the second half of the sine of the angle between them
   over the cosine of half of it; where that angle is wide nothing cancels. */
static double half_sine(const hr2di_viewer *w, uint32_t right, uint32_t left) {
  if (right == HR2DI_HORIZON && left == HR2DI_HORIZON) return 1;
  const hr2di_bearing *u = &w->bearing[right], *v = &w->bearing[left];
  if (right == HR2DI_HORIZON) return to_horizon(v->sine, v->cosine);
  if (left == HR2DI_HORIZON) return to_horizon(-u->sine, u->cosine);
  const double cosine = u->sine * v->sine + u->cosine * v->cosine;
  if (cosine <= 0) return (u->sine - v->sine) / 2;
  const double sine = cross(w, right, left) / u->distance / v->distance;
  return (u->cosine + v->cosine) * sine / (2 * (1 + cosine));
}

/* Where the ray through `vertex` meets a patch that shows its front. */
static double fraction_at(const hr2di_viewer *w, const hr2di_arc *arc, uint32_t vertex) {
  const uint32_t p = w->end[arc->patch][0], q = w->end[arc->patch][1];
  if (vertex == p) return 0;
  if (vertex == q) return 1;
  double at_p = w->bearing[p].height, at_q = w->bearing[q].height;
  if (vertex != HR2DI_HORIZON) {
    at_p = hr2di_det(&w->bearing[vertex].to, &w->bearing[p].to);
    at_q = hr2di_det(&w->bearing[vertex].to, &w->bearing[q].to);
  }
  /* What has the wrong sign is but a rounding. */
  if (at_p == 0 || at_q == 0 || (at_p > 0) == (at_q > 0)) return fabs(at_p) > fabs(at_q);
  return at_p / (at_p - at_q);
}

void hr2di_view_note(hr2di_viewer *w, const hr2di_arc *arc, uint32_t right, uint32_t left) {
  const double sine = half_sine(w, right, left);
  if (!(sine > 0)) return;
  if (!arc->front) {
    hr2di_sum_add(&w->back, sine);
    return;
  }
  double from = fraction_at(w, arc, right), to = fraction_at(w, arc, left);
  /* Close to a patch a wide angle may take less of it than fractions can tell. */
  if (!(from < to)) {
    to = from + DBL_EPSILON;
    if (to > 1) {
      to = 1;
      from = 1 - DBL_EPSILON;
    }
  }
  w->glimpse[w->glimpses++] = (hr2di_glimpse){arc->patch, from, to, fmin(sine, 1)};
}
