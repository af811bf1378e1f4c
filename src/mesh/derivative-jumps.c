/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/derivative-jumps.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/team.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Of second differences, as a part of the patch. */
#define STEP 1e-6

/* How many steps beside the vertex a view ends: what is seen past it moves by one. */
#define BESIDE 4

struct hr2di_jump_worker {
  hr2di_point_viewer *viewer;
  hr2di_watch own; /* but the calling thread has that of the call */
  hr2d_status status;
};

/* The line past the vertex of an event. */
typedef struct line {
  hr2d_point from, along;
} line;

/* The leaf of a patch where a line meets it, or that nearest to where it meets the line of the
   patch.  A foot has no line, and the patch that stands on it is nearest there. */
static uint32_t leaf_at(const hr2di_derivative_jumps *j, uint32_t patch, line l) {
  const hr2d_element *element = j->lights->trees->element;
  const hr2d_segment s = j->scene->patch[patch].scaled;
  const hr2d_point u = hr2di_point_minus(s.b, s.a), v = hr2di_point_minus(l.from, s.a);
  const double across = hr2di_point_cross(l.along, u);
  double t = across != 0 ? hr2di_point_cross(l.along, v) / across
                         : hr2di_point_dot(u, v) / hr2di_point_dot(u, u);
  uint32_t at = patch;
  t = fmin(fmax(t, 0), 1);
  while (element[at].child) at = hr2di_element_child_at(element, at, &t, 0);
  return at;
}

/* sum += weight · what falls on a point between two places from B, and from the importance. */
static hr2d_status gather(const hr2di_derivative_jumps *j, hr2di_point_viewer *viewer,
                          size_t patch, double at, const hr2d_point border[2], line l,
                          double weight, double *sum) {
  hr2di_view_from seen;
  const hr2d_status status = hr2di_view_between(viewer, patch, at, border, &seen);
  if (status) return status;
  for (size_t k = 0; k < seen.count; k++) {
    const double part = weight * seen.interval[k].sine;
    const size_t from = leaf_at(j, seen.interval[k].patch, l) * j->bands;
    for (size_t b = 0; b < j->bands; b++) {
      sum[b] += part * j->lights->radiosity[from + b];
      sum[j->bands + b] += part * j->lights->importance[from + b];
    }
  }
  return HR2D_OK;
}

static hr2d_status gather_around(const hr2di_derivative_jumps *j, hr2di_point_viewer *viewer,
                                 size_t event) {
  const hr2di_event *e = &j->events->event[event];
  double *jump = j->jump + event * 2 * j->bands;
  for (size_t b = 0; b < 2 * j->bands; b++) jump[b] = 0;
  const double step = fmin(STEP, 0.5 * fmin(e->at, 1 - e->at));
  const double move = step * j->scene->patch[e->patch].length;
  const hr2d_point at = hr2di_point_at(j->scene->patch[e->patch].scaled, e->at),
                   to = hr2di_point_minus(e->past, at);
  /* Of a foot the border is no place: all is looked at. */
  const double side = BESIDE * move / hypot(to.x, to.y);
  const hr2d_point border[2] = {{e->past.x + side * to.y, e->past.y - side * to.x},
                                {e->past.x - side * to.y, e->past.y + side * to.x}};
  const line l = {at, to};
  hr2d_status status = gather(j, viewer, e->patch, e->at, border, l, -2 / move, jump);
  if (!status) status = gather(j, viewer, e->patch, e->at - step, border, l, 1 / move, jump);
  return status ? status : gather(j, viewer, e->patch, e->at + step, border, l, 1 / move, jump);
}

/* The first event that is not before a place. */
size_t hr2di_derivative_jumps_find(const hr2di_events *events, uint32_t patch, double at) {
  size_t low = 0, high = events->count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    const hr2di_event *e = &events->event[middle];
    if (e->patch < patch || (e->patch == patch && e->at < at))
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* The event that another one comes from, or that itself. */
static size_t origin_of(const hr2di_derivative_jumps *j, size_t k) {
  const hr2di_event *e = &j->events->event[k];
  const size_t from = hr2di_derivative_jumps_find(j->events, e->origin, e->origin_at);
  return from < j->events->count && j->events->event[from].patch == e->origin &&
                 (j->events->event[from].generation < e->generation ||
                  (e->passed && !j->events->event[from].passed))
             ? from
             : k;
}

/* The importance of light that y reflects is ρ times what falls there, as its radiosity is.  On
   a pane ρ + τ is a bound of that on both sides. */
static void take_over(hr2di_derivative_jumps *j, size_t k, size_t from) {
  const hr2di_event *e = &j->events->event[k];
  for (size_t b = 0; b < 2 * j->bands; b++) {
    const double rho = hr2di_scene_scattered(j->scene, e->origin, b % j->bands);
    j->jump[k * 2 * j->bands + b] =
        (e->passed ? 1 : e->spread * rho) * j->jump[from * 2 * j->bands + b];
  }
}

hr2d_status hr2di_derivative_jumps_know(hr2di_derivative_jumps *j, size_t k) {
  const size_t from = origin_of(j, k);
  hr2d_status status = HR2D_OK;
  if (j->known[k]) return status;
  if (from != k) {
    status = hr2di_derivative_jumps_know(j, from);
    take_over(j, k, from);
  } else {
    status = gather_around(j, j->observer->viewer, k);
  }
  j->known[k] = 1;
  return status;
}

void hr2di_derivative_jumps_want(hr2di_derivative_jumps *j, size_t k) {
  for (size_t from = k; !j->known[k]; k = from) {
    from = origin_of(j, k);
    if (from != k) continue;
    j->wanted[j->count++] = k;
    j->known[k] = 1;
  }
}

/* Events that a task looks at. */
enum { TASK = 16 };

static void examine_some(void *ctx, size_t worker, size_t task) {
  hr2di_derivative_jumps *j = ctx;
  hr2di_jump_worker *by = &j->observer[worker];
  const size_t from = task * TASK, to = j->count - from > TASK ? from + TASK : j->count;
  for (size_t k = from; k < to && !by->status; k++)
    by->status = gather_around(j, by->viewer, j->wanted[k]);
}

hr2d_status hr2di_derivative_jumps_look(hr2di_derivative_jumps *j) {
  hr2d_status status = HR2D_OK;
  hr2di_team_run(j->observers, (j->count + TASK - 1) / TASK, examine_some, j, j->watch);
  for (size_t k = 0; k < j->observers && !status; k++) status = j->observer[k].status;
  j->count = 0;
  return status;
}

static hr2d_status set_bounds(hr2di_derivative_jumps *j) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < j->lights->trees->elements && !status; k++) {
    status = hr2di_watch_work(j->watch, 1 + j->bands / 8);
    for (size_t b = 0; b < j->bands; b++) {
      const size_t at = k * j->bands + b;
      j->max[b] = fmax(j->max[b], j->lights->radiosity[at]);
      j->max[j->bands + b] = fmax(j->max[j->bands + b], j->lights->importance[at]);
    }
  }
  for (unsigned g = 1, any = 1; any && !status; g++) {
    any = 0;
    for (size_t k = 0; k < j->events->count && !status; k++) {
      const hr2di_event *e = &j->events->event[k];
      if (e->generation != g) continue;
      any = 1;
      const size_t from = origin_of(j, k);
      if (from != k) take_over(j, k, from);
      for (size_t b = 0; b < 2 * j->bands && from == k; b++)
        j->jump[k * 2 * j->bands + b] = 2 * e->spread * j->max[b];
      status = hr2di_watch_work(j->watch, 1 + j->bands / 8);
    }
  }
  return status;
}

enum { MOST_LOOKERS = 64 };

static hr2d_status hire(hr2di_derivative_jumps *j, unsigned threads) {
  const size_t asked = hr2di_team_threads(threads), max = j->events->count / TASK + 1;
  size_t count = asked < MOST_LOOKERS ? asked : MOST_LOOKERS;
  if (count > max) count = max;
  j->observer = hr2di_alloc_zero(j->alloc, count, sizeof *j->observer);
  hr2d_status status = j->observer ? HR2D_OK : HR2D_ENOMEM;
  for (; j->observers < count && !status; j->observers++) {
    hr2di_jump_worker *by = &j->observer[j->observers];
    hr2di_watch_follow(&by->own, j->watch);
    status = hr2di_point_viewer_create(j->scene, j->alloc,
                                       j->observers > 0 ? &by->own : j->watch, &by->viewer);
  }
  return status;
}

hr2d_status hr2di_derivative_jumps_init(hr2di_derivative_jumps *j, const hr2d_scene *scene,
                                        const hr2di_events *events,
                                        const hr2di_primal_dual *lights, unsigned threads,
                                        const hr2d_allocator *alloc, hr2di_watch *watch) {
  const size_t count = events->count, values = 2 * scene->bands;
  *j = (hr2di_derivative_jumps){.scene = scene,
                                .events = events,
                                .lights = lights,
                                .alloc = alloc,
                                .bands = scene->bands,
                                .watch = watch};
  j->max = hr2di_alloc_zero(alloc, values, sizeof *j->max);
  j->jump = hr2di_alloc(alloc, count, values * sizeof *j->jump);
  j->known = hr2di_alloc_zero(alloc, count, 1);
  j->wanted = hr2di_alloc(alloc, count, sizeof *j->wanted);
  if (!j->max || !j->jump || !j->known || !j->wanted) return HR2D_ENOMEM;
  if (lights->any_light) memset(j->known, 1, count);
  const hr2d_status status = lights->any_light ? HR2D_OK : hire(j, threads);
  return status ? status : set_bounds(j);
}

void hr2di_derivative_jumps_clear(hr2di_derivative_jumps *j) {
  for (size_t k = 0; k < j->observers; k++) hr2di_point_viewer_destroy(j->observer[k].viewer);
  hr2di_alloc_free(j->alloc, j->observer);
  hr2di_alloc_free(j->alloc, j->max);
  hr2di_alloc_free(j->alloc, j->jump);
  hr2di_alloc_free(j->alloc, j->known);
  hr2di_alloc_free(j->alloc, j->wanted);
}
