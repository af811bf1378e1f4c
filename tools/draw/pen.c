/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours and text. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include "output/printable.h"

void pen_colour(cairo_t *cr, colour c) {
  cairo_set_source_rgb(cr, c.r, c.g, c.b);
}

void pen_grey(cairo_t *cr, double grey) {
  cairo_set_source_rgb(cr, grey, grey, grey);
}

void pen_font(cairo_t *cr, double size, int bold) {
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, size);
}

/* No text of a picture is longer: a line is 200 characters at most. */
enum { MOST_TEXT = 1024 };

double pen_text_width(cairo_t *cr, const char *text) {
  cairo_text_extents_t extents;
  char shown[MOST_TEXT];
  printable_copy(shown, sizeof shown, text);
  cairo_text_extents(cr, shown, &extents);
  return extents.x_advance;
}

void pen_write(cairo_t *cr, double x, double y, const char *text) {
  char shown[MOST_TEXT];
  printable_copy(shown, sizeof shown, text);
  cairo_move_to(cr, x, y);
  cairo_show_text(cr, shown);
}

void pen_text_path(cairo_t *cr, double x, double y, const char *text) {
  char shown[MOST_TEXT];
  printable_copy(shown, sizeof shown, text);
  cairo_move_to(cr, x, y);
  cairo_text_path(cr, shown);
}
#endif
