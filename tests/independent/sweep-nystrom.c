/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With s the sine of the angle from the normal, H = ½ ∫ B ds: no kernel is left that could be
   nearly singular. Where a point sees a patch that reflects nothing, B is constant and the
   integral is a difference of sines. On other patches B is a polynomial on each panel.

   Panels begin at the places where views change. They are halved until the polynomial through
   their nodes agrees with H in between. This H comes from the solution on the panels before, so
   that each round sees the bends of B that the last one made. */
#include "independent/sweep-nystrom.h"

#include <check.h>
#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_POINTS = 16, NEAR_POINTS = 16, DEEPEST = 46, ROUNDS = 4 };

/* Beside an end, B bends like a power of the distance. Panels shorter than this part of a patch
   need not follow it: nobody asks there. */
#define LEAST 1e-9L

typedef struct rule {
  size_t count;
  double at[MOST_POINTS], weight[MOST_POINTS]; /* in −1 … 1 */
  double scale[MOST_POINTS];                   /* barycentric */
} rule;

typedef struct panel {
  size_t patch, node; /* its first node */
  real from, to;
} panel;

typedef struct node {
  size_t patch;
  spot place, normal;
  double weight; /* length */
} node;

typedef struct mesh {
  panel *panel;
  node *node;
  double *radiosity; /* nodes × bands */
  size_t panels, nodes, capacity;
  size_t *first; /* panel of each patch, and one more */
} mesh;

struct swept_solution {
  const swept_scene *scene;
  rule rule, near;
  double tolerance, scale[SWEPT_BANDS];
  real **event;
  size_t *events;
  sweep_span *span; /* work space of a gather */
  double *row;
  size_t row_size;
  mesh mesh;
};

static rule make_rule(size_t points) {
  rule r = {.count = points};
  gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(points);
  ck_assert(table != NULL && points <= MOST_POINTS);
  for (size_t k = 0; k < points; k++)
    gsl_integration_glfixed_point(-1, 1, k, &r.at[k], &r.weight[k], table);
  gsl_integration_glfixed_table_free(table);
  for (size_t k = 0; k < points; k++) {
    r.scale[k] = 1;
    for (size_t m = 0; m < points; m++)
      if (m != k) r.scale[k] /= 2 * (r.at[k] - r.at[m]);
  }
  return r;
}

/* The values at z of the polynomials that are 1 at one node and 0 at the others. */
static void interpolate(const rule *r, double z, double *value) {
  double sum = 0;
  for (size_t k = 0; k < r->count; k++) {
    if (z == r->at[k]) {
      memset(value, 0, r->count * sizeof *value);
      value[k] = 1;
      return;
    }
    sum += value[k] = r->scale[k] / (z - r->at[k]);
  }
  for (size_t k = 0; k < r->count; k++) value[k] /= sum;
}

static int reflects(const swept_scene *s, size_t patch) {
  for (size_t b = 0; b < s->bands; b++)
    if (s->light[patch].reflectance[b] > 0) return 1;
  return 0;
}

/* A panel as a point sees it. */
typedef struct sight {
  const sweep_frame *f;
  const panel *panel;
  spot a, d; /* the start of its patch and the vector to the end, local */
  real pole; /* the direction along the patch */
  double *row;
} sight;

/* ½ ∫ cosθ B dθ by a rule, where θ leads to the place t = a×e/(e×d) of the patch, e the
   direction: a tangent, whose pole is a whole interval away. */
static void add_directions(const swept_solution *s, const sight *v, real low, real high) {
  const real middle = (low + high) / 2, half = (high - low) / 2;
  for (size_t q = 0; q < s->near.count; q++) {
    const real angle = middle + half * s->near.at[q];
    const spot e = {sinl(angle), cosl(angle)};
    const real t = sweep_cross(v->a, e) / sweep_cross(e, v->d);
    const double z =
        (double)((2 * t - v->panel->from - v->panel->to) / (v->panel->to - v->panel->from));
    double value[MOST_POINTS];
    interpolate(&s->rule, fmin(fmax(z, -1), 1), value);
    const double weight = (double)(half * e.y / 2) * s->near.weight[q];
    for (size_t k = 0; k < s->rule.count; k++) v->row[v->panel->node + k] += weight * value[k];
  }
}

static void add_part(const swept_solution *s, const sight *v, real low, real high) {
  const real from_pole = fminl(fabsl(sinl(low - v->pole)), fabsl(sinl(high - v->pole)));
  if (high - low <= from_pole || high - low < 1e-13L) {
    add_directions(s, v, low, high);
    return;
  }
  const real middle = (low + high) / 2;
  add_part(s, v, low, middle);
  add_part(s, v, middle, high);
}

/* All of a panel at which B and the kernel are smooth: at its nodes. */
static void add_far(const swept_solution *s, const sight *v) {
  const double ux = (double)v->f->along.x, uy = (double)v->f->along.y;
  for (size_t k = v->panel->node; k < v->panel->node + s->rule.count; k++) {
    const node *n = &s->mesh.node[k];
    const double x = (double)(n->place.x - v->f->origin.x);
    const double y = (double)(n->place.y - v->f->origin.y);
    const double mine = ux * y - uy * x;
    const double other = -((double)n->normal.x * x + (double)n->normal.y * y);
    const double square = x * x + y * y;
    if (mine > 0 && other > 0)
      v->row[k] += n->weight * mine * other / (2 * square * sqrt(square));
  }
}

/* No longer than its distance from the point. */
static int is_far(spot from, spot to) {
  const spot d = {to.x - from.x, to.y - from.y};
  const real square = d.x * d.x + d.y * d.y;
  const real at = fminl(fmaxl(-(from.x * d.x + from.y * d.y) / square, 0), 1);
  return hypotl(from.x + at * d.x, from.y + at * d.y) >= sqrtl(square);
}

/* The direction of a place of the patch, or of the patch at the horizon. A patch turns from
   high angles to low ones where its front is seen. */
static real direction(const sight *v, spot place) {
  if (place.y > 0) return sweep_angle(place);
  return v->d.y > 0 ? HUGE_VALL : -HUGE_VALL;
}

static void add_mirror(const swept_solution *s, const sweep_frame *f, const sweep_span *span,
                       double *row) {
  const sweep_patches *p = &s->scene->patches;
  const size_t patch = span->seen;
  const spot a = sweep_local(f, sweep_place(p, patch, 0));
  const spot b = sweep_local(f, sweep_place(p, patch, 1));
  sight v = {.f = f, .a = a, .d = {b.x - a.x, b.y - a.y}, .row = row};
  v.pole = sweep_angle(v.d);
  spot from = a;
  real high = direction(&v, from);
  for (size_t k = s->mesh.first[patch]; k < s->mesh.first[patch + 1]; k++) {
    v.panel = &s->mesh.panel[k];
    const spot to = sweep_local(f, sweep_place(p, patch, v.panel->to));
    const real low = direction(&v, to);
    const real least = fmaxl(low, span->low), most = fminl(high, span->high);
    const int whole = low >= span->low - 1e-17L && high <= span->high + 1e-17L;
    if (most > least) {
      if (whole && is_far(from, to))
        add_far(s, &v);
      else
        add_part(s, &v, least, most);
    }
    from = to;
    high = low;
  }
}

/* The weights of B at all nodes in H at a place, and what arrives from elsewhere. */
static void make_row(const swept_solution *s, size_t patch, real t, double *row, double *rest) {
  const swept_scene *scene = s->scene;
  const sweep_frame f = sweep_frame_at(&scene->patches, patch, t);
  const size_t spans = sweep_all(&scene->patches, &f, s->span);
  memset(row, 0, s->mesh.nodes * sizeof *row);
  for (size_t b = 0; b < scene->bands; b++) rest[b] = 0;
  for (size_t k = 0; k < spans; k++) {
    const sweep_span *span = &s->span[k];
    if (span->seen == SWEEP_BACK) continue;
    if (span->seen != SWEEP_SKY && reflects(scene, span->seen)) {
      add_mirror(s, &f, span, row);
      continue;
    }
    const real part = cosl((span->low + span->high) / 2) * sinl((span->high - span->low) / 2);
    for (size_t b = 0; b < scene->bands; b++)
      rest[b] +=
          (double)part * (span->seen == SWEEP_SKY ? scene->background[b]
                                                  : scene->light[span->seen].emission[b]);
  }
}

static double gather(const swept_solution *s, const double *row, size_t band) {
  double sum = 0;
  for (size_t k = 0; k < s->mesh.nodes; k++)
    sum += row[k] * s->mesh.radiosity[k * s->scene->bands + band];
  return sum;
}

void swept_at(const swept_solution *s, size_t patch, real t, double *irradiance) {
  double rest[SWEPT_BANDS];
  make_row(s, patch, t, s->row, rest);
  for (size_t b = 0; b < s->scene->bands; b++) irradiance[b] = gather(s, s->row, b) + rest[b];
}

/* H at the nodes of a panel. */
typedef struct values {
  double at[MOST_POINTS][SWEPT_BANDS];
} values;

static void find_values(const swept_solution *s, size_t patch, real from, real to, values *v) {
  for (size_t k = 0; k < s->rule.count; k++)
    swept_at(s, patch, from + (to - from) * (1 + s->rule.at[k]) / 2, v->at[k]);
}

/* How far the polynomial of a panel is from H on one half of it, relative to the scale. */
static double miss(const swept_solution *s, const values *whole, const values *half,
                   int second) {
  double most = 0;
  for (size_t k = 0; k < s->rule.count; k++) {
    double value[MOST_POINTS];
    interpolate(&s->rule, (s->rule.at[k] + (second ? 1 : -1)) / 2, value);
    for (size_t b = 0; b < s->scene->bands; b++) {
      double sum = 0;
      for (size_t m = 0; m < s->rule.count; m++) sum += value[m] * whole->at[m][b];
      most = fmax(most, fabs(sum - half->at[k][b]) / s->scale[b]);
    }
  }
  return most;
}

/* A pass over the panels that H asks for. */
typedef struct pass {
  const swept_solution *s;
  size_t patch;
  double tolerance;
  mesh *mesh;  /* receives the panels; or NULL: */
  double *sum; /* receives ∫ H dt */
} pass;

static void add_panel(const pass *p, real from, real to) {
  const swept_solution *s = p->s;
  const sweep_patches *patches = &s->scene->patches;
  mesh *m = p->mesh;
  const sweep_frame f = sweep_frame_at(patches, p->patch, 0);
  const double *at = patches->at[p->patch];
  const double length = hypot(at[2] - at[0], at[3] - at[1]);
  if (m->panels == m->capacity) {
    m->capacity = 2 * m->capacity + 64;
    m->panel = realloc(m->panel, m->capacity * sizeof *m->panel);
    m->node = realloc(m->node, m->capacity * s->rule.count * sizeof *m->node);
    ck_assert(m->panel != NULL && m->node != NULL);
  }
  m->panel[m->panels++] = (panel){p->patch, m->nodes, from, to};
  for (size_t k = 0; k < s->rule.count; k++)
    m->node[m->nodes++] =
        (node){p->patch,
               sweep_place(patches, p->patch, from + (to - from) * (1 + s->rule.at[k]) / 2),
               {-f.along.y, f.along.x},
               (double)(to - from) * length * s->rule.weight[k] / 2};
}

static void finish_panel(const pass *p, real from, real to, const values *v) {
  if (p->mesh)
    add_panel(p, from, to);
  else
    for (size_t k = 0; k < p->s->rule.count; k++)
      for (size_t b = 0; b < p->s->scene->bands; b++)
        p->sum[b] += (double)(to - from) * p->s->rule.weight[k] / 2 * v->at[k][b];
}

/* An average takes no more from a panel than its part of the patch. */
static double importance(const pass *p, real length) {
  return p->mesh ? (double)fminl(length / LEAST, 1) : (double)length;
}

static void refine(const pass *p, real from, real to, const values *v, int depth) {
  const swept_solution *s = p->s;
  const real middle = (from + to) / 2;
  values half[2];
  find_values(s, p->patch, from, middle, &half[0]);
  find_values(s, p->patch, middle, to, &half[1]);
  const double off = fmax(miss(s, v, &half[0], 0), miss(s, v, &half[1], 1));
  if (depth == DEEPEST || off * importance(p, to - from) <= p->tolerance) {
    finish_panel(p, from, to, v);
    return;
  }
  refine(p, from, middle, &half[0], depth + 1);
  refine(p, middle, to, &half[1], depth + 1);
}

static void run(const pass *p) {
  const real *at = p->s->event[p->patch];
  for (size_t k = 1; k < p->s->events[p->patch]; k++) {
    values v;
    find_values(p->s, p->patch, at[k - 1], at[k], &v);
    refine(p, at[k - 1], at[k], &v, 0);
  }
}

static void free_mesh(mesh *m) {
  free(m->panel);
  free(m->node);
  free(m->radiosity);
  free(m->first);
}

/* Panels of the patches that reflect: `tolerance` infinite asks for no halving. */
static mesh make_mesh(const swept_solution *s, double tolerance) {
  const size_t patches = s->scene->patches.count;
  mesh m = {.first = calloc(patches + 1, sizeof *m.first)};
  ck_assert_ptr_nonnull(m.first);
  for (size_t k = 0; k < patches; k++) {
    const pass p = {s, k, tolerance, &m, NULL};
    m.first[k] = m.panels;
    if (!reflects(s->scene, k)) continue;
    if (isfinite(tolerance))
      run(&p);
    else
      for (size_t e = 1; e < s->events[k]; e++)
        add_panel(&p, s->event[k][e - 1], s->event[k][e]);
  }
  m.first[patches] = m.panels;
  m.radiosity = calloc(m.nodes * s->scene->bands + 1, sizeof *m.radiosity);
  ck_assert_ptr_nonnull(m.radiosity);
  return m;
}

/* B = E + ρH by Gauss and Seidel. */
static double sweep_nodes(swept_solution *s, const double *matrix, const double *rest) {
  const size_t n = s->mesh.nodes, bands = s->scene->bands;
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const swept_light *light = &s->scene->light[s->mesh.node[i].patch];
    double sum[SWEPT_BANDS] = {0};
    for (size_t j = 0; j < n; j++)
      for (size_t b = 0; b < bands; b++)
        sum[b] += matrix[i * n + j] * s->mesh.radiosity[j * bands + b];
    for (size_t b = 0; b < bands; b++) {
      const double h = sum[b] + rest[i * bands + b];
      const double value = light->emission[b] + light->reflectance[b] * h;
      double *is = &s->mesh.radiosity[i * bands + b];
      most = fmax(most, fabs(value - *is) / s->scale[b]);
      *is = value;
    }
  }
  return most;
}

/* Stops when changes no longer shrink: roundings are left. */
static void solve(swept_solution *s, double enough) {
  const size_t n = s->mesh.nodes, bands = s->scene->bands;
  double *matrix = malloc((n * n + 1) * sizeof *matrix);
  double *rest = malloc((n * bands + 1) * sizeof *rest);
  ck_assert(matrix != NULL && rest != NULL);
  for (size_t k = 0; k < s->mesh.panels; k++)
    for (size_t q = 0; q < s->rule.count; q++) {
      const panel *p = &s->mesh.panel[k];
      const size_t i = p->node + q;
      make_row(s, p->patch, p->from + (p->to - p->from) * (1 + s->rule.at[q]) / 2,
               matrix + i * n, rest + i * bands);
    }
  for (int k = 0; k < 400 && sweep_nodes(s, matrix, rest) > enough; k++) continue;
  free(matrix);
  free(rest);
}

static void replace_mesh(swept_solution *s, double tolerance) {
  mesh m = make_mesh(s, tolerance);
  free_mesh(&s->mesh);
  s->mesh = m;
  free(s->row);
  s->row = calloc(m.nodes + 1, sizeof *s->row);
  ck_assert_ptr_nonnull(s->row);
}

static void prepare(swept_solution *s) {
  const swept_scene *scene = s->scene;
  const size_t patches = scene->patches.count;
  s->span = calloc(2 * patches + 2, sizeof *s->span);
  s->event = calloc(patches, sizeof *s->event);
  s->events = calloc(patches, sizeof *s->events);
  ck_assert(s->span != NULL && s->event != NULL && s->events != NULL);
  for (size_t k = 0; k < patches; k++)
    s->event[k] = sweep_events(&scene->patches, k, &s->events[k]);
  for (size_t b = 0; b < scene->bands; b++) {
    s->scale[b] = scene->background[b];
    for (size_t k = 0; k < patches; k++)
      s->scale[b] = fmax(s->scale[b], scene->light[k].emission[b]);
    if (!(s->scale[b] > 0)) s->scale[b] = 1;
  }
}

swept_solution *swept_solve(const swept_scene *scene, swept_mesh how) {
  swept_solution *s = calloc(1, sizeof *s);
  ck_assert(s != NULL && scene->bands <= SWEPT_BANDS);
  s->scene = scene;
  s->rule = make_rule(how.points);
  s->near = make_rule(NEAR_POINTS);
  s->tolerance = how.tolerance;
  prepare(s);
  replace_mesh(s, HUGE_VAL);
  solve(s, 1e-4);
  for (int round = 1; round < ROUNDS && s->mesh.nodes > 0; round++) {
    const double part = round < ROUNDS - 2 ? 1e3 : 1;
    replace_mesh(s, part * how.tolerance);
    solve(s, round == ROUNDS - 1 ? 1e-15 : 0.01 * how.tolerance);
  }
  return s;
}

void swept_destroy(swept_solution *s) {
  if (!s) return;
  for (size_t k = 0; k < s->scene->patches.count; k++) free(s->event[k]);
  free(s->event);
  free(s->events);
  free(s->span);
  free(s->row);
  free_mesh(&s->mesh);
  free(s);
}

size_t swept_nodes(const swept_solution *s) {
  return s->mesh.nodes;
}

void swept_average(const swept_solution *s, size_t patch, double *irradiance) {
  const pass p = {s, patch, s->tolerance, NULL, irradiance};
  for (size_t b = 0; b < s->scene->bands; b++) irradiance[b] = 0;
  run(&p);
}
