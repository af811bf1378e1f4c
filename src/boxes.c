/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tree of boxes: walls are sorted by their centres along the longer edge and
   halved. */
#include "boxes.h"

#include <math.h>
#include <stdlib.h>

#include "alloc.h"

typedef struct item {
  double key;
  double cx, cy;
  uint32_t wall;
} item;

typedef struct task {
  uint32_t box;
  size_t first, last; /* of the items */
} task;

static int by_key(const void *left, const void *right) {
  const item *l = left, *r = right;
  if (l->key != r->key) return l->key < r->key ? -1 : 1;
  return (l->wall > r->wall) - (l->wall < r->wall);
}

static void enclose(hr2di_box *box, hr2d_segment s) {
  box->x0 = fmin(box->x0, fmin(s.a.x, s.b.x));
  box->x1 = fmax(box->x1, fmax(s.a.x, s.b.x));
  box->y0 = fmin(box->y0, fmin(s.a.y, s.b.y));
  box->y1 = fmax(box->y1, fmax(s.a.y, s.b.y));
}

/* Sets a box around its items, and sorts these along its longer edge. */
static void fit(const hr2di_walls *walls, hr2di_box *box, item *items, size_t count) {
  *box = (hr2di_box){.x0 = HUGE_VAL, .x1 = -HUGE_VAL, .y0 = HUGE_VAL, .y1 = -HUGE_VAL};
  for (size_t k = 0; k < count; k++) enclose(box, walls->wall[items[k].wall].at);
  const double width = box->x1 - box->x0, height = box->y1 - box->y0;
  box->size = fmax(width, height);
  box->wall = count == 1 ? items[0].wall : HR2DI_NO_WALL;
  if (count == 1) return;
  for (size_t k = 0; k < count; k++) items[k].key = width > height ? items[k].cx : items[k].cy;
  qsort(items, count, sizeof *items, by_key);
}

hr2d_status hr2di_boxes_make(hr2di_walls *walls) {
  item *items = hr2di_alloc(&walls->alloc, walls->walls, sizeof *items);
  if (!items) return HR2D_ENOMEM;
  for (size_t k = 0; k < walls->walls; k++) {
    const hr2d_segment s = walls->wall[k].at;
    items[k] = (item){0, 0.5 * (s.a.x + s.b.x), 0.5 * (s.a.y + s.b.y), (uint32_t)k};
  }
  task tasks[HR2DI_BOX_DEPTH];
  size_t count = 0;
  uint32_t boxes = 1;
  tasks[count++] = (task){0, 0, walls->walls};
  while (count > 0) {
    const task t = tasks[--count];
    hr2di_box *box = &walls->box[t.box];
    fit(walls, box, items + t.first, t.last - t.first);
    if (t.last - t.first == 1) continue;
    const size_t middle = t.first + (t.last - t.first) / 2;
    box->below = boxes;
    boxes += 2;
    tasks[count++] = (task){box->below, t.first, middle};
    tasks[count++] = (task){box->below + 1, middle, t.last};
  }
  hr2di_free(&walls->alloc, items);
  return HR2D_OK;
}
