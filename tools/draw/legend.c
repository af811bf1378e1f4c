/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Title, colour scale, scale of lengths and the key of the links. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdio.h>

#include "cli/scene.h"
#include "output/ticks.h"

#define SIDE    24.0
#define BAR     14.0
#define TALLEST 280.0

/* The target or budget, and the bound of the error that was reached. */
static void describe_target(const run *r, char *text, size_t size) {
  const options *o = r->options;
  const int sup = o->norm == HR2D_NORM_SUP;
  char wanted[48];
  if (o->target_error > 0)
    snprintf(wanted, sizeof wanted, "target error %g", o->target_error);
  else
    snprintf(wanted, sizeof wanted, "%g seconds", o->time_budget);
  const double bound = sup ? r->account.sup.bound : r->account.average.bound;
  if (isfinite(bound))
    snprintf(text, size, "%s, at most %.1e reached", wanted, bound);
  else
    snprintf(text, size, "%s, error unknown", wanted);
}

void legend_draw_title(const picture *p) {
  const run *r = p->run;
  const options *o = r->options;
  const hr2d_refine_counts n = hr2d_linkset_counts(r->links);
  char first[32] = "", order[32] = "", last[128], text[256];
  pen_grey(p->cr, 0.1);
  pen_font(p->cr, 15, 1);
  pen_write(p->cr, SIDE, 28, scene_file_name(o));
  if (options_targeted(o)) {
    describe_target(r, last, sizeof last);
  } else {
    snprintf(first, sizeof first, "ε = %g    ", o->epsilon);
    snprintf(last, sizeof last, "oracle %s, variant %s", o->oracle->name, o->policy->name);
  }
  if (r->account.order > 1) snprintf(order, sizeof order, "p = %u    ", r->account.order);
  snprintf(text, sizeof text, "%s%sN = %llu    L = %llu    %s", first, order,
           (unsigned long long)n.elements, (unsigned long long)r->account.links, last);
  pen_grey(p->cr, 0.3);
  pen_font(p->cr, 10.5, 0);
  pen_write(p->cr, SIDE, 46, text);
}

static void fill_bar(const picture *p, double x, double y, double height) {
  cairo_pattern_t *pattern = cairo_pattern_create_linear(0, y + height, 0, y);
  for (int k = 0; k <= 64; k++) {
    const colour c = palette_viridis(k / 64.);
    cairo_pattern_add_color_stop_rgb(pattern, k / 64., c.r, c.g, c.b);
  }
  cairo_rectangle(p->cr, x, y, BAR, height);
  cairo_set_source(p->cr, pattern);
  cairo_fill_preserve(p->cr);
  pen_grey(p->cr, 0.25);
  cairo_set_line_width(p->cr, 0.5);
  cairo_stroke(p->cr);
  cairo_pattern_destroy(pattern);
}

static void draw_scale_ticks(const picture *p, double x, double y, double height) {
  ticks t;
  ticks_make(&t, p->lo, p->hi, p->logarithmic, height > 160 ? 6 : 4);
  pen_font(p->cr, 10, 0);
  for (int k = 0; k < t.count; k++) {
    char label[32];
    const double at = y + height * (1 - scale_position(p, t.value[k]));
    ticks_label(&t, k, label, sizeof label);
    cairo_move_to(p->cr, x + BAR, at);
    cairo_line_to(p->cr, x + BAR + 4, at);
    cairo_stroke(p->cr);
    pen_write(p->cr, x + BAR + 7, at + 3.5, label);
  }
}

static void draw_colour_scale(const picture *p) {
  const size_t bands = hr2d_scene_bands(p->run->scene);
  const double x = p->width - 92, y = 96, height = fmin(TALLEST, p->height - y - 52);
  char text[64];
  pen_grey(p->cr, 0.1);
  pen_font(p->cr, 10.5, 1);
  pen_write(p->cr, x, y - 27, "radiosity B");
  pen_font(p->cr, 9, 0);
  pen_grey(p->cr, 0.3);
  if (bands > 1)
    snprintf(text, sizeof text, "mean of %zu bands", bands);
  else
    snprintf(text, sizeof text, "in the unit of E");
  pen_write(p->cr, x, y - 14, text);
  fill_bar(p, x, y, height);
  draw_scale_ticks(p, x, y, height);
}

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
  draw_colour_scale(p);
  draw_length_scale(p);
  if (p->run->options->link_level != NO_LEVEL)
    neighbours_draw_key(p);
  else if (p->path_count && p->level_lo <= p->level_hi)
    draw_level_key(p);
  if (p->seen) beams_draw_key(p);
}
#endif
