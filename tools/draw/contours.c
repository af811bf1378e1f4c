/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Isolines by marching squares: a cell of the raster has a piece of the line between each two
   sides that cross the level, and the pieces are chained. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output/complain.h"
#include "output/ticks.h"

#define EXACT 0.06 /* points by which a line may leave the raster's, to have fewer vertices */
#define SHORT 6.0  /* shorter lines are not drawn */

enum { WINDOW = 64, MOST_LEVELS = 40 };

/* The cells that a wall passes, and the sides of cells where the line of this level was. */
typedef struct march {
  picture *picture;
  const raster *raster;
  unsigned char *wall, *done;
  double level;
  hr2d_point *point; /* of the line that is followed */
  size_t count, capacity;
} march;

/* Corner k of a cell, clockwise from the upper left; side k joins corners k and k + 1. */
static size_t corner(const raster *r, size_t cell, int k) {
  static const size_t right[] = {0, 1, 1, 0}, down[] = {0, 0, 1, 1};
  return cell + right[k & 3] + down[k & 3] * r->columns;
}

static double value(const march *m, size_t cell, int k) {
  return shade_number(m->picture, m->raster->at[corner(m->raster, cell, k)]);
}

/* Whether a cell has four corners with light and no wall. */
static int is_open(const march *m, size_t cell) {
  const raster *r = m->raster;
  if (cell % r->columns + 1 == r->columns || cell / r->columns + 1 >= r->rows || m->wall[cell])
    return 0;
  for (int k = 0; k < 4; k++)
    if (!isfinite(value(m, cell, k))) return 0;
  return 1;
}

/* A bit for each side that crosses the level. */
static int crossed(const march *m, size_t cell) {
  int sides = 0;
  for (int k = 0; k < 4; k++)
    if ((value(m, cell, k) > m->level) != (value(m, cell, k + 1) > m->level)) sides |= 1 << k;
  return sides;
}

/* The side where a line that comes in by a side goes out.  In a saddle the middle of the cell
   belongs to two of the corners; the line goes around one of the others. */
static int other_side(const march *m, size_t cell, int side) {
  const int sides = crossed(m, cell);
  if (sides != 15) {
    for (int k = 0; k < 4; k++)
      if (k != side && sides >> k & 1) return k;
    return side;
  }
  double middle = 0;
  for (int k = 0; k < 4; k++) middle += 0.25 * value(m, cell, k);
  const int around = (value(m, cell, side) > m->level) != (middle > m->level);
  return (side + (around ? 3 : 1)) % 4;
}

static int add_point(march *m, size_t cell, int side) {
  if (m->count == m->capacity) {
    const size_t capacity = m->capacity ? 2 * m->capacity : 1024;
    hr2d_point *point = realloc(m->point, capacity * sizeof *point);
    if (!point) return complain_memory();
    m->point = point;
    m->capacity = capacity;
  }
  const raster *r = m->raster;
  const size_t a = corner(r, cell, side), b = corner(r, cell, side + 1);
  const double va = value(m, cell, side), vb = value(m, cell, side + 1);
  const double t = (m->level - va) / (vb - va);
  const double ax = (double)(a % r->columns), ay = (double)(a / r->columns);
  const double bx = (double)(b % r->columns), by = (double)(b / r->columns);
  m->point[m->count++] = (hr2d_point){r->x + r->step * (ax + t * (bx - ax)),
                                      r->y + r->step * (ay + t * (by - ay))};
  return EXIT_DONE;
}

/* Follows the line that leaves a cell by a side, until it ends or closes. */
static int follow(march *m, size_t cell, int side) {
  const size_t columns = m->raster->columns;
  for (;;) {
    m->done[cell] |= (unsigned char)(1 << side);
    const int status = add_point(m, cell, side);
    if (status) return status;
    if ((side == 0 && cell < columns) || (side == 3 && cell % columns == 0)) return EXIT_DONE;
    cell += side == 0 ? (size_t)0 - columns : side == 1 ? 1 : side == 2 ? columns : (size_t)-1;
    side = (side + 2) % 4;
    if (!is_open(m, cell) || m->done[cell] >> side & 1) return EXIT_DONE;
    m->done[cell] |= (unsigned char)(1 << side);
    side = other_side(m, cell, side);
  }
}

static void reverse(march *m) {
  for (size_t k = 0; 2 * k + 1 < m->count; k++) {
    const hr2d_point kept = m->point[k];
    m->point[k] = m->point[m->count - 1 - k];
    m->point[m->count - 1 - k] = kept;
  }
}

static double distance(hr2d_point q, hr2d_point a, hr2d_point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = hypot(dx, dy);
  if (!(length > 0)) return hypot(q.x - a.x, q.y - a.y);
  return fabs((q.x - a.x) * dy - (q.y - a.y) * dx) / length;
}

static int is_straight(const hr2d_point *point, size_t from, size_t to) {
  for (size_t k = from + 1; k < to; k++)
    if (distance(point[k], point[from], point[to]) > EXACT) return 0;
  return 1;
}

/* Leaves out vertices between which the line is straight. */
static void simplify(march *m) {
  size_t kept = 0, from = 0;
  for (size_t to = 2; to <= m->count; to++)
    if (to == m->count || to - from > WINDOW || !is_straight(m->point, from, to)) {
      from = to - 1;
      m->point[++kept] = m->point[from];
    }
  m->count = kept + 1;
}

static double length_of(const march *m) {
  double sum = 0;
  for (size_t k = 1; k < m->count; k++)
    sum += hypot(m->point[k].x - m->point[k - 1].x, m->point[k].y - m->point[k - 1].y);
  return sum;
}

/* Hands the line over to the picture. */
static int keep_line(march *m) {
  contours *c = &m->picture->contours;
  if (m->count > 2) simplify(m);
  const double length = length_of(m);
  if (length < SHORT) return EXIT_DONE;
  contour *more = realloc(c->items, (c->count + 1) * sizeof *more);
  if (!more) return complain_memory();
  c->items = more;
  hr2d_point *point = malloc(m->count * sizeof *point);
  if (!point) return complain_memory();
  memcpy(point, m->point, m->count * sizeof *point);
  c->items[c->count++] = (contour){m->level, point, m->count, length};
  return EXIT_DONE;
}

static int trace(march *m, size_t cell, int side) {
  m->count = 0;
  int status = follow(m, cell, side);
  reverse(m);
  const int back = other_side(m, cell, side);
  if (!status && !(m->done[cell] >> back & 1)) status = follow(m, cell, back);
  return status ? status : keep_line(m);
}

static int trace_level(march *m) {
  const size_t cells = m->raster->columns * m->raster->rows;
  int status = EXIT_DONE;
  memset(m->done, 0, cells);
  for (size_t cell = 0; cell < cells && !status; cell++) {
    if (!is_open(m, cell)) continue;
    const int sides = crossed(m, cell);
    for (int k = 0; k < 4 && sides && !status; k++)
      if (sides >> k & 1 && !(m->done[cell] >> k & 1)) status = trace(m, cell, k);
  }
  return status;
}

/* Values on the two sides of a wall have nothing to do with each other. */
static void mark_walls(march *m) {
  const raster *r = m->raster;
  for (size_t k = 0; k < hr2d_scene_patches(m->picture->run->scene); k++) {
    const stroke *s = &m->picture->strokes[k];
    const double steps = ceil(s->length / (0.3 * r->step));
    for (double i = 0; i <= steps; i++) {
      const hr2d_point q = layout_along(s, steps > 0 ? i / steps : 0);
      const double x = floor((q.x - r->x) / r->step), y = floor((q.y - r->y) / r->step);
      if (x >= 0 && y >= 0 && x < (double)r->columns && y < (double)r->rows)
        m->wall[(size_t)y * r->columns + (size_t)x] = 1;
    }
  }
}

static void find_range(const picture *p, double *lo, double *hi) {
  *lo = INFINITY;
  *hi = -INFINITY;
  for (size_t k = 0; k < p->raster.columns * p->raster.rows; k++) {
    const double x = shade_number(p, p->raster.at[k]);
    *lo = fmin(*lo, x);
    *hi = fmax(*hi, x);
  }
  if (p->logarithmic) *lo = fmax(*lo, p->lo);
  if (p->beyond) *hi = fmin(*hi, p->hi);
}

static int trace_all(march *m) {
  picture *p = m->picture;
  double lo, hi;
  ticks t;
  int status = EXIT_DONE;
  find_range(p, &lo, &hi);
  if (!(hi - lo > 1e-9 * fabs(hi))) return EXIT_DONE;
  ticks_make(&t, lo, hi, p->logarithmic, (int)p->run->options->contours);
  p->contours.levels = t;
  mark_walls(m);
  for (int k = 0; k < t.count && !status; k++) {
    m->level = t.value[k];
    status = trace_level(m);
  }
  return status;
}

int contours_make(picture *p) {
  const size_t cells = p->raster.columns * p->raster.rows;
  march m = {.picture = p, .raster = &p->raster};
  if (!p->run->options->contours) return EXIT_DONE;
  m.wall = calloc(cells, 1);
  m.done = malloc(cells);
  const int status = m.wall && m.done ? trace_all(&m) : complain_memory();
  free(m.wall);
  free(m.done);
  free(m.point);
  return status;
}

/* What stands out from the colour of a level. */
colour contours_ink(const picture *p, double level) {
  const shade s = {{level, level, level}};
  const colour c = p->filled ? scale_colour(p, s) : (colour){1, 1, 1};
  const int bright = 0.21 * c.r + 0.72 * c.g + 0.07 * c.b > 0.42;
  return bright ? (colour){0.08, 0.08, 0.08} : (colour){1, 1, 1};
}

void contours_draw(const picture *p) {
  cairo_set_line_width(p->cr, CONTOUR_WIDTH);
  cairo_set_line_join(p->cr, CAIRO_LINE_JOIN_ROUND);
  for (size_t k = 0; k < p->contours.count; k++) {
    const contour *c = &p->contours.items[k];
    cairo_new_path(p->cr);
    for (size_t j = 0; j < c->count; j++) cairo_line_to(p->cr, c->point[j].x, c->point[j].y);
    pen_colour(p->cr, contours_ink(p, c->level));
    cairo_stroke(p->cr);
  }
}

void contours_release(picture *p) {
  for (size_t k = 0; k < p->contours.count; k++) free(p->contours.items[k].point);
  free(p->contours.items);
}
#endif
