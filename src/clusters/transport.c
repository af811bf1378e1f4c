/* SPDX-License-Identifier: GPL-3.0-or-later */
/* K over cluster links: patches to points, points to points of the clusters around, across
   the links, and back the same way, so that the whole is symmetric.

   Threads share out the patches of each way, the clusters of each level of the trees, and the
   links.  Each number is made by one of them, in the order of patches and of clusters.  Links
   are in slices, whose sums are added in their order; how many there are depends on the links
   alone.

   Of several shares each has some of the clusters: their patches, and all that they receive. So
   each number is made by one share, in one order, which is not that of both ways at once. */
#include <string.h>

#include "base/alloc.h"
#include "base/legendre.h"
#include "base/team.h"
#include "clusters/clusters-impl.h"
#include "clusters/interpolation.h"
#include "clusters/point-exchange.h"
#include "scene/scene-impl.h"

/* Slices at most, and for each point of all clusters the exchanges of a slice at least, whose
   sums are added up; patches of a task, and those that are worth another thread; and threads at
   most. */
enum { MOST_SLICES = 8, SLICE_WORTH = 8, TASK = 64, WORTH = 1000, MOST_THREADS = 16 };

/* What a thread has to itself. */
typedef struct worker {
  hr2di_watch *watch, own; /* the calling thread has another than its own */
  double *vector;          /* one value per plane */
  hr2di_rule *rule;        /* for each number of points; 0 points: not made yet */
} worker;

/* Of each cluster 2·bands planes, each with a value per point: x components, then y. */
typedef struct gather {
  const hr2di_clusters *c;
  size_t order, bands, planes;
  hr2di_cluster_gas gas;
  size_t field;      /* values of all clusters */
  hr2d_share *share; /* NULL: there is but one */
  double *sent;
  size_t slices;
  double *received; /* slices × field; the first one becomes the sum */
  const double *radiosity;
  double *power;
  hr2di_watch *watch; /* of the calling thread */
  hr2di_basis basis;
  worker worker[MOST_THREADS];
  size_t workers;
  size_t level; /* under way */
} gather;

static double *planes_of(const gather *g, double *field, const hr2di_linked *c) {
  return field + c->first * g->planes;
}

static const hr2di_rule *rule_of(const worker *w, size_t points) {
  hr2di_rule *rule = &w->rule[points];
  if (rule->points == 0) hr2di_rule_init(rule, points);
  return rule;
}

static hr2d_point point_of(hr2d_segment s, double xi) {
  const double t = 0.5 * (1 + xi);
  return (hr2d_point){s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
}

/* B n ds at the Gauss points of a patch; n ds = (−dy, dx)·weight. */
static void send_patch(const gather *g, const worker *w, size_t patch) {
  const hr2di_linked *c = &g->c->linked[g->c->home[patch]];
  const hr2di_patch *p = &g->c->scene->patch[patch];
  const hr2d_segment s = p->scaled;
  const double *radiosity = g->radiosity + patch * g->order * g->bands;
  const hr2di_rule *rule =
      rule_of(w, hr2di_expansion_gauss(&c->far, p->length, g->order, g->c->accuracy));
  for (size_t k = 0; k < rule->points; k++) {
    for (size_t band = 0; band < g->bands; band++) {
      const double b =
          rule->weight[k] * hr2di_basis_sum(&g->basis, rule->at[k], radiosity + band, g->bands);
      w->vector[band] = b * (s.a.y - s.b.y);
      w->vector[g->bands + band] = b * (s.b.x - s.a.x);
    }
    hr2di_interpolation_send(&c->far, point_of(s, rule->at[k]), g->planes, w->vector,
                             planes_of(g, g->sent, c));
  }
}

static void receive_patch(const gather *g, const worker *w, size_t patch) {
  const hr2di_linked *c = &g->c->linked[g->c->home[patch]];
  const hr2di_patch *p = &g->c->scene->patch[patch];
  const hr2d_segment s = p->scaled;
  double *power = g->power + patch * g->order * g->bands;
  const hr2di_rule *rule =
      rule_of(w, hr2di_expansion_gauss(&c->far, p->length, g->order, g->c->accuracy));
  double phi[HR2D_MAX_ORDER];
  for (size_t k = 0; k < rule->points; k++) {
    hr2di_interpolation_receive(&c->far, point_of(s, rule->at[k]), g->planes,
                                planes_of(g, g->received, c), w->vector);
    hr2di_basis_at(&g->basis, rule->at[k], phi);
    for (size_t band = 0; band < g->bands; band++) {
      const double h = rule->weight[k] * (w->vector[band] * (s.a.y - s.b.y) +
                                          w->vector[g->bands + band] * (s.b.x - s.a.x));
      for (size_t l = 0; l < g->order; l++) power[l * g->bands + band] += h * phi[l];
    }
  }
}

/* From the points of a cluster to the one above it, as if they were patches. */
static void send_up(const gather *g, const worker *w, const hr2di_linked *c) {
  const hr2di_linked *parent = &g->c->linked[c->parent];
  const size_t points = hr2di_expansion_points(&c->far);
  const double *plane = planes_of(g, g->sent, c);
  for (size_t k = 0; k < points; k++) {
    for (size_t m = 0; m < g->planes; m++) w->vector[m] = plane[m * points + k];
    hr2di_interpolation_send(&parent->far, g->c->point[c->first + k], g->planes, w->vector,
                             planes_of(g, g->sent, parent));
  }
}

static void receive_down(const gather *g, const worker *w, const hr2di_linked *c) {
  const hr2di_linked *parent = &g->c->linked[c->parent];
  const size_t points = hr2di_expansion_points(&c->far);
  double *plane = planes_of(g, g->received, c);
  for (size_t k = 0; k < points; k++) {
    hr2di_interpolation_receive(&parent->far, g->c->point[c->first + k], g->planes,
                                planes_of(g, g->received, parent), w->vector);
    for (size_t m = 0; m < g->planes; m++) plane[m * points + k] += w->vector[m];
  }
}

static int is_own(const gather *g, uint32_t cluster) {
  return hr2di_share_has_row(g->share, cluster, g->c->linked_count);
}

/* Whether this share speaks for a patch that has a cluster. */
static int has_patch(const gather *g, size_t patch) {
  const uint32_t home = g->c->home[patch];
  return home != HR2DI_NO_CLUSTER && is_own(g, home);
}

/* The points of a cluster, and what they cost on the way up or down. */
static hr2d_status declare(const gather *g, const worker *w, const hr2di_linked *c) {
  const size_t points = hr2di_expansion_points(&c->far);
  return hr2di_watch_work(w->watch, 1 + points * points * g->planes / 64);
}

static hr2d_status declare_patch(const gather *g, const worker *w, size_t patch) {
  const size_t points = hr2di_expansion_points(&g->c->linked[g->c->home[patch]].far);
  return hr2di_watch_work(w->watch, 4 + g->order * points * g->planes / 16);
}

static void clear(const gather *g, double *field, size_t cluster) {
  const hr2di_linked *c = &g->c->linked[cluster];
  memset(planes_of(g, field, c), 0,
         hr2di_expansion_points(&c->far) * g->planes * sizeof *field);
}

/* Patches whose clusters are of one part: so the sums of a cluster have their order. */
static void send_part(void *ctx, size_t number, size_t part) {
  const gather *g = ctx;
  const worker *w = &g->worker[number];
  for (size_t k = part; k < g->c->linked_count; k += g->workers) {
    clear(g, g->sent, k);
    if (hr2di_watch_work(w->watch, 1 + g->planes / 16)) return;
  }
  for (size_t k = 0; k < g->c->scene->patches; k++) {
    if (k % 1024 == 0 && hr2di_watch_work(w->watch, 16)) return;
    if (!has_patch(g, k) || g->c->home[k] % g->workers != part) continue;
    if (declare_patch(g, w, k)) return;
    send_patch(g, w, k);
  }
}

static void receive_some(void *ctx, size_t number, size_t task) {
  const gather *g = ctx;
  const worker *w = &g->worker[number];
  const size_t from = task * TASK, left = g->c->scene->patches - from;
  for (size_t k = from; k < from + (left < TASK ? left : TASK); k++) {
    if (!has_patch(g, k)) continue;
    if (declare_patch(g, w, k)) return;
    receive_patch(g, w, k);
  }
}

/* A cluster takes what its children send, the last one first, before it is turned. */
static void go_up(void *ctx, size_t number, size_t task) {
  const gather *g = ctx;
  const worker *w = &g->worker[number];
  const hr2di_levels *l = &g->c->levels;
  const uint32_t cluster = l->cluster[l->begin[g->level] + task];
  const hr2di_linked *c = &g->c->linked[cluster];
  for (uint32_t k = l->child[cluster]; k != HR2DI_NO_CLUSTER; k = l->next[k]) {
    if (declare(g, w, &g->c->linked[k])) return;
    send_up(g, w, &g->c->linked[k]);
  }
  if (declare(g, w, c)) return;
  hr2di_interpolation_turn(g->c, &c->far, g->planes, 1, planes_of(g, g->sent, c));
}

static void go_down(void *ctx, size_t number, size_t task) {
  const gather *g = ctx;
  const worker *w = &g->worker[number];
  const hr2di_levels *l = &g->c->levels;
  const hr2di_linked *c = &g->c->linked[l->cluster[l->begin[g->level] + task]];
  if (declare(g, w, c)) return;
  if (c->parent != HR2DI_NO_CLUSTER) receive_down(g, w, c);
  hr2di_interpolation_turn(g->c, &c->far, g->planes, 0, planes_of(g, g->received, c));
}

static hr2di_points points_of(const gather *g, uint32_t cluster, double *received) {
  const hr2di_linked *c = &g->c->linked[cluster];
  return (hr2di_points){.point = g->c->point + c->first,
                        .count = hr2di_expansion_points(&c->far),
                        .sent = planes_of(g, g->sent, c),
                        .received = planes_of(g, received, c)};
}

static void exchange_slice(void *ctx, size_t number, size_t slice) {
  const gather *g = ctx;
  hr2di_watch *watch = g->worker[number].watch;
  const size_t links = g->c->links;
  double *received = g->received + slice * g->field;
  const size_t from = slice * links / g->slices, to = (slice + 1) * links / g->slices;
  if (hr2di_watch_work(watch, g->field / 128)) return;
  memset(received, 0, g->field * sizeof *received);
  for (size_t k = from; k < to && !hr2di_watch_status(watch); k++) {
    const hr2di_cluster_link *link = &g->c->link[k];
    const hr2di_points i = points_of(g, link->first, received),
                       j = points_of(g, link->second, received);
    hr2di_gas_series series;
    const hr2di_gas_series *gas = NULL;
    if (g->gas.absorption > 0) {
      hr2di_gas_series_init(&series, &g->gas, g->c->accuracy, i.point, i.count, j.point,
                            j.count);
      gas = &series;
    }
    if (!g->share) {
      hr2di_points_exchange(&i, &j, g->bands, gas, watch);
      continue;
    }
    if (is_own(g, link->first)) hr2di_points_receive(&i, &j, g->bands, gas, watch);
    if (is_own(g, link->second)) hr2di_points_receive(&j, &i, g->bands, gas, watch);
  }
}

/* Values that a task adds up over all slices. */
enum { SUM = 8192 };

static void sum_some(void *ctx, size_t number, size_t task) {
  const gather *g = ctx;
  const size_t from = task * SUM, to = g->field - from > SUM ? from + SUM : g->field;
  if (hr2di_watch_work(g->worker[number].watch, g->slices * SUM / 64)) return;
  for (size_t s = 1; s < g->slices; s++)
    for (size_t k = from; k < to; k++) g->received[k] += g->received[s * g->field + k];
}

/* Does tasks with all workers; the status of the watch. */
static hr2d_status work(gather *g, size_t tasks, hr2di_team_fn run) {
  hr2di_team_run(g->workers, tasks, run, g, g->watch);
  return hr2di_watch_status(g->watch);
}

/* Puts the points of all shares together. */
static hr2d_status combine(const gather *g, hr2d_status status, double *field) {
  return hr2di_share_combine(g->share, status, HR2D_COMBINE_SUM, field, g->field);
}

static hr2d_status do_level(gather *g, size_t level, hr2di_team_fn run) {
  const uint32_t *begin = g->c->levels.begin;
  g->level = level;
  return work(g, begin[level + 1] - begin[level], run);
}

static hr2d_status run(gather *g) {
  const size_t levels = g->c->levels.count;
  hr2d_status status = combine(g, work(g, g->workers, send_part), g->sent);
  for (size_t k = levels; k-- > 0 && !status;) status = do_level(g, k, go_up);
  if (!status) status = work(g, g->slices, exchange_slice);
  if (!status && g->slices > 1) status = work(g, (g->field + SUM - 1) / SUM, sum_some);
  if (!status) status = combine(g, hr2di_watch_status(g->watch), g->received);
  for (size_t k = 0; k < levels && !status; k++) status = do_level(g, k, go_down);
  return status ? status : work(g, (g->c->scene->patches + TASK - 1) / TASK, receive_some);
}

/* Adds up what patches of all shares receive before it is added to `power`. */
static hr2d_status run_shared(gather *g) {
  const hr2d_allocator *alloc = &g->c->alloc;
  const size_t values = g->c->scene->patches * g->order * g->bands;
  double *sum = hr2di_alloc_zero(alloc, values, sizeof *sum), *power = g->power;
  g->power = sum;
  hr2d_status status = sum ? run(g) : HR2D_ENOMEM;
  status = hr2di_share_combine(g->share, status, HR2D_COMBINE_SUM, sum, values);
  for (size_t k = 0; k < values && !status; k++) power[k] += sum[k];
  hr2di_alloc_free(alloc, sum);
  return status;
}

static hr2d_status hire(gather *g, unsigned threads) {
  const hr2d_allocator *alloc = &g->c->alloc;
  const size_t asked = hr2di_team_threads(threads), max = g->c->scene->patches / WORTH + 1;
  size_t count = asked < MOST_THREADS ? asked : MOST_THREADS;
  if (count > max) count = max;
  for (; g->workers < count; g->workers++) {
    worker *w = &g->worker[g->workers];
    hr2di_watch_follow(&w->own, g->watch);
    w->watch = g->workers > 0 ? &w->own : g->watch;
    w->vector = hr2di_alloc(alloc, g->planes, sizeof *w->vector);
    w->rule = hr2di_alloc_zero(alloc, HR2DI_RULE_POINTS + 1, sizeof *w->rule);
    if (!w->vector || !w->rule) break;
  }
  return g->workers == count ? HR2D_OK : HR2D_ENOMEM;
}

/* Depends on the links alone, as the order of sums does. */
static size_t count_slices(const gather *g) {
  const uint64_t slices = 1 + g->c->exchanges / (SLICE_WORTH * (uint64_t)g->c->points);
  return g->share ? 1 : slices < MOST_SLICES ? (size_t)slices : MOST_SLICES;
}

void hr2di_cluster_room_clear(hr2di_cluster_room *room) {
  if (room->value) hr2di_alloc_free(&room->alloc, room->value);
  *room = (hr2di_cluster_room){0};
}

/* Gives a room `count` fields of `values` each, of any content. */
static hr2d_status enlarge(hr2di_cluster_room *room, const hr2d_allocator *alloc, size_t count,
                           size_t values) {
  if (room->value && room->values / count >= values) return HR2D_OK;
  hr2di_cluster_room_clear(room);
  room->alloc = *alloc;
  room->value = hr2di_alloc(alloc, count, values * sizeof *room->value);
  if (room->value) room->values = count * values;
  return room->value ? HR2D_OK : HR2D_ENOMEM;
}

static hr2d_status reserve(gather *g, hr2di_cluster_room *room, unsigned threads) {
  g->slices = count_slices(g);
  hr2di_basis_init(&g->basis, g->order);
  if (g->c->points > SIZE_MAX / sizeof *g->sent / g->planes) return HR2D_ENOMEM;
  g->field = g->c->points * g->planes;
  if (enlarge(room, &g->c->alloc, 1 + g->slices, g->field)) return HR2D_ENOMEM;
  g->sent = room->value;
  g->received = g->sent + g->field;
  return hire(g, threads);
}

static void dismiss(gather *g) {
  for (size_t k = 0; k < MOST_THREADS; k++) {
    hr2di_alloc_free(&g->c->alloc, g->worker[k].vector);
    hr2di_alloc_free(&g->c->alloc, g->worker[k].rule);
  }
}

hr2di_cluster_gas hr2di_cluster_gas_of(const hr2d_scene *scene, int absorbed) {
  hr2di_cluster_gas gas = {.absorbed = absorbed};
  if (!hr2di_scene_has_gas(scene)) return gas;
  gas.section = hr2di_scene_section(scene);
  gas.absorption = hr2di_scene_scaled_range(scene).most;
  return gas;
}

hr2d_status hr2di_clusters_gather(hr2di_clusters *clusters, const hr2di_cluster_gather *how,
                                  const double *radiosity, double *power) {
  if (clusters->links == 0) return HR2D_OK;
  hr2di_cluster_room own = {0};
  gather g = {.c = clusters,
              .order = how->order,
              .bands = how->bands,
              .gas = how->gas,
              .planes = 2 * how->bands,
              .share = how->share,
              .radiosity = radiosity,
              .power = power,
              .watch = how->watch};
  hr2d_status status = reserve(&g, how->room ? how->room : &own, how->threads);
  if (g.share && status) status = hr2di_share_agree(g.share, status);
  if (!status) status = (g.share ? run_shared : run)(&g);
  dismiss(&g);
  hr2di_cluster_room_clear(&own);
  return status;
}
