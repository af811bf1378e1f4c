/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In a convex room everything sees everything, so that V is 1 where both cosines are positive.

   A point is held as its nearer vertex and the distance from it. Differences of points are then
   exact to rounding however near to a vertex both are. A panel is no longer than its distance
   from the other patches: the poles of the kernel lie outside an ellipse of 4.2, beside corners
   of 5.8, and n points integrate to 5.8^-2n. */
#include "independent/convex-nystrom.h"

#include <check.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdlib.h>

typedef long double real;

typedef struct vec {
  real x, y;
} vec;

/* A point at a vertex + distance·(direction of its patch, or the opposite). */
typedef struct place {
  size_t patch, vertex;
  vec along; /* direction of the patch */
  vec off;
  real distance;     /* from the start of the patch or its end */
  real weight, root; /* and its square root */
  real last;         /* length of its panel, if that touches the vertex */
} place;

struct convex_solution {
  const convex_room *room;
  size_t count, capacity;
  place *place;
  double *radiosity, *irradiance;
};

static vec minus(vec a, vec b) {
  return (vec){a.x - b.x, a.y - b.y};
}

static real dot(vec a, vec b) {
  return a.x * b.x + a.y * b.y;
}

static vec vertex_of(const convex_room *r, size_t k) {
  const double *p = r->patch[k % r->patches];
  return (vec){p[0], p[1]};
}

static real length_of(const convex_room *r, size_t patch) {
  const vec d = minus(vertex_of(r, patch + 1), vertex_of(r, patch));
  return hypotl(d.x, d.y);
}

static vec direction_of(const convex_room *r, size_t patch) {
  const vec d = minus(vertex_of(r, patch + 1), vertex_of(r, patch));
  const real length = hypotl(d.x, d.y);
  return (vec){d.x / length, d.y / length};
}

static place place_at(const convex_room *r, size_t patch, real distance, int from_end) {
  const vec u = direction_of(r, patch);
  const real way = from_end ? -distance : distance;
  return (place){.patch = patch,
                 .vertex = (patch + (from_end ? 1 : 0)) % r->patches,
                 .along = u,
                 .off = {way * u.x, way * u.y},
                 .distance = distance};
}

/* y − x, without the part along `own` patch of x or y that a normal of it does not see. */
static vec between(const convex_room *r, const place *x, const place *y) {
  vec d = minus(y->off, x->off);
  if (x->vertex != y->vertex) {
    const vec apart = minus(vertex_of(r, y->vertex), vertex_of(r, x->vertex));
    d = (vec){d.x + apart.x, d.y + apart.y};
  }
  return d;
}

/* How far y is in front of the patch of x. */
static real above(const convex_room *r, const place *x, const place *y) {
  const vec u = x->along;
  const int mine = y->vertex == x->patch || y->vertex == (x->patch + 1) % r->patches;
  real height = u.x * y->off.y - u.y * y->off.x;
  if (!mine) {
    const vec apart = minus(vertex_of(r, y->vertex), vertex_of(r, x->patch));
    height += u.x * apart.y - u.y * apart.x;
  }
  return height;
}

static real kernel(const convex_room *r, const place *x, const place *y) {
  if (x->patch == y->patch) return 0;
  const real at_x = above(r, x, y), at_y = above(r, y, x);
  if (!(at_x > 0) || !(at_y > 0)) return 0;
  const vec d = between(r, x, y);
  const real square = dot(d, d);
  return at_x * at_y / (2 * square * sqrtl(square));
}

/* The distance of a point from another patch. */
static real distance_to(const convex_room *r, const place *x, size_t patch) {
  const place start = place_at(r, patch, 0, 0);
  const vec u = start.along, d = between(r, &start, x);
  const real along = fminl(fmaxl(dot(d, u), 0), length_of(r, patch));
  return hypotl(d.x - along * u.x, d.y - along * u.y);
}

static void add_panel(convex_solution *s, size_t patch, int from_end, real from, real to,
                      const gsl_integration_glfixed_table *rule) {
  for (size_t q = 0; q < rule->n; q++) {
    double at, weight;
    gsl_integration_glfixed_point(-1, 1, q, &at, &weight, rule);
    if (s->count == s->capacity) {
      s->capacity = 2 * s->capacity + 1024;
      s->place = realloc(s->place, s->capacity * sizeof *s->place);
      ck_assert_ptr_nonnull(s->place);
    }
    place *p = &s->place[s->count++];
    *p = place_at(s->room, patch, from + (to - from) * (1 + (real)at) / 2, from_end);
    p->weight = (to - from) * (real)weight / 2;
    p->root = sqrtl(p->weight);
    if (!(from > 0)) p->last = to;
  }
}

/* Half a patch, from the vertex at 0. */
static void add_half(convex_solution *s, size_t patch, int from_end, real from, real to,
                     real last, const gsl_integration_glfixed_table *rule) {
  const convex_room *r = s->room;
  real near = HUGE_VALL;
  for (size_t k = 0; k < r->patches; k++)
    for (int q = 0; q < 5 && k != patch; q++) {
      const place p = place_at(r, patch, from + (to - from) * q / 4, from_end);
      near = fminl(near, distance_to(r, &p, k));
    }
  const int small = from > 0 ? 0 : to <= last;
  if (small || to - from <= near * 1.0001L) {
    add_panel(s, patch, from_end, from, to, rule);
    return;
  }
  add_half(s, patch, from_end, from, (from + to) / 2, last, rule);
  add_half(s, patch, from_end, (from + to) / 2, to, last, rule);
}

static double reflectance(const convex_solution *s, size_t at) {
  return s->room->patch[s->place[at].patch][5];
}

static double emission(const convex_solution *s, size_t at) {
  return s->room->patch[s->place[at].patch][4];
}

/* Whether both points are on the last panels at a vertex. */
static int meet(const place *x, const place *y) {
  return x->vertex == y->vertex && x->patch != y->patch && x->last > 0 && y->last > 0;
}

/* The exchange of the last panels at a vertex, by Hottel's strings, is its part of what the
   rule makes of it. */
static real last_exchange(const place *x, const place *y) {
  const real cosine = -dot(x->along, y->along);
  const real a = x->last, b = y->last, far = sqrtl(a * a + b * b - 2 * a * b * cosine);
  return a * b * (1 + cosine) / (a + b + far); /* ½(a + b − far) */
}

/* √(w_i w_j) G. The rule resolves all but the exchange of two last panels, of which only the
   sum is right; what it still misses of ∫ G dy = 1 is put on the diagonal. */
static double *make_matrix(const convex_solution *s) {
  const size_t n = s->count;
  double *m = calloc(n * n, sizeof *m);
  real *found = calloc(s->room->patches, sizeof *found);
  ck_assert(m != NULL && found != NULL);
  for (int round = 0; round < 2; round++)
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < i; j++) {
        const place *x = &s->place[i], *y = &s->place[j];
        const int last = meet(x, y);
        if (round == 0 && !last) continue;
        real g = kernel(s->room, x, y);
        if (round == 0) found[x->vertex] += g * x->weight * y->weight;
        if (round == 1 && last && g > 0) g *= last_exchange(x, y) / found[x->vertex];
        m[i * n + j] = m[j * n + i] = (double)(g * x->root * y->root);
      }
  for (size_t i = 0; i < n; i++) {
    real seen = 0;
    for (size_t j = 0; j < n; j++) seen += m[i * n + j] * s->place[j].root;
    m[i * n + i] = (double)(1 - seen / s->place[i].root);
  }
  free(found);
  return m;
}

static void multiply(const double *m, size_t n, const double *in, double *out) {
  for (size_t i = 0; i < n; i++) {
    const double *row = m + i * n;
    double sum[4] = {0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
      for (size_t k = 0; k < 4; k++) sum[k] += row[j + k] * in[j + k];
    for (; j < n; j++) sum[0] += row[j] * in[j];
    out[i] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
}

static double scalar(const double *u, const double *v, size_t n) {
  real sum = 0;
  for (size_t k = 0; k < n; k++) sum += (real)u[k] * v[k];
  return (double)sum;
}

/* (I − √ρ M √ρ) y = √ρ M √w E by conjugate gradients; then B = E + ρKB some times over, which
   gives small patches the digits that the norm of all does not ask for.

   At last H is gathered without the diagonal.  Its mean over a patch is 0, since the rules add
   up to the exchange of whole patches; what it has in doubles, times B of a lamp, may be much
   of the H of the lamp. */
static void solve(convex_solution *s, double *m) {
  enum { MOST = 400, SWEEPS = 12 };
  const size_t n = s->count;
  double *space = calloc(6 * n, sizeof *space);
  ck_assert_ptr_nonnull(space);
  double *y = space, *r = y + n, *p = r + n, *q = p + n, *in = q + n, *root = in + n;
  for (size_t k = 0; k < n; k++) {
    root[k] = sqrt(reflectance(s, k));
    in[k] = (double)s->place[k].root * emission(s, k);
  }
  multiply(m, n, in, r);
  for (size_t k = 0; k < n; k++) p[k] = r[k] = root[k] * r[k];
  double square = scalar(r, r, n);
  const double first = square;
  for (int step = 0; step < MOST && square > 1e-32 * first; step++) {
    for (size_t k = 0; k < n; k++) in[k] = root[k] * p[k];
    multiply(m, n, in, q);
    for (size_t k = 0; k < n; k++) q[k] = p[k] - root[k] * q[k];
    const double way = square / scalar(p, q, n);
    for (size_t k = 0; k < n; k++) y[k] += way * p[k], r[k] -= way * q[k];
    const double next = scalar(r, r, n);
    for (size_t k = 0; k < n; k++) p[k] = r[k] + next / square * p[k];
    square = next;
  }
  for (size_t k = 0; k < n; k++)
    in[k] = (double)s->place[k].root * emission(s, k) + root[k] * y[k];
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    multiply(m, n, in, q);
    for (size_t k = 0; k < n; k++)
      in[k] = (double)s->place[k].root * emission(s, k) + reflectance(s, k) * q[k];
  }
  for (size_t k = 0; k < n; k++) m[k * n + k] = 0;
  multiply(m, n, in, q);
  for (size_t k = 0; k < n; k++) {
    s->radiosity[k] = in[k] / (double)s->place[k].root;
    s->irradiance[k] = q[k] / (double)s->place[k].root;
  }
  free(space);
}

convex_solution *convex_solve(const convex_room *room, convex_mesh mesh) {
  convex_solution *s = calloc(1, sizeof *s);
  gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(mesh.points);
  ck_assert(s != NULL && rule != NULL);
  s->room = room;
  for (size_t k = 0; k < room->patches; k++)
    for (int end = 0; end < 2; end++) {
      const size_t other = (k + (end ? 1 : room->patches - 1)) % room->patches;
      const real shorter = fminl(length_of(room, k), length_of(room, other));
      add_half(s, k, end, 0, length_of(room, k) / 2, ldexpl(shorter, -mesh.levels), rule);
    }
  s->radiosity = calloc(2 * s->count, sizeof *s->radiosity);
  ck_assert_ptr_nonnull(s->radiosity);
  s->irradiance = s->radiosity + s->count;
  double *m = make_matrix(s);
  solve(s, m);
  free(m);
  gsl_integration_glfixed_table_free(rule);
  return s;
}

void convex_destroy(convex_solution *s) {
  if (!s) return;
  free(s->place);
  free(s->radiosity);
  free(s);
}

static double average(const convex_solution *s, const double *value, size_t patch) {
  real sum = 0;
  for (size_t k = 0; k < s->count; k++)
    if (s->place[k].patch == patch) sum += s->place[k].weight * value[k];
  return (double)(sum / length_of(s->room, patch));
}

double convex_radiosity(const convex_solution *s, size_t patch) {
  return average(s, s->radiosity, patch);
}

double convex_irradiance(const convex_solution *s, size_t patch) {
  return average(s, s->irradiance, patch);
}

double convex_irradiance_at(const convex_solution *s, size_t patch, double distance,
                            int from_end) {
  const place x = place_at(s->room, patch, distance, from_end);
  real sum = 0;
  for (size_t k = 0; k < s->count; k++)
    sum += kernel(s->room, &x, &s->place[k]) * s->place[k].weight * s->radiosity[k];
  return (double)sum;
}
