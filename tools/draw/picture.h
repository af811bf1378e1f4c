/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page with a scene on it.  Lengths on the page are points, 1/72 inch, y downwards. */
#ifndef HR2D_TOOLS_DRAW_PICTURE_H
#define HR2D_TOOLS_DRAW_PICTURE_H

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <stddef.h>
#include <stdint.h>

#include "output/palette.h"
#include "run/run.h"

#if HAVE_CAIRO
#include <cairo.h>

/* A patch on the page: the coloured band lies between a→b and the same line moved by
   `band` along the front normal, mitred where patches meet. */
typedef struct stroke {
  hr2d_point a, b;
  hr2d_point front; /* unit normal */
  double length;
  double cut_a, cut_b; /* by how much the inner edge is shorter at either end */
  int twin;            /* another patch lies behind it, back to back */
} stroke;

typedef struct line {
  hr2d_point a, b;
} line;

/* What labels must keep clear of. */
typedef struct obstacles {
  line *lines;
  size_t count, capacity;
} obstacles;

/* A linked element, and where it starts on its patch, in element units. */
typedef struct neighbour {
  uint32_t element, patch;
  double start;
} neighbour;

/* The elements linked to one element; lengths in element units. */
typedef struct region {
  neighbour *far;
  size_t count;
  double least, most; /* distances of centres */
  double extent;      /* total length */
} region;

enum { MAX_NAMES = 24 };

/* A name, and the patch it is written beside. */
typedef struct caption {
  size_t patch;
  char *text;
} caption;

typedef struct picture {
  cairo_t *cr;
  const run *run;
  double width, height;
  double scale;      /* points per element unit */
  hr2d_point low;    /* lower left corner of the scene, in element units */
  hr2d_point origin; /* where `low` is on the page */
  double band;       /* thickness of the coloured bands */
  double lo, hi;     /* of the colour scale */
  int logarithmic;
  caption name[MAX_NAMES];
  size_t name_count;
  stroke *strokes;             /* one per patch */
  uint32_t *path;              /* the elements that hold the point of --links-of, leaf first */
  size_t path_count;           /* 0: no links are drawn; 1 with --link-level */
  region region;               /* filled with --link-level */
  unsigned level_lo, level_hi; /* of the linked elements of other patches */
  double tree_step;            /* distance of two levels in the trees behind patches */
  unsigned tree_levels;
  obstacles obstacles;
} picture;

#define TREE_GAP 5.0 /* between a patch and the tree behind it */

/* layout.c: page size, scale and strokes.  Returns 0 or EXIT_FAILED. */
int layout(picture *p);
hr2d_point on_page(const picture *p, hr2d_point element);
double tree_height(const picture *p);

/* joints.c: the thickness of the bands, cuts and twins. */
void join_strokes(picture *p);

/* The distance of a point from a stroke. */
double to_stroke(hr2d_point q, const stroke *s);

/* labels.c: which names are written; the texts are to be freed. */
int choose_names(picture *p);

/* bands.c, draw-links.c, labels.c, legend.c: onto the page. */
int draw_bands(picture *p);
int find_links(picture *p);
int draw_links(picture *p);
void draw_point(const picture *p);
int draw_names(picture *p);
void draw_title(const picture *p);
void draw_legend(const picture *p);

/* draw-neighbours.c: with --link-level. */
int note_neighbour(picture *p, uint32_t far);
void measure_region(picture *p);
int draw_region(picture *p);
int draw_parents(picture *p);
void draw_region_key(const picture *p);

/* The place of a value on the colour scale, in [0,1]. */
double on_scale(const picture *p, double value);

/* Remembers a line that labels must not cross; returns 0 or EXIT_FAILED. */
int add_obstacle(picture *p, hr2d_point a, hr2d_point b);

void set_colour(cairo_t *cr, colour c);
void set_grey(cairo_t *cr, double grey);
void set_font(cairo_t *cr, double size, int bold);
double text_width(cairo_t *cr, const char *text);

#endif
#endif
