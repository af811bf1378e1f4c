/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page: its width is fixed, its height depends on the scene. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"

#define PAGE_WIDTH   800.0
#define LEAST_HEIGHT 300.0
#define MOST_SCENE   600.0 /* height of a scene */
#define TITLE        62.0
#define FOOT         46.0
#define LEGEND       112.0
#define MARGIN       34.0

typedef struct margins {
  double left, right, top, bottom;
} margins;

hr2d_point layout_point(const picture *p, hr2d_point e) {
  return (hr2d_point){p->origin.x + (e.x - p->low.x) * p->scale,
                      p->origin.y - (e.y - p->low.y) * p->scale};
}

double layout_tree_height(const picture *p) {
  return p->path_count ? TREE_GAP + p->tree_step * (p->tree_levels + 1) : 0;
}

/* The root element of a patch, which has its end points in element units. */
static const hr2d_element *root(const picture *p, size_t patch) {
  return &hr2d_hierarchy_elements(p->run->hierarchy)[patch];
}

static hr2d_point bounds(picture *p) {
  hr2d_point low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};
  for (size_t k = 0; k < hr2d_scene_patches(p->run->scene); k++) {
    const hr2d_element *e = root(p, k);
    low.x = fmin(low.x, fmin(e->a.x, e->b.x));
    low.y = fmin(low.y, fmin(e->a.y, e->b.y));
    high.x = fmax(high.x, fmax(e->a.x, e->b.x));
    high.y = fmax(high.y, fmax(e->a.y, e->b.y));
  }
  p->low = low;
  return (hr2d_point){high.x - low.x, high.y - low.y};
}

/* Room for the names of upright patches, on the side of their backs. */
static margins choose_margins(const picture *p) {
  margins m = {MARGIN, MARGIN, 12, 12};
  if (p->name_count) m.top = m.bottom = 24;
  pen_font(p->cr, 10, 0);
  for (size_t k = 0; k < p->name_count; k++) {
    const hr2d_element *e = root(p, p->name[k].patch);
    const double back = (e->b.y - e->a.y) / hypot(e->b.x - e->a.x, e->b.y - e->a.y);
    const double width = fmin(140, pen_text_width(p->cr, p->name[k].text) + 22);
    if (back < -0.5) m.left = fmax(m.left, width);
    if (back > 0.5) m.right = fmax(m.right, width);
  }
  const double tree = layout_tree_height(p);
  return (margins){m.left + tree, m.right + tree, m.top + tree, m.bottom + tree};
}

hr2d_point layout_along(const stroke *s, double t) {
  return (hr2d_point){s->a.x + t * (s->b.x - s->a.x), s->a.y + t * (s->b.y - s->a.y)};
}

void layout_draw_dot(const picture *p, const stroke *s, double t) {
  const hr2d_point at = layout_along(s, t);
  cairo_new_sub_path(p->cr);
  cairo_arc(p->cr, at.x, at.y, 3, 0, 6.2832);
  pen_grey(p->cr, 1);
  cairo_fill_preserve(p->cr);
  pen_grey(p->cr, 0);
  cairo_set_line_width(p->cr, 1.2);
  cairo_stroke(p->cr);
}

box layout_frame(const picture *p) {
  return (box){0.4 * MARGIN, TITLE - 6, p->width - LEGEND, p->height - FOOT};
}

static int make_strokes(picture *p) {
  const size_t count = hr2d_scene_patches(p->run->scene);
  p->strokes = calloc(count, sizeof *p->strokes);
  if (!p->strokes) return complain_memory();
  for (size_t k = 0; k < count; k++) {
    stroke *s = &p->strokes[k];
    s->a = layout_point(p, root(p, k)->a);
    s->b = layout_point(p, root(p, k)->b);
    /* The front is on the left in the plane; on the page y points downwards. */
    const double dx = s->b.x - s->a.x, dy = s->b.y - s->a.y;
    s->length = hypot(dx, dy);
    s->front =
        s->length > 0 ? (hr2d_point){dy / s->length, -dx / s->length} : (hr2d_point){0, 0};
  }
  return EXIT_DONE;
}

int layout_make(picture *p) {
  const hr2d_point size = bounds(p);
  const margins m = choose_margins(p);
  const double room = PAGE_WIDTH - m.left - m.right - LEGEND;
  p->scale = fmin(room / size.x, MOST_SCENE / size.y);
  if (!isfinite(p->scale))
    return complain(p->run->options->draw, "the scene is too small to draw");
  const double height = TITLE + m.top + size.y * p->scale + m.bottom + FOOT;
  p->width = PAGE_WIDTH;
  p->height = ceil(fmax(LEAST_HEIGHT, height));
  p->origin.x = m.left + 0.5 * (room - size.x * p->scale);
  p->origin.y = p->height - FOOT - m.bottom - 0.5 * (p->height - height);
  const int status = make_strokes(p);
  if (!status) joints_make(p);
  return status;
}
#endif
