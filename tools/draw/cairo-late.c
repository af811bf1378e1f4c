/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions with the names and types of cairo's, which call those of a library that is loaded
   when it is needed.  What draws is written and compiled as if it were linked with cairo. */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <stddef.h>

#include "draw/cairo-late.h"

#if HAVE_CAIRO && HAVE_LATE_CAIRO
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <dlfcn.h>

#define CAIRO_LIBRARY "libcairo.so.2" /* the name of its interface, the same since 2003 */

/* The functions that pictures call. */
#define CAIRO_ACTS(X)                                                                          \
  X(arc, (cairo_t * cr, double xc, double yc, double radius, double angle1, double angle2),    \
    (cr, xc, yc, radius, angle1, angle2))                                                      \
  X(clip, (cairo_t * cr), (cr))                                                                \
  X(close_path, (cairo_t * cr), (cr))                                                          \
  X(destroy, (cairo_t * cr), (cr))                                                             \
  X(fill, (cairo_t * cr), (cr))                                                                \
  X(fill_preserve, (cairo_t * cr), (cr))                                                       \
  X(line_to, (cairo_t * cr, double x, double y), (cr, x, y))                                   \
  X(move_to, (cairo_t * cr, double x, double y), (cr, x, y))                                   \
  X(new_path, (cairo_t * cr), (cr))                                                            \
  X(new_sub_path, (cairo_t * cr), (cr))                                                        \
  X(paint, (cairo_t * cr), (cr))                                                               \
  X(pattern_add_color_stop_rgb,                                                                \
    (cairo_pattern_t * pattern, double offset, double red, double green, double blue),         \
    (pattern, offset, red, green, blue))                                                       \
  X(pattern_destroy, (cairo_pattern_t * pattern), (pattern))                                   \
  X(pdf_surface_set_metadata,                                                                  \
    (cairo_surface_t * surface, cairo_pdf_metadata_t metadata, const char *utf8),              \
    (surface, metadata, utf8))                                                                 \
  X(rectangle, (cairo_t * cr, double x, double y, double width, double height),                \
    (cr, x, y, width, height))                                                                 \
  X(restore, (cairo_t * cr), (cr))                                                             \
  X(rotate, (cairo_t * cr, double angle), (cr, angle))                                         \
  X(save, (cairo_t * cr), (cr))                                                                \
  X(scale, (cairo_t * cr, double sx, double sy), (cr, sx, sy))                                 \
  X(select_font_face,                                                                          \
    (cairo_t * cr, const char *family, cairo_font_slant_t slant, cairo_font_weight_t weight),  \
    (cr, family, slant, weight))                                                               \
  X(set_antialias, (cairo_t * cr, cairo_antialias_t antialias), (cr, antialias))               \
  X(set_dash, (cairo_t * cr, const double *dashes, int num_dashes, double offset),             \
    (cr, dashes, num_dashes, offset))                                                          \
  X(set_font_size, (cairo_t * cr, double size), (cr, size))                                    \
  X(set_line_cap, (cairo_t * cr, cairo_line_cap_t line_cap), (cr, line_cap))                   \
  X(set_line_join, (cairo_t * cr, cairo_line_join_t line_join), (cr, line_join))               \
  X(set_line_width, (cairo_t * cr, double width), (cr, width))                                 \
  X(set_source, (cairo_t * cr, cairo_pattern_t * source), (cr, source))                        \
  X(set_source_rgb, (cairo_t * cr, double red, double green, double blue),                     \
    (cr, red, green, blue))                                                                    \
  X(set_source_rgba, (cairo_t * cr, double red, double green, double blue, double alpha),      \
    (cr, red, green, blue, alpha))                                                             \
  X(set_source_surface, (cairo_t * cr, cairo_surface_t * surface, double x, double y),         \
    (cr, surface, x, y))                                                                       \
  X(show_page, (cairo_t * cr), (cr))                                                           \
  X(show_text, (cairo_t * cr, const char *utf8), (cr, utf8))                                   \
  X(stroke, (cairo_t * cr), (cr))                                                              \
  X(stroke_preserve, (cairo_t * cr), (cr))                                                     \
  X(surface_destroy, (cairo_surface_t * surface), (surface))                                   \
  X(surface_finish, (cairo_surface_t * surface), (surface))                                    \
  X(surface_flush, (cairo_surface_t * surface), (surface))                                     \
  X(surface_mark_dirty, (cairo_surface_t * surface), (surface))                                \
  X(text_extents, (cairo_t * cr, const char *utf8, cairo_text_extents_t *extents),             \
    (cr, utf8, extents))                                                                       \
  X(text_path, (cairo_t * cr, const char *utf8), (cr, utf8))                                   \
  X(translate, (cairo_t * cr, double tx, double ty), (cr, tx, ty))

#define CAIRO_ANSWERS(X)                                                                       \
  X(cairo_t *, create, (cairo_surface_t * target), (target))                                   \
  X(cairo_surface_t *, get_target, (cairo_t * cr), (cr))                                       \
  X(cairo_surface_t *, image_surface_create, (cairo_format_t format, int width, int height),   \
    (format, width, height))                                                                   \
  X(unsigned char *, image_surface_get_data, (cairo_surface_t * surface), (surface))           \
  X(int, image_surface_get_stride, (cairo_surface_t * surface), (surface))                     \
  X(cairo_pattern_t *, pattern_create_linear, (double x0, double y0, double x1, double y1),    \
    (x0, y0, x1, y1))                                                                          \
  X(cairo_surface_t *, pdf_surface_create_for_stream,                                          \
    (cairo_write_func_t write_func, void *closure, double width_in_points,                     \
     double height_in_points),                                                                 \
    (write_func, closure, width_in_points, height_in_points))                                  \
  X(cairo_status_t, status, (cairo_t * cr), (cr))                                              \
  X(const char *, status_to_string, (cairo_status_t status), (status))                         \
  X(cairo_surface_type_t, surface_get_type, (cairo_surface_t * surface), (surface))            \
  X(cairo_status_t, surface_status, (cairo_surface_t * surface), (surface))                    \
  X(cairo_status_t, surface_write_to_png_stream,                                               \
    (cairo_surface_t * surface, cairo_write_func_t write_func, void *closure),                 \
    (surface, write_func, closure))                                                            \
  X(cairo_surface_t *, svg_surface_create_for_stream,                                          \
    (cairo_write_func_t write_func, void *closure, double width_in_points,                     \
     double height_in_points),                                                                 \
    (write_func, closure, width_in_points, height_in_points))

#define DEFINE_ACT(name, parameters, arguments)                                                \
  static void(*found_##name) parameters;                                                       \
  void cairo_##name parameters {                                                               \
    found_##name arguments;                                                                    \
  }
CAIRO_ACTS(DEFINE_ACT)

#define DEFINE_ANSWER(type, name, parameters, arguments)                                       \
  static type(*found_##name) parameters;                                                       \
  type cairo_##name parameters {                                                               \
    return found_##name arguments;                                                             \
  }
CAIRO_ANSWERS(DEFINE_ANSWER)

/* POSIX lets a pointer to a function be written through one to an object. */
#define FIND(name)                                     (*(void **)(&found_##name) = dlsym(library, "cairo_" #name))
#define FIND_ACT(name, parameters, arguments)          &&FIND(name)
#define FIND_ANSWER(type, name, parameters, arguments) &&FIND(name)

const char *cairo_late_load(void) {
  void *library = dlopen(CAIRO_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  const int found = library CAIRO_ACTS(FIND_ACT) CAIRO_ANSWERS(FIND_ANSWER);
  return found ? NULL : dlerror();
}

#else

const char *cairo_late_load(void) {
  return NULL;
}

#endif
