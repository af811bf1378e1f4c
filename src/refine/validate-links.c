/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks that the links of a set account for every transport exactly once.

   Links between two patches P and Q are rectangles in the product of their trees.  P's
   tree is walked depth first; at an element e the links of e and of its ancestors are
   spread over Q's tree.  The exchange of e with Q is accounted for exactly once if none
   of these links lies below another and they fill Q, except what e cannot see.  A link
   is spread once and taken away once, with one step per level; nothing is rounded. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/alloc.h"
#include "geometry/exchange-area.h"
#include "geometry/predicates.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/linkset-impl.h"
#include "refine/occluded-pairs.h"
#include "scene/scene-impl.h"

enum { AREAS = 256 };

#define NOBODY  UINT32_MAX
#define NO_LINK UINT64_MAX

/* The state of an element while the links between P and Q are checked. */
typedef struct node {
  uint64_t links;      /* in P: where its links begin */
  uint32_t by;         /* in Q: the element of P that is linked with it, or NOBODY */
  uint32_t inside;     /* in Q: links spread on it and below */
  unsigned char whole; /* in Q: these links fill it */
  unsigned char above; /* in P: an element below it has links */
} node;

typedef struct validator {
  hr2d_linkset *links;
  const hr2d_hierarchy *h;
  hr2d_pair *pair, *spare; /* the links, sorted by patches and first element */
  uint64_t *bucket;
  uint64_t begin, end; /* of the links between P and Q */
  node *node;
  hr2d_pair *stack;
  size_t capacity;
  hr2di_pair_visibility *visibility; /* NULL if the scene needs no occlusion */
  hr2di_watch watch;
} validator;

static hr2d_status fail(validator *v, hr2d_pair pair, const char *what) {
  const hr2d_scene *scene = v->h->scene;
  const hr2d_element *e = v->h->element;
  return hr2di_message_fail(
      &v->links->message, HR2D_EINVAL, "elements %u of %s and %u of %s %s",
      (unsigned)pair.first, hr2di_patch_label(scene, e[pair.first].patch).text,
      (unsigned)pair.second, hr2di_patch_label(scene, e[pair.second].patch).text, what);
}

static hr2d_status fail_overlap(validator *v, hr2d_pair one, hr2d_pair other) {
  if (one.first == other.first && one.second == other.second)
    return fail(v, one, "are linked twice");
  char what[96];
  snprintf(what, sizeof what, "are linked, and so are %u and %u, which are part of them",
           (unsigned)other.first, (unsigned)other.second);
  return fail(v, one, what);
}

static hr2di_facing face(const validator *v, uint32_t i, uint32_t j) {
  const hr2d_element *e = v->h->element;
  return hr2di_facing_of(&(hr2d_segment){e[i].a, e[i].b}, &(hr2d_segment){e[j].a, e[j].b});
}

/* A root is its own parent. */
static int is_root(const validator *v, uint32_t element) {
  return v->h->parent[element] == element;
}

static int is_right(const validator *v, uint32_t element) {
  return element == v->h->element[v->h->parent[element]].child + 1;
}

static hr2d_status out_of_memory(validator *v) {
  return hr2di_message_fail(&v->links->message, HR2D_ENOMEM, "out of memory");
}

/* Leaves a message for a status that is HR2D_OK, HR2D_ENOMEM or that of the watch. */
static hr2d_status pass_on(validator *v, hr2d_status status) {
  if (status && hr2di_watch_refused(&v->watch))
    return hr2di_message_fail(&v->links->message, status, "callback \"progress\": %s",
                              hr2d_strerror(status));
  return status ? out_of_memory(v) : HR2D_OK;
}

static hr2d_status work(validator *v, uint64_t units) {
  return pass_on(v, hr2di_watch_work(&v->watch, units));
}

/* Midpoints are off the lines of their patches by up to an ulp.  So an element may lie on the
   other side of a wall's end than its ancestor, from which a refinement inherits the walls in
   the way.  Moving the ends of elements by an ulp, δ, opens or closes gaps of δ, and strings
   change by as much: the exchange area of a pair with walls in the way is known to some δ.
   Four ends may count as ends of walls, each of them by up to 2^-49.  For elements of a few
   ulps that is all of it. */
static double rounding_of(const validator *v, hr2d_pair pair) {
  const hr2d_element *i = &v->h->element[pair.first], *j = &v->h->element[pair.second];
  const double x = fmax(fmax(fabs(i->a.x), fabs(i->b.x)), fmax(fabs(j->a.x), fabs(j->b.x)));
  const double y = fmax(fmax(fabs(i->a.y), fabs(i->b.y)), fmax(fabs(j->a.y), fabs(j->b.y)));
  return v->visibility ? 16 * DBL_EPSILON * fmax(x, y) + 4 * 0x1p-49 : 0;
}

/* The exchange areas that the links of pairs should have. */
static hr2d_status integrate(validator *v, const hr2d_pair *pair, size_t count, double *area) {
  hr2d_status status = work(v, count);
  if (!v->visibility) hr2di_exchange_areas(v->h->element, pair, count, area);
  for (size_t k = 0; k < count && v->visibility && !status; k++) {
    hr2di_visibility_class view = HR2DI_CLEAR;
    status = pass_on(v, hr2di_occluded_area(v->visibility, v->h, pair[k], &area[k], &view));
    if (view == HR2DI_BLOCKED) area[k] = 0;
  }
  return status;
}

static hr2d_status check_areas(validator *v, const hr2d_link *link, size_t count) {
  const hr2d_element *element = v->h->element;
  hr2d_pair pair[AREAS] = {{0}};
  double area[AREAS];
  for (size_t k = 0; k < count; k++) {
    pair[k] = link[k].pair;
    if (pair[k].first >= v->h->elements || pair[k].second >= v->h->elements)
      return hr2di_message_fail(&v->links->message, HR2D_EINVAL,
                                "elements %u and %u are linked, but there are only %zu",
                                (unsigned)pair[k].first, (unsigned)pair[k].second,
                                v->h->elements);
    if (element[pair[k].first].patch == element[pair[k].second].patch)
      return fail(v, pair[k], "are linked, but belong to the same patch");
  }
  const hr2d_status status = integrate(v, pair, count, area);
  if (status) return status;
  for (size_t k = 0; k < count; k++) {
    const double weight = hr2di_linkset_weight(v->links, pair[k]);
    if (weight == 0) return fail(v, pair[k], "are linked, but an image of the pair is to be");
    area[k] *= weight;
    if (!(fabs(link[k].exchange_area - area[k]) <= fabs(weight) * rounding_of(v, pair[k]))) {
      if (!(area[k] > 0)) return fail(v, pair[k], "are linked, but are hidden from each other");
      const double unit = hr2d_scene_unit(v->h->scene);
      char what[96];
      snprintf(what, sizeof what, "exchange %.17g, but their link says %.17g", area[k] * unit,
               link[k].exchange_area * unit);
      return fail(v, pair[k], what);
    }
  }
  return HR2D_OK;
}

/* Checks the links one by one and copies their elements.  If links serve both directions, the
   element of the patch with the lower number comes first. */
static hr2d_status take_links(validator *v) {
  const hr2di_store *store = &v->links->store;
  for (uint64_t first = 0; first < store->count; first += AREAS) {
    const uint64_t rest = store->count - first;
    size_t count = rest < AREAS ? (size_t)rest : AREAS;
    v->watch.report.fraction = (double)first / (double)store->count;
    hr2d_link room[HR2DI_READ_LINKS]; /* AREAS divides a chunk, and is not more */
    const hr2d_link *link = hr2di_store_read(store, first, &count, room);
    const hr2d_status status = check_areas(v, link, count);
    if (status) return status;
    for (size_t k = 0; k < count; k++) {
      const hr2d_pair p = link[k].pair;
      const int swap =
          !v->links->directed && v->h->element[p.first].patch > v->h->element[p.second].patch;
      v->pair[first + k] = swap ? (hr2d_pair){p.second, p.first} : p;
    }
  }
  return HR2D_OK;
}

typedef enum key { FIRST_ELEMENT, FIRST_PATCH, SECOND_PATCH } key;

static size_t key_of(const validator *v, hr2d_pair pair, key by) {
  if (by == FIRST_ELEMENT) return pair.first;
  return v->h->element[by == FIRST_PATCH ? pair.first : pair.second].patch;
}

/* A stable counting sort, O(L + N). */
static hr2d_status sort(validator *v, key by) {
  const uint64_t count = v->links->store.count;
  const size_t keys = by == FIRST_ELEMENT ? v->h->elements : v->h->scene->patches;
  hr2d_status status = work(v, keys / 64);
  memset(v->bucket, 0, keys * sizeof *v->bucket);
  for (uint64_t k = 0; k < count && !status; k++) {
    if (k % AREAS == 0) status = work(v, AREAS / 16);
    v->bucket[key_of(v, v->pair[k], by)]++;
  }
  uint64_t begin = 0;
  for (size_t k = 0; k < keys; k++) {
    const uint64_t size = v->bucket[k];
    v->bucket[k] = begin;
    begin += size;
  }
  for (uint64_t k = 0; k < count && !status; k++) {
    if (k % AREAS == 0) status = work(v, AREAS / 8);
    v->spare[v->bucket[key_of(v, v->pair[k], by)]++] = v->pair[k];
  }
  hr2d_pair *sorted = v->spare;
  v->spare = v->pair;
  v->pair = sorted;
  return status;
}

/* Spreads the link of e and f over Q's tree, where links of e's ancestors and other links of
   e are already. */
static hr2d_status spread(validator *v, uint32_t e, uint32_t f) {
  const hr2d_element *element = v->h->element;
  node *at = v->node;
  const hr2d_status status = work(v, 2 + v->h->level[f] / 8);
  if (status) return status;
  for (uint32_t u = f;; u = v->h->parent[u]) {
    if (at[u].by != NOBODY) return fail_overlap(v, (hr2d_pair){e, f}, (hr2d_pair){at[u].by, u});
    if (is_root(v, u)) break;
  }
  if (at[f].inside > 0) {
    uint32_t u = f;
    while (at[u].by == NOBODY) {
      u = element[u].child;
      if (at[u].inside == 0) u++;
    }
    return fail_overlap(v, (hr2d_pair){e, f}, (hr2d_pair){at[u].by, u});
  }
  at[f].by = e;
  int whole = 1;
  for (uint32_t u = f;; u = v->h->parent[u]) {
    const uint32_t child = element[u].child;
    whole = whole && (u == f || (at[child].whole && at[child + 1].whole));
    at[u].whole = (unsigned char)whole;
    at[u].inside++;
    if (is_root(v, u)) return HR2D_OK;
  }
}

static void take_away(validator *v, uint32_t e) {
  for (uint64_t k = v->node[e].links; k < v->end && v->pair[k].first == e; k++) {
    const uint32_t f = v->pair[k].second;
    v->node[f].by = NOBODY;
    for (uint32_t u = f;; u = v->h->parent[u]) {
      v->node[u].whole = 0;
      v->node[u].inside--;
      if (is_root(v, u)) break;
    }
  }
}

/* Whether the elements of a pair, or ancestors of these, face each other as `facing` says;
   ancestors of the second go up to `top`.  Ancestors matter only where a midpoint is off the
   line of its patch by a rounding error that decides on which side of it something lies.  1
   once the watch has stopped. */
static int inherits(validator *v, hr2d_pair pair, uint32_t top, hr2di_facing facing) {
  for (uint32_t i = pair.first;; i = v->h->parent[i]) {
    for (uint32_t j = pair.second;; j = v->h->parent[j]) {
      if (hr2di_watch_work(&v->watch, 1) || face(v, i, j) == facing) return 1;
      if (j == top) break;
    }
    if (is_root(v, i)) return 0;
  }
}

/* Sets *hidden to 1 if walls hide the elements of a pair from each other, else to 0. */
static hr2d_status examine(validator *v, hr2d_pair pair, int *hidden) {
  hr2di_visibility_class view = HR2DI_CLEAR;
  double area = 0;
  hr2d_status status = hr2di_watch_work(&v->watch, 1);
  if (!status && v->visibility)
    status = hr2di_occluded_area(v->visibility, v->h, pair, &area, &view);
  if (status) return pass_on(v, status);
  *hidden = view == HR2DI_BLOCKED || (v->visibility && area <= rounding_of(v, pair));
  return HR2D_OK;
}

/* Sets *hidden to 1 if walls hide e, or an ancestor of e, from f.  Because midpoints are
   rounded, walls that hide an ancestor may leave a gap to e. */
static hr2d_status view_above(validator *v, uint32_t e, uint32_t f, int *hidden) {
  for (;; e = v->h->parent[e]) {
    const hr2d_status status = examine(v, (hr2d_pair){e, f}, hidden);
    if (status || *hidden || is_root(v, e)) return status;
  }
}

/* Checks, for e and f that no link joins, that no leaves below them see each other. */
static hr2d_status check_unseen(validator *v, uint32_t e, uint32_t f) {
  const hr2d_element *element = v->h->element;
  size_t count = 0;
  int above = 0;
  const hr2d_status looked = view_above(v, e, f, &above);
  if (looked || above) return looked;
  for (hr2d_pair p = {e, f};;) {
    int hidden = 0;
    const hr2d_status status = examine(v, p, &hidden);
    if (status) return status;
    if (!hidden && !inherits(v, p, f, HR2DI_FACING_NONE)) {
      const uint32_t left = element[p.first].child, right = element[p.second].child;
      if (!left && !right)
        return fail(v, (hr2d_pair){e, f}, "see each other, but no link joins them");
      if (hr2di_alloc_reserve(&v->links->alloc, &v->stack, &v->capacity, count + 2, sizeof p))
        return out_of_memory(v);
      for (uint32_t k = 0; k < 2; k++)
        v->stack[count++] =
            left ? (hr2d_pair){left + k, p.second} : (hr2d_pair){p.first, right + k};
    }
    if (count == 0) return HR2D_OK;
    p = v->stack[--count];
  }
}

/* Checks that e cannot see the parts of q's tree that no link of e or its ancestors fills. */
static hr2d_status check_filled(validator *v, uint32_t e, uint32_t q, hr2di_facing facing) {
  uint32_t f = q;
  for (;;) {
    const hr2d_status asked = work(v, 1);
    if (asked) return asked;
    if (!v->node[f].whole && v->node[f].inside > 0) {
      f = v->h->element[f].child;
      continue;
    }
    if (!v->node[f].whole) {
      const hr2d_status status =
          facing == HR2DI_FACING_FULL && !v->visibility
              ? fail(v, (hr2d_pair){e, f}, "see each other, but no link joins them")
              : check_unseen(v, e, f);
      if (status) return status;
    }
    while (f != q && is_right(v, f)) f = v->h->parent[f];
    if (f == q) return HR2D_OK;
    f++;
  }
}

/* Walks the tree of p, as far down as there are links to q. */
static hr2d_status walk(validator *v, uint32_t p, uint32_t q, hr2di_facing facing) {
  uint32_t e = p;
  for (;;) {
    hr2d_status status = work(v, 1);
    for (uint64_t k = v->node[e].links; !status && k < v->end && v->pair[k].first == e; k++)
      status = spread(v, e, v->pair[k].second);
    if (status) return status;
    if (v->node[e].above) {
      e = v->h->element[e].child;
      continue;
    }
    status = check_filled(v, e, q, facing);
    if (status) return status;
    for (take_away(v, e); e != p && is_right(v, e); take_away(v, e)) e = v->h->parent[e];
    if (e == p) return HR2D_OK;
    e++;
  }
}

/* Sets `links` and `above` of the elements of P for the links between P and Q, or clears
   them. */
static hr2d_status mark(validator *v, int clear) {
  hr2d_status status = HR2D_OK;
  for (uint64_t k = v->end; k-- > v->begin && !status;) {
    if (k % AREAS == 0) status = work(v, AREAS / 4);
    uint32_t u = v->pair[k].first;
    v->node[u].links = clear ? NO_LINK : k;
    while (!is_root(v, u)) {
      u = v->h->parent[u];
      if (v->node[u].above == !clear) break;
      v->node[u].above = (unsigned char)!clear;
    }
  }
  return status;
}

/* Checks all links between two patches; they are the next ones in v->pair. */
static hr2d_status check_patches(validator *v, uint32_t p, uint32_t q) {
  const uint64_t count = v->links->store.count;
  const hr2d_element *element = v->h->element;
  v->begin = v->end;
  while (v->end < count && element[v->pair[v->end].first].patch == p &&
         element[v->pair[v->end].second].patch == q)
    v->end++;
  const hr2di_facing facing = face(v, p, q);
  hr2d_status status = work(v, 1);
  for (uint64_t k = v->begin; k < v->end && facing != HR2DI_FACING_FULL && !status; k++) {
    status = work(v, 1);
    const hr2d_pair pair = v->pair[k];
    if (facing == HR2DI_FACING_NONE || (face(v, pair.first, pair.second) == HR2DI_FACING_NONE &&
                                        !inherits(v, pair, q, HR2DI_FACING_FULL)))
      return fail(v, pair, "are linked, but cannot see each other");
  }
  if (status || facing == HR2DI_FACING_NONE || !hr2di_scene_lit(v->h->scene, p) ||
      !hr2di_scene_lit(v->h->scene, q))
    return status;
  status = mark(v, 0);
  if (!status) status = walk(v, p, q, facing);
  return status ? status : mark(v, 1);
}

static hr2d_status check_all(validator *v) {
  const uint32_t n = (uint32_t)v->h->scene->patches;
  hr2d_status status = take_links(v);
  if (!status) status = sort(v, FIRST_ELEMENT);
  if (!status) status = sort(v, SECOND_PATCH);
  if (!status) status = sort(v, FIRST_PATCH);
  for (uint32_t p = 0; p < n && !status; p++)
    for (uint32_t q = v->links->directed ? 0 : p + 1; q < n && !status; q++)
      if (p != q &&
          hr2di_symmetry_weight(&v->h->scene->symmetry, p, q, v->links->directed) != 0)
        status = check_patches(v, p, q);
  return status;
}

hr2d_status hr2d_linkset_validate(hr2d_linkset *links) {
  if (!links) return HR2D_EINVAL;
  const hr2d_hierarchy *h = links->hierarchy;
  const hr2d_allocator *alloc = &links->alloc;
  const size_t count = (size_t)links->store.count;
  validator v = {.links = links, .h = h};
  hr2di_scene_watch(h->scene, &v.watch, NULL, NULL, "validate");
  v.pair = hr2di_alloc(alloc, count, sizeof *v.pair);
  v.spare = hr2di_alloc(alloc, count, sizeof *v.spare);
  v.bucket = hr2di_alloc(alloc, h->elements, sizeof *v.bucket);
  v.node = hr2di_alloc(alloc, h->elements, sizeof *v.node);
  hr2d_status status;
  if (!v.pair || !v.spare || !v.bucket || !v.node) {
    status = out_of_memory(&v);
  } else {
    for (size_t e = 0; e < h->elements; e++) v.node[e] = (node){.links = NO_LINK, .by = NOBODY};
    hr2di_pair_visibility visibility = {0};
    status = HR2D_OK;
    if (h->scene->effect[HR2D_EFFECT_OCCLUSION].on) {
      v.visibility = &visibility;
      status = hr2di_pair_visibility_init(&visibility, h->scene, NULL, alloc, &v.watch);
    }
    status = status ? out_of_memory(&v) : check_all(&v);
    hr2di_pair_visibility_clear(&visibility);
  }
  hr2di_alloc_free(alloc, v.pair);
  hr2di_alloc_free(alloc, v.spare);
  hr2di_alloc_free(alloc, v.bucket);
  hr2di_alloc_free(alloc, v.node);
  hr2di_alloc_free(alloc, v.stack);
  return status;
}
