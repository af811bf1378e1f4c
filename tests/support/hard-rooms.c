/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/hard-rooms.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

hard_room hard_polygon(const char *name, const double (*corner)[2], size_t corners, size_t lit,
                       double rho) {
  hard_room room = {.name = name, .walls = corners};
  for (size_t k = 0; k < corners; k++) {
    memcpy(room.wall[k], corner[k], 2 * sizeof(double));
    memcpy(room.wall[k] + 2, corner[(k + 1) % corners], 2 * sizeof(double));
    room.wall[k][4] = k == lit;
    room.wall[k][5] = rho;
  }
  return room;
}

static const double unit_square[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

hard_room hard_square(double rho) {
  return hard_polygon("square", unit_square, 4, 0, rho);
}

hard_room hard_l_shape(double rho) {
  const double corner[][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  return hard_polygon("L", corner, 6, 1, rho);
}

hard_room hard_circle(double rho) {
  double corner[HARD_WALLS][2];
  for (int k = 0; k < HARD_WALLS; k++) {
    corner[k][0] = cos(2 * 3.14159265358979323846 * k / HARD_WALLS);
    corner[k][1] = sin(2 * 3.14159265358979323846 * k / HARD_WALLS);
  }
  return hard_polygon("300 walls", (const double(*)[2])corner, HARD_WALLS, 7, rho);
}

hard_room hard_with_occluder(double rho) {
  const double box[][2] = {{.4, .4}, {.4, .6}, {.6, .6}, {.6, .4}};
  hard_room room = hard_square(rho), inner = hard_polygon("", box, 4, 4, rho);
  room.name = "with an occluder";
  memcpy(room.wall[4], inner.wall, 4 * sizeof *inner.wall);
  room.walls = 8;
  return room;
}

hr2d_scene *hard_scene(const hard_room *room) {
  return test_scene((const double(*)[6])room->wall, room->walls);
}

typedef struct element {
  long double a[2], b[2], length;
  size_t wall;
} element;

typedef struct mesh {
  size_t count;
  element *element;
  double *exchange; /* count × count */
} mesh;

static void add_element(mesh *m, const hard_room *room, size_t wall, double from, double to) {
  element *e = &m->element[m->count++];
  const double *w = room->wall[wall];
  for (int k = 0; k < 2; k++) {
    e->a[k] = w[k] + (long double)from * ((long double)w[2 + k] - w[k]);
    e->b[k] = w[k] + (long double)to * ((long double)w[2 + k] - w[k]);
  }
  e->length = hypotl(e->b[0] - e->a[0], e->b[1] - e->a[1]);
  e->wall = wall;
}

static long double distance(const long double *p, const long double *q) {
  return hypotl(p[0] - q[0], p[1] - q[1]);
}

static double strings(const element *i, const element *j) {
  return (double)(0.5L * (distance(i->a, j->a) + distance(i->b, j->b) - distance(i->a, j->b) -
                          distance(i->b, j->a)));
}

static double midpoints(const element *i, const element *j) {
  const double ix = (double)(i->b[0] - i->a[0]), iy = (double)(i->b[1] - i->a[1]);
  const double jx = (double)(j->b[0] - j->a[0]), jy = (double)(j->b[1] - j->a[1]);
  const double dx = (double)(j->a[0] + j->b[0] - i->a[0] - i->b[0]) / 2;
  const double dy = (double)(j->a[1] + j->b[1] - i->a[1] - i->b[1]) / 2;
  const double r = sqrt(dx * dx + dy * dy);
  return (ix * dy - iy * dx) * (jy * dx - jx * dy) / (2 * r * r * r);
}

/* Walls of a convex room see each other, and not themselves. */
static void set_exchange(mesh *m, hard_factors factors) {
  m->exchange = calloc(m->count * m->count, sizeof *m->exchange);
  ck_assert_ptr_nonnull(m->exchange);
  for (size_t i = 0; i < m->count; i++)
    for (size_t j = 0; j < m->count; j++) {
      const element *e = &m->element[i], *f = &m->element[j];
      if (e->wall != f->wall)
        m->exchange[i * m->count + j] =
            fmax(0, factors == HARD_STRINGS ? strings(e, f) : midpoints(e, f));
    }
}

static void free_mesh(mesh *m) {
  free(m->element);
  free(m->exchange);
}

hard_sweeps hard_gauss_seidel(const hard_room *room, hard_factors factors, size_t parts,
                              unsigned limit) {
  mesh m = {.element = malloc(room->walls * parts * sizeof *m.element)};
  ck_assert_ptr_nonnull(m.element);
  for (size_t w = 0; w < room->walls; w++)
    for (size_t k = 0; k < parts; k++)
      add_element(&m, room, w, (double)k / (double)parts, (double)(k + 1) / (double)parts);
  set_exchange(&m, factors);
  double *b = calloc(m.count, sizeof *b);
  hard_sweeps made = {.finite = 1};
  for (double change = 1; change > 1e-6 && made.count < limit && made.finite; made.count++) {
    change = 0;
    for (size_t i = 0; i < m.count; i++) {
      const double *wall = room->wall[m.element[i].wall];
      double sum = 0;
      for (size_t j = 0; j < m.count; j++) sum += m.exchange[i * m.count + j] * b[j];
      const double next = wall[4] + wall[5] * sum / (double)m.element[i].length;
      if (next > 0) change = fmax(change, fabs(next - b[i]) / next);
      b[i] = next;
      made.finite &= isfinite(next) != 0;
    }
  }
  for (size_t i = 0; i < m.count; i++) made.total += b[i] * (double)m.element[i].length;
  free(b);
  free_mesh(&m);
  return made;
}

/* Elements at corners are no smaller than this part of their wall. */
#define SMALLEST 0x1p-10

static double distance_to_others(const hard_room *room, size_t wall, double x, double y) {
  double min = HUGE_VAL;
  for (size_t k = 0; k < room->walls; k++) {
    const double *w = room->wall[k], dx = w[2] - w[0], dy = w[3] - w[1];
    const double t = ((x - w[0]) * dx + (y - w[1]) * dy) / (dx * dx + dy * dy);
    const double at = fmin(fmax(t, 0), 1);
    if (k != wall) min = fmin(min, hypot(x - w[0] - at * dx, y - w[1] - at * dy));
  }
  return min;
}

/* Elements as long as their distance from other walls, each cut into `parts`. */
static mesh graded(const hard_room *room, size_t parts) {
  mesh m = {.element = NULL};
  for (size_t w = 0; w < room->walls; w++) {
    const double *p = room->wall[w], whole = hypot(p[2] - p[0], p[3] - p[1]);
    for (double from = 0, size = 1; from < 1; from += size) {
      for (size = 1; size > SMALLEST; size /= 2) {
        const double middle = from + size / 2;
        const double far = distance_to_others(room, w, p[0] + middle * (p[2] - p[0]),
                                              p[1] + middle * (p[3] - p[1]));
        if (fmod(from, size) == 0 && size * whole <= far) break;
      }
      m.element = realloc(m.element, (m.count + parts) * sizeof *m.element);
      ck_assert_ptr_nonnull(m.element);
      for (size_t k = 0; k < parts; k++)
        add_element(&m, room, w, from + size * (double)k / (double)parts,
                    from + size * (double)(k + 1) / (double)parts);
    }
  }
  set_exchange(&m, HARD_STRINGS);
  return m;
}

/* out = (I − √ρ K √ρ) in, in units of √A. */
static void apply(const mesh *m, const double *scale, const double *diagonal, const double *in,
                  double *out) {
  for (size_t i = 0; i < m->count; i++) {
    const double *row = m->exchange + i * m->count;
    double sum = 0;
    for (size_t j = 0; j < m->count; j++) sum += row[j] * scale[j] * in[j];
    out[i] = in[i] - scale[i] * (sum + diagonal[i] * scale[i] * in[i]);
  }
}

static double dot(size_t count, const double *u, const double *v) {
  double sum = 0;
  for (size_t k = 0; k < count; k++) sum += u[k] * v[k];
  return sum;
}

static void conjugate_gradients(const mesh *m, const double *scale, const double *diagonal,
                                const double *b, double *y) {
  const size_t n = m->count;
  double *r = calloc(3 * n, sizeof *r), *p = r + n, *q = p + n;
  ck_assert_ptr_nonnull(r);
  memcpy(r, b, n * sizeof *r);
  memcpy(p, b, n * sizeof *p);
  double square = dot(n, r, r);
  const double min = 1e-30 * square;
  for (int k = 0; k < 5000 && square > min; k++) {
    apply(m, scale, diagonal, p, q);
    const double step = square / dot(n, p, q);
    for (size_t i = 0; i < n; i++) y[i] += step * p[i], r[i] -= step * q[i];
    const double next = dot(n, r, r);
    for (size_t i = 0; i < n; i++) p[i] = r[i] + next / square * p[i];
    square = next;
  }
  ck_assert_double_le(square, min);
  free(r);
}

/* With B = E + √ρ y/√A and b = √ρ K E of it. */
void hard_averages(const hard_room *room, size_t parts, double *average) {
  mesh m = graded(room, parts);
  const size_t n = m.count;
  double *scale = calloc(4 * n, sizeof *scale), *diagonal = scale + n, *b = diagonal + n,
         *y = b + n;
  ck_assert_ptr_nonnull(scale);
  for (size_t i = 0; i < n; i++) {
    double sum = 0;
    for (size_t j = 0; j < n; j++) sum += m.exchange[i * n + j];
    diagonal[i] = (double)m.element[i].length - sum;
    scale[i] = sqrt(room->wall[m.element[i].wall][5] / (double)m.element[i].length);
  }
  for (size_t i = 0; i < n; i++) {
    b[i] = diagonal[i] * room->wall[m.element[i].wall][4];
    for (size_t j = 0; j < n; j++)
      b[i] += m.exchange[i * n + j] * room->wall[m.element[j].wall][4];
    b[i] *= scale[i];
  }
  conjugate_gradients(&m, scale, diagonal, b, y);
  for (size_t w = 0; w < room->walls; w++) average[w] = 0;
  double length[HARD_WALLS] = {0};
  for (size_t i = 0; i < n; i++) {
    const double a = (double)m.element[i].length;
    length[m.element[i].wall] += a;
    average[m.element[i].wall] += a * scale[i] * y[i];
  }
  for (size_t w = 0; w < room->walls; w++)
    average[w] = room->wall[w][4] + average[w] / length[w];
  free(scale);
  free_mesh(&m);
}
