/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The hull as two chains of points in lexicographic order (Andrew), by exact signs.

   A line through a segment has all points on one side iff it supports the hull.  What the hull
   has on such a line is a corner or an edge.  The segment is no corner: it lies on an edge. */
#include "geometry/hull.h"

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/orient-sign.h"

static int compare(hr2d_point p, hr2d_point q) {
  if (p.x != q.x) return p.x < q.x ? -1 : 1;
  return (p.y > q.y) - (p.y < q.y);
}

static int by_point(const void *left, const void *right) {
  return compare(*(const hr2d_point *)left, *(const hr2d_point *)right);
}

/* Appends p to a chain whose points all have the hull on the side `sign`. */
static void append(hr2d_point *chain, size_t *count, hr2d_point p, int sign) {
  size_t n = *count;
  if (n > 0 && compare(chain[n - 1], p) == 0) return;
  while (n > 1 && sign * hr2di_orient_sign(chain[n - 2], chain[n - 1], p) <= 0) n--;
  chain[n++] = p;
  *count = n;
}

static hr2d_status make_chains(hr2di_hull *hull, const hr2d_point *point, size_t points,
                               hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (int upper = 0; upper < 2; upper++) {
    hr2d_point *chain = hull->at + (upper ? hull->count[0] : 0);
    for (size_t k = 0; k < points && !status; k++) {
      if (k % 16 == 0) status = hr2di_watch_work(watch, 8);
      append(chain, &hull->count[upper], point[k], upper ? -1 : 1);
    }
  }
  return status;
}

hr2d_status hr2di_hull_init(hr2di_hull *hull, const hr2d_allocator *alloc,
                            const hr2d_segment *first, size_t count, size_t stride,
                            hr2di_watch *watch) {
  *hull = (hr2di_hull){.alloc = *alloc};
  hr2d_point *point = hr2di_alloc(alloc, count, 2 * sizeof *point);
  hull->at = hr2di_alloc(alloc, count, 4 * sizeof *hull->at);
  hr2d_status status = point && hull->at ? hr2di_watch_work(watch, count / 8) : HR2D_ENOMEM;
  for (size_t k = 0; k < count && !status; k++) {
    const hr2d_segment *s = (const hr2d_segment *)((const char *)first + k * stride);
    point[2 * k] = s->a;
    point[2 * k + 1] = s->b;
  }
  if (!status) status = hr2di_sort(point, 2 * count, sizeof *point, by_point, watch);
  if (!status) status = make_chains(hull, point, 2 * count, watch);
  hr2di_alloc_free(alloc, point);
  return status;
}

/* Whether p and q, the lesser one first, lie on one edge of a chain. */
static int on_edge(const hr2d_point *chain, size_t count, hr2d_point p, hr2d_point q) {
  size_t low = 0, high = count - 1;
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (compare(chain[middle], p) <= 0)
      low = middle;
    else
      high = middle;
  }
  return compare(q, chain[high]) <= 0 && hr2di_orient_sign(chain[low], chain[high], p) == 0 &&
         hr2di_orient_sign(chain[low], chain[high], q) == 0;
}

unsigned hr2di_hull_sides(const hr2di_hull *hull, hr2d_segment s) {
  const int forward = compare(s.a, s.b) < 0;
  const hr2d_point p = forward ? s.a : s.b, q = forward ? s.b : s.a;
  const int lower = on_edge(hull->at, hull->count[0], p, q),
            upper = on_edge(hull->at + hull->count[0], hull->count[1], p, q);
  if (lower && upper) return 0; /* all points are on one line */
  if (!lower && !upper) return 3;
  return lower == forward ? 1 : 2;
}

void hr2di_hull_clear(hr2di_hull *hull) {
  hr2di_alloc_free(&hull->alloc, hull->at);
}
