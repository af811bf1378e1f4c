/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page: as wide and as high as the scene takes of it. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"

#define PAGE_WIDTH   800.0
#define LEAST_HEIGHT 300.0 /* where the legend stands beside the scene */
#define MOST_SCENE   600.0 /* height of a scene, */
#define MOST_TALL    960.0 /* and of a tall one */
#define TITLE        62.0
#define FOOT         46.0
#define FLAT_FOOT    74.0 /* with the legend in it */
#define LEGEND       120.0
#define MARGIN       34.0

/* A scene so many times as wide as high has its legend below, one so tall more of the page. */
#define FLAT 2.3
#define TALL 2.0

/* Of the size of the cell, on each side where there are images. */
#define IMAGES 0.15

typedef struct margins {
  double left, right, top, bottom;
} margins;

hr2d_point layout_point(const picture *p, hr2d_point e) {
  return (hr2d_point){p->origin.x + (e.x - p->low.x) * p->scale,
                      p->origin.y - (e.y - p->low.y) * p->scale};
}

hr2d_point layout_scene_point(const picture *p, double x, double y) {
  const double unit = hr2d_scene_unit(p->run->scene);
  return (hr2d_point){unit * (p->low.x + (x - p->origin.x) / p->scale),
                      unit * (p->low.y - (y - p->origin.y) / p->scale)};
}

double layout_tree_height(const picture *p) {
  return p->path_count ? TREE_GAP + p->tree_step * (p->tree_levels + 1) : 0;
}

/* The root element of a patch, which has its end points in element units. */
static const hr2d_element *root(const picture *p, size_t patch) {
  return &hr2d_hierarchy_elements(p->run->hierarchy)[patch];
}

static void set_bounds(picture *p, hr2d_point low, hr2d_point high) {
  p->low = low;
  p->size = (hr2d_point){high.x - low.x, high.y - low.y};
}

/* Takes some of the images into the bounds, which are in element units. */
static void widen(const picture *p, hr2d_point *low, hr2d_point *high) {
  const hr2d_scene *scene = p->run->scene;
  const double unit = hr2d_scene_unit(scene);
  const hr2d_point l = *low, h = *high;
  const double more = IMAGES * fmax(h.x - l.x, h.y - l.y);
  for (size_t g = 1; g < hr2d_scene_images(scene); g++)
    for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
      const hr2d_segment s = hr2d_scene_image(scene, k, g);
      low->x = fmax(l.x - more, fmin(low->x, fmin(s.a.x, s.b.x) / unit));
      low->y = fmax(l.y - more, fmin(low->y, fmin(s.a.y, s.b.y) / unit));
      high->x = fmin(h.x + more, fmax(high->x, fmax(s.a.x, s.b.x) / unit));
      high->y = fmin(h.y + more, fmax(high->y, fmax(s.a.y, s.b.y) / unit));
    }
}

void layout_bounds(picture *p) {
  hr2d_point low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};
  for (size_t k = 0; k < hr2d_scene_patches(p->run->scene); k++) {
    const hr2d_element *e = root(p, k);
    low.x = fmin(low.x, fmin(e->a.x, e->b.x));
    low.y = fmin(low.y, fmin(e->a.y, e->b.y));
    high.x = fmax(high.x, fmax(e->a.x, e->b.x));
    high.y = fmax(high.y, fmax(e->a.y, e->b.y));
  }
  widen(p, &low, &high);
  set_bounds(p, low, high);
}

/* Room for the names of upright patches, on the side of their backs. */
static margins choose_margins(const picture *p) {
  margins m = {MARGIN, MARGIN, 12, 12};
  if (p->name_count) m.top = m.bottom = 24;
  if (p->part) return m;
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

int layout_strokes(picture *p) {
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
  joints_make(p);
  return EXIT_DONE;
}

/* A part of the page of whole pixels of a PNG, which has two in a point. */
static box whole_pixels(box b) {
  return (box){ceil(2 * b.x0) / 2, ceil(2 * b.y0) / 2, floor(2 * b.x1) / 2,
               floor(2 * b.y1) / 2};
}

static void set_frame(picture *p, double legend, double foot) {
  const double edge = 0.4 * MARGIN;
  p->frame = (box){edge, TITLE - 6, p->width - fmax(edge, legend), p->height - foot};
  if (p->part)
    p->frame = (box){p->origin.x, p->origin.y - p->size.y * p->scale,
                     p->origin.x + p->size.x * p->scale, p->origin.y};
  p->frame = whole_pixels(p->frame);
}

/* Scale, page and place of the scene on it. */
static void set_page(picture *p, margins m) {
  const int plain = !p->path_count && !p->run->options->beams_of.count;
  const double aspect = p->size.x / p->size.y;
  p->flat = plain && aspect > FLAT;
  const double legend = p->flat ? 0 : LEGEND, foot = p->flat ? FLAT_FOOT : FOOT;
  const double max = aspect * TALL < 1 ? MOST_TALL : MOST_SCENE;
  p->scale = fmin((PAGE_WIDTH - m.left - m.right - legend) / p->size.x, max / p->size.y);
  const double width = m.left + p->size.x * p->scale + m.right + legend;
  const double height = TITLE + m.top + p->size.y * p->scale + m.bottom + foot;
  const double min = fmax(title_width(p), p->run->options->arrows ? ARROW_KEY : 0);
  p->width = plain ? ceil(fmin(PAGE_WIDTH, fmax(min, width))) : PAGE_WIDTH;
  p->height = ceil(fmax(p->flat ? 0 : LEAST_HEIGHT, height));
  p->origin.x = m.left + 0.5 * (p->width - width);
  p->origin.y = p->height - foot - m.bottom - 0.5 * (p->height - height);
  set_frame(p, legend, foot);
}

int layout_make(picture *p) {
  layout_bounds(p);
  const int status = extent_choose(p);
  if (status) return status;
  set_page(p, choose_margins(p));
  if (!(isfinite(p->scale) && p->scale > 0))
    return complain(p->run->options->draw, "the scene is too small to draw");
  return layout_strokes(p);
}
#endif
