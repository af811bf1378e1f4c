/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Links that are shown: those of all shares, each of which has found its own.  Numbers add up,
   as each has a place that is 0 on the others. */
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"
#include "run/run.h"

/* Of each link: its elements, whose numbers all shares have, and its exchange area. */
enum { VALUES = 3 };

typedef struct collection {
  const run *r;
  int (*wants)(void *ctx, hr2d_pair pair, run_link *link);
  void *ctx;
  size_t own, before, all;
} collection;

static hr2d_status add_up(const run *r, int has, double *value, size_t count) {
  const hr2d_status status = has ? HR2D_OK : HR2D_ENOMEM;
  return r->share ? r->share->combine(r->share->ctx, status, HR2D_COMBINE_SUM, value, count)
                  : status;
}

/* Links to images of mirrors and periods are not drawn: only the cell is. */
static int is_shown(const collection *c, hr2d_pair pair) {
  const hr2d_element *elements = hr2d_hierarchy_elements(c->r->hierarchy);
  const size_t patches = hr2d_scene_patches(c->r->scene);
  return elements[pair.first].patch < patches && elements[pair.second].patch < patches;
}

/* Those of this share that are wanted; `value` receives VALUES numbers for each, unless it is
   NULL.  Returns how many there are. */
static size_t look(const collection *c, double *value) {
  const uint64_t count = hr2d_linkset_size(c->r->links);
  size_t found = 0;
  for (uint64_t k = 0; k < count; k++) {
    run_link link;
    const hr2d_link own = hr2d_linkset_get(c->r->links, k);
    if (!is_shown(c, own.pair) || !c->wants(c->ctx, own.pair, &link)) continue;
    if (value) {
      value[VALUES * found] = link.near;
      value[VALUES * found + 1] = link.far;
      value[VALUES * found + 2] = own.exchange_area;
    }
    found++;
  }
  return found;
}

static hr2d_status count(collection *c) {
  const unsigned shares = c->r->share ? c->r->share->count : 1;
  const unsigned number = c->r->share ? c->r->share->number : 0;
  double *of = calloc(shares, sizeof *of);
  c->own = look(c, NULL);
  if (of) of[number] = (double)c->own;
  const hr2d_status status = add_up(c->r, of != NULL, of, shares);
  for (unsigned k = 0; k < shares && !status; k++) {
    if (k < number) c->before += (size_t)of[k];
    c->all += (size_t)of[k];
  }
  free(of);
  return status;
}

static hr2d_status collect(collection *c, run_links *links) {
  hr2d_status status = count(c);
  if (status) return status;
  double *value = calloc(VALUES * c->all + 1, sizeof *value);
  links->items = malloc((c->all + 1) * sizeof *links->items);
  const int has = value && links->items;
  if (has) look(c, value + VALUES * c->before);
  status = add_up(c->r, has, value, VALUES * c->all);
  for (size_t k = 0; k < c->all && !status; k++) {
    const double *of = &value[VALUES * k];
    links->items[k] = (run_link){(uint32_t)of[0], (uint32_t)of[1], of[2]};
  }
  links->count = status ? 0 : c->all;
  free(value);
  return status;
}

/* The patch of the point and its leaf. */
typedef struct point {
  const hr2d_hierarchy *hierarchy;
  uint32_t patch, leaf;
} point;

/* Whether an element holds the point. */
static int holds(const point *p, uint32_t element) {
  if (hr2d_hierarchy_elements(p->hierarchy)[element].patch != p->patch) return 0;
  uint32_t at = p->leaf;
  while (at != element && at != p->patch) at = hr2d_element_parent(p->hierarchy, at);
  return at == element;
}

static int serves(void *ctx, hr2d_pair pair, run_link *link) {
  const point *p = ctx;
  if (holds(p, pair.first))
    *link = (run_link){.near = pair.first, .far = pair.second};
  else if (holds(p, pair.second))
    *link = (run_link){.near = pair.second, .far = pair.first};
  else
    return 0;
  return 1;
}

/* Where an element is, whatever its number. */
typedef struct place_of {
  uint32_t patch;
  double start;
  unsigned level;
} place_of;

/* Where a link stands among others. */
typedef struct placed {
  run_link link;
  place_of far, near;
} placed;

static place_of locate(const hr2d_hierarchy *h, uint32_t number) {
  const hr2d_element *element = hr2d_hierarchy_elements(h), *e = &element[number];
  const hr2d_point root = element[e->patch].a;
  return (place_of){e->patch, hypot(e->a.x - root.x, e->a.y - root.y),
                    hr2d_element_level(h, number)};
}

static int compare(const place_of *a, const place_of *b) {
  if (a->patch != b->patch) return a->patch < b->patch ? -1 : 1;
  if (a->start != b->start) return a->start < b->start ? -1 : 1;
  return (a->level > b->level) - (a->level < b->level);
}

static int by_place(const void *left, const void *right) {
  const placed *a = left, *b = right;
  const int far = compare(&a->far, &b->far);
  return far ? far : compare(&a->near, &b->near);
}

/* The first share shows them. */
static int sort(const run *r, const run_links *links) {
  const hr2d_hierarchy *h = r->hierarchy;
  if (!run_is_first(r)) return 0;
  placed *order = malloc((links->count + 1) * sizeof *order);
  if (!order) return complain_memory();
  for (size_t k = 0; k < links->count; k++) {
    const run_link link = links->items[k];
    order[k] = (placed){link, locate(h, link.far), locate(h, link.near)};
  }
  qsort(order, links->count, sizeof *order, by_place);
  for (size_t k = 0; k < links->count; k++) links->items[k] = order[k].link;
  free(order);
  return 0;
}

int run_point_links(run *r) {
  const place_list *at = &r->options->at;
  if (!r->options->links_of.patch) return 0;
  const size_t patch = r->places[at->count];
  point p = {r->hierarchy, (uint32_t)patch,
             hr2d_hierarchy_leaf(r->hierarchy, patch, r->options->links_of.t)};
  collection c = {.r = r, .wants = serves, .ctx = &p};
  const int status = collect(&c, &r->point_links) ? complain_memory() : 0;
  return status ? status : sort(r, &r->point_links);
}

static int any(void *ctx, hr2d_pair pair, run_link *link) {
  (void)ctx;
  *link = (run_link){.near = pair.first, .far = pair.second};
  return 1;
}

int run_all_links(const run *r, run_links *links) {
  collection c = {.r = r, .wants = any};
  const int status = collect(&c, links) ? complain_memory() : 0;
  return status ? status : sort(r, links);
}
