/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a run to a picture file, which is written as a whole or not at all. */
#include "draw/draw.h"

#include "draw/picture.h"
#include "output/complain.h"

int draw_check_scene(const options *o, const hr2d_scene *scene) {
  const size_t bands = hr2d_scene_bands(scene);
  if ((o->band == BAND_RGB || o->exposure > 0) && bands != 3)
    return complain_usage("true colour needs a scene of 3 bands, and this one has %zu", bands);
  if (o->band >= 0 && (size_t)o->band >= bands)
    return complain_usage("--band: the scene has no band %d, only 0 to %zu", o->band,
                          bands - 1);
  return EXIT_DONE;
}

#if HAVE_CAIRO
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <stdlib.h>

#include "draw/cairo-late.h"
#include "output/metadata.h"
#include "output/output.h"
#include "output/provenance.h"
#include "output/suffix.h"

#define PIXELS_PER_POINT 2.0

int draw_check(const char *path) {
  const char *trouble = path ? cairo_late_load() : NULL;
  return trouble ? complain(path, "cannot be drawn without cairo: %s", trouble) : EXIT_DONE;
}

static cairo_status_t write_bytes(void *stream, const unsigned char *bytes, unsigned size) {
  return fwrite(bytes, 1, size, stream) == size ? CAIRO_STATUS_SUCCESS
                                                : CAIRO_STATUS_WRITE_ERROR;
}

static void clip(const picture *p) {
  const box *f = &p->frame;
  cairo_rectangle(p->cr, f->x0, f->y0, f->x1 - f->x0, f->y1 - f->y0);
  cairo_clip(p->cr);
}

static int draw_page(picture *p) {
  title_draw(p);
  cairo_save(p->cr);
  if (p->part) clip(p);
  if (p->filled) fill_draw(p);
  contours_draw(p);
  images_draw(p);
  int status = beams_draw(p);
  if (!status) status = links_draw(p);
  if (!status) status = bands_draw(p);
  links_draw_point(p);
  beams_draw_points(p);
  cairo_restore(p->cr);
  if (!status) status = labels_draw(p);
  if (!status) status = contours_label(p);
  if (!status) status = arrows_draw(p);
  legend_draw(p);
  return status;
}

/* Cairo would write the time into a PDF. */
static cairo_surface_t *make_pdf(const picture *p, FILE *stream) {
  cairo_surface_t *pdf =
      cairo_pdf_surface_create_for_stream(write_bytes, stream, p->width, p->height);
  char *text = provenance_text();
  if (text) cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_SUBJECT, text);
  cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATE_DATE, NULL);
  free(text);
  return pdf;
}

static cairo_surface_t *make_surface(const picture *p, suffix format, FILE *stream) {
  switch (format) {
  case SUFFIX_SVG:
    return cairo_svg_surface_create_for_stream(write_bytes, stream, p->width, p->height);
  case SUFFIX_PDF:
    return make_pdf(p, stream);
  default:
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)(PIXELS_PER_POINT * p->width),
                                      (int)(PIXELS_PER_POINT * p->height));
  }
}

static int draw_into(picture *p, FILE *stream, const char *path, int (*page)(picture *p)) {
  const suffix format = suffix_of(path);
  cairo_surface_t *surface = make_surface(p, format, stream);
  p->cr = cairo_create(surface);
  if (format == SUFFIX_PNG) cairo_scale(p->cr, PIXELS_PER_POINT, PIXELS_PER_POINT);
  pen_grey(p->cr, 1);
  cairo_paint(p->cr);
  const int status = page(p);
  cairo_show_page(p->cr);
  cairo_status_t trouble = cairo_status(p->cr);
  cairo_destroy(p->cr);
  if (format == SUFFIX_PNG && !trouble && !status)
    trouble = cairo_surface_write_to_png_stream(surface, write_bytes, stream);
  cairo_surface_finish(surface);
  if (!trouble) trouble = cairo_surface_status(surface);
  cairo_surface_destroy(surface);
  if (!trouble || status) return status;
  return complain(path, "cannot be drawn: %s", cairo_status_to_string(trouble));
}

int draw_file(picture *p, const char *path, int (*page)(picture *p)) {
  output out;
  char *bytes = NULL;
  size_t size = 0;
  int status = output_open(&out, path);
  if (status) return status;
  FILE *memory = open_memstream(&bytes, &size);
  status = memory ? draw_into(p, memory, path, page) : complain_memory();
  if (memory && fclose(memory) && !status) status = complain_memory();
  if (!status) status = metadata_write(out.stream, suffix_of(path), bytes, size);
  free(bytes);
  return output_close(&out, status);
}

int draw_measure(picture *p, int (*layout)(picture *p)) {
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  p->cr = cairo_create(surface);
  const int status = layout(p);
  cairo_destroy(p->cr);
  cairo_surface_destroy(surface);
  return status;
}

int draw_run(const run *r, const char *path) {
  picture p = {.run = r};
  shade_choose(&p);
  int status = links_find(&p);
  if (!status) status = labels_choose(&p);
  if (!status) status = draw_measure(&p, layout_make);
  if (!status) status = scale_choose(&p);
  if (!status && (p.filled || r->options->contours)) status = fill_make(&p);
  if (!status) status = contours_make(&p);
  if (!status) status = draw_file(&p, path, draw_page);
  for (size_t k = 0; k < p.name_count; k++) free(p.name[k].text);
  free(p.strokes);
  free(p.raster.at);
  contours_release(&p);
  free(p.path);
  free(p.region.far);
  free(p.obstacles.lines);
  return status;
}

#else

int draw_check(const char *path) {
  return path ? complain(path, "cannot be drawn: hr2d was built without cairo") : EXIT_DONE;
}

int draw_run(const run *r, const char *path) {
  (void)r;
  return draw_check(path);
}

#endif
