/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The algorithm at work: for falling ε the elements and links of the scene, and beside them its
   light, as frames of an animation. */
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

#define PIXELS   1.0 /* in a point */
#define WIDTH    800.0
#define HIGHEST  400.0 /* of the scene */
#define MARGIN   24.0
#define TITLE    84.0
#define FOOT     62.0
#define SHOWN    1000 /* milliseconds */
#define LAST     3000
#define FINE     0.002 /* the tolerance of the light, which is small */
#define LEVELS   28.0  /* colours, as a film of more is large */
#define MOST_INK 9.0   /* the opacity of links, times the square root of their number */

enum { STAGES = 7, MOST_STAGES = 60, MOST_LINES = 1500 };

/* The bytes of a PNG. */
typedef struct bytes {
  unsigned char *at;
  size_t size, capacity;
} bytes;

typedef struct watch {
  run_links links;  /* of the frame */
  const run *whole; /* the run with --eps, which sets the scale of colours */
  picture page;     /* of the whole run; both panels have its scale */
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

/* Half a page wide; the second panel begins in its middle. */
static void place_panel(picture *p, int second) {
  const double x = (second ? 0.5 * WIDTH : 0) + 0.5 * (0.5 * WIDTH - p->size.x * p->scale);
  p->origin = (hr2d_point){x, TITLE + p->size.y * p->scale};
  const double out = 0.4 * MARGIN;
  p->frame = (box){at_pixel(x - out), at_pixel(TITLE - out), x + p->size.x * p->scale + out,
                   p->origin.y + out};
}

static void set_page(picture *p) {
  layout_bounds(p);
  p->scale = fmin((0.5 * WIDTH - 2 * MARGIN) / p->size.x, HIGHEST / p->size.y);
  p->width = WIDTH;
  p->height = ceil(TITLE + p->size.y * p->scale + 0.5 * MARGIN + FOOT);
  p->flat = 1;
  place_panel(p, 1);
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
  for (size_t k = 0; k < links->count; k++) {
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
  pen_write(p->cr, 0.5 * WIDTH + MARGIN, 58, "the light that they give");
}

/* Room for the scene at its place on the page; of the light alone the raster is made. */
static int draw_panel(picture *p, const run_links *links, int second) {
  place_panel(p, second);
  int status = layout_strokes(p);
  if (!status && second) status = raster_make(p, 1 / PIXELS, FINE, &p->raster);
  if (!status && second) fill_draw(p);
  if (!status) images_draw(p);
  if (!status && !second) draw_links(p, links);
  if (!status) status = bands_draw(p);
  free(p->strokes);
  free(p->raster.at);
  free(p->obstacles.lines);
  p->strokes = NULL;
  p->raster.at = NULL;
  p->obstacles = (obstacles){NULL, 0, 0};
  return status;
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
  int status = draw_panel(&p, &w->links, 0);
  if (!status) status = draw_panel(&p, &w->links, 1);
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
  int status = count_links(r) <= MOST_LINES ? run_all_links(r, &w->links) : 0;
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
  w->film = (apng){.stream = out.stream, .frames = count_frames(r.options)};
  status = make_frames(w, &r);
  if (!status && first) apng_end(&w->film);
  run_release(&r);
  return first ? output_close(&out, status) : status;
}

/* The place of joints and the like is measured with text, as for a picture. */
static int start_page(picture *p, const char *path) {
  shade_choose(p);
  p->levels = LEVELS;
  p->filled = 1;
  set_page(p);
  if (!(isfinite(p->scale) && p->scale > 0))
    return complain(path, "the scene is too small to draw");
  return scale_choose(p);
}

int draw_watch(const run *r, const char *path) {
  watch w = {.whole = r, .page = {.run = r}};
  int status = run_agree(r, run_is_first(r) ? start_page(&w.page, path) : EXIT_DONE);
  if (!status) status = write_film(&w, path);
  free(w.png.at);
  return status;
}

#else

int draw_watch(const run *r, const char *path) {
  (void)r;
  return draw_check(path);
}

#endif
