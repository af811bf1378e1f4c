/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is around a cell: the images of patches, pale, and mirrors, hatched at their backs. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>

#define PALE      0.72
#define HATCH     7.0 /* points between two lines of the hatching, */
#define HATCH_END 4.5 /* and their width */

static hr2d_point on_page(const picture *p, hr2d_point scene) {
  const double unit = hr2d_scene_unit(p->run->scene);
  return layout_point(p, (hr2d_point){scene.x / unit, scene.y / unit});
}

static void draw_patches(const picture *p) {
  const hr2d_scene *scene = p->run->scene;
  for (size_t g = 1; g < hr2d_scene_images(scene); g++)
    for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
      const hr2d_segment s = hr2d_scene_image(scene, k, g);
      const hr2d_point a = on_page(p, s.a), b = on_page(p, s.b);
      cairo_move_to(p->cr, a.x, a.y);
      cairo_line_to(p->cr, b.x, b.y);
    }
  pen_grey(p->cr, PALE);
  cairo_set_line_width(p->cr, 2);
  cairo_stroke(p->cr);
}

/* The middle of the cell on the page. */
static hr2d_point middle_of(const picture *p) {
  hr2d_point sum = {0, 0};
  const size_t patches = hr2d_scene_patches(p->run->scene);
  for (size_t k = 0; k < patches; k++) {
    sum.x += 0.5 * (p->strokes[k].a.x + p->strokes[k].b.x) / (double)patches;
    sum.y += 0.5 * (p->strokes[k].a.y + p->strokes[k].b.y) / (double)patches;
  }
  return sum;
}

/* Across the frame, however it was drawn; short lines at 45 degrees lead away from the cell. */
static void draw_mirror(const picture *p, hr2d_segment mirror) {
  const hr2d_point a = on_page(p, mirror.a), b = on_page(p, mirror.b), m = middle_of(p);
  const double length = hypot(b.x - a.x, b.y - a.y);
  const hr2d_point u = {(b.x - a.x) / length, (b.y - a.y) / length};
  const double along = (m.x - a.x) * u.x + (m.y - a.y) * u.y;
  const hr2d_point foot = {a.x + along * u.x, a.y + along * u.y};
  const double side = (m.x - a.x) * u.y - (m.y - a.y) * u.x > 0 ? 1 : -1;
  const hr2d_point back = {-side * u.y + u.x, side * u.x + u.y};
  const double far = p->width + p->height;
  cairo_move_to(p->cr, foot.x - far * u.x, foot.y - far * u.y);
  cairo_line_to(p->cr, foot.x + far * u.x, foot.y + far * u.y);
  for (double at = -far; at <= far; at += HATCH) {
    const double x = foot.x + at * u.x, y = foot.y + at * u.y;
    cairo_move_to(p->cr, x, y);
    cairo_line_to(p->cr, x + HATCH_END * back.x, y + HATCH_END * back.y);
  }
  pen_grey(p->cr, 0.9);
  cairo_set_line_width(p->cr, 2);
  cairo_stroke_preserve(p->cr);
  pen_grey(p->cr, 0.35);
  cairo_set_line_width(p->cr, 0.8);
  cairo_stroke(p->cr);
}

void images_draw(const picture *p) {
  const box f = p->frame;
  if (hr2d_scene_images(p->run->scene) == 1) return;
  cairo_save(p->cr);
  cairo_rectangle(p->cr, f.x0, f.y0, f.x1 - f.x0, f.y1 - f.y0);
  cairo_clip(p->cr);
  draw_patches(p);
  for (size_t k = 0; k < hr2d_scene_mirrors(p->run->scene); k++)
    draw_mirror(p, hr2d_scene_mirror(p->run->scene, k));
  cairo_restore(p->cr);
}
#endif
