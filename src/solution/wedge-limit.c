/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A point that touches another patch has the limit from the inside of its own patch.  There the
   two patches p and q form a wedge, and see each other under k = ½(1 + cos α) of all directions
   whatever the distance from its edge.  With the irradiance r from everything else the limits
   of B solve
     b_p = E_p + ρ_p (k b_q + r_p),   b_q = E_q + ρ_q (k b_p + r_q).
   A pane p has another wedge behind it, where H is linear in what p sends: H' = A + Cτ H_p. So
   it is in its own wedge as if it were opaque, b_p = (E_p + τA) + (ρ_p + τ²C) H_p. Where a pane
   stands in the wedge behind a pane, too, what passes that is H of the solution. */
#include <math.h>

#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/panes.h"
#include "solution/gatherer.h"

/* The limits at the edge of a wedge are found from points so far beside it.  Roundings of the
   coordinates of a foot do not matter there. */
#define BESIDE 0x1p-46

/* The point of a patch at the edge of a wedge, with the inside of the patch on the given side
   if both are. */
static hr2di_edge edge_of(const hr2di_gatherer *g, size_t patch, double at, double side) {
  const double step = BESIDE / hr2di_solution_scene(g->solution)->patch[patch].length;
  const double inside = at <= step ? 1 : at >= 1 - step ? -1 : side;
  return (hr2di_edge){patch, at, 8 * step, inside};
}

/* The unit vector along a patch, from the edge to the point beside it. */
static hr2d_point direction_of(const hr2di_gatherer *g, const hr2di_edge *e) {
  const hr2di_patch *p = &hr2di_solution_scene(g->solution)->patch[e->patch];
  const hr2d_point along = hr2di_point_minus(p->scaled.b, p->scaled.a);
  return (hr2d_point){e->inside * along.x / p->length, e->inside * along.y / p->length};
}

/* A place so many steps beside an edge. */
static double beside(const hr2di_gatherer *g, const hr2di_edge *e, double steps) {
  const double step =
      steps * BESIDE / hr2di_solution_scene(g->solution)->patch[e->patch].length;
  return fmin(fmax(e->at + e->inside * step, 0), 1);
}

/* The form factor of an edge is k = ½(1 + cos α) = ¼|u + w|², and that of everything else
   1 − k = ¼|u − w|².  A view from beside the edge has neither exactly: irradiances from
   everything else are scaled by the right one. */
static hr2d_status view_beside(hr2di_gatherer *g, const hr2di_edge *p, const hr2di_edge *q,
                               double steps, double right, double *irradiance, int *sees) {
  double wedge, others;
  const hr2d_status status =
      hr2di_gatherer_look(g, p->patch, beside(g, p, steps), q, irradiance, &wedge, &others);
  *sees = !status && wedge > 0;
  for (size_t b = 0; b < g->solution->bands && !status; b++)
    irradiance[b] *= others > 0 ? right / others : 0;
  return status;
}

/* The irradiance from everything but the other patch at the edge of a wedge: 2H(x) − H(2x),
   which differs from the limit by O(x²). */
static hr2d_status examine_edge(hr2di_gatherer *g, const hr2di_edge *p, const hr2di_edge *q,
                                double right, double *irradiance, int *sees) {
  hr2d_status status = view_beside(g, p, q, 2, right, g->far, sees);
  if (!status && *sees) status = view_beside(g, p, q, 1, right, irradiance, sees);
  for (size_t b = 0; b < g->solution->bands && !status && *sees; b++)
    irradiance[b] = fmax(2 * irradiance[b] - g->far[b], 0);
  return status;
}

/* Arrays of g->surface. */
enum { SENT, RHO, SIDES = 2, PASSED = 2 * SIDES * 2, GAIN };
_Static_assert((int)GAIN + 1 == (int)HR2DI_SURFACE_ARRAYS, "arrays of surfaces");

static double *surface_of(const hr2di_gatherer *g, int side, int what) {
  return g->surface + (size_t)((g->behind * SIDES + side) * 2 + what) * g->solution->bands;
}

static hr2d_status look_behind(hr2di_gatherer *g, const hr2di_edge *p);

/* E and ρ of a side of the wedge, as if it were opaque. */
static hr2d_status set_surface(hr2di_gatherer *g, const hr2di_edge *e, int side) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  const size_t bands = g->solution->bands;
  double *sent = surface_of(g, side, SENT), *rho = surface_of(g, side, RHO);
  const int pane = hr2di_pane_is(scene, e->patch), own = side == 0;
  const hr2d_status status = pane && !g->behind ? look_behind(g, e) : HR2D_OK;
  const double *passed = g->surface + PASSED * bands, *gain = g->surface + GAIN * bands;
  for (size_t b = 0; b < bands && !status; b++) {
    const double tau = pane ? hr2d_scene_transmittance(scene, e->patch, b) : 0;
    sent[b] = hr2d_scene_emission(scene, e->patch, b);
    rho[b] = hr2d_scene_reflectance(scene, e->patch, b);
    if (pane && !g->behind) {
      sent[b] += tau * passed[b];
      rho[b] += tau * tau * gain[b];
    } else if (pane && !own) {
      sent[b] += tau * hr2d_solution_irradiance_at(
                           g->solution, hr2di_scene_other_side(scene, e->patch), 1 - e->at, b);
    }
  }
  return status;
}

/* The irradiance at the edge of the wedge that two patches make; *closed is 0 if they do not
   see each other beside it. */
static hr2d_status close_wedge(hr2di_gatherer *g, const hr2di_edge *p, const hr2di_edge *q,
                               double *irradiance, int *closed) {
  const hr2d_point u = direction_of(g, p), w = direction_of(g, q);
  const hr2d_point sum = {u.x + w.x, u.y + w.y}, difference = hr2di_point_minus(u, w);
  const double k = 0.25 * hr2di_point_dot(sum, sum),
               rest = 0.25 * hr2di_point_dot(difference, difference);
  hr2d_status status = set_surface(g, p, 0);
  if (!status) status = set_surface(g, q, 1);
  if (!status) status = examine_edge(g, p, q, rest, irradiance, closed);
  if (!status && *closed) status = examine_edge(g, q, p, rest, g->edge, closed);
  if (status || !*closed) return status;
  const double *sent_p = surface_of(g, 0, SENT), *sent_q = surface_of(g, 1, SENT);
  double *gain = g->surface + GAIN * g->solution->bands;
  for (size_t b = 0; b < g->solution->bands; b++) {
    const double rho_p = surface_of(g, 0, RHO)[b], rho_q = surface_of(g, 1, RHO)[b];
    const double alone_p = sent_p[b] + rho_p * irradiance[b];
    const double alone_q = sent_q[b] + rho_q * g->edge[b];
    irradiance[b] += k * (alone_q + rho_q * k * alone_p) / (1 - rho_p * rho_q * k * k);
    gain[b] = rho_q * k * k / (1 - rho_p * rho_q * k * k);
  }
  return HR2D_OK;
}

/* Where a patch has an edge in common with that at p, and shows its front beside it. */
static int makes_wedge(const hr2di_gatherer *g, size_t patch, hr2di_edge *q) {
  const hr2d_segment s = hr2di_solution_scene(g->solution)->patch[patch].scaled;
  const double rises = hr2di_point_dot(hr2di_point_minus(s.b, s.a), g->normal);
  double distance;
  const double at = hr2di_gatherer_nearest(g, patch, 0, 1, &distance);
  if (distance > HR2DI_TOUCH) return 0;
  *q = edge_of(g, patch, at, rises > 0 ? 1 : -1);
  return q->inside * rises > 0;
}

/* The first patch from *k on that makes a wedge with the point's own one; its number is left in
 *k, or that of patches if there is none.  It is seen from where limits are found. */
static hr2d_status next_wedge(hr2di_gatherer *g, const hr2di_edge *p, size_t *k,
                              hr2di_edge *q) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  hr2di_view_from seen;
  const hr2d_status status = hr2di_view_at(g->viewer, p->patch, beside(g, p, 2), &seen);
  if (status) return status;
  hr2di_gatherer_set_point(g, &scene->patch[p->patch], p->at);
  for (size_t m = 0; m < seen.count; m++) {
    const size_t patch = seen.interval[m].patch;
    if (patch < *k || (m > 0 && patch == seen.interval[m - 1].patch)) continue;
    if (!makes_wedge(g, patch, q)) continue;
    *k = patch;
    return hr2di_watch_work(g->watch, seen.count / 8);
  }
  *k = scene->patches;
  return hr2di_watch_work(g->watch, seen.count / 8);
}

static hr2d_status close_at(hr2di_gatherer *g, const hr2di_edge *p, double *irradiance,
                            int *closed) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  hr2di_edge q;
  hr2d_status status = HR2D_OK;
  *closed = 0;
  for (size_t k = 0; k < scene->patches && !*closed && !status; k++) {
    status = next_wedge(g, p, &k, &q);
    if (!status && k < scene->patches) status = close_wedge(g, p, &q, irradiance, closed);
  }
  return status;
}

/* Sets what the other side of a pane gets at an edge of it, without what passes from this side,
   and how much more per light that does. */
static hr2d_status look_behind(hr2di_gatherer *g, const hr2di_edge *p) {
  const hr2d_scene *scene = hr2di_solution_scene(g->solution);
  const size_t bands = g->solution->bands;
  const hr2di_edge other =
      edge_of(g, hr2di_scene_other_side(scene, p->patch), 1 - p->at, -p->inside);
  double *passed = g->surface + PASSED * bands, *gain = g->surface + GAIN * bands;
  double wedge, others;
  int closed;
  g->behind = 1;
  hr2d_status status = close_at(g, &other, passed, &closed);
  if (!status && !closed) {
    for (size_t b = 0; b < bands; b++) gain[b] = 0;
    status = hr2di_gatherer_look(g, other.patch, beside(g, &other, 1), NULL, passed, &wedge,
                                 &others);
  }
  g->behind = 0;
  return status;
}

hr2d_status hr2di_gatherer_close_wedge(hr2di_gatherer *g, size_t patch, double t,
                                       double *irradiance, int *closed) {
  const hr2di_edge p = edge_of(g, patch, t, t <= 0.5 ? 1 : -1);
  return close_at(g, &p, irradiance, closed);
}
