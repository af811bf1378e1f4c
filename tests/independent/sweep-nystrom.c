/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels begin at the places where views change. They are halved until the polynomial through
   their nodes agrees with H in between. This H comes from the solution on the panels before, so
   that each round sees the bends of B that the last one made. */
#include "independent/sweep-nystrom.h"

#include <check.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "independent/sweep-row.h"

enum { NEAR_POINTS = 16, DEEPEST = 46, ROUNDS = 4 };

/* Beside an end, B bends like a power of the distance. Panels shorter than this part of a patch
   need not follow it: nobody asks there. */
#define LEAST 1e-9L

struct swept_solution {
  sweep_field field;
  double tolerance, scale[SWEPT_BANDS];
  real **event;
  size_t *events;
  double *row; /* work space */
};

static double gather(const swept_solution *s, const double *row, size_t band) {
  double sum = 0;
  for (size_t k = 0; k < s->field.mesh.nodes; k++)
    sum += row[k] * s->field.mesh.radiosity[k * s->field.scene->bands + band];
  return sum;
}

void swept_at(const swept_solution *s, size_t patch, real t, double *irradiance) {
  double rest[SWEPT_BANDS];
  sweep_row(&s->field, patch, t, s->row, rest);
  for (size_t b = 0; b < s->field.scene->bands; b++)
    irradiance[b] = gather(s, s->row, b) + rest[b];
}

/* H at the nodes of a panel. */
typedef struct values {
  double at[MOST_POINTS][SWEPT_BANDS];
} values;

static void find_values(const swept_solution *s, size_t patch, real from, real to, values *v) {
  for (size_t k = 0; k < s->field.rule.count; k++)
    swept_at(s, patch, from + (to - from) * (1 + s->field.rule.at[k]) / 2, v->at[k]);
}

/* How far the polynomial of a panel is from H on one half of it, relative to the scale. */
static double miss(const swept_solution *s, const values *whole, const values *half,
                   int second) {
  double max = 0;
  for (size_t k = 0; k < s->field.rule.count; k++) {
    double value[MOST_POINTS];
    sweep_interpolate(&s->field.rule, (s->field.rule.at[k] + (second ? 1 : -1)) / 2, value);
    for (size_t b = 0; b < s->field.scene->bands; b++) {
      double sum = 0;
      for (size_t m = 0; m < s->field.rule.count; m++) sum += value[m] * whole->at[m][b];
      max = fmax(max, fabs(sum - half->at[k][b]) / s->scale[b]);
    }
  }
  return max;
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
  const sweep_patches *patches = &s->field.scene->patches;
  mesh *m = p->mesh;
  const sweep_frame f = sweep_frame_at(patches, p->patch, 0);
  const double *at = patches->at[p->patch];
  const double length = hypot(at[2] - at[0], at[3] - at[1]);
  if (m->panels == m->capacity) {
    m->capacity = 2 * m->capacity + 64;
    m->panel = realloc(m->panel, m->capacity * sizeof *m->panel);
    m->node = realloc(m->node, m->capacity * s->field.rule.count * sizeof *m->node);
    ck_assert(m->panel != NULL && m->node != NULL);
  }
  m->panel[m->panels++] = (panel){p->patch, m->nodes, from, to};
  for (size_t k = 0; k < s->field.rule.count; k++)
    m->node[m->nodes++] = (node){
        p->patch,
        sweep_place(patches, p->patch, from + (to - from) * (1 + s->field.rule.at[k]) / 2),
        {-f.along.y, f.along.x},
        (double)(to - from) * length * s->field.rule.weight[k] / 2};
}

static void finish_panel(const pass *p, real from, real to, const values *v) {
  if (p->mesh)
    add_panel(p, from, to);
  else
    for (size_t k = 0; k < p->s->field.rule.count; k++)
      for (size_t b = 0; b < p->s->field.scene->bands; b++)
        p->sum[b] += (double)(to - from) * p->s->field.rule.weight[k] / 2 * v->at[k][b];
}

/* An average takes no more from a panel than its part of the patch. */
static double importance(const pass *p, real length) {
  return p->mesh ? (double)fminl(length / LEAST, 1) : (double)length;
}

/* Whether no node may be near enough to another patch to see what it does. */
static int is_blind(const pass *p, real from, real to) {
  const sweep_patches *patches = &p->s->field.scene->patches;
  const spot a = sweep_place(patches, p->patch, from), b = sweep_place(patches, p->patch, to);
  return hypotl(b.x - a.x, b.y - a.y) > 8 * sweep_clearance(patches, p->patch, from, to);
}

static void refine(const pass *p, real from, real to, const values *v, int depth) {
  const swept_solution *s = p->s;
  const real middle = (from + to) / 2;
  values half[2];
  find_values(s, p->patch, from, middle, &half[0]);
  find_values(s, p->patch, middle, to, &half[1]);
  const double off = fmax(miss(s, v, &half[0], 0), miss(s, v, &half[1], 1));
  if (depth == DEEPEST ||
      (off * importance(p, to - from) <= p->tolerance && !is_blind(p, from, to))) {
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
  const size_t patches = s->field.scene->patches.count;
  mesh m = {.first = calloc(patches + 1, sizeof *m.first)};
  ck_assert_ptr_nonnull(m.first);
  for (size_t k = 0; k < patches; k++) {
    const pass p = {s, k, tolerance, &m, NULL};
    m.first[k] = m.panels;
    if (!sweep_reflects(s->field.scene, k)) continue;
    if (isfinite(tolerance))
      run(&p);
    else
      for (size_t e = 1; e < s->events[k]; e++)
        add_panel(&p, s->event[k][e - 1], s->event[k][e]);
  }
  m.first[patches] = m.panels;
  m.radiosity = calloc(m.nodes * s->field.scene->bands + 1, sizeof *m.radiosity);
  ck_assert_ptr_nonnull(m.radiosity);
  return m;
}

/* B = E + ρH by Gauss and Seidel. */
static double sweep_nodes(swept_solution *s, const double *matrix, const double *rest) {
  const size_t n = s->field.mesh.nodes, bands = s->field.scene->bands;
  double max = 0;
  for (size_t i = 0; i < n; i++) {
    const swept_light *light = &s->field.scene->light[s->field.mesh.node[i].patch];
    double sum[SWEPT_BANDS] = {0};
    for (size_t j = 0; j < n; j++)
      for (size_t b = 0; b < bands; b++)
        sum[b] += matrix[i * n + j] * s->field.mesh.radiosity[j * bands + b];
    for (size_t b = 0; b < bands; b++) {
      const double h = sum[b] + rest[i * bands + b];
      const double value = light->emission[b] + light->reflectance[b] * h;
      double *is = &s->field.mesh.radiosity[i * bands + b];
      max = fmax(max, fabs(value - *is) / s->scale[b]);
      *is = value;
    }
  }
  return max;
}

/* Until a round changes little, or no less than the round before: roundings are left. */
static void solve(swept_solution *s, double enough) {
  const size_t n = s->field.mesh.nodes, bands = s->field.scene->bands;
  double *matrix = malloc((n * n + 1) * sizeof *matrix);
  double *rest = malloc((n * bands + 1) * sizeof *rest);
  ck_assert(matrix != NULL && rest != NULL);
  for (size_t k = 0; k < s->field.mesh.panels; k++)
    for (size_t q = 0; q < s->field.rule.count; q++) {
      const panel *p = &s->field.mesh.panel[k];
      const size_t i = p->node + q;
      sweep_row(&s->field, p->patch,
                p->from + (p->to - p->from) * (1 + s->field.rule.at[q]) / 2, matrix + i * n,
                rest + i * bands);
    }
  for (double before = HUGE_VAL, change = DBL_MAX; change > enough && change < before;) {
    before = change;
    change = sweep_nodes(s, matrix, rest);
  }
  free(matrix);
  free(rest);
}

static void replace_mesh(swept_solution *s, double tolerance) {
  mesh m = make_mesh(s, tolerance);
  free_mesh(&s->field.mesh);
  s->field.mesh = m;
  free(s->row);
  s->row = calloc(m.nodes + 1, sizeof *s->row);
  ck_assert_ptr_nonnull(s->row);
}

static void prepare(swept_solution *s) {
  const swept_scene *scene = s->field.scene;
  const size_t patches = scene->patches.count;
  s->field.span = calloc(2 * patches + 2, sizeof *s->field.span);
  s->event = calloc(patches, sizeof *s->event);
  s->events = calloc(patches, sizeof *s->events);
  ck_assert(s->field.span != NULL && s->event != NULL && s->events != NULL);
  for (size_t k = 0; k < patches; k++)
    s->event[k] = sweep_events(&scene->patches, k, &s->events[k]);
  for (size_t b = 0; b < scene->bands; b++) {
    s->scale[b] = scene->background[b];
    for (size_t k = 0; k < patches; k++)
      s->scale[b] = fmax(s->scale[b], scene->light[k].emission[b]);
    if (!(s->scale[b] > 0)) s->scale[b] = 1;
  }
}

/* Behind a narrow window B is far below that of the sky. */
static void find_scale(swept_solution *s) {
  const size_t nodes = s->field.mesh.nodes, bands = s->field.scene->bands;
  for (size_t b = 0; b < bands; b++) {
    double max = 0;
    for (size_t k = 0; k < nodes; k++) max = fmax(max, s->field.mesh.radiosity[k * bands + b]);
    if (max > 0) s->scale[b] = fmin(s->scale[b], max);
  }
}

swept_solution *swept_solve(const swept_scene *scene, swept_mesh how) {
  swept_solution *s = calloc(1, sizeof *s);
  ck_assert(s != NULL && scene->bands <= SWEPT_BANDS);
  s->field.scene = scene;
  s->field.rule = sweep_rule(how.points);
  s->field.near = sweep_rule(NEAR_POINTS);
  s->tolerance = how.tolerance;
  prepare(s);
  replace_mesh(s, HUGE_VAL);
  solve(s, 1e-4);
  find_scale(s);
  for (int round = 1; round < ROUNDS && s->field.mesh.nodes > 0; round++) {
    const double part = round < ROUNDS - 2 ? 1e3 : 1;
    replace_mesh(s, part * how.tolerance);
    solve(s, round == ROUNDS - 1 ? 1e-15 : 0.01 * how.tolerance);
  }
  return s;
}

void swept_destroy(swept_solution *s) {
  if (!s) return;
  for (size_t k = 0; k < s->field.scene->patches.count; k++) free(s->event[k]);
  free(s->event);
  free(s->events);
  free(s->field.span);
  free(s->row);
  free_mesh(&s->field.mesh);
  free(s);
}

size_t swept_nodes(const swept_solution *s) {
  return s->field.mesh.nodes;
}

void swept_average(const swept_solution *s, size_t patch, double *irradiance) {
  const pass p = {s, patch, s->tolerance, NULL, irradiance};
  for (size_t b = 0; b < s->field.scene->bands; b++) irradiance[b] = 0;
  run(&p);
}
