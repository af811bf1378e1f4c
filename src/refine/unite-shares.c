/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Level by level: all shares have the same list of elements that may be divided, and say which
   of them they have divided.  So new elements get the same numbers on each. */
#include "refine/unite-shares.h"

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"

/* Stands for an element that this share has not made. */
#define ABSENT UINT32_MAX

/* An element that may be divided. */
typedef struct place {
  uint32_t own; /* its number on the share's own tree, or ABSENT */
  uint32_t united;
} place;

typedef struct uniting {
  hr2d_hierarchy *h;
  hr2d_hierarchy *own; /* as this share has divided it */
  hr2d_share *share;
  uint32_t *united; /* per element of its own tree */
  place *place, *next;
  size_t places;
  double *divided; /* per place */
  hr2di_watch *watch;
} uniting;

static hr2d_status start(uniting *u, size_t elements) {
  const hr2d_allocator *alloc = &u->h->alloc;
  const hr2d_status status = hr2di_hierarchy_clone(u->h, &u->own);
  if (status) return status;
  hr2di_hierarchy_truncate(u->h, elements);
  u->united = hr2di_alloc(alloc, u->own->elements, sizeof *u->united);
  u->place = hr2di_alloc(alloc, elements, sizeof *u->place);
  if (!u->united || !u->place) return HR2D_ENOMEM;
  for (uint32_t k = 0; k < elements; k++) {
    u->united[k] = k;
    if (!u->h->element[k].child) u->place[u->places++] = (place){k, k};
  }
  return hr2di_watch_work(u->watch, elements / 8);
}

static uint32_t own_child(const uniting *u, const place *p) {
  return p->own == ABSENT ? 0 : u->own->element[p->own].child;
}

/* Says what this share has divided, and learns what others have. */
static hr2d_status ask(uniting *u, hr2d_status status) {
  hr2di_alloc_free(&u->h->alloc, u->divided);
  u->divided = hr2di_alloc(&u->h->alloc, u->places, sizeof *u->divided);
  if (!status && !u->divided) status = HR2D_ENOMEM;
  for (size_t k = 0; k < u->places && !status; k++)
    u->divided[k] = own_child(u, &u->place[k]) > 0;
  return hr2di_share_combine(u->share, status, HR2D_COMBINE_MOST, u->divided, u->places);
}

static hr2d_status divide_one(uniting *u, const place *p, place *child) {
  const hr2d_status status = hr2di_hierarchy_reserve(u->h);
  if (status) return status;
  const uint32_t united = hr2di_element_halve(u->h, p->united), own = own_child(u, p);
  for (uint32_t side = 0; side < 2; side++) {
    child[side] = (place){own ? own + side : ABSENT, united + side};
    if (own) u->united[own + side] = united + side;
  }
  return HR2D_OK;
}

/* Divides what some share has divided; the children are the next places. */
static hr2d_status divide(uniting *u) {
  size_t count = 0, found = 0;
  for (size_t k = 0; k < u->places; k++) count += u->divided[k] > 0;
  u->next = hr2di_alloc(&u->h->alloc, 2 * count, sizeof *u->next);
  hr2d_status status = u->next ? hr2di_watch_work(u->watch, 1 + u->places / 8) : HR2D_ENOMEM;
  for (size_t k = 0; k < u->places && !status; k++)
    if (u->divided[k] > 0) status = divide_one(u, &u->place[k], u->next + 2 * found++);
  hr2di_alloc_free(&u->h->alloc, u->place);
  u->place = u->next;
  u->next = NULL;
  u->places = u->place ? 2 * count : 0;
  return status;
}

static hr2d_status unite(uniting *u, size_t elements, hr2d_status status) {
  if (!status) status = start(u, elements);
  do {
    status = ask(u, status);
    if (status) return status;
    status = divide(u);
  } while (u->places > 0 || status);
  return HR2D_OK;
}

hr2d_status hr2di_unite_shares(hr2d_hierarchy *h, hr2d_share *share, size_t elements,
                               hr2di_store *made, hr2di_watch *watch, hr2d_status status) {
  const hr2d_allocator *alloc = &h->alloc;
  uniting u = {.h = h, .share = share, .watch = watch};
  status = unite(&u, elements, status);
  if (!status) status = hr2di_store_rename(made, u.united, watch);
  if (status && h->elements > elements) hr2di_hierarchy_truncate(h, elements);
  hr2d_hierarchy_destroy(u.own);
  hr2di_alloc_free(alloc, u.united);
  hr2di_alloc_free(alloc, u.place);
  hr2di_alloc_free(alloc, u.divided);
  return status;
}

hr2d_status hr2di_unite_counts(hr2d_refine_counts *c, hr2d_share *share, hr2d_status status) {
  uint64_t *const count[] = {&c->links,         &c->limited_links,    &c->oracle_calls,
                             &c->facing_tests,  &c->visibility_tests, &c->exchange_areas,
                             &c->partial_links, &c->blocked_pairs,    &c->dark_pairs};
  enum { COUNTS = sizeof count / sizeof *count };
  double sum[COUNTS];
  for (size_t k = 0; k < COUNTS; k++) sum[k] = (double)*count[k];
  status = hr2di_share_combine(share, status, HR2D_COMBINE_SUM, sum, COUNTS);
  for (size_t k = 0; k < COUNTS && !status; k++) *count[k] = (uint64_t)sum[k];
  return status;
}
