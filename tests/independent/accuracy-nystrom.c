/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "independent/accuracy-nystrom.h"

#include <check.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

/* Panels with 20 points each: their poles lie so that the rule is good to 1e-15 or so. */
enum { POINTS = 20 };

/* The length of the last panel at a corner, which is not graded further. */
#define SMALLEST 0x1p-46

typedef struct side {
  size_t count;
  double *at, *weight; /* lengths along the patch */
} side;

/* G between lengths x on the floor and y on the other patch. */
typedef struct kernel {
  double sine, cosine; /* of a corner's angle */
  double height;       /* of a ceiling */
} kernel;

static double value_of(const kernel *k, double x, double y) {
  const double square = k->height > 0 ? (x - y) * (x - y) + k->height * k->height
                                      : x * x + y * y - 2 * x * y * k->cosine;
  const double cosines = k->height > 0 ? k->height * k->height : x * y * k->sine * k->sine;
  return cosines / (2 * square * sqrt(square));
}

static void add_panel(side *s, double from, double to) {
  gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(POINTS);
  s->at = realloc(s->at, (s->count + POINTS) * sizeof *s->at);
  s->weight = realloc(s->weight, (s->count + POINTS) * sizeof *s->weight);
  ck_assert(rule != NULL && s->at != NULL && s->weight != NULL);
  for (size_t q = 0; q < POINTS; q++, s->count++)
    gsl_integration_glfixed_point(from, to, q, &s->at[s->count], &s->weight[s->count], rule);
  gsl_integration_glfixed_table_free(rule);
}

/* Shrinks towards the corner, which is at 0: from x poles are at x e^±iα. */
static side graded(double length, double sine) {
  const double ratio = 1 + fmin(1, 2.8 * sine);
  side s = {0, NULL, NULL};
  double to = length;
  for (; to > SMALLEST; to /= ratio) add_panel(&s, to / ratio, to);
  add_panel(&s, 0, to);
  return s;
}

/* As far from poles at a height above their line as panels twice as long can be. */
static side even(double from, double to, double height) {
  const int panels = 1 + (int)ceil((to - from) / fmin(2 * height, .5));
  const double size = (to - from) / panels;
  side s = {0, NULL, NULL};
  for (int k = 0; k < panels; k++) add_panel(&s, from + k * size, from + (k + 1) * size);
  return s;
}

typedef struct matrix {
  size_t rows, columns;
  double *value; /* √(w_i w_j) G(x_i, y_j) */
} matrix;

static matrix make_matrix(const kernel *k, const side *floor, const side *other) {
  matrix m = {floor->count, other->count, malloc(floor->count * other->count * sizeof(double))};
  ck_assert(m.value != NULL);
  for (size_t i = 0; i < m.rows; i++)
    for (size_t j = 0; j < m.columns; j++)
      m.value[i * m.columns + j] =
          sqrt(floor->weight[i] * other->weight[j]) * value_of(k, floor->at[i], other->at[j]);
  return m;
}

/* out = ρ M in, or ρ Mᵀ in. */
static void multiply(const matrix *m, int transposed, double rho, const double *in,
                     double *out) {
  for (size_t k = 0; k < (transposed ? m->columns : m->rows); k++) out[k] = 0;
  for (size_t i = 0; i < m->rows; i++)
    for (size_t j = 0; j < m->columns; j++) {
      if (transposed)
        out[j] += rho * m->value[i * m->columns + j] * in[i];
      else
        out[i] += rho * m->value[i * m->columns + j] * in[j];
    }
}

static double dot(const double *u, const double *v, size_t count) {
  double sum = 0;
  for (size_t k = 0; k < count; k++) sum += u[k] * v[k];
  return sum;
}

/* u = √w B on the floor from (I − ρ² M Mᵀ) u = √w, with v for the other patch: conjugate
   gradients. */
static void solve(const matrix *m, double rho, const side *floor, double *u, double *v) {
  const size_t n = m->rows;
  double *r = calloc(3 * n, sizeof *r), *p = r + n, *q = p + n;
  ck_assert(r != NULL);
  for (size_t k = 0; k < n; k++) u[k] = 0, r[k] = p[k] = sqrt(floor->weight[k]);
  double square = dot(r, r, n);
  for (int k = 0; k < 2000 && square > 1e-34; k++) {
    multiply(m, 1, rho, p, v);
    multiply(m, 0, rho, v, q);
    for (size_t i = 0; i < n; i++) q[i] = p[i] - q[i];
    const double step = square / dot(p, q, n);
    for (size_t i = 0; i < n; i++) u[i] += step * p[i], r[i] -= step * q[i];
    const double next = dot(r, r, n);
    for (size_t i = 0; i < n; i++) p[i] = r[i] + next / square * p[i];
    square = next;
  }
  ck_assert_double_lt(square, 1e-30);
  multiply(m, 1, rho, u, v);
  free(r);
}

/* ∫ G B over one side, seen from x on the other. */
static double gather(const kernel *k, const side *s, const double *u, double x, int on_floor) {
  double sum = 0;
  for (size_t q = 0; q < s->count; q++)
    sum += sqrt(s->weight[q]) * u[q] *
           (on_floor ? value_of(k, x, s->at[q]) : value_of(k, s->at[q], x));
  return sum;
}

/* `origin` and `way` lead from a fraction of the other patch to its length along the side. */
static void finish(nystrom *n, const kernel *k, side *floor, side *other, double origin,
                   double way) {
  const double rho = n->patch[0][5];
  matrix m = make_matrix(k, floor, other);
  double *u = malloc((floor->count + other->count) * sizeof *u), *v = u + floor->count;
  ck_assert(u != NULL);
  solve(&m, rho, floor, u, v);
  n->average[0] = n->average[1] = 0;
  for (size_t q = 0; q < floor->count; q++) n->average[0] += sqrt(floor->weight[q]) * u[q];
  for (size_t q = 0; q < other->count; q++)
    n->average[1] += sqrt(other->weight[q]) * v[q] / fabs(way);
  for (int q = 0; q < 3; q++) {
    const double t = n->place[q] = .25 * (q + 1);
    n->value[0][q] = 1 + rho * gather(k, other, v, t, 1);
    n->value[1][q] = rho * gather(k, floor, u, origin + way * t, 0);
  }
  side *const sides[] = {floor, other};
  for (int s = 0; s < 2; s++) free(sides[s]->at), free(sides[s]->weight);
  free(m.value);
  free(u);
}

nystrom nystrom_corner(double angle, double length, double rho) {
  const double sine = sin(angle * PI / 180), cosine = cos(angle * PI / 180);
  const kernel k = {sine, cosine, 0};
  nystrom n = {.patch = {{0, 0, 1, 0, 1, rho}, {length * cosine, length * sine, 0, 0, 0, rho}}};
  side floor = graded(1, sine), wall = graded(length, sine);
  finish(&n, &k, &floor, &wall, length, -length);
  return n;
}

nystrom nystrom_parallel(double height, double from, double to, double rho) {
  const kernel k = {0, 0, height};
  nystrom n = {.patch = {{0, 0, 1, 0, 1, rho}, {to, height, from, height, 0, rho}}};
  side floor = even(0, 1, height), ceiling = even(from, to, height);
  finish(&n, &k, &floor, &ceiling, to, from - to);
  return n;
}
