/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exchange areas of all pairs of patches.

   Pairs of runs are halved until a pair of parts is clear, or blocked, or one pair of
   patches.  If it is clear, all pairs of patches below get the unoccluded exchange area
   without a further test. */
#include <hr2d/visibility.h>
#include <stdatomic.h>
#include <string.h>

#include "base/alloc.h"
#include "base/sized-struct.h"
#include "base/team.h"
#include "geometry/exchange-area.h"
#include "geometry/predicates.h"
#include "occlusion/pair-visibility.h"
#include "scene/patch-runs.h"
#include "scene/scene-impl.h"

enum { BATCH = 1024, DEPTH = 80, TILE = 8, MOST_THREADS = 256 };

/* A pair of parts of two runs, with its walls in filler::list from `first` on. */
typedef struct node {
  hr2di_run i, j;
  size_t first, count;
  hr2di_facing facing;
} node;

/* What all threads share; each fills entries of its own. */
typedef struct matrix {
  const hr2d_scene *scene;
  size_t n;
  double *area;
  double unit; /* of the scene's coordinates */
  hr2di_runs runs;
  hr2d_element *element; /* of which only a and b are used */
  hr2d_matrix_options options;
  hr2di_watch *watch; /* of the calling thread */
  atomic_size_t rows_done;
  atomic_int stop;
} matrix;

/* The work of one thread. */
typedef struct filler {
  matrix *m;
  hr2di_watch *watch; /* of the thread: `own`, or that of the matrix */
  hr2di_watch own;
  hr2d_status status;
  hr2d_matrix_counts counts;
  hr2di_visibility visibility;
  hr2di_wall_list list;
  hr2d_pair pair[BATCH];
  double value[BATCH];
  size_t pairs;
} filler;

/* The upper triangle is filled first. */
static void put(filler *f, uint32_t i, uint32_t j, double area) {
  const size_t row = i < j ? i : j, column = i < j ? j : i;
  f->m->area[row * f->m->n + column] = area * f->m->unit;
}

static void flush(filler *f) {
  hr2di_exchange_areas(f->m->element, f->pair, f->pairs, f->value);
  for (size_t k = 0; k < f->pairs; k++)
    put(f, f->pair[k].first, f->pair[k].second, f->value[k]);
  f->counts.exchange_areas += f->pairs;
  f->pairs = 0;
}

static hr2d_status fill_clear(filler *f, hr2di_run i, hr2di_run j) {
  for (uint32_t k = i.first; k < i.last; k++)
    for (uint32_t m = j.first; m < j.last; m++) {
      f->pair[f->pairs++] = (hr2d_pair){f->m->runs.patch[k], f->m->runs.patch[m]};
      if (f->pairs < BATCH) continue;
      flush(f);
      const hr2d_status status = hr2di_watch_work(f->watch, BATCH);
      if (status) return status;
    }
  return HR2D_OK;
}

/* From the start of the first patch of a part to the end of its last. */
static hr2d_segment span(const filler *f, hr2di_run r) {
  const hr2di_patch *patch = f->m->scene->patch;
  return (hr2d_segment){patch[f->m->runs.patch[r.first]].scaled.a,
                        patch[f->m->runs.patch[r.last - 1]].scaled.b};
}

/* Parts of runs that face each other fully do so, too. */
static int shaft_of(const filler *f, hr2di_run i, hr2di_run j, hr2di_facing *facing,
                    hr2di_shaft *shaft) {
  const hr2d_segment s = span(f, i), t = span(f, j);
  if (*facing != HR2DI_FACING_FULL) *facing = hr2di_facing_of(&s, &t);
  return hr2di_shaft_init(shaft, *facing, s, t, s, t);
}

static hr2d_status fill_partial(filler *f, const node *at) {
  const uint32_t i = f->m->runs.patch[at->i.first], j = f->m->runs.patch[at->j.first];
  hr2di_shaft shaft;
  /* The first of two patches is the one with the lower index, as in links. */
  hr2di_facing facing = at->facing;
  if (!(i < j ? shaft_of(f, at->i, at->j, &facing, &shaft)
              : shaft_of(f, at->j, at->i, &facing, &shaft)))
    return HR2D_OK;
  double area;
  int open;
  const hr2d_status status =
      hr2di_visibility_area(&f->visibility, &shaft, hr2di_wall_list_from(&f->list, at->first),
                            at->count, &area, &open);
  if (status) return status;
  put(f, i, j, area);
  f->counts.exchange_areas += (unsigned)open;
  f->counts.partial_pairs += (unsigned)open;
  f->counts.blocked_pairs += !open;
  return HR2D_OK;
}

static double extent(const filler *f, hr2di_run r) {
  const hr2d_segment s = span(f, r);
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  return r.last - r.first == 1 ? -1 : dx * dx + dy * dy; /* may underflow */
}

/* The longer of the parts is halved, unless it is a single patch. */
static void halve(const filler *f, const node *at, node half[2]) {
  half[0] = half[1] = *at;
  const int first = extent(f, at->i) >= extent(f, at->j);
  const hr2di_run r = first ? at->i : at->j;
  const uint32_t middle = r.first + (r.last - r.first) / 2;
  (first ? &half[0].i : &half[0].j)->last = middle;
  (first ? &half[1].i : &half[1].j)->first = middle;
}

static uint64_t pairs_of(const node *at) {
  return (uint64_t)(at->i.last - at->i.first) * (at->j.last - at->j.first);
}

/* Fills what needs no further look; *keep if the part is to be halved. */
static hr2d_status look(filler *f, node *at, const node *parent, int *keep) {
  hr2di_shaft shaft;
  hr2di_visibility_class view = HR2DI_CLEAR;
  *keep = 0;
  const hr2d_status asked = hr2di_watch_work(f->watch, 2);
  if (asked) return asked;
  const int shaded = shaft_of(f, at->i, at->j, &at->facing, &shaft);
  if (at->facing == HR2DI_FACING_NONE) return HR2D_OK;
  at->first = f->list.count;
  if (!shaded || !f->m->scene->effect[HR2D_EFFECT_OCCLUSION].on)
    return fill_clear(f, at->i, at->j);
  const hr2d_status status =
      parent ? hr2di_visibility_shrink(&f->visibility, &shaft, &f->list, parent->first,
                                       parent->count, &f->list, &view)
             : hr2di_visibility_collect(&f->visibility, &shaft, &f->list, &view);
  at->count = f->list.count - at->first;
  if (status) return status;
  if (view == HR2DI_CLEAR) return fill_clear(f, at->i, at->j);
  if (view == HR2DI_BLOCKED) f->counts.blocked_pairs += pairs_of(at);
  *keep = view == HR2DI_PARTIAL;
  return HR2D_OK;
}

static hr2d_status fill_runs(filler *f, hr2di_run i, hr2di_run j) {
  node stack[DEPTH];
  size_t count = 0;
  int keep;
  f->list.count = 0;
  stack[0] = (node){.i = i, .j = j, .facing = HR2DI_FACING_NONE};
  hr2d_status status = look(f, &stack[0], NULL, &keep);
  count += (size_t)keep;
  while (count > 0 && !status) {
    const node at = stack[--count];
    node half[2];
    f->list.count = at.first + at.count;
    if (pairs_of(&at) == 1) {
      status = fill_partial(f, &at);
      continue;
    }
    halve(f, &at, half);
    for (int k = 0; k < 2 && !status; k++) {
      status = look(f, &half[k], &at, &keep);
      if (keep) stack[count++] = half[k];
    }
  }
  return status;
}

/* Pairs of runs: a row has one for each row behind it. */
static void describe(void *of, hr2d_progress *told) {
  const matrix *m = of;
  const double rest = 1 - (double)atomic_load(&m->rows_done) / (double)m->runs.runs;
  told->fraction = 1 - rest * rest;
}

/* Every thread looks whether another has failed. */
static hr2d_status look_around(const filler *f) {
  return atomic_load(&f->m->stop) ? HR2D_STOPPED : hr2di_watch_status(f->watch);
}

/* A run with all those behind it. */
static void fill_row(void *ctx, size_t worker, size_t row) {
  filler *f = ((filler *const *)ctx)[worker];
  matrix *m = f->m;
  hr2d_status status = look_around(f);
  for (size_t k = row + 1; k < m->runs.runs && !status; k++)
    status = fill_runs(f, m->runs.run[row], m->runs.run[k]);
  atomic_fetch_add(&m->rows_done, 1);
  if (!status || f->status) return;
  f->status = status;
  atomic_store(&m->stop, 1);
}

static void fill(filler **team, size_t count) {
  const matrix *m = team[0]->m;
  hr2di_team_run(count, m->runs.runs, fill_row, team, m->watch);
  for (size_t k = 0; k < count; k++) flush(team[k]);
}

/* Tile by tile, lest each value take a cache line of its own. */
static hr2d_status mirror(double *area, size_t n, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t i0 = 0; i0 < n && !status; i0 += TILE)
    for (size_t j0 = i0; j0 < n && !(status = hr2di_watch_work(watch, TILE)); j0 += TILE)
      for (size_t i = i0; i < n && i < i0 + TILE; i++)
        for (size_t j = j0 > i ? j0 : i + 1; j < n && j < j0 + TILE; j++)
          area[j * n + i] = area[i * n + j];
  return status;
}

static size_t count_threads(const matrix *m) {
  const size_t wanted = hr2di_team_threads(m->options.threads);
  const size_t max = wanted < MOST_THREADS ? wanted : MOST_THREADS;
  return max < m->runs.runs ? max : m->runs.runs;
}

static hr2d_status start(matrix *m) {
  hr2d_status status = hr2di_runs_init(&m->runs, m->scene, m->watch);
  if (status) return status;
  m->element = hr2di_alloc_zero(&m->scene->alloc, m->n, sizeof *m->element);
  if (!m->element) return HR2D_ENOMEM;
  for (size_t k = 0; k < m->n; k++) {
    m->element[k].a = m->scene->patch[k].scaled.a;
    m->element[k].b = m->scene->patch[k].scaled.b;
  }
  for (size_t k = 0; k < m->n && !status; k++) {
    memset(m->area + k * m->n, 0, m->n * sizeof *m->area);
    status = hr2di_watch_work(m->watch, 1 + m->n / 128);
  }
  return status;
}

static hr2d_status hire(matrix *m, filler **team, size_t count) {
  for (size_t k = 0; k < count; k++) {
    team[k] = hr2di_alloc_zero(&m->scene->alloc, 1, sizeof **team);
    if (!team[k]) return HR2D_ENOMEM;
    team[k]->m = m;
    team[k]->watch = k == 0 ? m->watch : &team[k]->own;
    hr2di_watch_follow(&team[k]->own, m->watch);
    hr2di_visibility_init(&team[k]->visibility, &m->scene->walls, &m->scene->alloc,
                          team[k]->watch);
  }
  return HR2D_OK;
}

/* Adds up the counts; the status of the first that failed and was not told to stop. */
static hr2d_status dismiss(matrix *m, filler **team, size_t count, hr2d_matrix_counts *sum) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && team[k]; k++) {
    filler *f = team[k];
    sum->exchange_areas += f->counts.exchange_areas;
    sum->partial_pairs += f->counts.partial_pairs;
    sum->blocked_pairs += f->counts.blocked_pairs;
    sum->visibility_tests += f->visibility.tests;
    if (f->status && (!status || status == HR2D_STOPPED)) status = f->status;
    hr2di_visibility_clear(&f->visibility);
    hr2di_alloc_free(&m->scene->alloc, f->list.wall);
    hr2di_alloc_free(&m->scene->alloc, f);
  }
  return status;
}

static hr2d_status fill_matrix(matrix *m, hr2d_matrix_counts *counts) {
  filler *team[MOST_THREADS] = {0};
  const size_t count = count_threads(m);
  hr2d_status status = hire(m, team, count);
  if (!status) status = hr2di_watch_ask(m->watch);
  if (!status) fill(team, count);
  const hr2d_status failed = dismiss(m, team, count, counts);
  if (!status) status = failed;
  return status ? status : mirror(m->area, m->n, m->watch);
}

hr2d_status hr2d_exchange_matrix(const hr2d_scene *scene, const hr2d_matrix_options *options,
                                 double *area, hr2d_matrix_counts *counts) {
  if (!scene->committed) return HR2D_ESTATE;
  matrix m = {.scene = scene,
              .n = scene->patches,
              .area = area,
              .unit = hr2d_scene_unit(scene),
              .options = HR2D_MATRIX_OPTIONS_INIT};
  hr2d_status status = hr2di_sized_copy(&m.options, sizeof m.options, options);
  if (status) return status;
  hr2d_matrix_counts sum = {0};
  hr2di_watch watch;
  hr2di_scene_watch(scene, &watch, m.options.progress, m.options.progress_ctx, "factors");
  m.watch = &watch;
  status = start(&m);
  hr2di_watch_describe(&watch, describe, &m);
  if (!status) status = fill_matrix(&m, &sum);
  if (!status) status = hr2di_watch_ask(&watch);
  if (!status && counts) *counts = sum;
  hr2di_runs_clear(&m.runs);
  hr2di_alloc_free(&scene->alloc, m.element);
  return status;
}
