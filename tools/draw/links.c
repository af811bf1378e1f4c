/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The links that serve one point, as in the paper's Figures 2 and 3. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"

#define TREE_ROOM 44.0 /* points behind a patch for its tree */

enum { MOST_OBSTACLES = 400 };

/* Keeps only the element on the level of --link-level. */
static int choose_level(picture *p) {
  const unsigned level = p->run->options->link_level;
  const size_t deepest = p->path_count - 1;
  if (level > deepest)
    return complain_usage("--link-level: the elements at this point have levels 0 to %zu",
                          deepest);
  p->path[0] = p->path[deepest - level];
  p->path_count = 1;
  return EXIT_DONE;
}

/* The elements that hold the point: those from its leaf up to the root. */
static int find_path(picture *p) {
  const hr2d_hierarchy *h = p->run->hierarchy;
  const size_t patch = p->run->places[p->run->options->at.count];
  uint32_t element = hr2d_hierarchy_leaf(h, patch, p->run->options->links_of.t);
  p->path_count = hr2d_element_level(h, element) + 1;
  p->path = malloc(p->path_count * sizeof *p->path);
  if (!p->path) return complain_memory();
  for (size_t k = 0; k < p->path_count; k++) {
    p->path[k] = element;
    element = hr2d_element_parent(h, element);
  }
  return p->run->options->link_level != NO_LEVEL ? choose_level(p) : EXIT_DONE;
}

static int on_path(const picture *p, uint32_t element) {
  for (size_t k = 0; k < p->path_count; k++)
    if (p->path[k] == element) return 1;
  return 0;
}

/* Calls visit(near, far) for each link of the point; `near` is on the patch of the point. */
static int each_link(picture *p, int (*visit)(picture *, uint32_t near, uint32_t far)) {
  const run_links *links = &p->run->point_links;
  int status = 0;
  for (size_t k = 0; !status && k < links->count; k++)
    if (on_path(p, links->items[k].near))
      status = visit(p, links->items[k].near, links->items[k].far);
  return status;
}

static int measure_link(picture *p, uint32_t near, uint32_t far) {
  const unsigned own = hr2d_element_level(p->run->hierarchy, near);
  const unsigned level = hr2d_element_level(p->run->hierarchy, far);
  p->level_lo = level < p->level_lo ? level : p->level_lo;
  p->level_hi = level > p->level_hi ? level : p->level_hi;
  p->tree_levels = own > p->tree_levels ? own : p->tree_levels;
  p->tree_levels = level > p->tree_levels ? level : p->tree_levels;
  return p->run->options->link_level != NO_LEVEL ? neighbours_note(p, far) : 0;
}

int links_find(picture *p) {
  if (!p->run->options->links_of.patch) return EXIT_DONE;
  int status = find_path(p);
  p->level_lo = (unsigned)-1;
  p->level_hi = 0;
  if (!status) status = each_link(p, measure_link);
  if (!status) neighbours_measure(p);
  p->tree_step = fmin(5, TREE_ROOM / (p->tree_levels + 1));
  return status;
}

static void set_level_colour(const picture *p, uint32_t element) {
  const unsigned level = hr2d_element_level(p->run->hierarchy, element);
  const unsigned range = p->level_hi - p->level_lo;
  pen_colour(p->cr, palette_ember(range ? (double)(level - p->level_lo) / range : 1));
}

static hr2d_point shifted(hr2d_point q, const stroke *s, double off) {
  return (hr2d_point){q.x + off * s->front.x, q.y + off * s->front.y};
}

/* An element as a bar behind its patch; the bar of the root is farthest away. */
static int draw_bar(picture *p, uint32_t element) {
  const hr2d_element *e = &hr2d_hierarchy_elements(p->run->hierarchy)[element];
  const stroke *s = &p->strokes[e->patch];
  const unsigned level = hr2d_element_level(p->run->hierarchy, element);
  const double off = TREE_GAP + p->tree_step * (p->tree_levels - level);
  const hr2d_point a = shifted(layout_point(p, e->a), s, -off);
  const hr2d_point b = shifted(layout_point(p, e->b), s, -off);
  const double gap = fmin(0.6, 0.2 * hypot(b.x - a.x, b.y - a.y));
  const double ux = -s->front.y * gap, uy = s->front.x * gap; /* along a→b */
  cairo_move_to(p->cr, a.x + ux, a.y + uy);
  cairo_line_to(p->cr, b.x - ux, b.y - uy);
  cairo_set_line_width(p->cr, fmin(2.2, 0.5 * p->tree_step));
  cairo_stroke(p->cr);
  return p->obstacles.count < MOST_OBSTACLES ? obstacles_add(p, a, b) : 0;
}

static int draw_link(picture *p, uint32_t near, uint32_t far) {
  const hr2d_element *elements = hr2d_hierarchy_elements(p->run->hierarchy);
  const stroke *sn = &p->strokes[elements[near].patch], *sf = &p->strokes[elements[far].patch];
  const hr2d_point a = shifted(layout_point(p, elements[near].centre), sn, p->band);
  const hr2d_point b = shifted(layout_point(p, elements[far].centre), sf, p->band);
  set_level_colour(p, far);
  cairo_move_to(p->cr, a.x, a.y);
  cairo_line_to(p->cr, b.x, b.y);
  cairo_set_line_width(p->cr, 0.7);
  cairo_stroke(p->cr);
  int status = draw_bar(p, far);
  if (status) return status;
  pen_grey(p->cr, 0.45);
  status = draw_bar(p, near);
  return status || p->obstacles.count >= MOST_OBSTACLES ? status : obstacles_add(p, a, b);
}

void links_draw_point(const picture *p) {
  if (!p->path_count) return;
  const size_t patch = p->run->places[p->run->options->at.count];
  const stroke *s = &p->strokes[patch];
  layout_draw_dot(p, s, p->run->options->links_of.t);
}

int links_draw(picture *p) {
  if (!p->path_count) return EXIT_DONE;
  cairo_set_line_cap(p->cr, CAIRO_LINE_CAP_BUTT);
  int status = each_link(p, draw_link);
  if (!status) status = neighbours_draw(p);
  if (!status && p->run->options->link_parents) status = neighbours_draw_parents(p);
  return status;
}
#endif
