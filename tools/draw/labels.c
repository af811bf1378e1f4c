/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names beside their patches, where nothing else is. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output/complain.h"

#define FONT   10.0
#define HEIGHT 11.0

typedef struct box {
  double x0, y0, x1, y1;
} box;

/* The length of a name without the marks of the parts of a feature: "/2" for the second
   patch, " (back)" for its back, " [3]" for its third piece. */
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

/* The name that starts with the same `size` bytes and ends there; name_count if none. */
static size_t find_name(const picture *p, const char *text, size_t size) {
  size_t k = 0;
  while (k < p->name_count && (strncmp(p->name[k].text, text, size) || p->name[k].text[size]))
    k++;
  return k;
}

static void forget_names(picture *p) {
  while (p->name_count) free(p->name[--p->name_count].text);
}

/* Every patch has its own name written beside it, or if there are many, every feature the
   one it has in common beside its longest patch, or if these are still many, none. */
int choose_names(picture *p) {
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
    if (!p->name[at].text) return fail_memory();
    p->name_count++;
  }
  return EXIT_DONE;
}

int add_obstacle(picture *p, hr2d_point a, hr2d_point b) {
  obstacles *o = &p->obstacles;
  if (o->count == o->capacity) {
    const size_t capacity = o->capacity ? 2 * o->capacity : 64;
    line *lines = realloc(o->lines, capacity * sizeof *lines);
    if (!lines) return fail_memory();
    o->lines = lines;
    o->capacity = capacity;
  }
  o->lines[o->count++] = (line){a, b};
  return EXIT_DONE;
}

/* Narrows [*t0, *t1] to where lo ≤ x + t·d ≤ hi; returns whether anything is left. */
static int clip(double x, double d, double lo, double hi, double *t0, double *t1) {
  if (d == 0) return x >= lo && x <= hi;
  const double u = (lo - x) / d, v = (hi - x) / d;
  *t0 = fmax(*t0, fmin(u, v));
  *t1 = fmin(*t1, fmax(u, v));
  return *t0 <= *t1;
}

static int meets(const box *b, const line *l) {
  double t0 = 0, t1 = 1;
  return clip(l->a.x, l->b.x - l->a.x, b->x0, b->x1, &t0, &t1) &&
         clip(l->a.y, l->b.y - l->a.y, b->y0, b->y1, &t0, &t1);
}

static int is_free(const picture *p, const box *b) {
  const box clear = {b->x0 - 3, b->y0 - 2, b->x1 + 3, b->y1 + 2};
  if (b->x0 < 4 || b->x1 > p->width - 4 || b->y0 < 50 || b->y1 > p->height - 4) return 0;
  for (size_t k = 0; k < p->obstacles.count; k++)
    if (meets(&clear, &p->obstacles.lines[k])) return 0;
  return 1;
}

static double gap(const box *b, const stroke *s) {
  double least = to_stroke((hr2d_point){b->x0, b->y0}, s);
  for (int k = 1; k < 6; k++) {
    const hr2d_point q = {b->x0 + (k / 2) * 0.5 * (b->x1 - b->x0), k % 2 ? b->y1 : b->y0};
    least = fmin(least, to_stroke(q, s));
  }
  return least;
}

/* A name belongs to the patch that is nearest to it. */
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

/* The nearest free place: behind the patch if possible, else in front of it; a patch
   with another one behind it stays in front. */
static int find_box(const picture *p, const stroke *s, double width, box *b) {
  static const double places[] = {0.5, 0.35, 0.65, 0.2, 0.8};
  for (int side = s->twin ? 1 : -1; side <= 1; side += 2) {
    const double near = side < 0 ? 5 : p->band + 7, far = near + tree_height(p) + 16;
    for (double off = near; off <= far; off += 4)
      for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        *b = place_box(s, width, places[k], off, side);
        if (is_free(p, b) && is_own(p, b, s)) return 1;
      }
  }
  return 0;
}

static int occupy(picture *p, const box *b) {
  const int status = add_obstacle(p, (hr2d_point){b->x0, b->y0}, (hr2d_point){b->x1, b->y1});
  return status ? status
                : add_obstacle(p, (hr2d_point){b->x0, b->y1}, (hr2d_point){b->x1, b->y0});
}

static void write_name(const picture *p, const char *name, const box *b) {
  cairo_move_to(p->cr, b->x0, b->y1 - 2.5);
  cairo_text_path(p->cr, name);
  set_grey(p->cr, 1);
  cairo_set_line_width(p->cr, 2.5);
  cairo_set_line_join(p->cr, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(p->cr);
  cairo_move_to(p->cr, b->x0, b->y1 - 2.5);
  set_grey(p->cr, 0.1);
  cairo_show_text(p->cr, name);
}

/* A name cut to fit, with an ellipsis; the caller frees it. */
static char *shorten(cairo_t *cr, const char *name, double most) {
  static const char ellipsis[] = "…";
  const size_t size = strlen(name);
  char *text = malloc(size + sizeof ellipsis);
  if (!text) return NULL;
  memcpy(text, name, size + 1);
  for (size_t n = size; n && text_width(cr, text) > most;) {
    do n--;
    while (n && ((unsigned char)name[n] & 0xC0) == 0x80);
    memcpy(text + n, ellipsis, sizeof ellipsis);
  }
  return text;
}

int draw_names(picture *p) {
  int status = 0;
  set_font(p->cr, FONT, 0);
  for (size_t k = 0; !status && k < p->name_count; k++) {
    char *name = shorten(p->cr, p->name[k].text, 116);
    if (!name) return fail_memory();
    box b;
    if (find_box(p, &p->strokes[p->name[k].patch], text_width(p->cr, name), &b)) {
      write_name(p, name, &b);
      status = occupy(p, &b);
    }
    free(name);
  }
  return status;
}
#endif
