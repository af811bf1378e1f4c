/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Enough points for the distance, and what is kept of the clusters that have links. */
#include "clusters/expansion.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "clusters/clusters-impl.h"
#include "clusters/facing.h"
#include "scene/scene-impl.h"

/* The m asked for along the longer direction: a cluster of the same length may stand
   between two that are linked, with some to spare. */
#define APART 2.5

/* The constant in front of the bound grows with 1/r³ towards the ellipse, but m is seldom as
   small as it may be: the errors measured are a fifth of what is asked for, and less. */
double hr2di_expansion_degree(double accuracy, double m) {
  return log(1 / accuracy) / log(m + sqrt(m * m - 1));
}

static void set_counts(hr2di_expansion *far, double accuracy) {
  for (int k = 0; k < 2; k++) {
    const double degree =
        far->half[k] > 0 ? hr2di_expansion_degree(accuracy, far->reach[k] / far->half[k]) : 0;
    far->count[k] = (unsigned)fmin(fmax(ceil(degree), 1), HR2DI_EXPANSION_POINTS);
  }
}

/* What is APART along the longer direction of half h is (APART−1)·h away from the cluster,
   so that along a shorter one m ≥ (APART−1)·h/half. */
hr2di_expansion hr2di_expansion_of(const hr2di_cluster *c, double accuracy) {
  const hr2di_extent *e = &c->nested;
  hr2di_expansion far = {.u = c->u,
                         .at = {0.5 * (e->u0 + e->u1), 0.5 * (e->v0 + e->v1)},
                         .half = {0.5 * (e->u1 - e->u0), 0.5 * (e->v1 - e->v0)}};
  const double longer = fmax(far.half[0], far.half[1]);
  for (int k = 0; k < 2; k++) {
    far.reach[k] = fmax(APART * far.half[k], (APART - 1) * longer);
    if (far.half[k] == longer) far.reach[k] = APART * longer;
  }
  set_counts(&far, accuracy);
  return far;
}

/* How far x = 0 is outside of an interval, and the place in it nearest to 0. */
static double beyond(double low, double high, double half) {
  return fmax(fmax(low - half, -half - high), 0);
}

static double nearest(double low, double high) {
  return low > 0 ? low : high < 0 ? high : 0;
}

/* The sum of the distances to both ends of an interval, least where y is nearest. */
static double around(double half, double along, double aside) {
  return hypot(along - half, aside) + hypot(along + half, aside);
}

static int separated(const hr2di_cluster *c, const hr2di_expansion *far,
                     const hr2di_cluster *other, double min) {
  const hr2di_extent e = hr2di_cluster_extent_of(c, other, &other->nested);
  const double u0 = e.u0 - far->at[0], u1 = e.u1 - far->at[0];
  const double v0 = e.v0 - far->at[1], v1 = e.v1 - far->at[1];
  const double du = beyond(u0, u1, far->half[0]), dv = beyond(v0, v1, far->half[1]);
  return hypot(du, dv) >= min &&
         around(far->half[0], nearest(u0, u1), dv) >= 2 * far->reach[0] &&
         around(far->half[1], nearest(v0, v1), du) >= 2 * far->reach[1];
}

/* What is HR2DI_CLUSTER_TOUCH behind a patch at the distance r has a cosine of −TOUCH/r. */
int hr2di_expansion_apart(const hr2di_cluster *i, const hr2di_expansion *far_i,
                          const hr2di_cluster *j, const hr2di_expansion *far_j,
                          double accuracy) {
  const double min = 8 * HR2DI_CLUSTER_TOUCH / accuracy;
  return separated(i, far_i, j, min) && separated(j, far_j, i, min);
}

size_t hr2di_expansion_gauss(const hr2di_expansion *far, double length, size_t order,
                             double accuracy) {
  const double gap = (APART - 1) * fmax(far->half[0], far->half[1]);
  const double degree = hr2di_expansion_degree(accuracy, hypot(2 * gap / length, 1));
  const double max = far->count[0] + far->count[1] - 2;
  return (size_t)ceil(0.5 * ((double)order + fmin(ceil(degree), max)));
}

static hr2d_status reserve(hr2di_clusters *made, size_t linked, size_t points) {
  const hr2d_allocator *alloc = &made->alloc;
  const size_t n = HR2DI_EXPANSION_POINTS, cosines = n * (n + 1) * (2 * n + 1) / 6;
  made->linked = hr2di_alloc(alloc, linked, sizeof *made->linked);
  made->point = hr2di_alloc(alloc, points, sizeof *made->point);
  made->home = hr2di_alloc(alloc, made->scene->patches, sizeof *made->home);
  made->cosine = hr2di_alloc(alloc, cosines, sizeof *made->cosine);
  return made->linked && made->point && made->home && made->cosine ? HR2D_OK : HR2D_ENOMEM;
}

/* A cluster's Chebyshev points, those along u next to each other. */
static void put_points(const hr2di_clusters *made, const hr2di_linked *c) {
  const hr2di_expansion *f = &c->far;
  const double *tu = hr2di_clusters_cosines(made, f->count[0]),
               *tv = hr2di_clusters_cosines(made, f->count[1]);
  hr2d_point *point = made->point + c->first;
  for (unsigned b = 0; b < f->count[1]; b++)
    for (unsigned a = 0; a < f->count[0]; a++) {
      /* T_1(t) = t; one point is in the middle. */
      const double u = f->at[0] + (f->count[0] > 1 ? f->half[0] * tu[f->count[0] + a] : 0);
      const double v = f->at[1] + (f->count[1] > 1 ? f->half[1] * tv[f->count[1] + b] : 0);
      *point++ = (hr2d_point){u * f->u.x - v * f->u.y, u * f->u.y + v * f->u.x};
    }
}

static void put_cosines(hr2di_clusters *made) {
  double *cosine = made->cosine;
  for (unsigned count = 1; count <= HR2DI_EXPANSION_POINTS; count++)
    for (unsigned n = 0; n < count; n++)
      for (unsigned k = 0; k < count; k++)
        *cosine++ = cos(n * (2 * k + 1) * HR2DI_PI / (2 * count));
}

/* Numbers the clusters that have links; how many points they have. */
static size_t number_linked(hr2di_clusters *made, const hr2di_cluster_tree *tree,
                            const hr2di_expansion *far, uint32_t *number) {
  size_t points = 0;
  for (size_t k = 0; k < tree->clusters; k++) number[k] = HR2DI_NO_CLUSTER;
  for (size_t k = 0; k < made->links; k++)
    number[made->link[k].first] = number[made->link[k].second] = 0;
  for (size_t k = 0; k < tree->clusters; k++) {
    if (number[k] == HR2DI_NO_CLUSTER) continue;
    number[k] = (uint32_t)made->linked_count++;
    points += hr2di_expansion_points(&far[k]);
  }
  return points;
}

/* Parents come before children: the last one that claims a patch is the least. */
static void put_linked(hr2di_clusters *made, const hr2di_cluster_tree *tree,
                       const hr2di_expansion *far, const uint32_t *number) {
  for (size_t k = 0; k < made->scene->patches; k++) made->home[k] = HR2DI_NO_CLUSTER;
  put_cosines(made);
  for (size_t k = 0; k < tree->clusters; k++) {
    if (number[k] == HR2DI_NO_CLUSTER) continue;
    const hr2di_cluster *c = &tree->cluster[k];
    hr2di_linked *linked = &made->linked[number[k]];
    *linked = (hr2di_linked){far[k], made->home[tree->patch[c->first]], made->points};
    made->points += hr2di_expansion_points(&linked->far);
    for (uint32_t p = c->first; p < c->last; p++) made->home[tree->patch[p]] = number[k];
    put_points(made, linked);
  }
  for (size_t k = 0; k < made->links; k++) {
    made->link[k].first = number[made->link[k].first];
    made->link[k].second = number[made->link[k].second];
  }
}

hr2d_status hr2di_clusters_keep(hr2di_clusters *made, const hr2di_cluster_tree *tree,
                                const hr2di_expansion *far) {
  if (made->links == 0) return HR2D_OK;
  uint32_t *number = hr2di_alloc(&tree->alloc, tree->clusters, sizeof *number);
  if (!number) return HR2D_ENOMEM;
  const size_t points = number_linked(made, tree, far, number);
  const hr2d_status status = reserve(made, made->linked_count, points);
  if (!status) put_linked(made, tree, far, number);
  hr2di_alloc_free(&tree->alloc, number);
  return status;
}

/* A cluster with its counts, and its points behind those that are there. */
static void put_finer(hr2di_clusters *made, hr2di_linked linked) {
  set_counts(&linked.far, made->accuracy);
  linked.first = made->points;
  made->linked[made->linked_count++] = linked;
  made->points += hr2di_expansion_points(&linked.far);
  put_points(made, &made->linked[made->linked_count - 1]);
}

hr2d_status hr2di_clusters_keep_finer(hr2di_clusters *made, const hr2di_clusters *of) {
  size_t points = 0;
  if (of->links == 0) return HR2D_OK;
  for (size_t k = 0; k < of->linked_count; k++) {
    hr2di_expansion far = of->linked[k].far;
    set_counts(&far, made->accuracy);
    points += hr2di_expansion_points(&far);
  }
  made->link = hr2di_alloc(&made->alloc, of->links, sizeof *made->link);
  const hr2d_status status = reserve(made, of->linked_count, points);
  if (!made->link || status) return HR2D_ENOMEM;
  made->links = made->link_capacity = of->links;
  memcpy(made->link, of->link, of->links * sizeof *made->link);
  memcpy(made->home, of->home, of->scene->patches * sizeof *made->home);
  put_cosines(made);
  for (size_t k = 0; k < of->linked_count; k++) put_finer(made, of->linked[k]);
  return HR2D_OK;
}
