/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What points see: a beam for each part of a patch or of a back, and for the sky, which is cut
   off at the frame of the scene. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>

#include "output/complain.h"

#define FILL  0.12 /* opacity; every second beam is darker */
#define DARK  0.22
#define LINES 0.45
#define STEP  0.25 /* radians; a far border of so many stays beyond the frame */

static const struct {
  const char *name;
  colour colour;
} kinds[] = {[HR2D_SEEN_FRONT] = {"front of a patch", {0.90, 0.42, 0.05}},
             [HR2D_SEEN_BACK] = {"black back", {0.25, 0.25, 0.25}},
             [HR2D_SEEN_SKY] = {"sky", {0.15, 0.50, 0.90}},
             [HR2D_SEEN_PAST] = {"more images", {0.45, 0.20, 0.60}}};

enum { KINDS = sizeof kinds / sizeof *kinds };

/* The beams of one point while they are drawn. */
typedef struct fan {
  picture *picture;
  hr2d_point eye;
  hr2d_point last; /* the left end of the beam before, */
  size_t count;    /* if there is one */
} fan;

static hr2d_point on_page(const picture *p, hr2d_point scene) {
  const double unit = hr2d_scene_unit(p->run->scene);
  return layout_point(p, (hr2d_point){scene.x / unit, scene.y / unit});
}

/* Beyond the frame; on the page y points downwards. */
static hr2d_point far_away(const fan *f, double angle) {
  const double far = 2 * (f->picture->width + f->picture->height);
  return (hr2d_point){f->eye.x + far * cos(angle), f->eye.y - far * sin(angle)};
}

static double angle_of(hr2d_point direction) {
  return atan2(direction.y, direction.x);
}

/* The angle from the right border of a beam to the left one. */
static double width_of(const hr2d_beam *b) {
  return fabs(atan2(b->right.x * b->left.y - b->right.y * b->left.x,
                    b->right.x * b->left.x + b->right.y * b->left.y));
}

static void fill_beam(const fan *f, const hr2d_beam *b, hr2d_point right, hr2d_point left) {
  cairo_t *cr = f->picture->cr;
  const colour c = kinds[b->seen].colour;
  cairo_move_to(cr, f->eye.x, f->eye.y);
  cairo_line_to(cr, right.x, right.y);
  if (b->seen == HR2D_SEEN_SKY)
    for (double turn = STEP; turn < width_of(b); turn += STEP) {
      const hr2d_point q = far_away(f, angle_of(b->right) + turn);
      cairo_line_to(cr, q.x, q.y);
    }
  cairo_line_to(cr, left.x, left.y);
  cairo_close_path(cr);
  cairo_set_source_rgba(cr, c.r, c.g, c.b, f->count % 2 ? DARK : FILL);
  cairo_fill(cr);
}

/* The border of two beams ends at the farther of their ends. */
static void draw_border(const fan *f, hr2d_point right) {
  cairo_t *cr = f->picture->cr;
  const double far = hypot(f->last.x - f->eye.x, f->last.y - f->eye.y);
  const hr2d_point to = far > hypot(right.x - f->eye.x, right.y - f->eye.y) ? f->last : right;
  cairo_move_to(cr, f->eye.x, f->eye.y);
  cairo_line_to(cr, to.x, to.y);
  cairo_set_source_rgba(cr, 0.35, 0.15, 0, LINES);
  cairo_set_line_width(cr, 0.5);
  cairo_stroke(cr);
}

static hr2d_status draw_beam(void *ctx, const hr2d_beam *b) {
  fan *f = ctx;
  const int sky = b->seen == HR2D_SEEN_SKY;
  const hr2d_point right =
      sky ? far_away(f, angle_of(b->right)) : on_page(f->picture, b->end.a);
  const hr2d_point left = sky ? far_away(f, angle_of(b->left)) : on_page(f->picture, b->end.b);
  fill_beam(f, b, right, left);
  if (f->count++) draw_border(f, right);
  f->last = left;
  f->picture->seen |= 1U << b->seen;
  return HR2D_OK;
}

int beams_draw(picture *p) {
  const place_list *of = &p->run->options->beams_of;
  const size_t *patch = run_beamed(p->run);
  const box frame = p->frame;
  hr2d_status status = HR2D_OK;
  cairo_save(p->cr);
  cairo_rectangle(p->cr, frame.x0, frame.y0, frame.x1 - frame.x0, frame.y1 - frame.y0);
  cairo_clip(p->cr);
  for (size_t k = 0; k < of->count && !status; k++) {
    fan f = {.picture = p, .eye = layout_along(&p->strokes[patch[k]], of->items[k].t)};
    status = hr2d_beams_visit(p->run->scene, patch[k], of->items[k].t, draw_beam, &f);
  }
  cairo_restore(p->cr);
  return status ? complain_call(p->run->options->scene, "", status) : EXIT_DONE;
}

void beams_draw_points(const picture *p) {
  const place_list *of = &p->run->options->beams_of;
  const size_t *patch = run_beamed(p->run);
  for (size_t k = 0; k < of->count; k++)
    layout_draw_dot(p, &p->strokes[patch[k]], of->items[k].t);
}

/* A swatch for each kind that was drawn; over the key of the links if there is one. */
void beams_draw_key(const picture *p) {
  const double y = p->height - (p->path_count ? 42 : 20);
  double x = 200;
  pen_font(p->cr, 10, 0);
  pen_grey(p->cr, 0.2);
  pen_write(p->cr, x, y, "beams end at");
  x += pen_text_width(p->cr, "beams end at") + 12;
  for (int k = 0; k < KINDS; k++) {
    const colour c = kinds[k].colour;
    if (!(p->seen >> k & 1)) continue;
    cairo_rectangle(p->cr, x, y - 8, 12, 9);
    cairo_set_source_rgba(p->cr, c.r, c.g, c.b, 1.5 * DARK);
    cairo_fill(p->cr);
    pen_grey(p->cr, 0.2);
    pen_write(p->cr, x + 16, y, kinds[k].name);
    x += 16 + pen_text_width(p->cr, kinds[k].name) + 14;
  }
}
#endif
