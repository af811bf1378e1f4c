/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lit space in the colours of its light, as an image on the page. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>

#include "output/complain.h"

/* Points between two pixels: as many as in a PNG, and more where views take long. */
#define FINEST   0.5
#define COARSEST 2.0

/* Triangles of the plane that all views may pass, some seconds of work. */
#define MOST_WORK 1.5e8

/* What interpolation may add, in steps of the scale from 0 to 1. */
#define STEP 4e-3

/* The tolerance of hr2d_field_on_grid() is a part of the range of M, which the scale may
   exceed; on a logarithmic scale it is a part of the darkest light. */
static double tolerance_of(const picture *p) {
  if (p->rgb || !p->logarithmic) return STEP;
  const double decades = log(p->hi / p->lo);
  return fmax(1e-9, STEP * decades * p->lo / p->hi);
}

static double choose_step(const picture *p) {
  const box *f = &p->frame;
  double step = FINEST;
  while (step < COARSEST &&
         p->work * (f->x1 - f->x0) * (f->y1 - f->y0) > MOST_WORK * step * step)
    step += FINEST;
  return step;
}

int fill_make(picture *p) {
  return raster_make(p, choose_step(p), tolerance_of(p), &p->raster);
}

static uint32_t byte_of(double part) {
  return (uint32_t)(255 * fmin(1, fmax(0, part)) + 0.5);
}

static uint32_t pixel_of(const picture *p, shade s) {
  if (!p->rgb) s.v[0] = floor(p->levels * fmin(1, fmax(0, scale_position(p, s.v[0]))) + 0.5);
  const colour c = p->rgb ? scale_colour(p, s) : scale_colour_at(p, s.v[0] / p->levels);
  return 0xff000000 | byte_of(c.r) << 16 | byte_of(c.g) << 8 | byte_of(c.b);
}

static void fill_image(const picture *p, cairo_surface_t *image) {
  const raster *r = &p->raster;
  const size_t stride = (size_t)cairo_image_surface_get_stride(image) / sizeof(uint32_t);
  uint32_t *pixel = (void *)cairo_image_surface_get_data(image);
  cairo_surface_flush(image);
  for (size_t k = 0; k < r->columns * r->rows; k++) {
    if (!isfinite(r->at[k].v[0])) continue;
    pixel[k / r->columns * stride + k % r->columns] = pixel_of(p, r->at[k]);
  }
  cairo_surface_mark_dirty(image);
}

void fill_draw(const picture *p) {
  const raster *r = &p->raster;
  if (!r->at) return;
  cairo_surface_t *image =
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, (int)r->columns, (int)r->rows);
  if (cairo_surface_status(image) == CAIRO_STATUS_SUCCESS) fill_image(p, image);
  cairo_save(p->cr);
  cairo_translate(p->cr, r->x - 0.5 * r->step, r->y - 0.5 * r->step);
  cairo_scale(p->cr, r->step, r->step);
  cairo_set_source_surface(p->cr, image, 0, 0);
  cairo_paint(p->cr);
  cairo_restore(p->cr);
  cairo_surface_destroy(image);
}
#endif
