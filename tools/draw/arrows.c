/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrows along the net flow of light, −Φ, as Φ points to where the light comes from.  |Φ| is at
   most πM, and is that where all light comes from one direction.  So the length of an arrow is
   |Φ|/(πM): how one-sided the light is. */
#include "cli/scene.h"
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>

#include "output/complain.h"

#define SPACING 34.0
#define LONGEST 40.0
#define LEAST   4.0 /* shorter ones are left out */
#define HEAD    5.0
#define CLEAR   5.0 /* around an arrow */
#define PI      3.14159265358979323846

/* The places of arrows and what is there. */
typedef struct quiver {
  size_t count, bands;
  hr2d_point *page, *at;
  double *mean, *flux;
  unsigned char *place;
} quiver;

static void set_places(const picture *p, quiver *q, size_t columns) {
  for (size_t k = 0; k < q->count; k++) {
    const double x = p->frame.x0 + SPACING * ((double)(k % columns) + 0.5);
    const double y = p->frame.y0 + SPACING * ((double)(k / columns) + 0.5);
    q->page[k] = (hr2d_point){x, y};
    q->at[k] = layout_scene_point(p, x, y);
  }
}

static int look(const picture *p, quiver *q) {
  const size_t columns = (size_t)((p->frame.x1 - p->frame.x0) / SPACING);
  q->count = columns * (size_t)((p->frame.y1 - p->frame.y0) / SPACING);
  q->bands = hr2d_scene_bands(p->run->scene);
  q->page = malloc((q->count + 1) * sizeof *q->page);
  q->at = malloc((q->count + 1) * sizeof *q->at);
  q->mean = malloc((q->count * q->bands + 1) * sizeof *q->mean);
  q->flux = malloc((2 * q->count * q->bands + 1) * sizeof *q->flux);
  q->place = malloc(q->count + 1);
  if (!q->page || !q->at || !q->mean || !q->flux || !q->place) return complain_memory();
  set_places(p, q, columns);
  const hr2d_field_values to = {
      .struct_size = sizeof to, .mean = q->mean, .flux = q->flux, .place = q->place};
  const hr2d_status status = hr2d_field_at(p->run->solution, q->at, q->count, NULL, &to);
  return status ? scene_complain(p->run->options, p->run->scene, status) : EXIT_DONE;
}

/* The arrow at place k on the page, as a vector; of all bands or of the one that is shown. */
static hr2d_point arrow_at(const picture *p, const quiver *q, size_t k) {
  const int band = p->run->options->band;
  double x = 0, y = 0, mean = 0;
  for (size_t b = 0; b < q->bands; b++) {
    if (band >= 0 && b != (size_t)band) continue;
    mean += q->mean[k * q->bands + b];
    x += q->flux[2 * (k * q->bands + b)];
    y += q->flux[2 * (k * q->bands + b) + 1];
  }
  if (!(mean > 0)) return (hr2d_point){0, 0};
  return (hr2d_point){-LONGEST * x / (PI * mean), LONGEST * y / (PI * mean)};
}

static void trace_arrow(cairo_t *cr, hr2d_point from, hr2d_point v) {
  const double length = hypot(v.x, v.y), ux = v.x / length, uy = v.y / length;
  const double head = fmin(HEAD, 0.6 * length);
  const hr2d_point tip = {from.x + v.x, from.y + v.y};
  cairo_move_to(cr, from.x, from.y);
  cairo_line_to(cr, tip.x, tip.y);
  cairo_move_to(cr, tip.x - head * (ux - 0.5 * uy), tip.y - head * (uy + 0.5 * ux));
  cairo_line_to(cr, tip.x, tip.y);
  cairo_line_to(cr, tip.x - head * (ux + 0.5 * uy), tip.y - head * (uy - 0.5 * ux));
}

/* White with a dark rim, which is seen on all colours. */
static void draw_arrow(cairo_t *cr, hr2d_point from, hr2d_point v) {
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  trace_arrow(cr, from, v);
  pen_grey(cr, 0.1);
  cairo_set_line_width(cr, 2.4);
  cairo_stroke_preserve(cr);
  pen_grey(cr, 1);
  cairo_set_line_width(cr, 1.1);
  cairo_stroke(cr);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
}

static int draw_all(picture *p, const quiver *q) {
  int status = EXIT_DONE;
  for (size_t k = 0; k < q->count && !status; k++) {
    if (q->place[k] == HR2D_PLACE_OUTSIDE) continue;
    const hr2d_point v = arrow_at(p, q, k);
    const hr2d_point from = {q->page[k].x - 0.5 * v.x, q->page[k].y - 0.5 * v.y};
    const box b = {fmin(from.x, from.x + v.x) - CLEAR, fmin(from.y, from.y + v.y) - CLEAR,
                   fmax(from.x, from.x + v.x) + CLEAR, fmax(from.y, from.y + v.y) + CLEAR};
    if (hypot(v.x, v.y) < LEAST || obstacles_meet(p, &b)) continue;
    draw_arrow(p->cr, from, v);
    status = obstacles_add_box(p, &b);
  }
  return status;
}

int arrows_draw(picture *p) {
  quiver q = {0};
  if (!p->run->options->arrows) return EXIT_DONE;
  int status = look(p, &q);
  if (!status) status = draw_all(p, &q);
  free(q.page);
  free(q.at);
  free(q.mean);
  free(q.flux);
  free(q.place);
  return status;
}

void arrows_draw_key(const picture *p) {
  const double x = 176, y = p->height - 20 - 22 * ((p->path_count > 0) + (p->seen > 0));
  draw_arrow(p->cr, (hr2d_point){x, y - 3.5}, (hr2d_point){LONGEST, 0});
  pen_font(p->cr, 10, 0);
  pen_grey(p->cr, 0.2);
  pen_write(p->cr, x + LONGEST + 8, y, "net flow of light, so long if all came from one side");
}
#endif
