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

/* A patch on the page.  Its coloured band lies between the line a→b and the same line moved by
   `band` along the front normal; where patches meet, the bands are mitred. */
typedef struct stroke {
  hr2d_point a, b;
  hr2d_point front; /* unit normal */
  double length;
  double cut_a, cut_b; /* how much shorter the inner edge is at each end */
  int twin;            /* another patch lies behind it, back to back */
} stroke;

typedef struct line {
  hr2d_point a, b;
} line;

typedef struct box {
  double x0, y0, x1, y1;
} box;

/* The lines that labels must keep clear of. */
typedef struct obstacles {
  line *lines;
  size_t count, capacity;
} obstacles;

/* A linked element, and its start on its patch in element units. */
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

/* A name, and the patch beside which it is written. */
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
  unsigned seen; /* bit 1 << s for each hr2d_seen s at which a drawn beam ends */
  obstacles obstacles;
} picture;

#define TREE_GAP 5.0 /* between a patch and the tree behind it */

/* Functions that return an int return 0, or the exit status after an error message. */

/* scale.c: the range of B over the leaves, and whether the colour scale is logarithmic. */
int scale_choose(picture *p);

/* The place of a value on the colour scale, in [0,1]. */
double scale_position(const picture *p, double value);

/* layout.c: page size, scale and strokes. */
int layout_make(picture *p);

/* A point in element units, on the page. */
hr2d_point layout_point(const picture *p, hr2d_point element);

/* A point of a stroke, and a dot there. */
hr2d_point layout_along(const stroke *s, double t);
void layout_draw_dot(const picture *p, const stroke *s, double t);

/* The part of the page that has neither title nor legend. */
box layout_frame(const picture *p);

/* The height of the trees behind patches; 0 if no links are drawn. */
double layout_tree_height(const picture *p);

/* joints.c: the thickness of the bands, cuts and twins. */
void joints_make(picture *p);

/* The distance of a point from a stroke. */
double joints_distance(hr2d_point q, const stroke *s);

/* bands.c */
int bands_draw(picture *p);

/* labels.c: chooses the names to be written; the caller frees their texts. */
int labels_choose(picture *p);
int labels_draw(picture *p);

/* links.c: the links that serve the point of --links-of, and the point. */
int links_find(picture *p);
int links_draw(picture *p);
void links_draw_point(const picture *p);

/* beams.c: what the points of --beams-of see, these points, and what the colours mean. */
int beams_draw(picture *p);
void beams_draw_points(const picture *p);
void beams_draw_key(const picture *p);

/* neighbours.c: with --link-level, the elements that are linked to the one of this level. */
int neighbours_note(picture *p, uint32_t far);
void neighbours_measure(picture *p);
int neighbours_draw(picture *p);
int neighbours_draw_parents(picture *p);
void neighbours_draw_key(const picture *p);

/* legend.c */
void legend_draw_title(const picture *p);
void legend_draw(const picture *p);

/* obstacles.c: adds a line that labels must not cross, or the diagonals of a box. */
int obstacles_add(picture *p, hr2d_point a, hr2d_point b);
int obstacles_add_box(picture *p, const box *b);

/* Whether any obstacle meets a box. */
int obstacles_meet(const picture *p, const box *b);

/* pen.c: colours and text. */
void pen_colour(cairo_t *cr, colour c);
void pen_grey(cairo_t *cr, double grey);
void pen_font(cairo_t *cr, double size, int bold);
double pen_text_width(cairo_t *cr, const char *text);
void pen_write(cairo_t *cr, double x, double y, const char *text);

#endif
#endif
