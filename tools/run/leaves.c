/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A depth-first walk, in which only the right sibling of each level waits. */
#include "run/leaves.h"

#include <stdlib.h>

#include "output/complain.h"

/* The fraction of an element that is its left child: a half, unless the element was divided
   where light changes. */
static double left_part(const hr2d_element *elements, const hr2d_element *e) {
  const double left = elements[e->child].length, right = elements[e->child + 1].length;
  return left == right ? 0.5 : left / (left + right);
}

int leaves_walk(const hr2d_hierarchy *hierarchy, size_t patch, double finest, piece_fn visit,
                void *ctx) {
  const hr2d_element *elements = hr2d_hierarchy_elements(hierarchy);
  piece *waiting = malloc((hr2d_hierarchy_count(hierarchy).levels + 2) * sizeof *waiting);
  if (!waiting) return complain_memory();
  size_t count = 1;
  int status = 0;
  waiting[0] = (piece){(uint32_t)patch, 0, 0, 1};
  while (count && !status) {
    const piece p = waiting[--count];
    const hr2d_element *e = &elements[p.element];
    if (!e->child || e->length <= finest) {
      status = visit(ctx, &p);
      continue;
    }
    const double middle = p.t0 + left_part(elements, e) * (p.t1 - p.t0);
    waiting[count++] = (piece){e->child + 1, p.level + 1, middle, p.t1};
    waiting[count++] = (piece){e->child, p.level + 1, p.t0, middle};
  }
  free(waiting);
  return status;
}
