/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The region of neighbours of one element (paper, Figure 3), and the refused pairs of parents
   that its links come from (Figure 4). */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "output/complain.h"

#define ARM  6.0 /* ends of dimension lines, points */
#define FONT 10.0

enum { MOST_LABELS = 4 };

static const hr2d_element *element(const picture *p, uint32_t e) {
  return &hr2d_hierarchy_elements(p->run->hierarchy)[e];
}

static double separation(hr2d_point a, hr2d_point b) {
  return hypot(b.x - a.x, b.y - a.y);
}

int neighbours_note(picture *p, uint32_t far) {
  region *r = &p->region;
  const hr2d_element *e = element(p, far);
  neighbour *grown = realloc(r->far, (r->count + 1) * sizeof *grown);
  if (!grown) return complain_memory();
  r->far = grown;
  r->far[r->count++] = (neighbour){far, e->patch, separation(element(p, e->patch)->a, e->a)};
  return EXIT_DONE;
}

static int along_patches(const void *a, const void *b) {
  const neighbour *x = a, *y = b;
  if (x->patch != y->patch) return x->patch < y->patch ? -1 : 1;
  return (x->start > y->start) - (x->start < y->start);
}

/* Links with a direction may lead to the same element twice. */
void neighbours_measure(picture *p) {
  region *r = &p->region;
  size_t kept = 0;
  if (!r->count) return;
  qsort(r->far, r->count, sizeof *r->far, along_patches);
  r->min = INFINITY;
  for (size_t k = 0; k < r->count; k++) {
    const hr2d_element *e = element(p, r->far[k].element);
    const double distance = separation(element(p, p->path[0])->centre, e->centre);
    if (kept && r->far[kept - 1].element == r->far[k].element) continue;
    r->far[kept++] = r->far[k];
    r->min = fmin(r->min, distance);
    r->max = fmax(r->max, distance);
    r->extent += e->length;
  }
  r->count = kept;
}

/* Text on white, centred. */
static int write_label(picture *p, hr2d_point q, const char *text) {
  pen_font(p->cr, FONT, 0);
  const double half = 0.5 * pen_text_width(p->cr, text), high = 0.5 * FONT;
  cairo_rectangle(p->cr, q.x - half - 2, q.y - high, 2 * half + 4, 2 * high);
  pen_grey(p->cr, 1);
  cairo_fill(p->cr);
  pen_grey(p->cr, 0.15);
  pen_write(p->cr, q.x - half, q.y + 0.7 * high, text);
  return obstacles_add_box(p, &(box){q.x - half, q.y - high, q.x + half, q.y + high});
}

static void set_dashes(const picture *p) {
  cairo_set_dash(p->cr, (double[]){4, 3}, 2, 0);
  cairo_set_line_width(p->cr, 0.8);
  pen_grey(p->cr, 0.35);
}

/* The part of a circle about the centre of the element that lies in the box of the scene. */
static void draw_arc(const picture *p, double radius) {
  const hr2d_point centre = layout_point(p, element(p, p->path[0])->centre);
  hr2d_point low = centre, high = centre;
  for (size_t k = 0; k < hr2d_scene_patches(p->run->scene); k++) {
    const stroke *s = &p->strokes[k];
    low.x = fmin(low.x, fmin(s->a.x, s->b.x));
    low.y = fmin(low.y, fmin(s->a.y, s->b.y));
    high.x = fmax(high.x, fmax(s->a.x, s->b.x));
    high.y = fmax(high.y, fmax(s->a.y, s->b.y));
  }
  cairo_save(p->cr);
  cairo_rectangle(p->cr, low.x, low.y, high.x - low.x, high.y - low.y);
  cairo_clip(p->cr);
  cairo_arc(p->cr, centre.x, centre.y, radius * p->scale, 0, 6.2832);
  set_dashes(p);
  cairo_stroke(p->cr);
  cairo_restore(p->cr);
}

/* The bounds of the paper hold for its oracle and its modification only. */
static int has_bounds(const picture *p) {
  const options *o = p->run->options;
  return !options_targeted(o) && o->oracle == hr2d_oracle_size() &&
         o->policy == hr2d_policy_modified();
}

/* A dimension line behind a row of neighbours, with its length. */
static int draw_dimension(picture *p, const neighbour *first, const neighbour *last) {
  const hr2d_element *e = element(p, first->element), *f = element(p, last->element);
  const stroke *s = &p->strokes[first->patch];
  const double off = TREE_GAP + p->tree_step * (p->tree_levels + 1) - ARM;
  const hr2d_point a = layout_point(p, e->a), b = layout_point(p, f->b), n = s->front;
  const hr2d_point from = {a.x - off * n.x, a.y - off * n.y},
                   to = {b.x - off * n.x, b.y - off * n.y};
  const double x = 0.5 * ARM * n.x, y = 0.5 * ARM * n.y;
  char label[32];
  cairo_move_to(p->cr, from.x - x, from.y - y);
  cairo_line_to(p->cr, from.x + x, from.y + y);
  cairo_move_to(p->cr, from.x, from.y);
  cairo_line_to(p->cr, to.x, to.y);
  cairo_move_to(p->cr, to.x - x, to.y - y);
  cairo_line_to(p->cr, to.x + x, to.y + y);
  cairo_set_line_width(p->cr, 0.8);
  pen_grey(p->cr, 0.15);
  cairo_stroke(p->cr);
  snprintf(label, sizeof label, "%.4g",
           separation(e->a, f->b) * hr2d_scene_unit(p->run->scene));
  const int status = obstacles_add(p, from, to);
  const double out = 1.6 * ARM;
  return status ? status
                : write_label(p,
                              (hr2d_point){0.5 * (from.x + to.x) - out * n.x,
                                           0.5 * (from.y + to.y) - out * n.y},
                              label);
}

static int adjoins(const picture *p, const neighbour *x, const neighbour *y) {
  const double length = element(p, x->element)->length;
  return x->patch == y->patch && fabs(x->start + length - y->start) < 1e-6 * length;
}

int neighbours_draw(picture *p) {
  const region *r = &p->region;
  const options *o = p->run->options;
  int status = 0;
  if (!r->count) return status;
  for (size_t k = 0, first = 0; !status && k < r->count; k++)
    if (k + 1 == r->count || !adjoins(p, &r->far[k], &r->far[k + 1])) {
      status = draw_dimension(p, &r->far[first], &r->far[k]);
      first = k + 1;
    }
  if (has_bounds(p) && !o->link_parents) {
    const double size = element(p, p->path[0])->length;
    draw_arc(p, size / o->epsilon);
    draw_arc(p, 2 * size / o->epsilon + size);
  }
  return status;
}

static int label_distance(picture *p, hr2d_point a, hr2d_point b, double at, const char *name) {
  char label[48];
  const hr2d_point from = layout_point(p, a), to = layout_point(p, b);
  snprintf(label, sizeof label, "%s = %.4g", name,
           separation(a, b) * hr2d_scene_unit(p->run->scene));
  return write_label(
      p, (hr2d_point){from.x + at * (to.x - from.x), from.y + at * (to.y - from.y)}, label);
}

int neighbours_draw_parents(picture *p) {
  const hr2d_hierarchy *h = p->run->hierarchy;
  const hr2d_point a = element(p, hr2d_element_parent(h, p->path[0]))->centre;
  const int labelled = p->region.count <= MOST_LABELS;
  uint32_t last = UINT32_MAX;
  int status = 0;
  for (size_t k = 0; !status && k < p->region.count; k++) {
    const uint32_t parent = hr2d_element_parent(h, p->region.far[k].element);
    if (parent == last) continue;
    last = parent;
    const hr2d_point b = element(p, parent)->centre;
    const hr2d_point from = layout_point(p, a), to = layout_point(p, b);
    cairo_save(p->cr);
    set_dashes(p);
    cairo_move_to(p->cr, from.x, from.y);
    cairo_line_to(p->cr, to.x, to.y);
    cairo_stroke(p->cr);
    cairo_restore(p->cr);
    if (labelled) status = label_distance(p, a, b, 0.7, "r′");
  }
  for (size_t k = 0; !status && labelled && k < p->region.count; k++)
    status = label_distance(p, element(p, p->path[0])->centre,
                            element(p, p->region.far[k].element)->centre, 0.3, "r");
  return status;
}

void neighbours_draw_key(const picture *p) {
  const region *r = &p->region;
  const options *o = p->run->options;
  const double unit = hr2d_scene_unit(p->run->scene);
  const double size = element(p, p->path[0])->length;
  char text[160];
  pen_font(p->cr, FONT, 0);
  pen_grey(p->cr, 0.2);
  if (r->count)
    snprintf(text, sizeof text,
             "level %u: A = %.4g, %zu neighbours, D = %.4g = %.4g A, r = %.4g to %.4g",
             o->link_level, size * unit, r->count, r->extent * unit, r->extent / size,
             r->min * unit, r->max * unit);
  else
    snprintf(text, sizeof text, "level %u: A = %.4g, no neighbours", o->link_level,
             size * unit);
  pen_write(p->cr, 200, p->height - 27, text);
  *text = '\0';
  if (o->link_parents)
    snprintf(text, sizeof text, "dashed: the refused pairs of parents, at distance r′");
  else if (has_bounds(p))
    snprintf(text, sizeof text, "dashed: r = A/ε = %.4g and r = 2A/ε + A = %.4g",
             size / o->epsilon * unit, (2 * size / o->epsilon + size) * unit);
  pen_write(p->cr, 200, p->height - 12, text);
}
#endif
