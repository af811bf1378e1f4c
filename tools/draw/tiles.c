/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rectangle that the algorithm subdivides: a point of it is a pair of points of two
   patches, and each link is a tile, in the colour of its mean kernel.  What does not see each
   other stays white.  Of two patches it is their rectangle, of more the square of all. */
#include "draw/draw.h"
#include "draw/picture.h"
#include "output/complain.h"
#include "run/leaves.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>

#define TITLE   62.0
#define LEFT    50.0 /* with the names of rows */
#define FOOT    50.0 /* with the names of columns */
#define LEGEND  124.0
#define LONGEST 560.0 /* of the sides */
#define LEAST   0.1   /* of the longer side has the shorter one at least */
#define FONT    10.0
#define TICK    5.0 /* the ends of leaves beside the tiles */
#define LINE    0.5 /* between tiles, patches and ticks */
#define WIDE    5.0 /* what is narrower has thinner lines */
#define PIXELS  2.0 /* in a point, of tiles that are an image */

/* The parts of the area of all tiles that may lie outside of the scale of colours: the kernel
   has no bound where patches meet.  And so many powers of ten, at most. */
#define DARKEST   0.005
#define BRIGHTEST 0.995
#define DECADES   4.0

/* More links are an image in SVG and PDF, too: a tile takes 0.5 kB of an SVG. */
enum { MOST_VECTORS = 20000 };

/* An interval of an axis. */
typedef struct span {
  double from, to;
} span;

static const hr2d_element *element_of(const picture *p, uint32_t number) {
  return &hr2d_hierarchy_elements(p->run->hierarchy)[number];
}

static double distance(hr2d_point a, hr2d_point b) {
  return hypot(b.x - a.x, b.y - a.y);
}

static int make_axis(const picture *p, size_t first, size_t end, axis *to) {
  *to = (axis){first, end, malloc((end - first + 1) * sizeof *to->start)};
  if (!to->start) return complain_memory();
  to->start[0] = 0;
  for (size_t k = first; k < end; k++)
    to->start[k - first + 1] = to->start[k - first] + element_of(p, (uint32_t)k)->length;
  return EXIT_DONE;
}

static double length_of(const axis *a) {
  return a->start[a->end - a->first];
}

int tiles_make(picture *p) {
  const size_t patches = hr2d_scene_patches(p->run->scene);
  const int pair = patches == 2;
  const int status = make_axis(p, 0, pair ? 1 : patches, &p->tiling.columns);
  return status ? status : make_axis(p, pair, patches, &p->tiling.rows);
}

void tiles_release(picture *p) {
  free(p->tiling.columns.start);
  free(p->tiling.rows.start);
}

void tiles_place(picture *p, box room) {
  const double width = length_of(&p->tiling.columns), height = length_of(&p->tiling.rows);
  const double longer = fmax(width, height);
  const double scale = fmin((room.x1 - room.x0) / fmax(width, LEAST * longer),
                            (room.y1 - room.y0) / fmax(height, LEAST * longer));
  const double half_width = 0.5 * scale * fmax(width, LEAST * longer);
  const double half_height = 0.5 * scale * fmax(height, LEAST * longer);
  const double x = 0.5 * (room.x0 + room.x1), y = 0.5 * (room.y0 + room.y1);
  p->tiling.frame = (box){x - half_width, y - half_height, x + half_width, y + half_height};
}

/* The kernel has the unit of 1/length. */
static double mean_kernel(const picture *p, const run_link *link) {
  const double unit = hr2d_scene_unit(p->run->scene);
  const double near = element_of(p, link->near)->length, far = element_of(p, link->far)->length;
  return link->exchange_area / unit / near / (unit * far);
}

/* The mean kernel of a tile, and its area. */
typedef struct weighed {
  double mean, area;
} weighed;

static int ascending(const void *left, const void *right) {
  const double a = ((const weighed *)left)->mean, b = ((const weighed *)right)->mean;
  return (a > b) - (a < b);
}

/* Sorted by the kernel, what so large a part of their area does not exceed. */
static double quantile(const weighed *tile, size_t count, double part) {
  double all = 0, area = 0;
  size_t k = 0;
  for (size_t n = 0; n < count; n++) all += tile[n].area;
  while (k + 1 < count && (area += tile[k].area) < part * all) k++;
  return count ? tile[k].mean : 0;
}

static void choose_scale(picture *p, const weighed *tile, size_t count) {
  const double lo = quantile(tile, count, DARKEST), hi = quantile(tile, count, BRIGHTEST);
  p->kernel = p->coloured = 1;
  p->filled = p->rgb = 0;
  p->quantity = QUANTITY_MEAN;
  p->logarithmic = lo > 0 && hi > 10 * lo;
  p->lo = p->logarithmic ? fmax(lo, hi * pow(10, -DECADES)) : 0;
  p->hi = hi > 0 ? hi : 1;
  p->beyond = count && tile[count - 1].mean > p->hi;
}

int tiles_scale(picture *p, const run_links *links) {
  weighed *tile = malloc((links->count + 1) * sizeof *tile);
  if (!tile) return complain_memory();
  for (size_t k = 0; k < links->count; k++) {
    const run_link *link = &links->items[k];
    tile[k].mean = mean_kernel(p, link);
    tile[k].area = element_of(p, link->near)->length * element_of(p, link->far)->length;
  }
  qsort(tile, links->count, sizeof *tile, ascending);
  choose_scale(p, tile, links->count);
  free(tile);
  return EXIT_DONE;
}

/* Where an element lies on an axis; nowhere if the axis has not its patch. */
static int find_span(const picture *p, const axis *a, uint32_t number, span *to) {
  const hr2d_element *e = element_of(p, number), *root = element_of(p, e->patch);
  if (e->patch < a->first || e->patch >= a->end) return 0;
  const double start = a->start[e->patch - a->first];
  *to = (span){start + distance(root->a, e->a), start + distance(root->a, e->b)};
  return 1;
}

/* On the page y points downwards, and rows go up. */
static double page_x(const picture *p, double at) {
  const box *f = &p->tiling.frame;
  return f->x0 + at / length_of(&p->tiling.columns) * (f->x1 - f->x0);
}

static double page_y(const picture *p, double at) {
  const box *f = &p->tiling.frame;
  return f->y1 - at / length_of(&p->tiling.rows) * (f->y1 - f->y0);
}

/* So much of an axis, in points. */
static double on_page(const picture *p, int row, double length) {
  return row ? page_y(p, 0) - page_y(p, length) : page_x(p, length) - page_x(p, 0);
}

static int find_tile(const picture *p, uint32_t column, uint32_t row, box *to) {
  span x, y;
  if (!find_span(p, &p->tiling.columns, column, &x)) return 0;
  if (!find_span(p, &p->tiling.rows, row, &y)) return 0;
  *to = (box){page_x(p, x.from), page_y(p, y.to), page_x(p, x.to), page_y(p, y.from)};
  return 1;
}

/* The part of the picture that lines take goes to 0 where everything is small. */
static double line_width(double narrow) {
  const double part = fmin(1, narrow / WIDE);
  return LINE * part * part;
}

/* Neighbours share pixels without a gap. */
static void fill_tile(const picture *p, const run_link *link, const box *b) {
  cairo_rectangle(p->cr, b->x0, b->y0, b->x1 - b->x0, b->y1 - b->y0);
  pen_colour(p->cr, scale_colour_at(p, scale_position(p, mean_kernel(p, link))));
  cairo_fill(p->cr);
}

static void outline_tile(const picture *p, const run_link *link, const box *b) {
  (void)link;
  cairo_rectangle(p->cr, b->x0, b->y0, b->x1 - b->x0, b->y1 - b->y0);
  pen_grey(p->cr, 1);
  cairo_set_line_width(p->cr, line_width(fmin(b->x1 - b->x0, b->y1 - b->y0)));
  cairo_stroke(p->cr);
}

/* In a square each link has two tiles, one for each direction. */
static void each_tile(const picture *p,
                      void (*draw)(const picture *p, const run_link *link, const box *b)) {
  for (size_t k = 0; k < p->tiling.links->count; k++) {
    const run_link *link = &p->tiling.links->items[k];
    box b;
    if (find_tile(p, link->near, link->far, &b)) draw(p, link, &b);
    if (find_tile(p, link->far, link->near, &b)) draw(p, link, &b);
  }
}

/* A tick along an axis at the end of a leaf, or a line through all tiles between two patches.
 */
static void draw_mark(const picture *p, int row, double at, double length) {
  const box *f = &p->tiling.frame;
  if (row) {
    cairo_move_to(p->cr, length > 0 ? f->x0 - length : f->x1, page_y(p, at));
    cairo_line_to(p->cr, f->x0, page_y(p, at));
  } else {
    cairo_move_to(p->cr, page_x(p, at), length > 0 ? f->y1 + length : f->y0);
    cairo_line_to(p->cr, page_x(p, at), f->y1);
  }
  cairo_stroke(p->cr);
}

/* The side whose leaves are drawn, and the patch in it. */
typedef struct leaf_side {
  const picture *p;
  const axis *of;
  int row;
  size_t patch;
} leaf_side;

static int draw_leaf(void *ctx, const piece *leaf) {
  const leaf_side *s = ctx;
  const double *start = &s->of->start[s->patch - s->of->first];
  const double end = start[0] + leaf->t1 * (start[1] - start[0]);
  cairo_set_line_width(
      s->p->cr,
      line_width(on_page(s->p, s->row, (leaf->t1 - leaf->t0) * (start[1] - start[0]))));
  draw_mark(s->p, s->row, end, TICK);
  return 0;
}

static int draw_leaves(const picture *p, const axis *a, int row) {
  leaf_side s = {p, a, row, a->first};
  int status = 0;
  pen_grey(p->cr, 0.3);
  cairo_set_line_width(p->cr, LINE);
  draw_mark(p, row, 0, TICK);
  for (; !status && s.patch < a->end; s.patch++)
    status = leaves_walk(p->run->hierarchy, s.patch, 0, draw_leaf, &s);
  return status;
}

static void draw_borders(const picture *p, const axis *a, int row) {
  pen_grey(p->cr, 0.6);
  for (size_t k = 1; k < a->end - a->first; k++) {
    const double *at = &a->start[k];
    cairo_set_line_width(p->cr,
                         line_width(on_page(p, row, fmin(at[0] - at[-1], at[1] - at[0]))));
    draw_mark(p, row, *at, 0);
  }
}

/* The name of each patch that has room for it. */
static void write_names(const picture *p, const axis *a, int row) {
  const box *f = &p->tiling.frame;
  pen_font(p->cr, FONT, 0);
  pen_grey(p->cr, 0.1);
  for (size_t k = a->first; k < a->end; k++) {
    const double *start = &a->start[k - a->first];
    const char *name = hr2d_scene_name(p->run->scene, k);
    const double width = pen_text_width(p->cr, name);
    const double room = on_page(p, row, start[1] - start[0]);
    const double middle = 0.5 * (start[0] + start[1]);
    if (width + 4 > room) continue;
    cairo_save(p->cr);
    cairo_translate(p->cr, row ? f->x0 - 2 * TICK : page_x(p, middle),
                    row ? page_y(p, middle) : f->y1 + TICK + FONT + 2);
    if (row) cairo_rotate(p->cr, -1.5707963267948966);
    pen_write(p->cr, -0.5 * width, 0, name);
    cairo_restore(p->cr);
  }
}

static void draw_each(const picture *p) {
  cairo_set_antialias(p->cr, CAIRO_ANTIALIAS_NONE);
  each_tile(p, fill_tile);
  cairo_set_antialias(p->cr, CAIRO_ANTIALIAS_DEFAULT);
  each_tile(p, outline_tile);
}

static void draw_as_image(const picture *p) {
  const box *f = &p->tiling.frame;
  picture image = *p;
  cairo_surface_t *surface =
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, (int)ceil(PIXELS * (f->x1 - f->x0)),
                                 (int)ceil(PIXELS * (f->y1 - f->y0)));
  image.cr = cairo_create(surface);
  cairo_scale(image.cr, PIXELS, PIXELS);
  cairo_translate(image.cr, -f->x0, -f->y0);
  draw_each(&image);
  cairo_destroy(image.cr);
  cairo_save(p->cr);
  cairo_translate(p->cr, f->x0, f->y0);
  cairo_scale(p->cr, 1 / PIXELS, 1 / PIXELS);
  cairo_set_source_surface(p->cr, surface, 0, 0);
  cairo_paint(p->cr);
  cairo_restore(p->cr);
  cairo_surface_destroy(surface);
}

int tiles_draw(const picture *p) {
  const box *f = &p->tiling.frame;
  const int pixels =
      cairo_surface_get_type(cairo_get_target(p->cr)) == CAIRO_SURFACE_TYPE_IMAGE;
  if (pixels || p->tiling.links->count <= MOST_VECTORS)
    draw_each(p);
  else
    draw_as_image(p);
  draw_borders(p, &p->tiling.columns, 0);
  draw_borders(p, &p->tiling.rows, 1);
  int status = draw_leaves(p, &p->tiling.columns, 0);
  if (!status) status = draw_leaves(p, &p->tiling.rows, 1);
  cairo_rectangle(p->cr, f->x0, f->y0, f->x1 - f->x0, f->y1 - f->y0);
  pen_grey(p->cr, 0.25);
  cairo_set_line_width(p->cr, LINE);
  cairo_stroke(p->cr);
  return status;
}

static int layout(picture *p) {
  tiles_place(p, (box){LEFT, TITLE, LEFT + LONGEST, TITLE + LONGEST});
  const box f = p->tiling.frame;
  const double width = f.x1 - f.x0, height = f.y1 - f.y0;
  p->width = ceil(fmax(title_width(p), LEFT + width + LEGEND));
  p->height = ceil(TITLE + fmax(height, 180) + FOOT);
  p->tiling.frame = (box){LEFT, TITLE, LEFT + width, TITLE + height};
  return EXIT_DONE;
}

static int draw_page(picture *p) {
  title_draw(p);
  const int status = tiles_draw(p);
  write_names(p, &p->tiling.columns, 0);
  write_names(p, &p->tiling.rows, 1);
  if (p->tiling.links->count) legend_draw_scale(p); /* without a kernel there is no scale */
  return status;
}

static int draw_all(const run *r, const run_links *links, const char *path) {
  picture p = {.run = r, .tiling = {.links = links}};
  int status = tiles_make(&p);
  if (!status) status = tiles_scale(&p, links);
  if (!status) status = draw_measure(&p, layout);
  if (!status) status = draw_file(&p, path, draw_page);
  tiles_release(&p);
  return status;
}

int draw_tiles(const run *r, const char *path) {
  run_links links = {NULL, 0};
  int status = run_all_links(r, &links);
  if (!status && run_is_first(r)) status = draw_all(r, &links, path);
  free(links.items);
  return run_agree(r, status);
}

#else

int draw_tiles(const run *r, const char *path) {
  (void)r;
  return draw_check(path);
}

#endif
