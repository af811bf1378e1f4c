/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a run to a picture file: cairo writes into an output that is whole or not there. */
#include "draw/draw.h"

#include "draw/picture.h"
#include "output/complain.h"

#if HAVE_CAIRO
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <math.h>
#include <stdlib.h>

#include "output/output.h"
#include "output/suffix.h"
#include "run/leaves.h"

#define PIXELS_PER_POINT 2.0

/* Where the average B lies this low on a linear scale, most of the scene would be black. */
#define TOO_LOW 0.2

int draw_check(const char *path) {
  (void)path;
  return EXIT_DONE;
}

static cairo_status_t write_bytes(void *stream, const unsigned char *bytes, unsigned size) {
  return fwrite(bytes, 1, size, stream) == size ? CAIRO_STATUS_SUCCESS
                                                : CAIRO_STATUS_WRITE_ERROR;
}

/* B averaged over all patches. */
static double overall(const picture *p) {
  double sum = 0, length = 0;
  for (size_t k = 0; k < hr2d_scene_patches(p->run->scene); k++) {
    const double own = hr2d_scene_length(p->run->scene, k);
    sum += own * run_mean(p->run, (uint32_t)k);
    length += own;
  }
  return sum / length;
}

static void widen_scale(picture *p, double value) {
  p->lo = fmin(p->lo, value);
  p->hi = fmax(p->hi, value);
}

/* A polynomial may have its extremes anywhere. */
static int widen_by_leaf(void *ctx, const piece *e) {
  picture *p = ctx;
  const unsigned order = p->run->account.order;
  const uint32_t patch = hr2d_hierarchy_elements(p->run->hierarchy)[e->element].patch;
  if (order == 1) widen_scale(p, run_mean(p->run, e->element));
  for (unsigned k = 0; order > 1 && k <= 4 * order; k++)
    widen_scale(p, run_mean_at(p->run, patch, inside(e, k / (4. * order))));
  return 0;
}

/* The range of B over the leaves. */
static int choose_scale(picture *p) {
  int status = 0;
  p->lo = INFINITY;
  p->hi = -INFINITY;
  for (size_t k = 0; !status && k < hr2d_scene_patches(p->run->scene); k++)
    status = walk_leaves(p->run->hierarchy, k, 0, widen_by_leaf, p);
  if (status) return status;
  p->logarithmic =
      p->hi > 3 * p->lo && p->lo > 0 && (overall(p) - p->lo) / (p->hi - p->lo) < TOO_LOW;
  if (p->hi - p->lo > 1e-9 * fabs(p->hi)) return EXIT_DONE;
  const double margin = p->hi > 0 ? 0.5 * p->hi : 1;
  p->lo = fmax(0, p->lo - margin);
  p->hi += margin;
  return EXIT_DONE;
}

static int draw_page(picture *p) {
  set_grey(p->cr, 1);
  cairo_paint(p->cr);
  draw_title(p);
  int status = draw_links(p);
  if (!status) status = draw_bands(p);
  draw_point(p);
  if (!status) status = draw_names(p);
  draw_legend(p);
  cairo_show_page(p->cr);
  return status;
}

static cairo_surface_t *make_surface(const picture *p, suffix format, FILE *stream) {
  switch (format) {
  case SUFFIX_SVG:
    return cairo_svg_surface_create_for_stream(write_bytes, stream, p->width, p->height);
  case SUFFIX_PDF:
    return cairo_pdf_surface_create_for_stream(write_bytes, stream, p->width, p->height);
  default:
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)(PIXELS_PER_POINT * p->width),
                                      (int)(PIXELS_PER_POINT * p->height));
  }
}

static int draw_file(picture *p, const char *path) {
  const suffix format = suffix_of(path);
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  cairo_surface_t *surface = make_surface(p, format, out.stream);
  p->cr = cairo_create(surface);
  if (format == SUFFIX_PNG) cairo_scale(p->cr, PIXELS_PER_POINT, PIXELS_PER_POINT);
  status = draw_page(p);
  cairo_status_t trouble = cairo_status(p->cr);
  cairo_destroy(p->cr);
  if (format == SUFFIX_PNG && !trouble && !status)
    trouble = cairo_surface_write_to_png_stream(surface, write_bytes, out.stream);
  cairo_surface_finish(surface);
  if (!trouble) trouble = cairo_surface_status(surface);
  cairo_surface_destroy(surface);
  if (trouble && !status && !ferror(out.stream))
    status = fail(path, "cannot be drawn: %s", cairo_status_to_string(trouble));
  return output_close(&out, status);
}

/* Text is measured before the size of the page is known. */
static int measure(picture *p) {
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  p->cr = cairo_create(surface);
  const int status = layout(p);
  cairo_destroy(p->cr);
  cairo_surface_destroy(surface);
  return status;
}

int draw_run(const run *r, const char *path) {
  picture p = {.run = r};
  int status = choose_scale(&p);
  if (!status) status = find_links(&p);
  if (!status) status = choose_names(&p);
  if (!status) status = measure(&p);
  if (!status) status = draw_file(&p, path);
  for (size_t k = 0; k < p.name_count; k++) free(p.name[k].text);
  free(p.strokes);
  free(p.path);
  free(p.region.far);
  free(p.obstacles.lines);
  return status;
}

#else

int draw_check(const char *path) {
  return fail(path, "cannot be drawn: hr2d was built without cairo");
}

int draw_run(const run *r, const char *path) {
  (void)r;
  return draw_check(path);
}

#endif
