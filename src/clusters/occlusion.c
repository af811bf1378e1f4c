/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines between two clusters lie in the hull of their boxes, and cross the two sides by
   which the boxes face each other. */
#include "clusters/occlusion.h"

#include <math.h>

#include "clusters/facing.h"
#include "occlusion/wall-bodies.h"
#include "occlusion/wall-tree.h"

/* Looks into clusters, or boxes of walls, before the question is given up. */
enum { PATIENCE = 300, STACK = 2 * PATIENCE };

/* The hull of two boxes: the box around both, cut by half planes n·p ≤ offset. */
typedef struct hull {
  double x0, x1, y0, y1;
  struct {
    double nx, ny, offset, margin;
  } cut[4];
  int cuts;
} hull;

/* The line through two corners of one kind bounds the hull if its normal can point the way
   these corners do. */
static hull hull_of(const hr2di_cluster *i, const hr2di_cluster *j) {
  hull h = {.x0 = fmin(i->x0, j->x0),
            .x1 = fmax(i->x1, j->x1),
            .y0 = fmin(i->y0, j->y0),
            .y1 = fmax(i->y1, j->y1)};
  for (int k = 0; k < 4; k++) {
    const int right = k & 1, up = (k & 2) / 2;
    const double x = right ? i->x1 : i->x0, y = up ? i->y1 : i->y0;
    const double dx = (right ? j->x1 : j->x0) - x, dy = (up ? j->y1 : j->y0) - y;
    const int level = dx == 0 || dy == 0;
    if ((dx == 0 && dy == 0) || (!level && ((dx > 0) == right) == ((dy > 0) == up))) continue;
    const double nx = right ? fabs(dy) : -fabs(dy), ny = up ? fabs(dx) : -fabs(dx);
    h.cut[h.cuts].nx = nx;
    h.cut[h.cuts].ny = ny;
    h.cut[h.cuts].offset = nx * x + ny * y;
    h.cut[h.cuts++].margin = 0x1p-48 * (fabs(nx) + fabs(ny));
  }
  return h;
}

static int outside(const hull *h, const hr2di_cluster *c) {
  if (c->x0 > h->x1 || c->x1 < h->x0 || c->y0 > h->y1 || c->y1 < h->y0) return 1;
  for (int k = 0; k < h->cuts; k++) {
    const double nx = h->cut[k].nx, ny = h->cut[k].ny;
    const double min = nx * (nx > 0 ? c->x0 : c->x1) + ny * (ny > 0 ? c->y0 : c->y1);
    if (min > h->cut[k].offset + h->cut[k].margin) return 1;
  }
  return 0;
}

/* A line from p to y, each in front of the other's patch, stays in front of both: it does
   not meet what is behind p or behind y, nor a patch w of which both are on one side. */
static int harmless(const hr2di_cluster_tree *tree, uint32_t w, uint32_t i, uint32_t j) {
  const hr2di_cluster *c = &tree->cluster[w], *p = &tree->cluster[i], *y = &tree->cluster[j];
  if ((hr2di_cluster_glance(tree, p, c) | hr2di_cluster_glance(tree, y, c)) & HR2DI_SIDE_BEHIND)
    return 1;
  if (hr2di_cluster_glance(tree, c, p) & hr2di_cluster_glance(tree, c, y)) return 1;
  if (c->child) return 0;
  static const hr2di_side_of side[] = {HR2DI_SIDE_FRONT, HR2DI_SIDE_BEHIND};
  for (int k = 0; k < 2; k++)
    if (hr2di_cluster_on(tree, w, i, side[k]) && hr2di_cluster_on(tree, w, j, side[k]))
      return 1;
  return hr2di_cluster_on(tree, i, w, HR2DI_SIDE_BEHIND) ||
         hr2di_cluster_on(tree, j, w, HR2DI_SIDE_BEHIND);
}

int hr2di_clusters_clear(const hr2di_cluster_tree *tree, uint32_t i, uint32_t j,
                         uint32_t *suspect) {
  const hr2di_cluster *all = tree->cluster;
  if (!all[i].orderly || !all[j].orderly) return 0;
  const hull h = hull_of(&all[i], &all[j]);
  uint32_t stack[STACK], count = 0;
  stack[count++] = 0;
  if (*suspect) stack[count++] = *suspect;
  for (int turns = PATIENCE; count > 0 && turns > 0; turns--) {
    const uint32_t top = stack[--count];
    if (top == i || top == j || outside(&h, &all[top]) || harmless(tree, top, i, j)) continue;
    if (!all[top].child) {
      *suspect = top;
      return 0;
    }
    stack[count++] = all[top].child;
    stack[count++] = all[top].child + 1;
  }
  return count == 0;
}

/* Where the hull meets the line x = at, or y = at. */
static void section(const hull *h, int by_x, double at, double *low, double *high) {
  *low = by_x ? h->y0 : h->x0;
  *high = by_x ? h->y1 : h->x1;
  for (int k = 0; k < h->cuts; k++) {
    const double along = by_x ? h->cut[k].nx : h->cut[k].ny;
    const double across = by_x ? h->cut[k].ny : h->cut[k].nx;
    const double end = (h->cut[k].offset - along * at) / across;
    const double margin = h->cut[k].margin / fabs(across);
    if (across > 0 && end + margin < *high) *high = end + margin;
    if (across < 0 && end - margin > *low) *low = end - margin;
  }
  *low -= 0x1p-48;
  *high += 0x1p-48;
}

/* The sections of the hull at the sides by which two boxes face each other, from one to the
   other; 0 if no line along an axis parts the boxes. */
static int find_doors(const hr2di_cluster *i, const hr2di_cluster *j, hr2d_segment door[2]) {
  const double gap_x = fmax(j->x0 - i->x1, i->x0 - j->x1);
  const double gap_y = fmax(j->y0 - i->y1, i->y0 - j->y1);
  const int by_x = gap_x >= gap_y;
  if (!(fmax(gap_x, gap_y) > 0)) return 0;
  const hull h = hull_of(i, j);
  const int swapped = by_x ? i->x0 > j->x0 : i->y0 > j->y0;
  const hr2di_cluster *near = swapped ? j : i, *far = swapped ? i : j;
  const double at[] = {by_x ? near->x1 : near->y1, by_x ? far->x0 : far->y0};
  for (int k = 0; k < 2; k++) {
    double low, high;
    section(&h, by_x, at[k], &low, &high);
    const hr2d_point l = by_x ? (hr2d_point){at[k], low} : (hr2d_point){low, at[k]};
    const hr2d_point r = by_x ? (hr2d_point){at[k], high} : (hr2d_point){high, at[k]};
    door[k] = by_x == k ? (hr2d_segment){l, r} : (hr2d_segment){r, l};
  }
  return 1;
}

static double length_of(hr2d_segment s) {
  return fabs(s.b.x - s.a.x) + fabs(s.b.y - s.a.y);
}

int hr2di_clusters_body_across(const hr2di_walls *walls, const hr2di_shaft *shaft,
                               const hr2di_box *box) {
  if (box->body == HR2DI_NO_BODY ||
      !hr2di_shaft_has_in_front(shaft, box->x0, box->x1, box->y0, box->y1))
    return 0;
  const double dx = (shaft->c.at.x + shaft->d.at.x) - (shaft->a.at.x + shaft->b.at.x);
  const double dy = (shaft->c.at.y + shaft->d.at.y) - (shaft->a.at.y + shaft->b.at.y);
  const hr2d_segment chord = hr2di_body_chord_across(&walls->body[box->body], dx, dy);
  hr2di_obstacle obstacle;
  return hr2di_shaft_test(shaft, chord, &obstacle) == HR2DI_ACROSS;
}

int hr2di_clusters_blocked(const hr2di_walls *walls, const hr2di_cluster *i,
                           const hr2di_cluster *j) {
  hr2d_segment door[2];
  hr2di_shaft shaft;
  if (!find_doors(i, j, door) ||
      !hr2di_shaft_init(&shaft, HR2DI_FACING_FULL, door[0], door[1], door[0], door[1]))
    return 0;
  const double min = fmin(length_of(door[0]), length_of(door[1]));
  uint32_t stack[STACK], count = 0;
  stack[count++] = 0;
  for (int turns = PATIENCE; count > 0 && turns > 0; turns--) {
    const hr2di_box *box = &walls->box[stack[--count]];
    if ((box->x1 - box->x0) + (box->y1 - box->y0) < min ||
        !hr2di_shaft_meets_box(&shaft, box->x0, box->x1, box->y0, box->y1))
      continue;
    if (box->wall == HR2DI_NO_WALL) {
      if (hr2di_clusters_body_across(walls, &shaft, box)) return 1;
      stack[count++] = box->below;
      stack[count++] = box->below + 1;
      continue;
    }
    hr2di_obstacle obstacle;
    if (hr2di_shaft_test(&shaft, walls->wall[box->wall].at, &obstacle) == HR2DI_ACROSS)
      return 1;
  }
  return 0;
}
