/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "beams/line-class-list.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "geometry/vector.h"

void hr2di_line_class_list_clear(hr2di_line_class_list *l) {
  hr2di_alloc_free(&l->alloc, l->line_class);
  hr2di_alloc_free(&l->alloc, l->point);
  *l = (hr2di_line_class_list){.alloc = l->alloc};
}

uint64_t hr2di_line_class_list_bytes(const hr2di_line_class_list *l) {
  return l->capacity * sizeof *l->line_class + l->point_capacity * sizeof *l->point;
}

void hr2di_line_class_list_cut(hr2di_line_class_list *l, size_t count) {
  if (count >= l->count) return;
  l->points = count > 0 ? l->line_class[count].first : 0;
  l->count = count;
}

hr2di_line_class hr2di_line_class_list_at(const hr2di_line_class_list *l, size_t k) {
  const hr2di_stored_line_class *s = &l->line_class[k];
  const hr2d_point *p = l->point + s->first;
  return (hr2di_line_class){p, p + s->lefts, s->lefts, s->rights, s->ends};
}

/* The capacity that hr2di_alloc_reserve() may give at most. */
static uint64_t grown(size_t capacity, size_t needed) {
  return needed <= capacity ? capacity : needed < 8 ? 8 : 2 * (uint64_t)needed;
}

static hr2d_status reserve(hr2di_line_class_list *l, size_t classes, size_t points) {
  const uint64_t bytes = grown(l->capacity, l->count + classes) * sizeof *l->line_class +
                         grown(l->point_capacity, l->points + points) * sizeof *l->point;
  if (l->max_bytes && bytes > l->max_bytes && bytes > hr2di_line_class_list_bytes(l))
    return HR2D_EMAX_BYTES;
  return hr2di_alloc_reserve(&l->alloc, &l->line_class, &l->capacity, l->count + classes,
                             sizeof *l->line_class) ||
                 hr2di_alloc_reserve(&l->alloc, &l->point, &l->point_capacity,
                                     l->points + points, sizeof *l->point)
             ? HR2D_ENOMEM
             : HR2D_OK;
}

hr2d_status hr2di_line_class_list_add(hr2di_line_class_list *l, const hr2di_line_class *s,
                                      hr2d_segment near, hr2d_segment far) {
  const hr2d_status status = reserve(l, 1, s->lefts + s->rights);
  if (status) return status;
  l->line_class[l->count++] = (hr2di_stored_line_class){
      near, far, l->points, (uint32_t)s->lefts, (uint32_t)s->rights, s->ends};
  memcpy(l->point + l->points, s->left, s->lefts * sizeof *s->left);
  memcpy(l->point + l->points + s->lefts, s->right, s->rights * sizeof *s->right);
  l->points += s->lefts + s->rights;
  return HR2D_OK;
}

hr2d_status hr2di_line_class_list_copy(hr2di_line_class_list *l,
                                       const hr2di_line_class_list *from, size_t first,
                                       size_t last) {
  hr2d_status status = HR2D_OK;
  for (size_t k = first; k < last && !status; k++) {
    const hr2di_line_class s = hr2di_line_class_list_at(from, k);
    status =
        hr2di_line_class_list_add(l, &s, from->line_class[k].near, from->line_class[k].far);
  }
  return status;
}

/* Reversed as a whole, the left chain and the right one become the right one and the left one,
   each read from its other end. */
void hr2di_line_class_list_turn(hr2di_line_class_list *l, size_t k) {
  hr2di_stored_line_class *s = &l->line_class[k];
  hr2d_point *p = l->point + s->first;
  for (size_t low = 0, high = s->lefts + s->rights; low + 1 < high; low++) {
    const hr2d_point kept = p[low];
    p[low] = p[--high];
    p[high] = kept;
  }
  *s = (hr2di_stored_line_class){s->far,    s->near,  s->first,
                                 s->rights, s->lefts, (s->ends << 2 | s->ends >> 2) & 15};
}

/* A line class that is restricted, with room for the points of the next steps. */
typedef struct narrowing {
  hr2di_line_class s;
  hr2d_point *free;
} narrowing;

static int move(narrowing *n, hr2di_line_class_end end, hr2d_point x) {
  hr2di_line_class child;
  if (!hr2di_line_class_restrict(&n->s, end, x, n->free, &child)) return 0;
  if (child.left != n->s.left) n->free += child.lefts + child.rights;
  n->s = child;
  return 1;
}

/* Ends of walls that are moved onto vertices are moved by at most 4 units in the last place of
   scaled coordinates.  So near an end is that of the segment already. */
#define NEAR 0x1p-49

/* Leaves what lies along `part`, with both ends of the chains on it; 0 if nothing is left. */
static int clip(narrowing *n, hr2d_segment *all, hr2d_segment part, hr2di_line_class_end first,
                hr2di_line_class_end last) {
  const double start = hr2di_point_along(*all, all->a), end = hr2di_point_along(*all, all->b);
  const double from = hr2di_point_along(*all, part.a), to = hr2di_point_along(*all, part.b);
  const double near = fmin(NEAR, fmin(to - from, end - start) / 4);
  if (from >= end - near || to <= start + near) return 0;
  if (from > start + near) {
    if (!move(n, first, part.a)) return 0;
    all->a = part.a;
  }
  if (to >= end - near) return 1;
  all->b = part.b;
  return move(n, last, part.b);
}

hr2d_status hr2di_line_class_list_restrict(hr2di_line_class_list *l,
                                           const hr2di_line_class_list *from, size_t first,
                                           size_t last, hr2d_segment near, hr2d_segment far,
                                           hr2di_line_class_list *whole) {
  for (size_t k = first; k < last; k++) {
    hr2di_stored_line_class kept = from->line_class[k];
    /* Each of four steps keeps at most one point more than there was, behind the room for what
       is left: points + 4 and points + 1, + 2, + 3, + 4. */
    const size_t points = kept.lefts + kept.rights;
    hr2d_status status = reserve(l, 1, 5 * points + 14);
    if (status) return status;
    narrowing n = {hr2di_line_class_list_at(from, k), l->point + l->points + points + 4};
    if (!clip(&n, &kept.near, near, HR2DI_LINE_CLASS_A, HR2DI_LINE_CLASS_B) ||
        !clip(&n, &kept.far, far, HR2DI_LINE_CLASS_C, HR2DI_LINE_CLASS_D))
      continue;
    status = hr2di_line_class_list_add(l, &n.s, kept.near, kept.far);
    if (!status && whole) status = hr2di_line_class_list_copy(whole, from, k, k + 1);
    if (status) return status;
  }
  return HR2D_OK;
}

/* By where they begin and end, then by their chains. */
static int comes_before(const hr2di_line_class_list *l, const hr2di_stored_line_class *s,
                        const hr2di_stored_line_class *t) {
  int order = hr2di_point_order(s->near.a, t->near.a);
  if (!order) order = hr2di_point_order(s->far.a, t->far.a);
  const size_t count = s->lefts + s->rights, other = t->lefts + t->rights;
  for (size_t k = 0; !order && k < count && k < other; k++)
    order = hr2di_point_order(l->point[s->first + k], l->point[t->first + k]);
  return order ? order < 0 : count < other;
}

void hr2di_line_class_list_sort(hr2di_line_class_list *l) {
  for (size_t k = 1; k < l->count; k++) {
    const hr2di_stored_line_class s = l->line_class[k];
    size_t m = k;
    for (; m > 0 && comes_before(l, &s, &l->line_class[m - 1]); m--)
      l->line_class[m] = l->line_class[m - 1];
    l->line_class[m] = s;
  }
}

double hr2di_line_class_list_area(const hr2di_line_class_list *l, size_t first, size_t last) {
  double area = 0;
  for (size_t k = first; k < last; k++) {
    const hr2di_line_class s = hr2di_line_class_list_at(l, k);
    area += hr2di_line_class_area(&s);
  }
  return area;
}
