/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A ray turns from the right horizon to the left one; the patch that it meets first is seen.

   Directions are ranked once, by exact determinants.  From then on only ranks count: two arcs
   overlap if their ranks do.  The sides of their lines on which the ends of two patches lie
   tell which patch is nearer.  This is exact, too: patches do not cross. */
#include "geometry/orient-sign.h"
#include "visibility/point-view-impl.h"

/* Keys that differ by more are in their order. */
#define SURE 0x1p-48

static int precedes(const hr2di_viewer *w, hr2di_direction p, hr2di_direction q) {
  if (fabs(p.key - q.key) > SURE) return p.key < q.key;
  const int turn = hr2di_view_turn(w, p.vertex, q.vertex);
  return turn ? turn > 0 : p.vertex < q.vertex;
}

static void merge(const hr2di_viewer *w, const hr2di_direction *from, hr2di_direction *to,
                  size_t begin, size_t middle, size_t end) {
  size_t left = begin, right = middle;
  for (size_t k = begin; k < end; k++) {
    if (k % 16 == 0 && hr2di_watch_work(w->watch, 2)) return;
    const int from_right =
        left == middle || (right < end && precedes(w, from[right], from[left]));
    to[k] = from[from_right ? right++ : left++];
  }
}

/* Sorts the vertices in front of the patch; their number. */
static size_t sort_directions(hr2di_viewer *w) {
  size_t count = 0;
  for (uint32_t v = 0; v < w->vertices; v++)
    if (w->bearing[v].height > 0)
      w->direction[0][count++] = (hr2di_direction){w->bearing[v].key, v};
  for (size_t width = 1; width < count; width *= 2) {
    for (size_t begin = 0; begin < count; begin += 2 * width) {
      if (hr2di_watch_status(w->watch)) return 0;
      const size_t middle = begin + width < count ? begin + width : count;
      const size_t end = middle + width < count ? middle + width : count;
      merge(w, w->direction[0], w->direction[1], begin, middle, end);
    }
    hr2di_direction *sorted = w->direction[1];
    w->direction[1] = w->direction[0];
    w->direction[0] = sorted;
  }
  return count;
}

/* Vertices in the same direction have the same rank; the rank of the left horizon. */
static uint32_t rank_directions(hr2di_viewer *w) {
  const size_t count = sort_directions(w);
  const hr2di_direction *d = w->direction[0];
  uint32_t rank = 0;
  for (size_t k = 0; k < count; k++) {
    const int same = k > 0 && d[k].key - d[k - 1].key <= SURE &&
                     hr2di_view_turn(w, d[k - 1].vertex, d[k].vertex) == 0;
    if (!same) rank++;
    w->rank[d[k].vertex] = rank;
  }
  return rank + 1;
}

/* Lists arcs by the ranks of their ends. */
static void list_arcs(hr2di_viewer *w, uint32_t horizon) {
  for (uint32_t r = 0; r <= horizon; r++) w->starting[r] = w->ending[r] = HR2DI_NO_ARC;
  for (uint32_t k = 0; k < w->arcs; k++) {
    hr2di_arc *arc = &w->arc[k];
    arc->start = arc->right == HR2DI_HORIZON ? 0 : w->rank[arc->right];
    arc->end = arc->left == HR2DI_HORIZON ? horizon : w->rank[arc->left];
    if (arc->start >= arc->end) continue;
    arc->next_start = w->starting[arc->start];
    w->starting[arc->start] = k;
    arc->next_end = w->ending[arc->end];
    w->ending[arc->end] = k;
  }
}

/* On which side of a patch's line vertex v lies: 1 for that of the point, which is its left
   if it is seen from the front. */
static int side_of(const hr2di_viewer *w, const hr2di_arc *arc, uint32_t v) {
  const uint32_t a = w->end[arc->patch][0], b = w->end[arc->patch][1];
  if (v == a || v == b) return 0;
  const int side = hr2di_orient_sign(w->vertex[a], w->vertex[b], w->vertex[v]);
  return arc->front ? side : -side;
}

/* Of two arcs that overlap the first is nearer.  Where patches lie on one another that is
   the one that shows its front. */
static int nearer(const hr2di_viewer *w, uint32_t k, uint32_t m) {
  const hr2di_arc *p = &w->arc[k], *q = &w->arc[m];
  const uint32_t *end = w->end[q->patch];
  int one = side_of(w, p, end[0]), other = side_of(w, p, end[1]);
  if (one == 0 && other == 0) return p->front != q->front ? p->front : k < m;
  if (one <= 0 && other <= 0) return 1;
  if (one >= 0 && other >= 0) return 0;
  end = w->end[p->patch];
  one = side_of(w, q, end[0]);
  other = side_of(w, q, end[1]);
  return one >= 0 && other >= 0;
}

static void put(hr2di_viewer *w, size_t place, uint32_t arc) {
  w->heap[place] = arc;
  w->arc[arc].place = (uint32_t)place;
}

static void sift_up(hr2di_viewer *w, size_t place, uint32_t arc) {
  while (place > 0 && nearer(w, arc, w->heap[(place - 1) / 2])) {
    put(w, place, w->heap[(place - 1) / 2]);
    place = (place - 1) / 2;
  }
  put(w, place, arc);
}

static void sift_down(hr2di_viewer *w, size_t place, uint32_t arc) {
  for (;;) {
    size_t child = 2 * place + 1;
    if (child >= w->under_way) break;
    if (child + 1 < w->under_way && nearer(w, w->heap[child + 1], w->heap[child])) child++;
    if (!nearer(w, w->heap[child], arc)) break;
    put(w, place, w->heap[child]);
    place = child;
  }
  put(w, place, arc);
}

static void take_out(hr2di_viewer *w, uint32_t arc) {
  const size_t place = w->arc[arc].place;
  const uint32_t last = w->heap[--w->under_way];
  if (last == arc) return;
  if (place > 0 && nearer(w, last, w->heap[(place - 1) / 2]))
    sift_up(w, place, last);
  else
    sift_down(w, place, last);
}

/* The nearest arc just left of rank r; *at is an end of an arc there. */
static uint32_t pass(hr2di_viewer *w, uint32_t r, uint32_t *at) {
  for (uint32_t k = w->ending[r]; k != HR2DI_NO_ARC; k = w->arc[k].next_end) {
    if (hr2di_watch_work(w->watch, 4)) break;
    take_out(w, k);
    *at = w->arc[k].left;
  }
  for (uint32_t k = w->starting[r]; k != HR2DI_NO_ARC; k = w->arc[k].next_start) {
    if (hr2di_watch_work(w->watch, 4)) break;
    sift_up(w, w->under_way++, k);
    *at = w->arc[k].right;
  }
  return w->under_way > 0 ? w->heap[0] : HR2DI_NO_ARC;
}

hr2d_status hr2di_view_sweep(hr2di_viewer *w) {
  const uint32_t horizon = rank_directions(w);
  hr2d_status status = hr2di_watch_work(w->watch, w->arcs / 4);
  if (status) return status;
  uint32_t top = HR2DI_NO_ARC, since = HR2DI_HORIZON, at = HR2DI_HORIZON;
  list_arcs(w, horizon);
  w->under_way = 0;
  for (uint32_t r = 0; r <= horizon && !status; r++) {
    const uint32_t next = pass(w, r, &at);
    status = hr2di_watch_work(w->watch, 1);
    if (status) break;
    if (next == top) continue;
    /* A patch that begins or ends here does so at its own vertex. */
    const int begins = next != HR2DI_NO_ARC && w->arc[next].start == r;
    if (begins) at = w->arc[next].right;
    if (top != HR2DI_NO_ARC) {
      const int ends = w->arc[top].end == r;
      const uint32_t until = ends ? w->arc[top].left : at;
      hr2di_view_note(w, &w->arc[top], since, until);
      if (ends && !begins) at = until;
    }
    since = at;
    top = next;
  }
  return status;
}
