/* SPDX-License-Identifier: GPL-3.0-or-later */
/* G dy = ½ cosθ dθ: from a point x of i the integrand over directions is bounded, however near
   j is.  It is smooth in x between the places where a line through two of the ends meets i. */
#include "independent/brute-block.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <stdlib.h>

#include "independent/pair-frame.h"

enum { LIMIT = 400 };

typedef struct arc {
  real from, to; /* directions, from the normal of i */
} arc;

struct brute_view {
  real length;      /* of i */
  real from, to;    /* the part of i in front of j */
  frame_point c, d; /* all of j */
  frame_point
      *end; /* the ends of the part of j in front of i, then the ends of each occluder */
  size_t ends;
  real *cut;
  size_t cuts;
  arc *hidden, *open;
  gsl_integration_cquad_workspace *inner, *outer;
  unsigned l, m;
  real x;
  real sine, cosine; /* of the middle of the arc under way */
};

brute_view *brute_view_open(const hr2d_segment *i, const hr2d_segment *j,
                            const hr2d_segment *occluder, size_t count) {
  brute_view *v = calloc(1, sizeof *v);
  v->end = malloc((2 * count + 2) * sizeof *v->end);
  v->hidden = malloc((count + 1) * sizeof *v->hidden);
  v->open = malloc((count + 1) * sizeof *v->open);
  v->inner = gsl_integration_cquad_workspace_alloc(LIMIT);
  v->outer = gsl_integration_cquad_workspace_alloc(LIMIT);
  v->c = frame_of(i, j, j->a);
  v->d = frame_of(i, j, j->b);
  v->length = frame_of(i, j, i->b).along;
  if (!frame_front(i, j, &v->from, &v->to)) v->to = v->from;
  v->end[0] = v->c;
  v->end[1] = v->d;
  if (!frame_clip(&v->end[0], &v->end[1], 0)) v->to = v->from;
  v->ends = 2;
  for (size_t k = 0; k < count; k++) {
    v->end[v->ends] = frame_of(i, j, occluder[k].a);
    v->end[v->ends + 1] = frame_of(i, j, occluder[k].b);
    if (frame_clip(&v->end[v->ends], &v->end[v->ends + 1], 1)) v->ends += 2;
  }
  v->cut = malloc((v->ends * (v->ends + 1) / 2 + 2) * sizeof *v->cut);
  /* Near the feet of ends the integrand may change fast. */
  v->cuts = frame_events(v->end, v->ends, v->from, v->to, 1, v->cut);
  return v;
}

void brute_view_close(brute_view *v) {
  gsl_integration_cquad_workspace_free(v->inner);
  gsl_integration_cquad_workspace_free(v->outer);
  free(v->end);
  free(v->cut);
  free(v->hidden);
  free(v->open);
  free(v);
}

static arc seen(const brute_view *v, const frame_point *p, const frame_point *q) {
  const real s = atan2l(p->along - v->x, p->height), t = atan2l(q->along - v->x, q->height);
  return s < t ? (arc){s, t} : (arc){t, s};
}

static int by_from(const void *left, const void *right) {
  const arc *l = left, *r = right;
  return (l->from > r->from) - (l->from < r->from);
}

/* The directions in which x sees j; their number. */
static size_t find_open(brute_view *v) {
  arc left = seen(v, &v->end[0], &v->end[1]);
  size_t hidden = 0, open = 0;
  for (size_t k = 2; k < v->ends; k += 2)
    v->hidden[hidden++] = seen(v, &v->end[k], &v->end[k + 1]);
  qsort(v->hidden, hidden, sizeof *v->hidden, by_from);
  for (size_t k = 0; k < hidden && left.from < left.to; k++) {
    const arc h = v->hidden[k];
    if (h.from > left.from) v->open[open++] = (arc){left.from, fminl(h.from, left.to)};
    left.from = fmaxl(left.from, h.to);
  }
  if (left.from < left.to) v->open[open++] = left;
  return open;
}

static double basis(unsigned l, real t) {
  const double xi = t > 0 ? t < 1 ? (double)(2 * t - 1) : 1 : -1;
  return sqrt(2.0 * l + 1) * gsl_sf_legendre_Pl((int)l, xi);
}

/* φ_m at the point where the ray meets the line of j.  Angles are counted from the middle of
   the arc, so that the angles of a narrow arc keep their digits. */
static double over_directions(double angle, void *ctx) {
  const brute_view *v = ctx;
  const real sine = sin(angle), half = sin(0.5 * angle), versed = 2 * half * half;
  const real s = v->sine + (v->cosine * sine - v->sine * versed);
  const real c = v->cosine - (v->sine * sine + v->cosine * versed);
  const real ex = v->d.along - v->c.along, ey = v->d.height - v->c.height;
  const real t = -((v->c.along - v->x) * c - v->c.height * s) / (ex * c - ey * s);
  return 0.5 * (double)c * basis(v->m, t);
}

static double over_positions(double x, void *ctx) {
  brute_view *v = ctx;
  double sum = 0;
  v->x = x;
  const size_t open = find_open(v);
  for (size_t k = 0; k < open; k++) {
    const gsl_function f = {over_directions, v};
    const real middle = (v->open[k].from + v->open[k].to) / 2;
    const double reach = (double)(v->open[k].to - middle);
    double part = 0, error;
    size_t evaluations;
    v->sine = sinl(middle);
    v->cosine = cosl(middle);
    gsl_integration_cquad(&f, -reach, reach, 1e-15, 1e-13, v->inner, &part, &error,
                          &evaluations);
    sum += part;
  }
  return sum * basis(v->l, x / v->length);
}

double brute_block(brute_view *v, unsigned l, unsigned m) {
  /* What GSL says of rounding is no failure. */
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  double sum = 0;
  v->l = l;
  v->m = m;
  for (size_t k = 1; k < v->cuts; k++) {
    const gsl_function f = {over_positions, v};
    double part = 0, error;
    if (!(v->cut[k] > v->cut[k - 1])) continue;
    size_t evaluations;
    gsl_integration_cquad(&f, (double)v->cut[k - 1], (double)v->cut[k],
                          1e-15 * (double)v->length, 1e-13, v->outer, &part, &error,
                          &evaluations);
    sum += part;
  }
  gsl_set_error_handler(handler);
  return sum;
}
