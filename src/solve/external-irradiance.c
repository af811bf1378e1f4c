/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A patch has the same H_sun wherever it is lit.  So the coefficients of H_sun on a leaf are
   those of its lit parts: on [ξ₀, ξ₁] of the leaf's [−1,1]

     c_l = H_sun ½ ∫ φ_l dξ,

   the half length times a mean over the part, for which a Gauss rule is exact.

   The factors of the pieces of the sky are those of views from the points of a rule: they are
   smooth on leaves that end where vertices, or edges of pieces, come into sight. */
#include "solve/external-irradiance.h"

#include <float.h>
#include <math.h>

#include "base/alloc.h"
#include "base/legendre.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "visibility/periodic-tail.h"
#include "visibility/point-view.h"

/* What a border is off the end of a leaf, at most, in places of the patch: they are the same.
 */
#define ALIKE 0x1p-44

typedef struct sunny {
  const hr2di_transport *t;
  const int *exponent;
  hr2di_basis basis;
  hr2di_rule rule;
} sunny;

int hr2di_external_wants_sky(const hr2d_scene *scene) {
  if (scene->effect[HR2D_EFFECT_BACKGROUND].forced) return 1;
  for (size_t b = 0; b < scene->bands; b++)
    if (hr2d_scene_background(scene, b) > 0) return 1;
  return 0;
}

int hr2di_external_has_pieces(const hr2d_scene *scene) {
  return scene->sky.pieces > 0 && scene->parts.wanted;
}

/* A place in [−1,1] of the leaf, with those at its ends exactly there. */
static double place(double at, double from, double size) {
  const double rounding = 4 * DBL_EPSILON + ALIKE * size;
  if (at <= from + rounding) return -1;
  if (at >= from + size - rounding) return 1;
  return 2 * (at - from) / size - 1;
}

/* Adds a lit part of a leaf, whose coefficients are `stride` apart. */
static void add_part(const sunny *s, double from, double to, double full, double *out) {
  const size_t stride = s->t->bands;
  if (!(to > from)) return;
  if (from == -1 && to == 1) {
    out[0] += full;
    return;
  }
  const double half = 0.5 * (to - from), middle = from + half;
  for (size_t q = 0; q < s->rule.points; q++) {
    double phi[HR2D_MAX_ORDER];
    hr2di_basis_at(&s->basis, middle + half * s->rule.at[q], phi);
    for (size_t l = 0; l < s->basis.order; l++)
      out[l * stride] += full * half * s->rule.weight[q] * phi[l];
  }
}

/* Adds the sun of a band to a leaf that begins at fraction `from` of its patch. */
static void add_sun(const sunny *s, size_t patch, double from, double size, size_t band,
                    double *out) {
  const hr2d_scene *scene = s->t->hierarchy->scene;
  size_t count;
  const hr2di_lit_part *lit = hr2di_sunlight_of(scene, patch, band, &count);
  if (count == 0) return;
  const double full = ldexp(hr2di_sunlight_full(scene, patch, band), -s->exponent[band]);
  for (size_t k = 0; k < count; k++)
    add_part(s, place(lit[k].from, from, size), place(lit[k].to, from, size), full, out);
}

static hr2d_status add_suns(const hr2di_transport *t, const int *exponent, double *field) {
  const hr2d_hierarchy *h = t->hierarchy;
  sunny s = {.t = t, .exponent = exponent};
  hr2d_status status = HR2D_OK;
  hr2di_basis_init(&s.basis, t->order);
  hr2di_rule_init(&s.rule, t->order / 2 + 1);
  for (size_t k = 0; k < t->leaves && !status; k++) {
    const hr2d_element *e = &h->element[t->leaf[k]];
    const double size = e->length / h->element[e->patch].length;
    const double from = hr2di_element_start(h, t->leaf[k]);
    if (hr2di_image_map_of(&t->image_map, t->leaf[k]) != t->leaf[k]) continue;
    for (size_t b = 0; b < t->bands; b++)
      add_sun(&s, e->patch, from, size, b, field + k * t->width + b);
    status = hr2di_watch_work(t->watch, 2 * t->bands);
  }
  return status;
}

/* Points of a rule beyond the order, for the factors of pieces. */
enum { MORE = 6 };

/* Looks at the pieces of the sky from leaves. */
typedef struct stargazer {
  const hr2di_transport *t;
  hr2di_point_viewer *viewer;
  hr2di_basis basis;
  hr2di_rule rule;
  hr2di_sky_front *front; /* the pieces, as `patch` sees them */
  size_t patch;
  double *factor; /* rows of the sky × order: the coefficients of a leaf */
} stargazer;

/* Adds the part of a piece that is past the ends of a period. */
static void add_far_factors(const hr2di_sky *sky, size_t piece, const hr2di_periodic_tail *tail,
                            double *factor) {
  double phi[HR2DI_SKY_TERMS];
  for (int k = 0; k < HR2DI_SKIES; k++) {
    if (tail->sky[k] == 0 || hr2di_sky_piece_at(sky, tail->bearing[k]) != piece) continue;
    hr2di_sky_terms_at(sky, piece, tail->bearing[k], phi);
    for (size_t l = 0; l < sky->terms; l++) factor[l] += tail->sky[k] * phi[l];
  }
}

/* Adds what a point of the rule, fraction t of the patch, sees. */
static void add_view(stargazer *g, size_t patch, double t, const hr2di_view_from *seen,
                     size_t point) {
  const hr2d_scene *scene = g->t->hierarchy->scene;
  hr2di_periodic_tail tail;
  hr2di_periodic_tail_of(scene, patch, t, seen, &tail);
  const size_t order = g->basis.order;
  double phi[HR2D_MAX_ORDER];
  hr2di_basis_at(&g->basis, g->rule.at[point], phi);
  for (size_t k = 0; k < scene->sky.pieces; k++) {
    double sum[HR2DI_SKY_TERMS] = {0};
    double *factor = g->factor + k * scene->sky.terms * order;
    add_far_factors(&scene->sky, k, &tail, sum);
    for (size_t m = 0; m < seen->arcs; m++)
      hr2di_sky_add_factors(&scene->sky, &g->front[k], seen->arc[m][0], seen->arc[m][1], sum);
    for (size_t j = 0; j < scene->sky.terms && sum[0] != 0; j++)
      for (size_t l = 0; l < order; l++)
        factor[j * order + l] += g->rule.weight[point] * phi[l] * sum[j];
  }
}

/* Leaves of a patch follow each other. */
static void look_from(stargazer *g, size_t patch) {
  const hr2d_scene *scene = g->t->hierarchy->scene;
  if (g->patch == patch) return;
  g->patch = patch;
  for (size_t k = 0; k < scene->sky.pieces; k++)
    hr2di_sky_front_of(scene, patch, k, &g->front[k]);
}

static hr2d_status view_from_leaf(stargazer *g, size_t leaf) {
  const hr2d_hierarchy *h = g->t->hierarchy;
  const hr2d_element *e = &h->element[g->t->leaf[leaf]];
  const double size = e->length / h->element[e->patch].length;
  const double from = hr2di_element_start(h, g->t->leaf[leaf]);
  const size_t factors = hr2di_sky_rows(&h->scene->sky) * g->basis.order;
  hr2d_status status = hr2di_watch_work(g->t->watch, hr2di_sky_rows(&h->scene->sky) / 4);
  look_from(g, e->patch);
  for (size_t k = 0; k < factors; k++) g->factor[k] = 0;
  for (size_t q = 0; q < g->rule.points && !status; q++) {
    hr2di_view_from seen;
    const double t = from + size * (0.5 + 0.5 * g->rule.at[q]);
    status = hr2di_view_at(g->viewer, e->patch, t, &seen);
    if (!status) add_view(g, e->patch, t, &seen, q);
    if (!status) status = hr2di_watch_work(g->t->watch, factors / 8);
  }
  return status;
}

/* A factor up to this cannot be told from rounding. */
#define NONE 1e-14

static int is_seen(const double *factor, size_t order) {
  for (size_t l = 0; l < order; l++)
    if (fabs(factor[l]) > NONE) return 1;
  return 0;
}

static void add_leaf(const stargazer *g, size_t leaf, const int *exponent, double *field) {
  const hr2d_scene *scene = g->t->hierarchy->scene;
  const size_t order = g->basis.order, bands = g->t->bands;
  for (size_t k = 0; k < hr2di_sky_rows(&scene->sky); k++)
    for (size_t b = 0; b < bands && is_seen(g->factor + k * order, order); b++) {
      const double beyond = ldexp(hr2di_sky_beyond(scene, k, b), -exponent[b]);
      for (size_t l = 0; l < order; l++)
        field[leaf * g->t->width + l * bands + b] += beyond * g->factor[k * order + l];
    }
}

static hr2d_status add_pieces(const hr2di_transport *t, const int *exponent, double *field) {
  const hr2d_scene *scene = t->hierarchy->scene;
  const size_t rows = hr2di_sky_rows(&scene->sky);
  stargazer g = {.t = t, .patch = scene->patches};
  hr2di_basis_init(&g.basis, t->order);
  hr2di_rule_init(&g.rule, t->order + MORE);
  g.front = hr2di_alloc(&t->alloc, scene->sky.pieces, sizeof *g.front);
  g.factor = hr2di_alloc(&t->alloc, rows, t->order * sizeof *g.factor);
  hr2d_status status = g.front && g.factor ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = hr2di_point_viewer_create(scene, &t->alloc, t->watch, &g.viewer);
  for (size_t k = 0; k < t->leaves && !status; k++) {
    if (hr2di_image_map_of(&t->image_map, t->leaf[k]) != t->leaf[k]) continue;
    status = view_from_leaf(&g, k);
    if (!status) add_leaf(&g, k, exponent, field);
    if (!status) status = hr2di_watch_work(t->watch, rows * t->width / 8);
  }
  hr2di_point_viewer_destroy(g.viewer);
  hr2di_alloc_free(&t->alloc, g.front);
  hr2di_alloc_free(&t->alloc, g.factor);
  return status;
}

hr2d_status hr2di_external_set(const hr2di_transport *t, const double *light,
                               const int *exponent, double *field) {
  for (size_t k = 0; k < t->leaves * t->order; k++)
    for (size_t b = 0; b < t->bands; b++)
      field[k * t->bands + b] = t->sky ? t->sky[k] * light[b] : 0;
  const hr2d_scene *scene = t->hierarchy->scene;
  hr2d_status status = hr2di_watch_work(t->watch, t->leaves * t->width / 8);
  if (!status && hr2di_scene_has_sun(scene)) status = add_suns(t, exponent, field);
  if (!status && hr2di_external_has_pieces(scene)) status = add_pieces(t, exponent, field);
  hr2di_image_map_spread_leaves(&t->image_map, t->order, t->bands, field);
  return status;
}
