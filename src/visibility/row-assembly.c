/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hands out blocks of rows to threads, walks beams, and sorts contributions by rows.

   A line class is turned round if its right tangent goes down, so that it is shared in the same
   way whichever end found it, and whole rows are as symmetric as sums of half rows. */
#include "visibility/row-assembly.h"

#include <math.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "geometry/vector.h"
#include "scene/scene-impl.h"

/* Rows per task: they are in memory at once. */
enum { BLOCK = 64, MOST_THREADS = 256 };

struct hr2di_row_worker {
  hr2di_row_assembly *maker;
  hr2di_watch *watch; /* `own`, or that of the calling thread */
  hr2di_watch own;
  hr2d_status status;
  hr2di_walk walk;
  hr2di_scatter scatter;
  hr2di_sparse_accumulator sum;
  hr2di_wall_side side; /* that is walked from */
  hr2di_parts near;     /* and the parts of it in the task */
  int part;             /* `near` is not the whole side */
  hr2d_point *turned;
  size_t turned_room;
  hr2di_contribution *sorted;
  size_t sorted_room;
};

/* A task and where it lies. */
typedef struct placed_task {
  hr2di_row_task task;
  uint32_t vertex, run;
} placed_task;

static int by_vertex(const void *left, const void *right) {
  const placed_task *l = left, *r = right;
  if (l->vertex != r->vertex) return l->vertex < r->vertex ? -1 : 1;
  return (l->task.first > r->task.first) - (l->task.first < r->task.first);
}

static size_t blocks_of(hr2di_run r) {
  return (r.last - r.first + BLOCK - 1) / BLOCK;
}

static size_t count_tasks(const hr2di_row_assembly *m) {
  size_t count = 0;
  for (size_t k = 0; k < m->scene->runs.runs; k++) count += blocks_of(m->scene->runs.run[k]);
  return count;
}

/* The parts of the places [first, last) among those of a run, from *part on. */
static hr2di_parts parts_of(const hr2di_row_assembly *m, uint32_t *part, uint32_t end,
                            uint32_t first, uint32_t last) {
  const hr2di_side_part *at = m->scene->parts.part;
  while (*part < end && (at[*part].patch == HR2DI_NOBODY || at[*part].place < first)) ++*part;
  hr2di_parts parts = {*part, *part};
  for (; *part < end && (at[*part].patch == HR2DI_NOBODY || at[*part].place < last); ++*part)
    if (at[*part].patch != HR2DI_NOBODY) parts.last = *part + 1;
  *part = parts.last;
  return parts;
}

static void place_run(const hr2di_row_assembly *m, uint32_t run, placed_task **task) {
  const hr2di_run r = m->scene->runs.run[run];
  uint32_t part = m->beams ? m->scene->parts.of_run[run].first : 0;
  for (uint32_t first = r.first; first < r.last; first += BLOCK, ++*task) {
    const uint32_t last = r.last - first < BLOCK ? r.last : first + BLOCK;
    **task = (placed_task){.task = {first, last, {0, 0}}, .run = run};
    if (!m->beams) continue;
    (*task)->task.parts = parts_of(m, &part, m->scene->parts.of_run[run].last, first, last);
    if ((*task)->task.parts.first == (*task)->task.parts.last) continue;
    const hr2di_wall_side side = m->scene->parts.part[(*task)->task.parts.first].side;
    if (side == HR2DI_HIDDEN) continue;
    (*task)->vertex = m->scene->plane.triangulation.edge[side >> 1].from;
  }
}

static hr2d_status make_tasks(hr2di_row_assembly *m) {
  const hr2d_allocator *alloc = &m->scene->alloc;
  m->tasks = count_tasks(m);
  placed_task *placed = hr2di_alloc(alloc, m->tasks, sizeof *placed), *next = placed;
  m->task = hr2di_alloc(alloc, m->tasks, sizeof *m->task);
  hr2d_status status = placed && m->task ? HR2D_OK : HR2D_ENOMEM;
  for (uint32_t k = 0; k < m->scene->runs.runs && !status; k++) {
    status = hr2di_watch_work(
        m->watch, 1 + (m->scene->runs.run[k].last - m->scene->runs.run[k].first) / 16);
    place_run(m, k, &next);
  }
  if (!status && m->beams)
    status = hr2di_sort(placed, m->tasks, sizeof *placed, by_vertex, m->watch);
  for (size_t k = 0; k < m->tasks && !status; k++) m->task[k] = placed[k].task;
  hr2di_alloc_free(alloc, placed);
  return status;
}

static int is_up(hr2d_point p, hr2d_point q) {
  return q.y > p.y || (q.y == p.y && q.x > p.x);
}

/* A line class that a beam has found. */
static hr2d_status share(void *ctx, const hr2di_line_class *s, hr2di_wall_side j) {
  hr2di_row_worker *w = ctx;
  const hr2di_side *of_side = w->maker->scene->parts.of_side, *far = &of_side[j];
  /* Edges of a wall that was bent by a rounding. */
  if (of_side[w->side].wall == far->wall) return HR2D_OK;
  const int right = is_up(s->left[0], s->right[s->rights - 1]);
  const int left = is_up(s->right[0], s->left[s->lefts - 1]);
  const int mine = right && left ? 1 : right || left ? w->side < j : 0;
  hr2di_patch_ranges among = {w->near, far->parts, 0, !mine, w->part};
  if (right) return hr2di_scatter_add(&w->scatter, s, &among);
  hr2di_line_class turned;
  if (hr2di_alloc_reserve(&w->maker->scene->alloc, &w->turned, &w->turned_room,
                          s->lefts + s->rights, sizeof *w->turned))
    return HR2D_ENOMEM;
  hr2di_line_class_turn(s, w->turned, &turned);
  among = (hr2di_patch_ranges){among.far, among.near, 1, !mine, w->part};
  return hr2di_scatter_add(&w->scatter, &turned, &among);
}

/* All that the parts of one side see. */
static hr2d_status view_from(hr2di_row_worker *w, hr2di_parts parts) {
  const hr2di_side_part *part = w->maker->scene->parts.part;
  w->side = part[parts.first].side;
  w->near = parts;
  const hr2di_parts all = w->maker->scene->parts.of_side[w->side].parts;
  const hr2d_segment span = {part[parts.first].at.a, part[parts.last - 1].at.b};
  w->part = parts.first != all.first || parts.last != all.last;
  return hr2di_walk_from(&w->walk, w->side, w->part ? &span : NULL);
}

/* What hidden parts among those of a task see. */
static hr2d_status add_contacts(hr2di_row_worker *w, hr2di_parts parts) {
  const hr2di_side_parts *p = &w->maker->scene->parts;
  hr2d_status status = HR2D_OK;
  for (size_t k = hr2di_side_parts_contact(p, parts.first);
       k < p->contacts && p->contact[k].part < parts.last && !status; k++) {
    const hr2di_part_contact *c = &p->contact[k];
    const int mine = c->part < c->other;
    if (!mine && !w->maker->whole) continue;
    status = hr2di_scatter_add_area(&w->scatter,
                                    (hr2di_contribution){.area = c->area,
                                                         .place = p->part[c->part].place,
                                                         .patch = p->part[c->other].patch,
                                                         .partial = 1,
                                                         .later = !mine});
  }
  return status;
}

static hr2d_status view_around(hr2di_row_worker *w, const hr2di_row_task *t) {
  const hr2di_side_part *part = w->maker->scene->parts.part;
  hr2d_status status = add_contacts(w, t->parts);
  for (uint32_t first = t->parts.first, last; first < t->parts.last && !status; first = last) {
    for (last = first; last < t->parts.last && part[last].side == part[first].side;) last++;
    if (part[first].side != HR2DI_HIDDEN) status = view_from(w, (hr2di_parts){first, last});
  }
  return status;
}

/* Without occlusion: pairs each patch of the task with all others, or only with later ones. */
static hr2d_status add_all(hr2di_row_worker *w, const hr2di_row_task *t) {
  const hr2di_row_assembly *m = w->maker;
  const hr2di_patch *patch = m->scene->patch;
  hr2d_status status = HR2D_OK;
  for (uint32_t k = t->first; k < t->last && !status; k++) {
    const uint32_t i = m->scene->runs.patch[k];
    for (uint32_t j = m->whole ? 0 : i + 1; j < m->scene->patches && !status; j++) {
      if (i == j) continue;
      /* The first of a pair is the one with the lower index, as in links. */
      const uint32_t low = i < j ? i : j, high = i < j ? j : i;
      const hr2d_segment pair[2] = {patch[low].scaled, patch[high].scaled};
      status = hr2di_scatter_add_pair(&w->scatter, pair,
                                      (hr2di_contribution){.place = k, .patch = j});
    }
  }
  return status;
}

/* Groups the contributions by row; *share receives the array that has them. */
static hr2d_status sort_rows(hr2di_row_worker *w, const hr2di_row_task *t, size_t *start,
                             hr2di_contribution **share) {
  const size_t rows = t->last - t->first;
  const hr2di_scatter *f = &w->scatter;
  for (size_t k = 0; k <= rows; k++) start[k] = 0;
  for (size_t k = 0; k < f->contributions; k++) start[f->share[k].place - t->first + 1]++;
  for (size_t k = 0; k < rows; k++) start[k + 1] += start[k];
  *share = f->share;
  if (rows == 1) return HR2D_OK;
  if (hr2di_alloc_reserve(&w->maker->scene->alloc, &w->sorted, &w->sorted_room,
                          f->contributions, sizeof *w->sorted))
    return HR2D_ENOMEM;
  size_t next[BLOCK];
  for (size_t k = 0; k < rows; k++) next[k] = start[k];
  for (size_t k = 0; k < f->contributions; k++)
    w->sorted[next[f->share[k].place - t->first]++] = f->share[k];
  *share = w->sorted;
  return hr2di_watch_work(w->watch, f->contributions / 8);
}

static hr2d_status make_rows(hr2di_row_worker *w, size_t worker, const hr2di_row_task *t) {
  const hr2di_row_assembly *m = w->maker;
  size_t start[BLOCK + 1];
  hr2di_contribution *share;
  w->scatter.contributions = 0;
  hr2d_status status = hr2di_watch_work(w->watch, 1);
  if (!status) status = m->beams ? view_around(w, t) : add_all(w, t);
  if (!status) status = hr2di_scatter_finish(&w->scatter);
  if (!status) status = sort_rows(w, t, start, &share);
  for (size_t k = 0; k < t->last - t->first && !status; k++) {
    const size_t count = start[k + 1] - start[k];
    status = hr2di_sparse_accumulator_make(&w->sum, count > 0 ? share + start[k] : NULL, count);
    const hr2di_row row = {m->scene->runs.patch[t->first + k], w->sum.column, w->sum.area,
                           w->sum.count};
    if (!status) status = m->take(m->ctx, worker, &row);
  }
  return status;
}

/* A worker does no more tasks if another one has failed. */
static void do_task(void *ctx, size_t worker, size_t task) {
  hr2di_row_assembly *m = ctx;
  hr2di_row_worker *w = &m->worker[worker];
  hr2d_status status = atomic_load(&m->stop) ? HR2D_STOPPED : hr2di_watch_status(w->watch);
  if (!status) status = make_rows(w, worker, &m->task[m->offset + task]);
  atomic_fetch_add(&m->done, 1);
  if (!status || w->status) return;
  w->status = status;
  atomic_store(&m->stop, 1);
}

/* Returns the status of the first worker that failed by itself, not by being told to stop. */
hr2d_status hr2di_row_assembly_run(hr2di_row_assembly *m, size_t first, size_t last,
                                   hr2di_row_fn take, void *ctx) {
  m->take = take;
  m->ctx = ctx;
  m->offset = first;
  hr2di_team_run(m->workers, last - first, do_task, m, m->watch);
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < m->workers; k++)
    if (m->worker[k].status && (!status || status == HR2D_STOPPED))
      status = m->worker[k].status;
  return status;
}

static hr2d_status hire(hr2di_row_assembly *m, unsigned threads) {
  const hr2d_allocator *alloc = &m->scene->alloc;
  size_t count = hr2di_team_threads(threads);
  if (count > MOST_THREADS) count = MOST_THREADS;
  if (count > m->tasks) count = m->tasks;
  m->worker = hr2di_alloc_zero(alloc, count, sizeof *m->worker);
  if (!m->worker) return HR2D_ENOMEM;
  hr2d_status status = HR2D_OK;
  for (; m->workers < count && !status; m->workers++) {
    hr2di_row_worker *w = &m->worker[m->workers];
    w->maker = m;
    w->watch = m->workers == 0 ? m->watch : &w->own;
    hr2di_watch_follow(&w->own, m->watch);
    w->walk = (hr2di_walk){.in = &m->scene->plane.triangulation,
                           .wanted = m->scene->parts.wanted,
                           .once = !m->whole,
                           .take = share,
                           .ctx = w,
                           .alloc = *alloc,
                           .watch = w->watch};
    w->scatter.parts = &m->scene->parts;
    w->scatter.alloc = *alloc;
    w->scatter.watch = w->watch;
    status = hr2di_sparse_accumulator_init(&w->sum, m->scene->patches, alloc, w->watch);
  }
  return status;
}

hr2d_status hr2di_row_assembly_init(hr2di_row_assembly *m, const hr2d_scene *scene,
                                    unsigned threads, int whole, hr2di_watch *watch) {
  *m = (hr2di_row_assembly){.scene = scene,
                            .watch = watch,
                            .whole = whole,
                            .beams = scene->effect[HR2D_EFFECT_OCCLUSION].on};
  hr2d_status status = make_tasks(m);
  if (!status) status = hire(m, threads);
  return status ? status : hr2di_watch_ask(watch);
}

static void dismiss(hr2di_row_worker *w) {
  const hr2d_allocator *alloc = &w->maker->scene->alloc;
  hr2di_walk_clear(&w->walk);
  hr2di_scatter_clear(&w->scatter);
  hr2di_sparse_accumulator_clear(&w->sum);
  hr2di_alloc_free(alloc, w->turned);
  hr2di_alloc_free(alloc, w->sorted);
}

void hr2di_row_assembly_clear(hr2di_row_assembly *m) {
  for (size_t k = 0; k < m->workers; k++) dismiss(&m->worker[k]);
  hr2di_alloc_free(&m->scene->alloc, m->worker);
  hr2di_alloc_free(&m->scene->alloc, m->task);
}

double hr2di_row_assembly_fraction(const hr2di_row_assembly *m) {
  return m->tasks > 0 ? (double)atomic_load(&m->done) / (double)m->tasks : 0;
}

uint64_t hr2di_row_assembly_steps(const hr2di_row_assembly *m) {
  uint64_t steps = 0;
  for (size_t k = 0; k < m->workers; k++) steps += m->worker[k].walk.steps;
  return steps;
}
