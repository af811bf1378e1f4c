/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The background's part of the irradiance: exact averages at order 1, Gauss rules above. */
#include "sky.h"

#include <math.h>

#include "alloc.h"
#include "hierarchy-impl.h"
#include "legendre.h"
#include "point-view.h"
#include "scene-impl.h"

hr2d_status hr2di_set_sky(hr2di_transport *t, const hr2di_rows *rows) {
  t->sky = hr2di_alloc(&t->alloc, t->leaves, sizeof *t->sky);
  if (!t->sky) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves; k++) {
    const uint32_t leaf = t->leaf[k];
    t->sky[k] = fmax(0, 1 - rows->front[leaf] - rows->back[leaf]);
  }
  return HR2D_OK;
}

typedef struct looker {
  hr2di_transport *t;
  hr2di_viewer *viewer;
  hr2di_basis basis;
  hr2di_rule rule;
} looker;

/* From a leaf that begins at fraction `from` of its patch. */
static hr2d_status look_from(looker *l, size_t leaf, double from, double size) {
  hr2di_transport *t = l->t;
  const size_t patch = t->hierarchy->element[t->leaf[leaf]].patch;
  double *sky = t->sky + leaf * t->order, phi[HR2D_MAX_ORDER];
  for (size_t q = 0; q < l->rule.points; q++) {
    hr2di_view_from seen;
    const double at = from + size * (0.5 + 0.5 * l->rule.at[q]);
    if (hr2di_view_at(l->viewer, patch, at, &seen)) return HR2D_ENOMEM;
    hr2di_basis_at(&l->basis, l->rule.at[q], phi);
    for (size_t k = 0; k < t->order; k++) sky[k] += l->rule.weight[q] * seen.sky * phi[k];
  }
  return HR2D_OK;
}

hr2d_status hr2di_look_at_sky(hr2di_transport *t) {
  const hr2d_hierarchy *h = t->hierarchy;
  looker l = {.t = t};
  hr2di_basis_make(&l.basis, t->order);
  hr2di_rule_make(&l.rule, t->order + 6);
  t->sky = hr2di_calloc(&t->alloc, t->leaves * t->order, sizeof *t->sky);
  hr2d_status status =
      t->sky ? hr2di_viewer_create(h->scene, &t->alloc, &l.viewer) : HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves && !status; k++) {
    const double size = h->element[t->leaf[k]].length;
    const double whole = h->element[h->element[t->leaf[k]].patch].length;
    if (hr2di_lit(h->scene, h->element[t->leaf[k]].patch))
      status = look_from(&l, k, hr2di_start(h, t->leaf[k]), size / whole);
  }
  hr2di_viewer_destroy(l.viewer);
  return status;
}
