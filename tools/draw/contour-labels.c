/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The number of each isoline, written along it where it is straight and nothing is in the way.
 */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>

#include "output/complain.h"
#include "output/ticks.h"

#define FONT  9.5
#define PLACE 6.0 /* points from one place that is tried to the next */
#define BEND  2.0 /* points by which the line may leave the middle of the text */

/* A text whose middle is `at`, along a direction that points to the right. */
typedef struct place_on {
  hr2d_point at, along;
  double cost;
} place_on;

/* The point of a line at so many points from its start. */
static hr2d_point walk(const contour *c, double s) {
  for (size_t k = 1; k < c->count; k++) {
    const hr2d_point a = c->point[k - 1], b = c->point[k];
    const double length = hypot(b.x - a.x, b.y - a.y);
    if (s <= length || k + 1 == c->count) {
      const double t = length > 0 ? fmin(1, s / length) : 0;
      return (hr2d_point){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    }
    s -= length;
  }
  return c->point[0];
}

/* The box around a text that is turned. */
static box box_of(const place_on *q, double width) {
  const double w = 0.5 * (fabs(q->along.x) * width + fabs(q->along.y) * FONT);
  const double h = 0.5 * (fabs(q->along.y) * width + fabs(q->along.x) * FONT);
  return (box){q->at.x - w - 2, q->at.y - h - 2, q->at.x + w + 2, q->at.y + h + 2};
}

static int is_free(const picture *p, const box *b) {
  const box *f = &p->frame;
  return b->x0 > f->x0 && b->y0 > f->y0 && b->x1 < f->x1 && b->y1 < f->y1 &&
         !obstacles_meet(p, b);
}

/* The place `s` along a line; an infinite cost if the line bends too much. */
static place_on place_at(const contour *c, double s, double width) {
  const hr2d_point a = walk(c, s - 0.5 * width), b = walk(c, s + 0.5 * width);
  const hr2d_point middle = walk(c, s);
  const double dx = b.x - a.x, dy = b.y - a.y, chord = hypot(dx, dy);
  const double bend = hypot(middle.x - 0.5 * (a.x + b.x), middle.y - 0.5 * (a.y + b.y));
  const double sign = dx < 0 ? -1 : 1;
  place_on q = {middle, {sign * dx / chord, sign * dy / chord}, INFINITY};
  if (chord > 0.93 * width && bend < BEND) q.cost = bend + 4 * fabs(s / c->length - 0.5);
  return q;
}

static int find_place(const picture *p, const contour *c, double width, place_on *best) {
  best->cost = INFINITY;
  const double end = 0.5 * width + 4;
  for (double s = end; s <= c->length - end; s += PLACE) {
    const place_on q = place_at(c, s, width);
    if (!(q.cost < best->cost)) continue;
    const box b = box_of(&q, width);
    if (is_free(p, &b)) *best = q;
  }
  return isfinite(best->cost);
}

/* The text interrupts the line: around it is the colour of the level. */
static void write_label(const picture *p, const contour *c, const place_on *q, double width,
                        const char *text) {
  const shade s = {{c->level, c->level, c->level}};
  cairo_save(p->cr);
  cairo_translate(p->cr, q->at.x, q->at.y);
  cairo_rotate(p->cr, atan2(q->along.y, q->along.x));
  cairo_rectangle(p->cr, -0.5 * width - 2, -0.5 * FONT, width + 4, FONT);
  pen_colour(p->cr, p->filled ? scale_colour(p, s) : (colour){1, 1, 1});
  cairo_fill(p->cr);
  pen_colour(p->cr, contours_ink(p, c->level));
  pen_write(p->cr, -0.5 * width, 0.36 * FONT, text);
  cairo_restore(p->cr);
}

static void name_level(const picture *p, double level, char *text, size_t size) {
  const ticks *t = &p->contours.levels;
  for (int k = 0; k < t->count; k++)
    if (t->value[k] == level) ticks_label(t, k, text, size);
}

int contours_label(picture *p) {
  int status = EXIT_DONE;
  pen_font(p->cr, FONT, 0);
  for (size_t k = 0; k < p->contours.count && !status; k++) {
    const contour *c = &p->contours.items[k];
    char text[32] = "";
    place_on q = {{0, 0}, {1, 0}, INFINITY};
    name_level(p, c->level, text, sizeof text);
    const double width = pen_text_width(p->cr, text);
    if (c->length < 2 * width || !find_place(p, c, width, &q)) continue;
    const box b = box_of(&q, width);
    write_label(p, c, &q, width, text);
    status = obstacles_add_box(p, &b);
  }
  return status;
}
#endif
