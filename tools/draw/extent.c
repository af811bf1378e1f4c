/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of the plane that a picture shows: --box, or what matters of the scene.  Patches far
   longer than the extent of all shorter ones, such as the ground under a few things, go on
   beyond the picture. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "output/complain.h"

#define FAR_LONGER 20

/* Parts of the extent: of the ground on each side, and around all. */
#define MORE   0.1
#define AROUND 0.06

typedef struct item {
  double length;
  size_t patch;
  box around; /* this patch and all shorter ones */
} item;

static int by_length(const void *a, const void *b) {
  const item *x = a, *y = b;
  return (x->length > y->length) - (x->length < y->length);
}

static void take(box *b, hr2d_point q) {
  *b = (box){fmin(b->x0, q.x), fmin(b->y0, q.y), fmax(b->x1, q.x), fmax(b->y1, q.y)};
}

static double extent(const box *b) {
  return fmax(b->x1 - b->x0, b->y1 - b->y0);
}

static const hr2d_element *root(const picture *p, size_t patch) {
  return &hr2d_hierarchy_elements(p->run->hierarchy)[patch];
}

static const box nothing = {INFINITY, INFINITY, -INFINITY, -INFINITY};

static item *sort_patches(const picture *p, size_t count) {
  item *items = malloc(count * sizeof *items);
  for (size_t k = 0; items && k < count; k++)
    items[k] =
        (item){.length = hr2d_scene_length(p->run->scene, k) / hr2d_scene_unit(p->run->scene),
               .patch = k};
  if (items) qsort(items, count, sizeof *items, by_length);
  box around = nothing;
  for (size_t k = 0; items && k < count; k++) {
    take(&around, root(p, items[k].patch)->a);
    take(&around, root(p, items[k].patch)->b);
    items[k].around = around;
  }
  return items;
}

/* How many of the sorted patches matter: the shorter half or more of them, if the next one is
   far longer than their extent; otherwise all. */
static size_t count_what_matters(const item *items, size_t count) {
  for (size_t k = (count + 1) / 2; k && k < count; k++)
    if (items[k].length >= FAR_LONGER * extent(&items[k - 1].around)) return k;
  return count;
}

/* Takes the points where a long patch passes a box: beside it along the patch, and no farther
   from it across the patch than it is large. */
static void take_passing(box *to, const box *at, const hr2d_element *e) {
  const double large = extent(at), more = MORE * large;
  const double dx = e->b.x - e->a.x, dy = e->b.y - e->a.y;
  const int flat = fabs(dx) >= fabs(dy);
  const double from = flat ? e->a.x : e->a.y, by = flat ? dx : dy;
  const double u = ((flat ? at->x0 : at->y0) - more - from) / by;
  const double v = ((flat ? at->x1 : at->y1) + more - from) / by;
  const double t[] = {fmax(0, fmin(u, v)), fmin(1, fmax(u, v))};
  for (int k = 0; k < 2 && t[0] <= t[1]; k++) {
    const hr2d_point q = {e->a.x + t[k] * dx, e->a.y + t[k] * dy};
    const int near = flat ? q.y >= at->y0 - large && q.y <= at->y1 + large
                          : q.x >= at->x0 - large && q.x <= at->x1 + large;
    if (near) take(to, q);
  }
}

/* What matters, and so much of the patches that go on that one sees where they are. */
static box choose(picture *p, const item *items, size_t count) {
  const size_t rest = count_what_matters(items, count);
  box shown = items[rest - 1].around;
  const double edge = AROUND * extent(&shown);
  p->going_on = count - rest;
  for (size_t k = rest; k < count; k++)
    take_passing(&shown, &items[rest - 1].around, root(p, items[k].patch));
  return (box){shown.x0 - edge, shown.y0 - edge, shown.x1 + edge, shown.y1 + edge};
}

static void show(picture *p, hr2d_point low, hr2d_point high) {
  p->part = 1;
  p->low = low;
  p->size = (hr2d_point){high.x - low.x, high.y - low.y};
}

int extent_choose(picture *p) {
  const grid_box *given = &p->run->options->box;
  const size_t count = hr2d_scene_patches(p->run->scene);
  const double unit = hr2d_scene_unit(p->run->scene);
  if (given->given) {
    show(p,
         (hr2d_point){fmin(given->side[0], given->side[2]) / unit,
                      fmin(given->side[1], given->side[3]) / unit},
         (hr2d_point){fmax(given->side[0], given->side[2]) / unit,
                      fmax(given->side[1], given->side[3]) / unit});
    return EXIT_DONE;
  }
  if (hr2d_scene_images(p->run->scene) > 1) return EXIT_DONE;
  item *items = sort_patches(p, count);
  if (!items) return complain_memory();
  const box shown = choose(p, items, count);
  if (p->going_on) show(p, (hr2d_point){shown.x0, shown.y0}, (hr2d_point){shown.x1, shown.y1});
  p->whole = items[count - 1].around;
  free(items);
  return EXIT_DONE;
}

void extent_draw_note(const picture *p) {
  char text[200];
  if (!p->going_on) return;
  const double unit = hr2d_scene_unit(p->run->scene);
  snprintf(text, sizeof text,
           "%zu patch%s beyond the picture: the scene is from (%g, %g) to (%g, %g)",
           p->going_on, p->going_on == 1 ? " goes on" : "es go on", unit * p->whole.x0,
           unit * p->whole.y0, unit * p->whole.x1, unit * p->whole.y1);
  pen_grey(p->cr, 0.2);
  pen_font(p->cr, 9, 0);
  pen_write(p->cr, 24, p->height - 5, text);
}
#endif
