/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "beams/triangular-expansion.h"

#include <string.h>

#include "base/alloc.h"

/* A border, and what is on its left: a half-edge to go on from, or what is there. */
typedef struct hr2di_triangular_expansion_frame {
  union {
    unsigned char border[HR2DI_TRIANGULAR_BORDER];
    double aligned;
  };
  int32_t beyond;
} frame;

static void copy(const hr2di_triangular_expansion *x, size_t to, const void *border) {
  memcpy(x->frame[to].border, border, x->border);
}

/* Follows what is between the right border and that of frame `top` from half-edge *h to where
   it ends, at *h, or splits.  Returns whether it splits: then the border is in the frame after
   `top`, and *h is on its right.  A straight line enters each triangle once at most, which ends
   it also where roundings of borders would lead it in a circle. */
static int follow(hr2di_triangular_expansion *x, size_t top, int32_t *h) {
  frame *const right = x->frame, *const left = right + top, *const split = left + 1;
  for (size_t steps = 1; steps <= x->in->triangles; steps++) {
    x->steps++;
    if (steps % 32 == 0 && hr2di_watch_work(x->watch, 16)) break;
    const hr2di_triangle *t = &x->in->triangle[*h >> 2];
    if (!x->outside && hr2di_triangle_is_outside(x->in, t)) break;
    const int to_right = hr2di_corner_after(*h & 3), to_left = hr2di_corner_before(*h & 3);
    const int side =
        x->side(x->ctx, right->border, left->border, t->corner[to_left], split->border);
    split->beyond = t->across[to_left];
    *h = side < 0 ? split->beyond : t->across[to_right];
    if (side == 0 || *h < 0) return side == 0;
  }
  *h = HR2DI_SKY;
  return 0;
}

hr2d_status hr2di_triangular_expansion_walk(hr2di_triangular_expansion *x, int32_t h,
                                            const void *right, const void *left) {
  size_t top = 0;
  for (int begins = 1;; begins = 0) {
    if (hr2di_alloc_reserve(&x->alloc, &x->frame, &x->room, top + 3, sizeof(frame)))
      return HR2D_ENOMEM;
    if (begins) {
      copy(x, 0, right);
      copy(x, ++top, left);
    }
    for (; h < 0; h = x->frame[top--].beyond) {
      const hr2d_status status = x->end(x->ctx, h, x->frame[0].border, x->frame[top].border);
      if (status || top == 1) return status;
      copy(x, 0, x->frame[top].border);
    }
    top += (size_t)follow(x, top, &h);
    const hr2d_status status = hr2di_watch_work(x->watch, 1);
    if (status) return status;
  }
}

void hr2di_triangular_expansion_clear(hr2di_triangular_expansion *x) {
  hr2di_alloc_free(&x->alloc, x->frame);
}
