/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sides by cones of normals and extents along them, exactly for pairs of patches. */
#include "clusters/facing.h"

#include <math.h>

#include "geometry/predicates.h"

/* Looks into pairs of clusters before a side is given up.  A convex chain takes a few for
   each level. */
enum { PATIENCE = 600, STACK = 2 * PATIENCE };

/* Bounds on n·(y−x), x on a patch with the normal n, y in an extent, and how far y may be
   behind x.  With n at an angle θ to v, n·d = v·d cosθ − u·d sinθ.  Coordinates lie in
   [-2,2]: rounding errors are below 2^-49, and HR2DI_CLUSTER_TOUCH is more than that. */
typedef struct range {
  double low, high, touch;
} range;

static double gap(double low, double high, double from, double to) {
  return fmax(fmax(low - to, from - high), 0);
}

static range range_of(const hr2di_cluster_tree *tree, const hr2di_cluster *c,
                      const hr2di_extent *y) {
  if (c->cosine <= 0) return (range){-HUGE_VAL, HUGE_VAL, 0};
  const hr2di_extent *x = &c->tight;
  const double low = y->v0 - x->v1, high = y->v1 - x->v0;
  const double aside = fmax(fabs(y->u1 - x->u0), fabs(y->u0 - x->u1)) * c->sine;
  const double distance =
      hypot(gap(x->u0, x->u1, y->u0, y->u1), gap(x->v0, x->v1, y->v0, y->v1));
  return (range){(low > 0 ? low * c->cosine : low) - aside,
                 (high < 0 ? high * c->cosine : high) + aside,
                 HR2DI_CLUSTER_TOUCH + tree->slack * distance};
}

static range range_to(const hr2di_cluster_tree *tree, const hr2di_cluster *c,
                      const hr2di_cluster *other) {
  const hr2di_extent y = hr2di_cluster_extent_of(c, other, &other->tight);
  return range_of(tree, c, &y);
}

unsigned hr2di_cluster_glance(const hr2di_cluster_tree *tree, const hr2di_cluster *c,
                              const hr2di_cluster *other) {
  const range r = range_to(tree, c, other);
  return (r.low >= -r.touch ? HR2DI_SIDE_FRONT : 0u) |
         (r.high <= r.touch ? HR2DI_SIDE_BEHIND : 0u);
}

static double size_of(const hr2di_cluster *c) {
  return c->child ? (c->x1 - c->x0) + (c->y1 - c->y0) : 0;
}

typedef struct two {
  uint32_t c, d;
} two;

/* Puts both halves of one of the two onto a stack: the larger, unless `keep` forbids to
   part the first; 0 if neither has halves. */
static int halve(const hr2di_cluster_tree *tree, two at, int keep, two *stack, size_t *count) {
  const hr2di_cluster *c = &tree->cluster[at.c], *d = &tree->cluster[at.d];
  const int may_c = c->child && !(keep && d->child);
  if (!may_c && !d->child) return 0;
  const int first = may_c && size_of(c) >= size_of(d);
  for (uint32_t k = 0; k < 2; k++)
    stack[(*count)++] = first ? (two){c->child + k, at.d} : (two){at.c, d->child + k};
  return 1;
}

int hr2di_cluster_on(const hr2di_cluster_tree *tree, uint32_t c, uint32_t other,
                     hr2di_side_of side) {
  const int front = side == HR2DI_SIDE_FRONT;
  two stack[STACK];
  size_t count = 0;
  stack[count++] = (two){c, other};
  for (int turns = PATIENCE; count > 0 && turns > 0; turns--) {
    const two at = stack[--count];
    const hr2di_cluster *top = &tree->cluster[at.c];
    const range r = range_to(tree, top, &tree->cluster[at.d]);
    if (front ? r.low >= -r.touch : r.high <= r.touch) continue;
    if (front ? r.high < -r.touch : r.low > r.touch) return 0;
    if (!halve(tree, at, top->run != HR2DI_NO_RUN, stack, &count)) return 0;
  }
  return count == 0;
}

hr2di_clusters_facing hr2di_clusters_face(const hr2di_cluster_tree *tree, uint32_t i,
                                          uint32_t j) {
  const hr2di_cluster *c = &tree->cluster[i], *d = &tree->cluster[j];
  if (c->run != HR2DI_NO_RUN && d->run != HR2DI_NO_RUN) {
    /* What two runs cannot see of each other no parts of them can. */
    const hr2di_facing facing =
        c->run == d->run ? HR2DI_FACING_NONE : hr2di_facing_of(&c->span, &d->span);
    return facing == HR2DI_FACING_NONE   ? HR2DI_CLUSTERS_APART
           : facing == HR2DI_FACING_FULL ? HR2DI_CLUSTERS_FACING
                                         : HR2DI_CLUSTERS_MIXED;
  }
  const range r = range_to(tree, c, d), s = range_to(tree, d, c);
  if (r.high < -HR2DI_CLUSTER_TOUCH || s.high < -HR2DI_CLUSTER_TOUCH)
    return HR2DI_CLUSTERS_APART;
  return r.low > HR2DI_CLUSTER_TOUCH && s.low > HR2DI_CLUSTER_TOUCH ? HR2DI_CLUSTERS_FACING
                                                                    : HR2DI_CLUSTERS_MIXED;
}

/* Whether no patch of d hides one of c. */
static int none_hides(const hr2di_cluster_tree *tree, two at) {
  two stack[STACK];
  size_t count = 0;
  stack[count++] = at;
  for (int turns = PATIENCE; count > 0 && turns > 0; turns--) {
    const two top = stack[--count];
    const hr2di_cluster *c = &tree->cluster[top.c], *d = &tree->cluster[top.d];
    const range of_d = range_to(tree, d, c), of_c = range_to(tree, c, d);
    if (of_d.low >= -of_d.touch || of_c.high <= of_c.touch) continue;
    if (!halve(tree, top, 0, stack, &count)) return 0;
  }
  return count == 0;
}

void hr2di_clusters_order(hr2di_cluster_tree *tree, hr2di_watch *watch) {
  for (uint32_t k = (uint32_t)tree->clusters; k-- > 0;) {
    hr2di_cluster *c = &tree->cluster[k];
    const uint32_t half = c->child;
    if (hr2di_watch_work(watch, half ? PATIENCE : 1)) return;
    c->orderly =
        !half || c->run != HR2DI_NO_RUN ||
        (tree->cluster[half].orderly && tree->cluster[half + 1].orderly &&
         none_hides(tree, (two){half, half + 1}) && none_hides(tree, (two){half + 1, half}));
  }
}
