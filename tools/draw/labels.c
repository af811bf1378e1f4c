/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names beside their patches, in free places. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output/complain.h"

#define FONT   10.0
#define HEIGHT 11.0

/* The length of a name without the marks of the parts of a feature: "/2" for its second patch,
   " (back)" for the back of a patch, " [3]" for a third piece. */
static size_t feature_length(const char *name) {
  static const char back[] = " (back)";
  size_t size = strlen(name);
  for (size_t before = 0; size != before;) {
    before = size;
    size_t digits = size - (size && name[size - 1] == ']');
    while (digits && strchr("0123456789", name[digits - 1])) digits--;
    if (digits && digits < size && name[digits - 1] == '/' && name[size - 1] != ']')
      size = digits - 1;
    else if (digits > 1 && name[size - 1] == ']' && !strncmp(name + digits - 2, " [", 2))
      size = digits - 2;
    else if (size > strlen(back) && !strncmp(name + size - strlen(back), back, strlen(back)))
      size -= strlen(back);
  }
  return size;
}

/* The number of the name that is the first `size` bytes of text; name_count if none. */
static size_t find_name(const picture *p, const char *text, size_t size) {
  size_t k = 0;
  while (k < p->name_count && (strncmp(p->name[k].text, text, size) || p->name[k].text[size]))
    k++;
  return k;
}

static void forget_names(picture *p) {
  while (p->name_count) free(p->name[--p->name_count].text);
}

/* Of few patches, each has its name written beside it.  Of many, each feature has the common
   name of its patches written beside the longest.  If these are still too many, none is
   written. */
int labels_choose(picture *p) {
  const hr2d_scene *scene = p->run->scene;
  const size_t count = hr2d_scene_patches(scene);
  for (size_t k = 0; k < count; k++) {
    const char *text = hr2d_scene_name(scene, k);
    const size_t size = count > MAX_NAMES ? feature_length(text) : strlen(text);
    const size_t at = count > MAX_NAMES ? find_name(p, text, size) : p->name_count;
    if (at == MAX_NAMES) {
      forget_names(p);
      return EXIT_DONE;
    }
    if (at < p->name_count) {
      if (hr2d_scene_length(scene, k) > hr2d_scene_length(scene, p->name[at].patch))
        p->name[at].patch = k;
      continue;
    }
    p->name[at] = (caption){k, strndup(text, size)};
    if (!p->name[at].text) return complain_memory();
    p->name_count++;
  }
  return EXIT_DONE;
}

static int within(const box *b, const box *frame) {
  return b->x0 > frame->x0 && b->y0 > frame->y0 && b->x1 < frame->x1 && b->y1 < frame->y1;
}

static int is_free(const picture *p, const box *b) {
  const box clear = {b->x0 - 3, b->y0 - 2, b->x1 + 3, b->y1 + 2};
  if (b->x0 < 4 || b->x1 > p->width - 4 || b->y0 < 58 || b->y1 > p->height - 4) return 0;
  if (p->part && !within(b, &p->frame)) return 0;
  return !obstacles_meet(p, &clear);
}

static double gap(const box *b, const stroke *s) {
  double min = joints_distance((hr2d_point){b->x0, b->y0}, s);
  for (int k = 1; k < 6; k++) {
    const hr2d_point q = {b->x0 + (k / 2) * 0.5 * (b->x1 - b->x0), k % 2 ? b->y1 : b->y0};
    min = fmin(min, joints_distance(q, s));
  }
  return min;
}

/* Whether no other patch is nearer to a name than its own. */
static int is_own(const picture *p, const box *b, const stroke *s) {
  const double own = gap(b, s);
  for (size_t k = 0; k < hr2d_scene_patches(p->run->scene); k++)
    if (&p->strokes[k] != s && gap(b, &p->strokes[k]) < own - 1e-6) return 0;
  return 1;
}

/* The box of a text whose nearest point is `off` points from the patch at fraction t. */
static box place_box(const stroke *s, double width, double t, double off, int side) {
  const double nx = side * s->front.x, ny = side * s->front.y;
  const double reach = off + fabs(nx) * 0.5 * width + fabs(ny) * 0.5 * HEIGHT;
  const double x = s->a.x + t * (s->b.x - s->a.x) + reach * nx;
  const double y = s->a.y + t * (s->b.y - s->a.y) + reach * ny;
  return (box){x - 0.5 * width, y - 0.5 * HEIGHT, x + 0.5 * width, y + 0.5 * HEIGHT};
}

/* The nearest free place: behind the patch if possible, else in front of it.  The name of a
   patch with another one at its back stays in front. */
static int find_box(const picture *p, const stroke *s, double width, box *b) {
  static const double places[] = {0.5, 0.35, 0.65, 0.2, 0.8};
  for (int side = s->twin ? 1 : -1; side <= 1; side += 2) {
    const double near = side < 0 ? 5 : p->band + 7, far = near + layout_tree_height(p) + 16;
    for (double off = near; off <= far; off += 4)
      for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        *b = place_box(s, width, places[k], off, side);
        if (is_free(p, b) && is_own(p, b, s)) return 1;
      }
  }
  return 0;
}

/* A plate on which a name can be read whatever is behind it. */
static void draw_plate(const picture *p, const box *b) {
  cairo_rectangle(p->cr, b->x0 - 2.5, b->y0 - 0.5, b->x1 - b->x0 + 5, b->y1 - b->y0 + 1);
  cairo_set_source_rgba(p->cr, 1, 1, 1, 0.8);
  cairo_fill(p->cr);
}

static void write_name(const picture *p, const char *name, const box *b) {
  if (p->filled || p->contours.count) {
    draw_plate(p, b);
    pen_grey(p->cr, 0.1);
    pen_write(p->cr, b->x0, b->y1 - 2.5, name);
    return;
  }
  pen_text_path(p->cr, b->x0, b->y1 - 2.5, name);
  pen_grey(p->cr, 1);
  cairo_set_line_width(p->cr, 2.5);
  cairo_set_line_join(p->cr, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(p->cr);
  pen_grey(p->cr, 0.1);
  pen_write(p->cr, b->x0, b->y1 - 2.5, name);
}

/* A name, cut with an ellipsis if it is too wide; the caller frees it. */
static char *shorten(cairo_t *cr, const char *name, double max) {
  static const char ellipsis[] = "…";
  /* So many bytes are wider than any label: 60 characters at least. */
  enum { WIDE = 240 };
  const size_t size = strnlen(name, WIDE);
  char *text = malloc(size + sizeof ellipsis);
  if (!text) return NULL;
  memcpy(text, name, size);
  text[size] = '\0';
  for (size_t n = size; n && pen_text_width(cr, text) > max;) {
    do n--;
    while (n && ((unsigned char)name[n] & 0xC0) == 0x80);
    memcpy(text + n, ellipsis, sizeof ellipsis);
  }
  return text;
}

int labels_draw(picture *p) {
  int status = 0;
  pen_font(p->cr, FONT, 0);
  for (size_t k = 0; !status && k < p->name_count; k++) {
    char *name = shorten(p->cr, p->name[k].text, 116);
    if (!name) return complain_memory();
    box b;
    if (find_box(p, &p->strokes[p->name[k].patch], pen_text_width(p->cr, name), &b)) {
      write_name(p, name, &b);
      status = obstacles_add_box(p, &b);
    }
    free(name);
  }
  return status;
}
#endif
