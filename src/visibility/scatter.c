/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts on both sides are halved, and the line class restricted, until nothing is left of
   it, or all lines between two ranges of parts, or one pair of parts.  Where all lines are
   left, nothing is in the way, and the pairs of parts are done in batches without a further
   look. */
#include "visibility/scatter.h"

#include "base/alloc.h"
#include "geometry/exchange-area.h"

/* Ranges below 2^32 are halved 32 times; each time both halves are kept. */
enum { DEPTH = 2 * 2 * 33 };

typedef struct node {
  hr2di_line_class s;
  hr2di_parts near, far;
  hr2d_point *free; /* behind its points */
} node;

static uint32_t count(hr2di_parts p) {
  return p.last - p.first;
}

static hr2d_status flush(hr2di_scatter *f) {
  double area[HR2DI_SHARING_BATCH];
  if (hr2di_alloc_reserve(&f->alloc, &f->share, &f->room, f->contributions + f->pairs,
                          sizeof *f->share))
    return HR2D_ENOMEM;
  hr2di_exchange_areas_between((const hr2d_segment(*)[2])f->pair, f->pairs, area);
  for (size_t k = 0; k < f->pairs; k++) {
    if (!(area[k] > 0)) continue;
    f->share[f->contributions] = f->waiting[k];
    f->share[f->contributions++].area = area[k];
  }
  const hr2d_status status = hr2di_watch_work(f->watch, 1 + f->pairs / 2);
  f->pairs = 0;
  return status;
}

hr2d_status hr2di_scatter_add_pair(hr2di_scatter *f, const hr2d_segment pair[2],
                                   hr2di_contribution share) {
  f->pair[f->pairs][0] = pair[0];
  f->pair[f->pairs][1] = pair[1];
  f->waiting[f->pairs++] = share;
  return f->pairs < HR2DI_SHARING_BATCH ? HR2D_OK : flush(f);
}

hr2d_status hr2di_scatter_add_area(hr2di_scatter *f, hr2di_contribution share) {
  if (hr2di_alloc_reserve(&f->alloc, &f->share, &f->room, f->contributions + 1,
                          sizeof *f->share))
    return HR2D_ENOMEM;
  f->share[f->contributions++] = share;
  return HR2D_OK;
}

hr2d_status hr2di_scatter_finish(hr2di_scatter *f) {
  return f->pairs > 0 ? flush(f) : HR2D_OK;
}

static hr2di_contribution share_of(const hr2di_scatter *f, const hr2di_patch_ranges *among,
                                   uint32_t near, uint32_t far, int partial) {
  const hr2di_side_part *part = f->parts->part;
  const uint32_t row = among->rows_far ? far : near, column = among->rows_far ? near : far;
  return (hr2di_contribution){.place = part[row].place,
                              .patch = part[column].patch,
                              .partial = (unsigned char)partial,
                              .later = (unsigned char)among->later};
}

static int somebody(const hr2di_scatter *f, uint32_t part) {
  return f->parts->part[part].patch != HR2DI_NOBODY;
}

static hr2d_status add_clear(hr2di_scatter *f, const node *n, const hr2di_patch_ranges *among) {
  hr2d_status status = HR2D_OK;
  for (uint32_t k = n->near.first; k < n->near.last; k++)
    for (uint32_t m = n->far.first; m < n->far.last && !status; m++) {
      if (!somebody(f, k) || !somebody(f, m)) continue;
      const hr2d_segment pair[2] = {f->parts->part[k].at, f->parts->part[m].at};
      status = hr2di_scatter_add_pair(f, pair, share_of(f, among, k, m, 0));
    }
  return status;
}

/* One pair of parts. */
static hr2d_status add_one(hr2di_scatter *f, const hr2di_line_class *s, uint32_t near,
                           uint32_t far, const hr2di_patch_ranges *among) {
  if (!somebody(f, near) || !somebody(f, far)) return HR2D_OK;
  const int clear = hr2di_line_class_clear(s);
  hr2di_contribution share = share_of(f, among, near, far, !clear);
  if (clear) {
    const hr2d_segment pair[2] = {f->parts->part[near].at, f->parts->part[far].at};
    return hr2di_scatter_add_pair(f, pair, share);
  }
  if (s->lefts == 2 && s->rights == 2) {
    const hr2d_segment pair[2] = {{s->left[0], s->right[0]}, {s->right[1], s->left[1]}};
    return hr2di_scatter_add_pair(f, pair, share);
  }
  share.area = hr2di_line_class_area(s);
  const hr2d_status status = share.area > 0 ? hr2di_scatter_add_area(f, share) : HR2D_OK;
  return status ? status : hr2di_watch_work(f->watch, 1 + (s->lefts + s->rights) / 2);
}

/* Moves one end of a node's line class, with points from n->free on. */
static int move(node *n, hr2di_line_class_end end, hr2d_point x) {
  hr2di_line_class child;
  if (!hr2di_line_class_restrict(&n->s, end, x, n->free, &child)) return 0;
  if (child.left != n->s.left) n->free += child.lefts + child.rights;
  n->s = child;
  return 1;
}

/* Leaves a half of the longer range; 0 if nothing is left. */
static int halve(const hr2di_side_part *part, node *n, int second) {
  const int near = count(n->near) >= count(n->far);
  hr2di_parts *range = near ? &n->near : &n->far;
  const uint32_t middle = range->first + count(*range) / 2;
  if (second) {
    range->first = middle;
    return move(n, near ? HR2DI_LINE_CLASS_A : HR2DI_LINE_CLASS_C, part[middle].at.a);
  }
  range->last = middle;
  return move(n, near ? HR2DI_LINE_CLASS_B : HR2DI_LINE_CLASS_D, part[middle - 1].at.b);
}

/* Restricts a line class of whole sides to the given parts of them. */
static int trim(const hr2di_scatter *f, node *n) {
  const hr2di_side_part *part = f->parts->part;
  const hr2di_side *of_side = f->parts->of_side;
  const hr2di_parts near = of_side[part[n->near.first].side].parts;
  const hr2di_parts far = of_side[part[n->far.first].side].parts;
  return (n->near.first == near.first ||
          move(n, HR2DI_LINE_CLASS_A, part[n->near.first].at.a)) &&
         (n->near.last == near.last ||
          move(n, HR2DI_LINE_CLASS_B, part[n->near.last - 1].at.b)) &&
         (n->far.first == far.first || move(n, HR2DI_LINE_CLASS_C, part[n->far.first].at.a)) &&
         (n->far.last == far.last || move(n, HR2DI_LINE_CLASS_D, part[n->far.last - 1].at.b));
}

static unsigned levels(uint32_t n) {
  unsigned k = 0;
  for (; n > 1; n -= n / 2) k++;
  return k;
}

/* Each restriction keeps at most one point more than there was; four trim the ranges, and two
   are kept on each level. */
static hr2d_status reserve(hr2di_scatter *f, const hr2di_line_class *s, const node *n) {
  const size_t depth = 4 + levels(count(n->near)) + levels(count(n->far));
  const size_t needed = 2 * depth * (s->lefts + s->rights + depth + 1);
  return hr2di_alloc_reserve(&f->alloc, &f->point, &f->points, needed, sizeof *f->point)
             ? HR2D_ENOMEM
             : HR2D_OK;
}

static hr2d_status add_many(hr2di_scatter *f, const hr2di_line_class *s,
                            const hr2di_patch_ranges *among) {
  node stack[DEPTH];
  size_t nodes = 0;
  node whole = {.s = *s, .near = among->near, .far = among->far};
  hr2d_status status = reserve(f, s, &whole);
  if (status) return status;
  whole.free = f->point;
  if (!among->part || trim(f, &whole)) stack[nodes++] = whole;
  while (nodes > 0 && !status) {
    const node n = stack[--nodes];
    if (count(n.near) == 1 && count(n.far) == 1) {
      status = add_one(f, &n.s, n.near.first, n.far.first, among);
    } else if (hr2di_line_class_clear(&n.s)) {
      status = add_clear(f, &n, among);
    } else {
      hr2d_point *free = n.free;
      for (int second = 1; second >= 0; second--) {
        stack[nodes] = n;
        stack[nodes].free = free;
        if (!halve(f->parts->part, &stack[nodes], second)) continue;
        free = stack[nodes++].free;
      }
      status = hr2di_watch_work(f->watch, 1 + (n.s.lefts + n.s.rights) / 8);
    }
  }
  return status;
}

hr2d_status hr2di_scatter_add(hr2di_scatter *f, const hr2di_line_class *s,
                              const hr2di_patch_ranges *among) {
  if (count(among->near) == 1 && count(among->far) == 1 && !among->part)
    return add_one(f, s, among->near.first, among->far.first, among);
  return add_many(f, s, among);
}

void hr2di_scatter_clear(hr2di_scatter *f) {
  hr2di_alloc_free(&f->alloc, f->share);
  hr2di_alloc_free(&f->alloc, f->point);
}
