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
#include "output/ticks.h"
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

/* What is shown of one place: a number, or three in true colour.  NaN: nothing. */
typedef struct shade {
  double v[3];
} shade;

/* Shades at points of the page, row by row from the top. */
typedef struct raster {
  size_t columns, rows;
  double x, y; /* the first point on the page */
  double step; /* points between two of them */
  double work; /* triangles of the plane per point, where none is interpolated */
  shade *at;
} raster;

/* An isoline on the page. */
typedef struct contour {
  double level;
  hr2d_point *point;
  size_t count;
  double length;
} contour;

typedef struct contours {
  contour *items;
  size_t count;
  ticks levels;
} contours;

#define CONTOUR_WIDTH 0.9
#define ARROW_KEY     530.0 /* points from the left that the key of arrows takes */

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
  double min, max; /* distances of centres */
  double extent;   /* total length */
} region;

/* The patches along a side of the tiles, and where each begins, in element units. */
typedef struct axis {
  size_t first, end;
  double *start; /* of each, and of their end */
} axis;

/* Links as tiles of a rectangle on the page. */
typedef struct tiling {
  const run_links *links;
  axis columns, rows; /* one patch each, or all patches */
  box frame;
} tiling;

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
  hr2d_point size;   /* of the scene, or of the part that is shown, in element units */
  int part;          /* the picture shows no more than that part */
  size_t going_on;   /* patches that are left out of it, */
  box whole;         /* and the bounds of all, in element units */
  box frame;         /* the part of the page that is for the scene */
  int flat;          /* the legend lies below the scene */
  double band;       /* thickness of the coloured bands */
  light quantity;
  int kernel;      /* colours are of the mean kernel of links, not of light */
  int filled;      /* with the light between the patches */
  int coloured;    /* bands show B; otherwise they are left out */
  int rgb;         /* in true colour, */
  double exposure; /* times B or M */
  double lo, hi;   /* of the colour scale */
  double levels;   /* so many colours of the scale are used to fill */
  int logarithmic;
  double work;   /* of a view, in triangles of the plane */
  int beyond;    /* there is more than `hi`, in the colour of `hi` */
  raster raster; /* of the light, if it is drawn */
  contours contours;
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
  tiling tiling;
} picture;

#define TREE_GAP 5.0 /* between a patch and the tree behind it */

/* Functions that return an int return 0, or the exit status after an error message. */

/* draw.c: writes a page as a whole file, or not at all. */
int draw_file(picture *p, const char *path, int (*page)(picture *p));

/* The size of a page depends on the size of its text: calls `layout` with a surface to measure
   it on. */
int draw_measure(picture *p, int (*layout)(picture *p));

/* shade.c: which bands and quantity are shown. */
void shade_choose(picture *p);

/* The shade of B or M, by the values of all bands. */
typedef double (*shade_value)(const void *ctx, size_t item, size_t band);
shade shade_of(const picture *p, shade_value get, const void *ctx, size_t item);

/* The shade of B on an element, and at a point of a patch. */
shade shade_of_element(const picture *p, uint32_t element);
shade shade_of_point(const picture *p, size_t patch, double t);

/* The number of a shade; of true colour the mean of the three. */
double shade_number(const picture *p, shade s);

/* scale.c: the range of colours, by B over the leaves and, where the picture is filled, by
   the light at some points. */
int scale_choose(picture *p);

/* The place of a value on the colour scale, in [0,1]. */
double scale_position(const picture *p, double value);

/* The colour of a shade, and of a place on the scale. */
colour scale_colour(const picture *p, shade s);
colour scale_colour_at(const picture *p, double position);

/* raster.c: looks from points of the frame, `step` points apart, with a tolerance as in
   hr2d_field_grid. */
int raster_make(const picture *p, double step, double tolerance, raster *to);

/* fill.c: the light between the patches. */
int fill_make(picture *p);
void fill_draw(const picture *p);

/* contours.c: with --contours, isolines of the light. */
int contours_make(picture *p);
void contours_draw(const picture *p);
void contours_release(picture *p);

/* Black or white, whatever can be read on the colour of a level. */
colour contours_ink(const picture *p, double level);

/* contour-labels.c: their numbers. */
int contours_label(picture *p);

/* arrows.c: with --arrows, the direction of the flux, and what it means. */
int arrows_draw(picture *p);
void arrows_draw_key(const picture *p);

/* layout.c: page size, scale and strokes. */
int layout_make(picture *p);

/* extent.c: which part of the plane is shown, `low` and `size`; and what else there is. */
int extent_choose(picture *p);
void extent_draw_note(const picture *p);

/* Parts of that: `low` and `size` of all; and, where scale and origin are known, the strokes.
 */
void layout_bounds(picture *p);
int layout_strokes(picture *p);

/* A point in element units, on the page. */
hr2d_point layout_point(const picture *p, hr2d_point element);

/* A point of a stroke, and a dot there. */
hr2d_point layout_along(const stroke *s, double t);
void layout_draw_dot(const picture *p, const stroke *s, double t);

/* A point of the page in scene coordinates. */
hr2d_point layout_scene_point(const picture *p, double x, double y);

/* The height of the trees behind patches; 0 if no links are drawn. */
double layout_tree_height(const picture *p);

/* joints.c: the thickness of the bands, cuts and twins; layout.c calls it. */
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

/* images.c: what is around a cell; nothing without mirrors and a period. */
void images_draw(const picture *p);

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

/* tiles.c: which patches the sides of the tiles have; their rectangle in a part of the page;
   and the scale of colours for some links. */
int tiles_make(picture *p);
void tiles_place(picture *p, box room);
int tiles_scale(picture *p, const run_links *links);
int tiles_draw(const picture *p);
void tiles_release(picture *p);

/* title.c */
double title_width(const picture *p);
void title_draw(const picture *p);

/* legend.c: the scale of lengths, and keys to what is drawn; calls the next. */
void legend_draw(const picture *p);

/* legend-scale.c: what the colours mean. */
void legend_draw_scale(const picture *p);

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

/* The outlines of a text become the path. */
void pen_text_path(cairo_t *cr, double x, double y, const char *text);

#endif
#endif
