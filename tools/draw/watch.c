/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The algorithm at work: for falling ε the elements and links of the scene, beside them the
   links as tiles, and the light of the scene, as frames of an animation. */
#include "draw/draw.h"
#include "draw/picture.h"
#include "output/complain.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/scene.h"
#include "output/apng.h"
#include "output/output.h"
#include "output/provenance.h"

#define PIXELS   1.0 /* in a point */
#define WIDTH    1080.0
#define HIGHEST  400.0 /* of a panel */
#define MARGIN   24.0
#define TITLE    84.0
#define FOOT     62.0
#define SHOWN    1000 /* milliseconds */
#define LAST     3000
#define FINE     0.002 /* the tolerance of the light, which is small */
#define LEVELS   28.0  /* colours, as a film of more is large */
#define MOST_INK 9.0   /* the opacity of links, times the square root of their number */

enum { STAGES = 7, MOST_STAGES = 60, MOST_LINES = 1500 };

/* From left to right, each in a column of its own. */
enum { PANEL_LINKS, PANEL_TILES, PANEL_LIGHT, PANELS };

#define COLUMN (WIDTH / PANELS)

/* The bytes of a PNG. */
typedef struct bytes {
  unsigned char *at;
  size_t size, capacity;
} bytes;

typedef struct watch {
  run_links links;  /* of the frame */
  const run *whole; /* the run with --eps, which sets the scale of colours */
  picture page;     /* of the whole run; both scenes have its scale */
  picture tiles;    /* likewise */
  double high;      /* of the panels */
  apng film;
  bytes png;
} watch;

static cairo_status_t keep_bytes(void *ctx, const unsigned char *from, unsigned size) {
  bytes *b = ctx;
  if (b->size + size > b->capacity) {
    const size_t capacity = 2 * (b->size + size);
    unsigned char *more = realloc(b->at, capacity);
    if (!more) return CAIRO_STATUS_NO_MEMORY;
    b->at = more;
    b->capacity = capacity;
  }
  memcpy(b->at + b->size, from, size);
  b->size += size;
  return CAIRO_STATUS_SUCCESS;
}

/* The ε of a frame: those of --multigrid, or halves. */
static double epsilon_of(const options *o, unsigned frame) {
  const double ratio = o->multigrid.ratio > 0 ? o->multigrid.ratio : 0.5;
  const double from =
      o->multigrid.ratio > 0 ? o->multigrid.from : o->epsilon * (1 << (STAGES - 1));
  const double epsilon = from * pow(ratio, frame);
  return epsilon > o->epsilon * (1 + 1e-12) ? epsilon : o->epsilon;
}

static unsigned count_frames(const options *o) {
  unsigned frames = 1;
  while (frames < MOST_STAGES && epsilon_of(o, frames - 1) > o->epsilon) frames++;
  return frames;
}

/* The light is drawn pixel by pixel. */
static double at_pixel(double x) {
  return ceil(PIXELS * x) / PIXELS;
}

/* Where the scene is in its panel. */
static void place_scene(picture *p, int panel, double high) {
  const double width = p->size.x * p->scale, height = p->size.y * p->scale;
  const double x = panel * COLUMN + 0.5 * (COLUMN - width), y = TITLE + 0.5 * (high - height);
  const double out = 0.4 * MARGIN;
  p->origin = (hr2d_point){x, y + height};
  p->frame = (box){at_pixel(x - out), at_pixel(y - out), x + width + out, y + height + out};
}

/* The part of the page for a panel so high. */
static box room_of(int panel, double high) {
  return (box){panel * COLUMN + MARGIN, TITLE, (panel + 1) * COLUMN - MARGIN, TITLE + high};
}

/* The panels are as high as the scene and the tiles need. */
static void set_page(watch *w) {
  picture *p = &w->page, *t = &w->tiles;
  layout_bounds(p);
  p->scale = fmin((COLUMN - 2 * MARGIN) / p->size.x, HIGHEST / p->size.y);
  tiles_place(t, room_of(PANEL_TILES, HIGHEST));
  w->high = fmax(p->size.y * p->scale, t->tiling.frame.y1 - t->tiling.frame.y0);
  tiles_place(t, room_of(PANEL_TILES, w->high));
  p->width = WIDTH;
  t->width = (PANEL_TILES + 1) * COLUMN;
  p->height = t->height = ceil(TITLE + w->high + 0.5 * MARGIN + FOOT);
  p->flat = t->flat = 1;
  place_scene(p, PANEL_LIGHT, w->high);
}

static uint64_t count_links(const run *r) {
  return hr2d_linkset_counts(r->links).links;
}

static void draw_links(const picture *p, const run_links *links) {
  const uint64_t count = count_links(p->run);
  const hr2d_element *elements = hr2d_hierarchy_elements(p->run->hierarchy);
  const double ink = fmin(0.7, fmax(0.15, MOST_INK / sqrt((double)count + 1)));
  const colour c = palette_ember(0.5);
  pen_colour(p->cr, (colour){1 - ink * (1 - c.r), 1 - ink * (1 - c.g), 1 - ink * (1 - c.b)});
  cairo_set_antialias(p->cr, CAIRO_ANTIALIAS_NONE);
  cairo_set_line_width(p->cr, 1 / PIXELS);
  for (size_t k = 0; count <= MOST_LINES && k < links->count; k++) {
    const hr2d_point a = layout_point(p, elements[links->items[k].near].centre);
    const hr2d_point b = layout_point(p, elements[links->items[k].far].centre);
    cairo_move_to(p->cr, a.x, a.y);
    cairo_line_to(p->cr, b.x, b.y);
    cairo_stroke(p->cr);
  }
  cairo_set_antialias(p->cr, CAIRO_ANTIALIAS_DEFAULT);
}

static void write_head(const picture *p, double epsilon) {
  const hr2d_refine_counts n = hr2d_linkset_counts(p->run->links);
  char text[96];
  pen_grey(p->cr, 0.1);
  pen_font(p->cr, 15, 1);
  pen_write(p->cr, MARGIN, 28, scene_file_name(p->run->options));
  snprintf(text, sizeof text, "ε = %.3g", epsilon);
  pen_write(p->cr, 0.5 * WIDTH - 30, 28, text);
  pen_font(p->cr, 12, 0);
  pen_grey(p->cr, 0.3);
  snprintf(text, sizeof text, "%llu elements and %llu links", (unsigned long long)n.elements,
           (unsigned long long)count_links(p->run));
  pen_write(p->cr, MARGIN, 58, text);
  pen_write(p->cr, PANEL_TILES * COLUMN + MARGIN, 58, "the links as tiles");
  pen_write(p->cr, PANEL_LIGHT * COLUMN + MARGIN, 58, "the light that they give");
}

/* Room for the scene at its place on the page; of the light alone the raster is made. */
static int draw_scene(picture *p, const watch *w, int panel) {
  const int lit = panel == PANEL_LIGHT;
  place_scene(p, panel, w->high);
  int status = layout_strokes(p);
  if (!status && lit) status = raster_make(p, 1 / PIXELS, FINE, &p->raster);
  if (!status && lit) fill_draw(p);
  if (!status) images_draw(p);
  if (!status && !lit) draw_links(p, &w->links);
  if (!status) status = bands_draw(p);
  free(p->strokes);
  free(p->raster.at);
  free(p->obstacles.lines);
  p->strokes = NULL;
  p->raster.at = NULL;
  p->obstacles = (obstacles){NULL, 0, 0};
  return status;
}

static int draw_tile_panel(const watch *w, const picture *p) {
  picture t = w->tiles;
  t.run = p->run;
  t.cr = p->cr;
  t.tiling.links = &w->links;
  legend_draw_scale(&t);
  return tiles_draw(&t);
}

static int draw_frame(watch *w, const run *r, double epsilon) {
  picture p = w->page;
  cairo_surface_t *surface = cairo_image_surface_create(
      CAIRO_FORMAT_RGB24, (int)(PIXELS * p.width), (int)(PIXELS * p.height));
  p.run = r;
  p.cr = cairo_create(surface);
  cairo_scale(p.cr, PIXELS, PIXELS);
  pen_grey(p.cr, 1);
  cairo_paint(p.cr);
  write_head(&p, epsilon);
  int status = draw_tile_panel(w, &p);
  if (!status) status = draw_scene(&p, w, PANEL_LINKS);
  if (!status) status = draw_scene(&p, w, PANEL_LIGHT);
  legend_draw_scale(&p);
  w->png.size = 0;
  cairo_status_t trouble = cairo_status(p.cr);
  cairo_destroy(p.cr);
  if (!trouble && !status)
    trouble = cairo_surface_write_to_png_stream(surface, keep_bytes, &w->png);
  cairo_surface_destroy(surface);
  if (trouble && !status)
    status =
        complain(r->options->watch, "cannot be drawn: %s", cairo_status_to_string(trouble));
  return status;
}

/* Refines and solves once more, from what the last frame had. */
static int solve_frame(run *r, double epsilon) {
  hr2d_refine_options refine = run_refine_options(r->options);
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  hr2d_solution *next = NULL;
  refine.epsilon = epsilon;
  refine.threads = options_threads(r->options);
  refine.brightness = r->solution;
  refine.share = r->share;
  hr2d_status status = hr2d_refine(r->own_links, &refine);
  solve.threads = options_threads(r->options);
  if (r->options->no_closure) solve.closure = HR2D_CLOSURE_OFF;
  solve.start = r->solution;
  if (!status) status = hr2d_solve(r->own_links, &solve, &next);
  if (status)
    return complain_call(r->options->scene, hr2d_linkset_message(r->own_links), status);
  hr2d_solution_destroy(r->solution);
  r->solution = next;
  return EXIT_DONE;
}

/* All shares have a part of the links; the first one draws. */
static int add_frame(watch *w, const run *r, double epsilon, unsigned milliseconds) {
  int status = run_all_links(r, &w->links);
  if (!status && run_is_first(r)) status = draw_frame(w, r, epsilon);
  if (!status && run_is_first(r)) apng_add(&w->film, w->png.at, w->png.size, milliseconds);
  free(w->links.items);
  w->links = (run_links){NULL, 0};
  return run_agree(r, status);
}

static int make_frames(watch *w, run *r) {
  const options *o = r->options;
  hr2d_status made = hr2d_hierarchy_create(r->scene, &r->own_hierarchy);
  if (!made) made = hr2d_hierarchy_set_order(r->own_hierarchy, o->order);
  if (!made)
    made =
        hr2d_linkset_create(r->own_hierarchy, o->oracle, NULL, o->policy, NULL, &r->own_links);
  if (made) complain_call(o->scene, "", made);
  if (run_agree(r, made ? EXIT_FAILED : EXIT_DONE)) return EXIT_FAILED;
  r->hierarchy = r->own_hierarchy;
  r->links = r->own_links;
  int status = EXIT_DONE;
  for (uint32_t k = 0; k < w->film.frames && !status; k++) {
    const double epsilon = k + 1 < w->film.frames ? epsilon_of(o, k) : o->epsilon;
    status = solve_frame(r, epsilon);
    if (!status) status = add_frame(w, r, epsilon, k + 1 < w->film.frames ? SHOWN : LAST);
  }
  return status;
}

static int write_film(watch *w, const char *path) {
  run r = {.options = w->whole->options,
           .scene = w->whole->scene,
           .shares = w->whole->shares,
           .share = w->whole->share};
  output out = {0};
  const int first = run_is_first(&r), opened = first ? output_open(&out, path) : 0;
  int status = run_agree(&r, opened);
  if (status) return opened || !first ? status : output_close(&out, status);
  r.account.order = r.options->order;
  char *comment = first ? provenance_text() : NULL;
  w->film = (apng){.stream = out.stream, .comment = comment, .frames = count_frames(r.options)};
  status = run_agree(&r, first && !comment ? complain_memory() : EXIT_DONE);
  if (!status) status = make_frames(w, &r);
  if (!status && first) apng_end(&w->film);
  free(comment);
  run_release(&r);
  return first ? output_close(&out, status) : status;
}

/* The place of joints and the like is measured with text, as for a picture.  Colours mean the
   same in all frames: what they mean in the last one. */
static int start_page(watch *w, const run_links *last, const char *path) {
  picture *p = &w->page;
  int status = tiles_make(&w->tiles);
  if (!status) status = tiles_scale(&w->tiles, last);
  if (status) return status;
  shade_choose(p);
  p->levels = LEVELS;
  p->filled = 1;
  set_page(w);
  if (!(isfinite(p->scale) && p->scale > 0))
    return complain(path, "the scene is too small to draw");
  return scale_choose(p);
}

int draw_watch(const run *r, const char *path) {
  watch w = {.whole = r, .page = {.run = r}, .tiles = {.run = r}};
  run_links last = {NULL, 0};
  int status = run_all_links(r, &last);
  if (!status && run_is_first(r)) status = start_page(&w, &last, path);
  free(last.items);
  status = run_agree(r, status);
  if (!status) status = write_film(&w, path);
  tiles_release(&w.tiles);
  free(w.png.at);
  return status;
}

#else

int draw_watch(const run *r, const char *path) {
  (void)r;
  return draw_check(path);
}

#endif
