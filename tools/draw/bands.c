/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each patch as a band on its front side, coloured by B, with a ruler of its elements. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>

#include "run/leaves.h"

#define FINEST  0.4 /* points; shorter elements are drawn as their parent */
#define CROWDED 3.0 /* points; elements shorter than this get no tick */
#define OVERLAP 0.3 /* points; hides the seams of antialiasing */
#define STOP    2.0 /* points between the stops of a gradient */

enum { MOST_STOPS = 200 };

/* The lines of thin bands are thin, so that the bands stay visible. */
static double fine(const picture *p, double width) {
  return width * fmin(1, fmax(0.2, p->band / 5));
}

typedef struct band {
  picture *picture;
  const stroke *stroke;
} band;

/* The point at fraction t of a stroke, `off` points in front of it. */
static hr2d_point beside(const stroke *s, double t, double off) {
  return (hr2d_point){s->a.x + t * (s->b.x - s->a.x) + off * s->front.x,
                      s->a.y + t * (s->b.y - s->a.y) + off * s->front.y};
}

/* The point of the inner edge at fraction t; the edge is lower where the band is cut. */
static hr2d_point inner(const picture *p, const stroke *s, double t) {
  double height = p->band;
  if (s->cut_a > 0) height = fmin(height, p->band * (t * s->length / s->cut_a));
  if (s->cut_b > 0) height = fmin(height, p->band * ((1 - t) * s->length / s->cut_b));
  return beside(s, t, height);
}

/* Adds the outline of a part of a band to the path; its inner edge bends at the cuts. */
static void outline(const picture *p, const stroke *s, double t0, double t1) {
  const double bend[] = {1 - s->cut_b / s->length, s->cut_a / s->length};
  const hr2d_point a = beside(s, t0, 0), b = beside(s, t1, 0);
  const hr2d_point c = inner(p, s, t1), d = inner(p, s, t0);
  cairo_move_to(p->cr, a.x, a.y);
  cairo_line_to(p->cr, b.x, b.y);
  cairo_line_to(p->cr, c.x, c.y);
  for (int k = 0; k < 2; k++)
    if (bend[k] > t0 && bend[k] < t1) {
      const hr2d_point q = inner(p, s, bend[k]);
      cairo_line_to(p->cr, q.x, q.y);
    }
  cairo_line_to(p->cr, d.x, d.y);
  cairo_close_path(p->cr);
}

/* On a leaf of a high order B is a polynomial, which the stops of a gradient follow. */
static void set_gradient(const picture *p, const stroke *s, const piece *e) {
  const uint32_t patch = hr2d_hierarchy_elements(p->run->hierarchy)[e->element].patch;
  const hr2d_point a = beside(s, e->t0, 0), b = beside(s, e->t1, 0);
  const double length = (e->t1 - e->t0) * s->length;
  const int stops = (int)fmin(MOST_STOPS, 2 + length / STOP);
  cairo_pattern_t *pattern = cairo_pattern_create_linear(a.x, a.y, b.x, b.y);
  for (int k = 0; k <= stops; k++) {
    const double at = (double)k / stops;
    const colour c = scale_colour(p, shade_of_point(p, patch, leaves_at(e, at)));
    cairo_pattern_add_color_stop_rgb(pattern, at, c.r, c.g, c.b);
  }
  cairo_set_source(p->cr, pattern);
  cairo_pattern_destroy(pattern);
}

static int fill_piece(void *ctx, const piece *e) {
  const band *b = ctx;
  const picture *p = b->picture;
  const int leaf = !hr2d_hierarchy_elements(p->run->hierarchy)[e->element].child;
  if (p->run->account.order > 1 && leaf)
    set_gradient(p, b->stroke, e);
  else
    pen_colour(p->cr, scale_colour(p, shade_of_element(p, e->element)));
  outline(p, b->stroke, e->t0, fmin(1, e->t1 + OVERLAP / b->stroke->length));
  cairo_fill(p->cr);
  return 0;
}

/* The level of the subdivision that made the start point of an element. */
static unsigned level_of_start(const hr2d_hierarchy *h, uint32_t element) {
  const hr2d_element *elements = hr2d_hierarchy_elements(h);
  unsigned level = hr2d_element_level(h, element);
  for (uint32_t parent; level > 0; element = parent, level--) {
    parent = hr2d_element_parent(h, element);
    if (elements[parent].child != element) break;
  }
  return level;
}

/* The tick at the start of an element.  As on a ruler, coarse levels have long ticks. */
static int tick_piece(void *ctx, const piece *e) {
  const band *b = ctx;
  const picture *p = b->picture;
  if ((e->t1 - e->t0) * b->stroke->length < CROWDED || !(e->t0 > 0)) return 0;
  const unsigned level = level_of_start(p->run->hierarchy, e->element);
  const double reach = p->band + fine(p, 1.5 + 5 * pow(0.75, level));
  const hr2d_point from = beside(b->stroke, e->t0, 0.55 * p->band);
  const hr2d_point to = beside(b->stroke, e->t0, reach);
  cairo_move_to(p->cr, from.x, from.y);
  cairo_line_to(p->cr, to.x, to.y);
  return 0;
}

static int draw_band(picture *p, size_t patch) {
  const stroke *s = &p->strokes[patch];
  band b = {p, s};
  if (!(s->length > 0)) return 0;
  const int status = leaves_walk(p->run->hierarchy, patch, FINEST / p->scale, fill_piece, &b);
  outline(p, s, 0, 1);
  pen_grey(p->cr, 0.25);
  cairo_set_line_width(p->cr, fine(p, 0.5));
  cairo_stroke(p->cr);
  return status;
}

static int draw_ticks(picture *p, size_t patch) {
  band b = {p, &p->strokes[patch]};
  pen_grey(p->cr, 0.3);
  cairo_set_line_width(p->cr, fine(p, 0.45));
  const int status = leaves_walk(p->run->hierarchy, patch, FINEST / p->scale, tick_piece, &b);
  cairo_stroke(p->cr);
  return status;
}

/* A pane is a line of dashes on white, and a shield one of dashes and dots. */
static void set_dashes(picture *p, size_t patch, double width) {
  const double pane[] = {4 * width, 3 * width},
               shield[] = {6 * width, 2 * width, width, 2 * width};
  const int is_shield = hr2d_scene_heat(p->run->scene, patch, NULL) == HR2D_HEAT_SHIELD;
  if (is_shield)
    cairo_set_dash(p->cr, shield, 4, 0);
  else
    cairo_set_dash(p->cr, pane, 2, 0);
}

/* Without a band a wall has a white rim, so that it is seen in the dark. */
static int draw_wall(picture *p, size_t patch) {
  const stroke *s = &p->strokes[patch];
  const size_t other = hr2d_scene_other_side(p->run->scene, patch);
  if (other < patch) return 0; /* drawn already */
  cairo_move_to(p->cr, s->a.x, s->a.y);
  cairo_line_to(p->cr, s->b.x, s->b.y);
  if (!p->coloured || other != patch) {
    pen_grey(p->cr, 0.9);
    cairo_set_line_width(p->cr, 3);
    cairo_stroke_preserve(p->cr);
  }
  pen_grey(p->cr, 0.1);
  const double width = p->coloured ? fine(p, 1.2) : 1.4;
  cairo_set_line_width(p->cr, width);
  if (other != patch) set_dashes(p, patch, width);
  cairo_stroke(p->cr);
  cairo_set_dash(p->cr, NULL, 0, 0);
  return obstacles_add(p, s->a, s->b);
}

/* Names keep clear of walls and of their bands. */
static int keep_clear(picture *p, const stroke *s) {
  return obstacles_add(p, beside(s, 0, p->band + 4), beside(s, 1, p->band + 4));
}

int bands_draw(picture *p) {
  const size_t count = hr2d_scene_patches(p->run->scene);
  int status = 0;
  for (size_t k = 0; p->coloured && !status && k < count; k++) status = draw_band(p, k);
  for (size_t k = 0; p->coloured && !status && k < count; k++) status = draw_ticks(p, k);
  for (size_t k = 0; !status && k < count; k++) {
    status = draw_wall(p, k);
    if (!status) status = keep_clear(p, &p->strokes[k]);
  }
  return status;
}
#endif
