/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scale of lengths and keys. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdio.h>

#include "output/ticks.h"

#define SIDE 24.0

/* A round length of about a sixth of the page. */
static void draw_length_scale(const picture *p) {
  const double unit = hr2d_scene_unit(p->run->scene);
  const double round = ticks_round_below(140 / p->scale * unit);
  const double width = round / unit * p->scale, x = SIDE, y = p->height - 20;
  char label[32];
  if (!isfinite(width)) return;
  pen_grey(p->cr, 0.2);
  cairo_set_line_width(p->cr, 1);
  cairo_move_to(p->cr, x, y - 4);
  cairo_line_to(p->cr, x, y);
  cairo_line_to(p->cr, x + width, y);
  cairo_line_to(p->cr, x + width, y - 4);
  cairo_stroke(p->cr);
  snprintf(label, sizeof label, "%g", round);
  pen_font(p->cr, 10, 0);
  pen_write(p->cr, x + 0.5 * (width - pen_text_width(p->cr, label)), y - 6, label);
}

/* A swatch per level, to the right of the scale of lengths. */
static void draw_level_key(const picture *p) {
  const unsigned range = p->level_hi - p->level_lo;
  const double y = p->height - 20;
  const double step = fmin(34, (p->width - 330 - SIDE) / (range + 1));
  pen_font(p->cr, 10, 0);
  pen_grey(p->cr, 0.2);
  pen_write(p->cr, 200, y, "links to elements of level");
  for (unsigned k = 0; k <= range; k++) {
    char label[16];
    const double x = 346 + step * k;
    snprintf(label, sizeof label, "%u", p->level_lo + k);
    pen_colour(p->cr, palette_ember(range ? (double)k / range : 1));
    cairo_rectangle(p->cr, x, y - 7, fmin(10, 0.4 * step), 7);
    cairo_fill(p->cr);
    pen_grey(p->cr, 0.2);
    if (step > 20 || k % 2 == 0) pen_write(p->cr, x + fmin(10, 0.4 * step) + 2, y, label);
  }
}

void legend_draw(const picture *p) {
  legend_draw_scale(p);
  draw_length_scale(p);
  extent_draw_note(p);
  if (p->run->options->link_level != NO_LEVEL)
    neighbours_draw_key(p);
  else if (p->path_count && p->level_lo <= p->level_hi)
    draw_level_key(p);
  if (p->seen) beams_draw_key(p);
  if (p->run->options->arrows) arrows_draw_key(p);
}
#endif
