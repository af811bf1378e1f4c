/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the colours mean: the scale, upright beside the scene or level below it. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdio.h>

#include "output/ticks.h"

#define SIDE    24.0
#define BAR     14.0
#define TALLEST 280.0
#define WIDEST  250.0
#define LEADING 13.0

enum { LINES = 3 };

/* Heading and lines of explanation. */
typedef struct legend {
  const char *heading;
  char line[LINES][48];
  int lines;
} legend;

/* The bar: at the value lo it is at (x, y), at hi `length` further, to the right or above. */
typedef struct bar {
  double x, y, length;
  int level;
} bar;

static void describe_bands(const picture *p, legend *l) {
  const int band = p->run->options->band;
  const size_t bands = hr2d_scene_bands(p->run->scene);
  char *text = l->line[l->lines++];
  const size_t size = sizeof l->line[0];
  if (band >= 0)
    snprintf(text, size, "band %d, unit of E", band);
  else if (bands > 1)
    snprintf(text, size, "mean of %zu bands", bands);
  else
    snprintf(text, size, "in the unit of E");
}

static legend describe_true_colour(const picture *p) {
  legend l = {.heading = "true colour", .lines = 2};
  const size_t size = sizeof l.line[0];
  snprintf(l.line[0], size, "red, green, blue");
  snprintf(l.line[1], size, "exposure %.3g", p->exposure);
  if (p->run->options->contours) snprintf(l.line[l.lines++], size, "isolines: mean");
  return l;
}

static legend describe_kernel(void) {
  legend l = {.heading = "mean kernel", .lines = 1};
  snprintf(l.line[0], sizeof l.line[0], "of a link, 1/length");
  return l;
}

static legend describe(const picture *p) {
  legend l = {.heading = p->filled ? "mean light M" : "radiosity B"};
  const size_t size = sizeof l.line[0];
  if (p->kernel) return describe_kernel();
  if (p->rgb) return describe_true_colour(p);
  switch (p->quantity) {
  case QUANTITY_TEMPERATURE:
    l.heading = "temperature";
    snprintf(l.line[l.lines++], size, "mean radiant, K");
    snprintf(l.line[l.lines++], size, "strips: of B");
    break;
  case QUANTITY_SKY:
    l.heading = "seen sky";
    snprintf(l.line[l.lines++], size, "of all directions");
    break;
  case QUANTITY_FLUX:
    l.heading = "flux |Φ|";
    describe_bands(p, &l);
    break;
  default:
    if (p->filled) snprintf(l.line[l.lines++], size, "strips: radiosity B");
    describe_bands(p, &l);
  }
  return l;
}

/* True colour has a scale of greys, from black to the light that is white. */
static colour colour_at(const picture *p, double part) {
  const double grey = palette_srgb(part);
  return p->rgb ? (colour){grey, grey, grey} : scale_colour_at(p, part);
}

/* A tip at the end of the bar: there is more. */
static void draw_tip(const picture *p, const bar *b) {
  const double x = b->level ? b->x + b->length + 1 : b->x;
  const double y = b->level ? b->y - BAR : b->y - b->length - 1;
  cairo_move_to(p->cr, x, y);
  cairo_line_to(p->cr, x + (b->level ? 0 : BAR), y + (b->level ? BAR : 0));
  cairo_line_to(p->cr, x + (b->level ? 9 : 0.5 * BAR), y + (b->level ? 0.5 * BAR : -9));
  cairo_close_path(p->cr);
  pen_colour(p->cr, colour_at(p, 1));
  cairo_fill_preserve(p->cr);
  pen_grey(p->cr, 0.25);
  cairo_set_line_width(p->cr, 0.5);
  cairo_stroke(p->cr);
}

static void fill_bar(const picture *p, const bar *b) {
  const double dx = b->level ? b->length : 0, dy = b->level ? 0 : -b->length;
  cairo_pattern_t *pattern = cairo_pattern_create_linear(b->x, b->y, b->x + dx, b->y + dy);
  for (int k = 0; k <= 64; k++) {
    const colour c = colour_at(p, k / 64.);
    cairo_pattern_add_color_stop_rgb(pattern, k / 64., c.r, c.g, c.b);
  }
  if (b->level)
    cairo_rectangle(p->cr, b->x, b->y - BAR, b->length, BAR);
  else
    cairo_rectangle(p->cr, b->x, b->y - b->length, BAR, b->length);
  cairo_set_source(p->cr, pattern);
  cairo_fill_preserve(p->cr);
  pen_grey(p->cr, 0.25);
  cairo_set_line_width(p->cr, 0.5);
  cairo_stroke(p->cr);
  cairo_pattern_destroy(pattern);
  if (p->beyond) draw_tip(p, b);
}

/* `free` is where the label before ends on a level bar; returns where this one ends. */
static double draw_tick(const picture *p, const bar *b, double part, const char *label,
                        double free) {
  const double x = b->level ? b->x + part * b->length : b->x + BAR;
  const double y = b->level ? b->y : b->y - part * b->length;
  const double half = 0.5 * pen_text_width(p->cr, label);
  cairo_move_to(p->cr, x, y);
  cairo_line_to(p->cr, x + (b->level ? 0 : 4), y + (b->level ? 4 : 0));
  cairo_stroke(p->cr);
  if (b->level && x - half < free + 5) return free;
  if (b->level)
    pen_write(p->cr, x - half, y + 15, label);
  else
    pen_write(p->cr, x + 7, y + 3.5, label);
  return x + half;
}

static void draw_ticks(const picture *p, const bar *b) {
  ticks t;
  double free = 0;
  const int max = b->level || b->length > 160 ? 6 : 4;
  ticks_make(&t, p->rgb ? 0 : p->lo, p->rgb ? 1 / p->exposure : p->hi, p->logarithmic, max);
  pen_font(p->cr, 10, 0);
  pen_grey(p->cr, 0.2);
  for (int k = 0; k < t.count; k++) {
    char label[32];
    ticks_label(&t, k, label, sizeof label);
    free = draw_tick(p, b, p->rgb ? p->exposure * t.value[k] : scale_position(p, t.value[k]),
                     label, free);
  }
}

static void draw_lines(const picture *p, const legend *l, double x, double y) {
  pen_font(p->cr, 10, 0);
  pen_grey(p->cr, 0.3);
  for (int k = 0; k < l->lines; k++) pen_write(p->cr, x, y + k * LEADING, l->line[k]);
}

static void draw_upright(const picture *p, const legend *l) {
  const double x = p->width - 100, top = 69 + LEADING * (l->lines + 1) + (p->beyond ? 6 : 0);
  const double length = fmin(TALLEST, p->height - top - 52);
  const bar b = {x, top + length, length, 0};
  pen_grey(p->cr, 0.1);
  pen_font(p->cr, 10.5, 1);
  pen_write(p->cr, x, 69, l->heading);
  draw_lines(p, l, x, 69 + LEADING);
  fill_bar(p, &b);
  draw_ticks(p, &b);
}

static void draw_level(const picture *p, const legend *l) {
  const double length = fmin(WIDEST, 0.45 * p->width);
  const bar b = {p->width - SIDE - 14 - length, p->height - 26, length, 1};
  double x = b.x;
  pen_grey(p->cr, 0.1);
  pen_font(p->cr, 10.5, 1);
  pen_write(p->cr, x, b.y - BAR - 8, l->heading);
  x += pen_text_width(p->cr, l->heading) + 10;
  for (int k = 0; k < l->lines; k++) {
    const char *comma = k + 1 < l->lines ? "," : "";
    char text[64];
    snprintf(text, sizeof text, "%s%s", l->line[k], comma);
    pen_font(p->cr, 10, 0);
    pen_grey(p->cr, 0.3);
    pen_write(p->cr, x, b.y - BAR - 8, text);
    x += pen_text_width(p->cr, text) + 5;
  }
  fill_bar(p, &b);
  draw_ticks(p, &b);
}

void legend_draw_scale(const picture *p) {
  const legend l = describe(p);
  if (!p->coloured && !p->filled) return;
  if (p->flat)
    draw_level(p, &l);
  else
    draw_upright(p, &l);
}
#endif
