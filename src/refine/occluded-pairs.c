/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Occluded pairs: each carries the walls that reach into its shaft, and hands each child pair
   the walls that reach into the child's shaft.

   A pair without walls is unoccluded, and no pair below it is tested again.  A pair that
   nothing passes is dropped: one wall that cuts the shaft is noticed at once; walls that
   block it together are noticed by a test of the widest of them, or else when the pair would
   be linked. */
#include "refine/occluded-pairs.h"

#include "base/alloc.h"
#include "geometry/exchange-area.h"
#include "scene/scene-impl.h"

static hr2d_status fail(hr2di_projector *p, hr2d_status status) {
  return hr2di_projector_fail(p, status, " for walls in the way");
}

/* The patch with the lower number comes first, so that both directions get the same
   bits. */
static int make_shaft(const hr2d_hierarchy *h, hr2d_pair pair, hr2di_facing *facing,
                      hr2di_shaft *shaft) {
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  if (i->patch > j->patch) {
    const hr2d_element *swap = i;
    i = j;
    j = swap;
  }
  const hr2d_segment s = {i->a, i->b}, t = {j->a, j->b};
  *facing = hr2di_facing_of(&s, &t);
  return hr2di_shaft_init(shaft, *facing, s, t, h->scene->patch[i->patch].scaled,
                          h->scene->patch[j->patch].scaled);
}

/* Tests a partly visible pair again, as several walls may block it together. */
static hr2d_status look_closer(hr2di_visibility *visibility, const hr2di_shaft *shaft,
                               hr2di_wall_list *found, size_t first,
                               hr2di_visibility_class *view) {
  int blocked = 0;
  hr2d_status status = HR2D_OK;
  if (*view == HR2DI_PARTIAL)
    status = hr2di_visibility_blocked(visibility, shaft, hr2di_wall_list_from(found, first),
                                      found->count - first, &blocked);
  if (blocked) {
    *view = HR2DI_BLOCKED;
    found->count = first;
  }
  return status;
}

hr2d_status hr2di_occluded_collect(hr2di_projector *p, hr2d_pair pair,
                                   hr2di_visibility_class *view) {
  hr2di_shaft shaft;
  hr2di_facing facing;
  const size_t first = p->found.count;
  *view = HR2DI_CLEAR;
  if (!make_shaft(p->hierarchy, pair, &facing, &shaft)) return HR2D_OK;
  hr2d_status status = hr2di_visibility_collect(p->visibility, &shaft, &p->found, view);
  if (!status) status = look_closer(p->visibility, &shaft, &p->found, first, view);
  return fail(p, status);
}

/* Puts a pair on the stack with its walls. */
static hr2d_status push(hr2di_projector *p, hr2d_pair pair, const uint32_t *wall,
                        size_t count) {
  hr2di_occluded_pairs *s = &p->occluded;
  const hr2d_allocator *alloc = &p->links->alloc;
  const size_t pairs = s->stack.count + 1, walls = s->list.count + count;
  hr2d_status status = hr2di_projector_check_budget(
      p, (pairs > s->first_capacity ? 2 * pairs * sizeof *s->first : 0) +
             (walls > s->list.capacity ? 2 * walls * sizeof *wall : 0));
  if (!status) status = hr2di_projector_push(p, &s->stack, pair);
  if (status) return status;
  if (hr2di_alloc_reserve(alloc, &s->first, &s->first_capacity, s->stack.count,
                          sizeof *s->first) ||
      hr2di_alloc_reserve(alloc, &s->list.wall, &s->list.capacity, s->list.count + count,
                          sizeof *s->list.wall))
    return fail(p, HR2D_ENOMEM);
  s->first[s->stack.count - 1] = s->list.count;
  for (size_t k = 0; k < count; k++) s->list.wall[s->list.count++] = wall[k];
  return HR2D_OK;
}

/* Links an accepted pair, unless its walls leave nothing of it. */
static hr2d_status link_pair(hr2di_projector *p, hr2d_pair pair, const uint32_t *wall,
                             size_t count) {
  hr2di_shaft shaft;
  hr2di_facing facing;
  double area = 0;
  int open = 0;
  if (!make_shaft(p->hierarchy, pair, &facing, &shaft)) return HR2D_OK;
  const hr2d_status status =
      p->sink ? hr2di_visibility_area(p->visibility, &shaft, wall, count, &area, &open)
              : hr2di_visibility_any(p->visibility, &shaft, wall, count, &open);
  if (status) return fail(p, status);
  if (!open) {
    p->counts.blocked_pairs++;
    return HR2D_OK;
  }
  p->counts.partial_links++;
  p->counts.exchange_areas += p->sink != NULL;
  p->accepted[0] = pair;
  return hr2di_projector_accept(p, &area, 1);
}

/* A pair to be proposed, with its walls in p->found. */
typedef struct candidate {
  hr2d_pair pair;
  size_t first, count;
} candidate;

enum { MOST = 4 };

static hr2d_status propose(hr2di_projector *p, const candidate *c, size_t count) {
  static const unsigned char partial[MOST] = {1, 1, 1, 1};
  hr2d_pair pairs[MOST] = {{0}};
  unsigned char accepted[MOST] = {0};
  if (count == 0) return HR2D_OK;
  for (size_t k = 0; k < count; k++) pairs[k] = c[k].pair;
  p->partial = partial;
  hr2d_status status = hr2di_projector_estimate(p, pairs, count);
  p->partial = NULL;
  for (size_t k = 0; k < count && !status; k++) accepted[k] = p->flag[k];
  for (size_t k = 0; k < count && !status; k++)
    status =
        accepted[k]
            ? link_pair(p, c[k].pair, hr2di_wall_list_from(&p->found, c[k].first), c[k].count)
            : push(p, c[k].pair, hr2di_wall_list_from(&p->found, c[k].first), c[k].count);
  return status;
}

/* Puts a clear pair on a stack of unoccluded pairs, drops a blocked pair, and adds a partly
   visible one to the candidates. */
static hr2d_status sort_out(hr2di_projector *p, hr2d_pair pair, hr2di_visibility_class view,
                            hr2di_facing facing, size_t first, candidate *c, size_t *count) {
  p->counts.blocked_pairs += view == HR2DI_BLOCKED;
  if (view == HR2DI_CLEAR)
    return hr2di_projector_push(p, &p->unoccluded[facing == HR2DI_FACING_PART || p->test_all],
                                pair);
  if (view == HR2DI_PARTIAL) c[(*count)++] = (candidate){pair, first, p->found.count - first};
  return HR2D_OK;
}

hr2d_status hr2di_occluded_propose_roots(hr2di_projector *p, const hr2d_pair *pairs,
                                         size_t count) {
  if (!p->visibility) return hr2di_projector_propose_clipped(p, pairs, count);
  hr2d_pair clear[HR2DI_CANDIDATES];
  size_t kept = 0;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++) {
    const hr2d_element *i = &p->hierarchy->element[pairs[k].first];
    const hr2d_element *j = &p->hierarchy->element[pairs[k].second];
    if (hr2di_facing_of(&(hr2d_segment){i->a, i->b}, &(hr2d_segment){j->a, j->b}) ==
        HR2DI_FACING_NONE)
      continue;
    status = fail(p, hr2di_projector_work(p, 1));
    if (status) break;
    hr2di_visibility_class view;
    candidate c = {pairs[k], 0, 0};
    p->found.count = 0;
    status = hr2di_occluded_collect(p, pairs[k], &view);
    c.count = p->found.count;
    p->counts.blocked_pairs += view == HR2DI_BLOCKED;
    if (view == HR2DI_CLEAR) clear[kept++] = pairs[k];
    if (view == HR2DI_PARTIAL && !status) status = propose(p, &c, 1);
  }
  return status ? status : hr2di_projector_propose_clipped(p, clear, kept);
}

hr2d_status hr2di_occluded_push(hr2di_projector *p, hr2d_pair pair) {
  hr2di_visibility_class view;
  p->found.count = 0;
  const hr2d_status status = hr2di_occluded_collect(p, pair, &view);
  return status ? status : push(p, pair, p->found.wall, p->found.count);
}

hr2d_status hr2di_occluded_share(hr2di_projector *p, const hr2di_occluded_pairs *from,
                                 size_t k) {
  const size_t last = k + 1 < from->stack.count ? from->first[k + 1] : from->list.count;
  return push(p, from->stack.pair[k], hr2di_wall_list_from(&from->list, from->first[k]),
              last - from->first[k]);
}

hr2d_status hr2di_occluded_round(hr2di_projector *p) {
  hr2di_occluded_pairs *s = &p->occluded;
  const hr2d_pair pair = s->stack.pair[--s->stack.count];
  const size_t from = s->first[s->stack.count], walls = s->list.count - from;
  candidate c[MOST];
  size_t candidates, count = 0;
  int limited;
  hr2d_status status = hr2di_projector_subdivide(p, pair, &candidates, &limited);
  const uint64_t links = p->counts.links;
  if (!status && limited)
    status = link_pair(p, pair, hr2di_wall_list_from(&s->list, from), walls);
  p->counts.limited_links += p->counts.links - links;
  p->found.count = 0;
  for (size_t k = 0; k < candidates && !status; k++) {
    hr2di_shaft shaft;
    hr2di_facing facing;
    hr2di_visibility_class view = HR2DI_CLEAR;
    const size_t first = p->found.count;
    const int occluded = make_shaft(p->hierarchy, p->candidate[k], &facing, &shaft);
    if (facing == HR2DI_FACING_NONE) continue;
    if (occluded)
      status = hr2di_visibility_shrink(p->visibility, &shaft, &s->list, from, walls, &p->found,
                                       &view);
    if (!status && occluded)
      status = look_closer(p->visibility, &shaft, &p->found, first, &view);
    if (status) return fail(p, status);
    status = sort_out(p, p->candidate[k], view, facing, first, c, &count);
  }
  s->list.count = from;
  return status ? status : propose(p, c, count);
}

hr2d_status hr2di_occluded_area(hr2di_visibility *visibility, const hr2d_hierarchy *hierarchy,
                                hr2d_pair pair, double *area, hr2di_visibility_class *view) {
  hr2di_shaft shaft;
  hr2di_facing facing;
  hr2di_wall_list found = {0};
  int open = 0;
  *area = 0;
  hr2d_status status = HR2D_OK;
  *view = HR2DI_CLEAR;
  if (make_shaft(hierarchy, pair, &facing, &shaft))
    status = hr2di_visibility_collect(visibility, &shaft, &found, view);
  if (!status && *view == HR2DI_CLEAR) hr2di_exchange_areas(hierarchy->element, &pair, 1, area);
  if (!status && *view == HR2DI_PARTIAL) {
    status = hr2di_visibility_area(visibility, &shaft, found.wall, found.count, area, &open);
    if (!open) *view = HR2DI_BLOCKED;
  }
  hr2di_alloc_free(&visibility->alloc, found.wall);
  return status;
}
