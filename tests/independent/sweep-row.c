/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With s the sine of the angle from the normal, H = ½ ∫ B ds: no kernel is left that could be
   nearly singular. Where a point sees a patch that reflects nothing, B is constant and the
   integral is a difference of sines. On other patches B is a polynomial on each panel. */
#include "independent/sweep-row.h"

#include <check.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

rule sweep_rule(size_t points) {
  rule r = {.count = points};
  gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(points);
  ck_assert(table != NULL && points <= MOST_POINTS);
  for (size_t k = 0; k < points; k++)
    gsl_integration_glfixed_point(-1, 1, k, &r.at[k], &r.weight[k], table);
  gsl_integration_glfixed_table_free(table);
  for (size_t k = 0; k < points; k++) {
    r.scale[k] = 1;
    for (size_t m = 0; m < points; m++)
      if (m != k) r.scale[k] /= 2 * (r.at[k] - r.at[m]);
  }
  return r;
}

void sweep_interpolate(const rule *r, double z, double *value) {
  double sum = 0;
  for (size_t k = 0; k < r->count; k++) {
    if (z == r->at[k]) {
      memset(value, 0, r->count * sizeof *value);
      value[k] = 1;
      return;
    }
    sum += value[k] = r->scale[k] / (z - r->at[k]);
  }
  for (size_t k = 0; k < r->count; k++) value[k] /= sum;
}

int sweep_reflects(const swept_scene *s, size_t patch) {
  for (size_t b = 0; b < s->bands; b++)
    if (s->light[patch].reflectance[b] > 0) return 1;
  return 0;
}

/* A panel as a point sees it. */
typedef struct line_class {
  const sweep_frame *f;
  const panel *panel;
  spot a, d; /* the start of its patch and the vector to the end, local */
  real pole; /* the direction along the patch */
  double *row;
} line_class;

/* ½ ∫ cosθ B dθ by a rule, where θ leads to the place t = a×e/(e×d) of the patch, e the
   direction: a tangent, whose pole is a whole interval away. */
static void add_directions(const sweep_field *s, const line_class *v, real low, real high) {
  const real middle = (low + high) / 2, half = (high - low) / 2;
  for (size_t q = 0; q < s->near.count; q++) {
    const real angle = middle + half * s->near.at[q];
    const spot e = {sinl(angle), cosl(angle)};
    const real t = sweep_cross(v->a, e) / sweep_cross(e, v->d);
    const double z =
        (double)((2 * t - v->panel->from - v->panel->to) / (v->panel->to - v->panel->from));
    double value[MOST_POINTS];
    sweep_interpolate(&s->rule, fmin(fmax(z, -1), 1), value);
    const double weight = (double)(half * e.y / 2) * s->near.weight[q];
    for (size_t k = 0; k < s->rule.count; k++) v->row[v->panel->node + k] += weight * value[k];
  }
}

static void add_part(const sweep_field *s, const line_class *v, real low, real high) {
  const real from_pole = fminl(fabsl(sinl(low - v->pole)), fabsl(sinl(high - v->pole)));
  if (high - low <= from_pole || high - low < 1e-13L) {
    add_directions(s, v, low, high);
    return;
  }
  const real middle = (low + high) / 2;
  add_part(s, v, low, middle);
  add_part(s, v, middle, high);
}

/* All of a panel at which B and the kernel are smooth: at its nodes. */
static void add_far(const sweep_field *s, const line_class *v) {
  const double ux = (double)v->f->along.x, uy = (double)v->f->along.y;
  for (size_t k = v->panel->node; k < v->panel->node + s->rule.count; k++) {
    const node *n = &s->mesh.node[k];
    const double x = (double)(n->place.x - v->f->origin.x);
    const double y = (double)(n->place.y - v->f->origin.y);
    const double mine = ux * y - uy * x;
    const double other = -((double)n->normal.x * x + (double)n->normal.y * y);
    const double square = x * x + y * y;
    if (mine > 0 && other > 0)
      v->row[k] += n->weight * mine * other / (2 * square * sqrt(square));
  }
}

/* No longer than its distance from the point. */
static int is_far(spot from, spot to) {
  const spot d = {to.x - from.x, to.y - from.y};
  const real square = d.x * d.x + d.y * d.y;
  const real at = fminl(fmaxl(-(from.x * d.x + from.y * d.y) / square, 0), 1);
  return hypotl(from.x + at * d.x, from.y + at * d.y) >= sqrtl(square);
}

/* The direction of a place of the patch, or of the patch at the horizon. A patch turns from
   high angles to low ones where its front is seen. */
static real direction(const line_class *v, spot place) {
  if (place.y > 0) return sweep_angle(place);
  return v->d.y > 0 ? HUGE_VALL : -HUGE_VALL;
}

static void add_mirror(const sweep_field *s, const sweep_frame *f, const sweep_span *span,
                       double *row) {
  const sweep_patches *p = &s->scene->patches;
  const size_t patch = span->seen;
  const spot a = sweep_local(f, sweep_place(p, patch, 0));
  const spot b = sweep_local(f, sweep_place(p, patch, 1));
  line_class v = {.f = f, .a = a, .d = {b.x - a.x, b.y - a.y}, .row = row};
  v.pole = sweep_angle(v.d);
  spot from = a;
  real high = direction(&v, from);
  for (size_t k = s->mesh.first[patch]; k < s->mesh.first[patch + 1]; k++) {
    v.panel = &s->mesh.panel[k];
    const spot to = sweep_local(f, sweep_place(p, patch, v.panel->to));
    const real low = direction(&v, to);
    const real min = fmaxl(low, span->low), max = fminl(high, span->high);
    const int whole = low >= span->low - 1e-17L && high <= span->high + 1e-17L;
    if (max > min) {
      if (whole && is_far(from, to))
        add_far(s, &v);
      else
        add_part(s, &v, min, max);
    }
    from = to;
    high = low;
  }
}

void sweep_row(const sweep_field *s, size_t patch, real t, double *row, double *rest) {
  const swept_scene *scene = s->scene;
  const sweep_frame f = sweep_frame_at(&scene->patches, patch, t);
  const size_t spans = sweep_all(&scene->patches, &f, s->span);
  memset(row, 0, s->mesh.nodes * sizeof *row);
  for (size_t b = 0; b < scene->bands; b++) rest[b] = 0;
  for (size_t k = 0; k < spans; k++) {
    const sweep_span *span = &s->span[k];
    if (span->seen == SWEEP_BACK) continue;
    if (span->seen != SWEEP_SKY && sweep_reflects(scene, span->seen)) {
      add_mirror(s, &f, span, row);
      continue;
    }
    const real part = cosl((span->low + span->high) / 2) * sinl((span->high - span->low) / 2);
    for (size_t b = 0; b < scene->bands; b++)
      rest[b] +=
          (double)part * (span->seen == SWEEP_SKY ? scene->background[b]
                                                  : scene->light[span->seen].emission[b]);
  }
}
