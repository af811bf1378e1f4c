/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pixels FILE [X Y]...: the width and height of a PNG, and the red, green, blue and opacity of
   each of these pixels, 0 to 255, a line each.  Exits with 1 if the file is no PNG, with 77 if
   this program has been built without cairo. */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#if HAVE_CAIRO
#include <cairo.h>

static void print_pixel(cairo_surface_t *image, long x, long y) {
  const unsigned char *row =
      cairo_image_surface_get_data(image) + y * cairo_image_surface_get_stride(image);
  const uint32_t c = ((const uint32_t *)(const void *)row)[x];
  const int opaque = cairo_image_surface_get_format(image) == CAIRO_FORMAT_RGB24;
  printf("%u %u %u %u\n", c >> 16 & 255, c >> 8 & 255, c & 255, opaque ? 255 : c >> 24);
}

int main(int argc, char **argv) {
  if (argc < 2 || argc % 2) return 2;
  cairo_surface_t *image = cairo_image_surface_create_from_png(argv[1]);
  const int failed = cairo_surface_status(image) != CAIRO_STATUS_SUCCESS;
  const int width = failed ? 0 : cairo_image_surface_get_width(image);
  const int height = failed ? 0 : cairo_image_surface_get_height(image);
  int outside = 0;
  if (!failed) printf("%d %d\n", width, height);
  for (int k = 2; k < argc && !failed; k += 2) {
    const long x = strtol(argv[k], NULL, 10), y = strtol(argv[k + 1], NULL, 10);
    if (x < 0 || y < 0 || x >= width || y >= height)
      outside = 1;
    else
      print_pixel(image, x, y);
  }
  cairo_surface_destroy(image);
  return failed || outside;
}

#else

int main(void) {
  return 77;
}

#endif
