/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "estimate/corner-residuals.h"

#include <math.h>
#include <stdlib.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/legendre.h"
#include "base/sort.h"
#include "estimate/points-gather.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"

/* How far beside a foot, in terms of the leaf: residuals change like x^γ there.  But what is
   no farther than a few roundings of coordinates may be seen from the other side of the foot.
 */
#define BESIDE    0x1p-20
#define ROUNDINGS (4 * HR2DI_TOUCH)

static double view_between(const hr2d_scene *scene, const hr2d_element *ends,
                           const hr2d_element *begins) {
  const hr2di_patch *p = &scene->patch[ends->patch], *q = &scene->patch[begins->patch];
  const hr2d_point u = hr2di_point_minus(p->scaled.a, p->scaled.b);
  const hr2d_point v = hr2di_point_minus(q->scaled.b, q->scaled.a);
  return 0.5 * (1 + hr2di_point_dot(u, v) / p->length / q->length);
}

static hr2d_status add(hr2di_contacts *c, const hr2di_transport *t, const uint32_t *number,
                       uint32_t ends, uint32_t begins) {
  const hr2d_element *e = t->hierarchy->element;
  if (hr2di_alloc_reserve(&c->alloc, &c->contact, &c->capacity, c->count + 1,
                          sizeof *c->contact))
    return HR2D_ENOMEM;
  c->contact[c->count++] =
      (hr2di_contact){.leaf = {number ? number[ends] : 0, number ? number[begins] : 0},
                      .view = view_between(t->hierarchy->scene, &e[ends], &e[begins])};
  return HR2D_OK;
}

static size_t max_for(const hr2d_scene *scene) {
  return scene->patches > HR2DI_CHOICE_CONTACTS_PATCHES ? HR2DI_CHOICE_CONTACTS_LARGE
                                                        : HR2DI_CHOICE_CONTACTS;
}

uint64_t hr2di_contacts_points(const hr2d_linkset *links) {
  const hr2d_hierarchy *h = links->hierarchy;
  const size_t max = max_for(h->scene);
  size_t contacts = 0;
  for (uint64_t k = 0; k < links->store.count && contacts < max; k++) {
    const hr2d_pair pair = hr2di_store_at(&links->store, k)->pair;
    const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
    if (i->child || j->child) continue;
    contacts += (size_t)hr2di_point_same(i->b, j->a) + (size_t)hr2di_point_same(j->b, i->a);
  }
  return 2 * (contacts < max ? contacts : max);
}

static int by_leaves(const void *left, const void *right) {
  const hr2di_contact *l = left, *r = right;
  if (l->leaf[0] != r->leaf[0]) return l->leaf[0] < r->leaf[0] ? -1 : 1;
  return (l->leaf[1] > r->leaf[1]) - (l->leaf[1] < r->leaf[1]);
}

/* The contacts of all shares, in an order that does not depend on these. */
static hr2d_status collect(hr2di_contacts *c, const hr2di_transport *t, hr2d_status status) {
  double *record = hr2di_alloc(&c->alloc, c->count, 2 * sizeof *record);
  size_t count = c->count;
  if (!status) status = record ? hr2di_transport_status(t) : HR2D_ENOMEM;
  for (size_t k = 0; k < 2 * count && !status; k++) record[k] = c->contact[k / 2].leaf[k % 2];
  status = hr2di_share_collect(t->links->share, status, &c->alloc, &record, &count, 2);
  c->count = 0;
  for (size_t k = 0; k < count && !status; k++)
    status =
        add(c, t, NULL, t->leaf[(uint32_t)record[2 * k]], t->leaf[(uint32_t)record[2 * k + 1]]);
  for (size_t k = 0; k < 2 * count && !status; k++)
    c->contact[k / 2].leaf[k % 2] = (uint32_t)record[k];
  hr2di_alloc_free(&c->alloc, record);
  return status ? status
                : hr2di_sort(c->contact, c->count, sizeof *c->contact, by_leaves, t->watch);
}

/* Leaves that touch are linked with each other. */
hr2d_status hr2di_contacts_init(hr2di_contacts *c, const hr2di_transport *t) {
  const hr2d_element *element = t->hierarchy->element;
  *c = (hr2di_contacts){.alloc = t->alloc};
  uint32_t *number = hr2di_alloc(&t->alloc, t->elements, sizeof *number);
  hr2d_status status = number ? HR2D_OK : HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves && number; k++) number[t->leaf[k]] = (uint32_t)k;
  for (uint64_t k = 0; k < t->links->store.count && !status; k++) {
    const hr2d_pair pair = hr2di_store_at(&t->links->store, k)->pair;
    const hr2d_element *i = &element[pair.first], *j = &element[pair.second];
    if (k % 16 == 0) status = hr2di_watch_work(t->watch, 2);
    if (status || i->child || j->child) continue;
    if (hr2di_point_same(i->b, j->a)) status = add(c, t, number, pair.first, pair.second);
    if (!status && hr2di_point_same(j->b, i->a))
      status = add(c, t, number, pair.second, pair.first);
  }
  hr2di_alloc_free(&t->alloc, number);
  return t->links->share ? collect(c, t, status) : status;
}

void hr2di_contacts_clear(hr2di_contacts *c) {
  hr2di_alloc_free(&c->alloc, c->contact);
  hr2di_alloc_free(&c->alloc, c->residual);
  *c = (hr2di_contacts){.alloc = c->alloc};
}

/* The leaf of which another one is an image. */
static uint32_t original(const hr2di_transport *t, uint32_t leaf) {
  return t->image_map.of ? t->image_map.number[t->image_map.of[t->leaf[leaf]]] : leaf;
}

/* A leaf may have contacts at both ends. */
hr2d_status hr2di_contacts_saturate(const hr2di_contacts *c, const hr2di_transport *t,
                                    size_t order, double exponent, double *residual) {
  const double ratio = (double)order / (double)t->order;
  const double theta = 1 - pow(ratio, 2 * (1 + 2 * exponent));
  unsigned char *touches = hr2di_alloc_zero(&c->alloc, t->leaves, 1);
  if (!touches) return HR2D_ENOMEM;
  for (size_t k = 0; k < c->count; k++)
    for (int side = 0; side < 2; side++) touches[original(t, c->contact[k].leaf[side])] = 1;
  for (size_t k = 0; k < t->leaves; k++) touches[k] = touches[original(t, (uint32_t)k)];
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t m = order * t->bands; m < t->width && touches[k]; m++)
      residual[k * t->width + m] /= theta;
  hr2di_alloc_free(&c->alloc, touches);
  return HR2D_OK;
}

static int by_key(const void *left, const void *right) {
  const hr2di_contact *l = left, *r = right;
  if (l->key != r->key) return l->key > r->key ? -1 : 1;
  if (l->leaf[0] != r->leaf[0]) return l->leaf[0] < r->leaf[0] ? -1 : 1;
  return (l->leaf[1] > r->leaf[1]) - (l->leaf[1] < r->leaf[1]);
}

/* Chooses by the residuals that coefficients have at the vertex. */
static void choose(hr2di_contacts *c, const hr2di_transport *t, const double *residual) {
  const size_t max = max_for(t->hierarchy->scene);
  hr2di_basis basis;
  hr2di_basis_init(&basis, t->order);
  for (size_t k = 0; k < c->count; k++) {
    hr2di_contact *at = &c->contact[k];
    at->key = 0;
    for (int side = 0; side < 2; side++)
      for (size_t b = 0; b < t->bands; b++)
        at->key = fmax(
            at->key, fabs(hr2di_basis_sum(&basis, side ? -1 : 1,
                                          residual + at->leaf[side] * t->width + b, t->bands)));
  }
  if (c->count > max) qsort(c->contact, c->count, sizeof *c->contact, by_key);
  c->gathered = c->count < max ? c->count : max;
}

/* Where a leaf begins or ends on its patch: 0 and 1 exactly at the ends of that. */
static double place_of(const hr2di_transport *t, uint32_t leaf, int begins) {
  const hr2d_element *e = &t->hierarchy->element[t->leaf[leaf]];
  const hr2d_segment s = t->hierarchy->scene->patch[e->patch].scaled;
  if (begins && hr2di_point_same(e->a, s.a)) return 0;
  if (!begins && hr2di_point_same(e->b, s.b)) return 1;
  const double from = hr2di_element_start(t->hierarchy, t->leaf[leaf]);
  const double size = e->length / t->hierarchy->scene->patch[e->patch].length;
  const double beside = fmin(fmax(BESIDE, ROUNDINGS / e->length), 0.5);
  return from + (begins ? beside : 1 - beside) * size;
}

/* One side of a contact: the end of a leaf, or of its original, at the vertex. */
typedef struct leaf_end {
  uint32_t leaf;
  int begins;
} leaf_end;

static leaf_end end_of(const hr2di_contacts *c, const hr2di_transport *t, size_t k) {
  const uint32_t leaf = c->contact[k / 2].leaf[k % 2];
  const int turned = t->image_map.of && t->image_map.odd[t->leaf[leaf]];
  return (leaf_end){original(t, leaf), k % 2 != (size_t)turned};
}

/* Leaves B' − B_h of B' at the vertex. */
static void subtract(const hr2di_equation *eq, const double *field, leaf_end at,
                     double *residual) {
  const hr2di_transport *t = &eq->transport;
  hr2di_basis basis;
  hr2di_basis_init(&basis, t->order);
  for (size_t b = 0; b < t->bands; b++)
    residual[b] =
        ldexp(residual[b], -eq->exponent[b]) -
        hr2di_basis_sum(&basis, at.begins ? -1 : 1, field + at.leaf * t->width + b, t->bands);
}

/* At the end of a patch B' is the limit that light to and fro in the corner leads to, and B' −
   B_h the error of B_h. Beside a foot it is what one gather makes of B_h, and lacks what the
   error b of the other patch sends, ρvb. One of the two is at its end. */
static void complete(hr2di_contacts *c, const hr2di_transport *t, size_t k) {
  const hr2d_scene *scene = t->hierarchy->scene;
  const hr2di_contact *at = &c->contact[k];
  for (int side = 0; side < 2; side++) {
    const double place = place_of(t, at->leaf[side], side);
    const uint32_t patch = t->hierarchy->element[t->leaf[at->leaf[side]]].patch;
    for (size_t b = 0; b < t->bands && place > 0 && place < 1; b++)
      c->residual[(2 * k + (size_t)side) * t->bands + b] +=
          hr2di_scene_scattered(scene, patch, b) * at->view *
          c->residual[(2 * k + 1 - (size_t)side) * t->bands + b];
  }
}

hr2d_status hr2di_contacts_gather(hr2di_contacts *c, const hr2di_equation *eq,
                                  const hr2d_solution *solution, const double *residual,
                                  const double *field) {
  const hr2di_transport *t = &eq->transport;
  hr2di_place place[2 * HR2DI_CHOICE_CONTACTS];
  choose(c, t, residual);
  const size_t count = 2 * c->gathered;
  c->residual = hr2di_alloc(&c->alloc, count, t->bands * sizeof *c->residual);
  if (!c->residual) return HR2D_ENOMEM;
  for (size_t k = 0; k < count; k++) {
    const leaf_end end = end_of(c, t, k);
    place[k] = (hr2di_place){t->hierarchy->element[t->leaf[end.leaf]].patch,
                             place_of(t, end.leaf, end.begins)};
  }
  const hr2d_status status =
      hr2di_points_gather(solution, place, count, t->threads, c->residual, t->watch);
  for (size_t k = 0; k < count && !status; k++) {
    subtract(eq, field, end_of(c, t, k), c->residual + k * t->bands);
    if (k % 2) complete(c, t, k / 2);
  }
  return status;
}
