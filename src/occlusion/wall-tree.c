/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tree of boxes: walls are sorted by the centres of their bodies along the longer edge
   and cut between two bodies, as near to the middle as can be; a single body by the
   centres of its walls, in the middle.

   Where a cut leaves more than half on one side, the body in the middle lies at that
   side's end; cut once more, it ends the other side or stands alone. */
#include "occlusion/wall-tree.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "occlusion/wall-bodies.h"

typedef struct item {
  double key;
  uint32_t wall, body;
} item;

typedef struct task {
  uint32_t box;
  size_t first, last; /* of the items */
  int whole;          /* nothing of its bodies is elsewhere */
} task;

static int by_key(const void *left, const void *right) {
  const item *l = left, *r = right;
  if (l->key != r->key) return l->key < r->key ? -1 : 1;
  if (l->body != r->body) return l->body < r->body ? -1 : 1;
  return (l->wall > r->wall) - (l->wall < r->wall);
}

static void enclose(hr2di_box *box, hr2d_segment s) {
  box->x0 = fmin(box->x0, fmin(s.a.x, s.b.x));
  box->x1 = fmax(box->x1, fmax(s.a.x, s.b.x));
  box->y0 = fmin(box->y0, fmin(s.a.y, s.b.y));
  box->y1 = fmax(box->y1, fmax(s.a.y, s.b.y));
}

/* The centre of a segment, or of the extent of a body, along an axis. */
static double centre(const hr2di_walls *walls, item i, int by_x, int of_body) {
  const hr2di_body *body = &walls->body[i.body];
  if (!of_body) {
    const hr2d_segment s = walls->wall[i.wall].at;
    return by_x ? s.a.x + s.b.x : s.a.y + s.b.y;
  }
  return by_x ? body->chord[0].a.x + body->chord[0].b.x
              : body->chord[1].a.y + body->chord[1].b.y;
}

/* Sets a box around its items and sorts these; *one is whether they are of one body. */
static hr2d_status fit(const hr2di_walls *walls, hr2di_box *box, item *items, size_t count,
                       int *one, hr2di_watch *watch) {
  const hr2d_status status = hr2di_watch_work(watch, 1 + count / 4);
  if (status) return status;
  *box = (hr2di_box){.x0 = HUGE_VAL, .x1 = -HUGE_VAL, .y0 = HUGE_VAL, .y1 = -HUGE_VAL};
  *one = 1;
  for (size_t k = 0; k < count; k++) {
    enclose(box, walls->wall[items[k].wall].at);
    *one &= items[k].body == items[0].body;
  }
  box->wall = count == 1 ? items[0].wall : HR2DI_NO_WALL;
  const int by_x = box->x1 - box->x0 > box->y1 - box->y0;
  for (size_t k = 0; k < count; k++) items[k].key = centre(walls, items[k], by_x, !*one);
  return hr2di_sort(items, count, sizeof *items, by_key, watch);
}

/* Where to cut: at the border of two bodies that is nearest to the middle. */
static size_t cut(const item *items, size_t count, int one) {
  const size_t middle = count / 2;
  for (size_t d = 0; !one && d <= middle; d++) {
    const size_t down = middle - d, up = middle + d;
    if (down > 0 && items[down].body != items[down - 1].body) return down;
    if (up < count && items[up].body != items[up - 1].body) return up;
  }
  return middle;
}

hr2d_status hr2di_wall_tree_init(hr2di_walls *walls, hr2di_watch *watch) {
  item *items = hr2di_alloc(&walls->alloc, walls->walls, sizeof *items);
  if (!items) return HR2D_ENOMEM;
  for (uint32_t k = 0; k < walls->walls; k++) items[k] = (item){0, k, walls->body_of[k]};
  task tasks[HR2DI_BOX_DEPTH];
  size_t count = 0;
  uint32_t boxes = 1;
  hr2d_status status = HR2D_OK;
  tasks[count++] = (task){0, 0, walls->walls, 1};
  while (count > 0 && !status) {
    const task t = tasks[--count];
    hr2di_box *box = &walls->box[t.box];
    item *some = items + t.first;
    int one;
    status = fit(walls, box, some, t.last - t.first, &one, watch);
    if (status) break;
    box->body = one && t.whole && t.last - t.first > 1 ? some[0].body : HR2DI_NO_BODY;
    if (t.last - t.first == 1) continue;
    const size_t middle = t.first + cut(some, t.last - t.first, one);
    box->below = boxes;
    boxes += 2;
    tasks[count++] = (task){box->below, t.first, middle, t.whole && !one};
    tasks[count++] = (task){box->below + 1, middle, t.last, t.whole && !one};
  }
  hr2di_alloc_free(&walls->alloc, items);
  return status;
}
