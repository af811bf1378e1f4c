/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs of clusters, from the root with itself, are parted until each is settled. */
#include "clusters/clusters.h"

#include <math.h>

#include "base/alloc.h"
#include "base/choices.h"
#include "base/sort.h"
#include "clusters/clusters-impl.h"
#include "clusters/facing.h"
#include "clusters/occlusion.h"
#include "scene/scene-impl.h"
#include "visibility/row-assembly.h"

/* NEAR pairs are handed over at a time.  A link costs as much as its points times those of
   the other.  Where few pairs of patches are left, and walls may be in the way, they are put
   off until rows tell which see each other.
   Sines below a part in SLACK of the digits do not matter, nor to links that are ten times as
   accurate. */
enum { NEAR = 256, SLACK = 640 };

/* A pair of clusters; what is known of it holds for its parts. */
typedef struct two {
  uint32_t i, j;
  uint32_t suspect;
  unsigned char facing, clear;
} two;

typedef struct walk {
  hr2di_clusters *made;
  hr2di_cluster_tree tree;
  hr2di_expansion *far;     /* of each cluster; NULL without links */
  const hr2di_walls *walls; /* NULL: nothing is in the way of anything */
  two *later;
  size_t laters, later_capacity;
  two *stack;
  size_t count, capacity;
  hr2di_near_fn near;
  void *ctx;
  hr2di_watch *watch;
  hr2d_pair pair[NEAR];
  size_t pairs;
} walk;

static hr2d_status flush(walk *w) {
  const size_t count = w->pairs;
  w->pairs = 0;
  return count > 0 ? w->near(w->ctx, w->pair, count) : HR2D_OK;
}

static hr2d_status hand_over(walk *w, uint32_t p, uint32_t q) {
  w->pair[w->pairs++] = p < q ? (hr2d_pair){p, q} : (hr2d_pair){q, p};
  return w->pairs == NEAR ? flush(w) : HR2D_OK;
}

static hr2d_status push(walk *w, two at, uint32_t i, uint32_t j) {
  if (hr2di_alloc_reserve(&w->tree.alloc, &w->stack, &w->capacity, w->count + 1,
                          sizeof *w->stack))
    return HR2D_ENOMEM;
  at.i = i;
  at.j = j;
  w->stack[w->count++] = at;
  return HR2D_OK;
}

static double size_of(const hr2di_cluster *c) {
  return c->child ? hypot(c->x1 - c->x0, c->y1 - c->y0) : -1;
}

static hr2d_status part(walk *w, two at) {
  const hr2di_cluster *i = &w->tree.cluster[at.i], *j = &w->tree.cluster[at.j];
  hr2d_status status;
  if (at.i == at.j) {
    if (!i->child) return HR2D_OK;
    status = push(w, at, i->child, i->child + 1);
    if (!status) status = push(w, at, i->child, i->child);
    return status ? status : push(w, at, i->child + 1, i->child + 1);
  }
  const int first = size_of(i) >= size_of(j);
  status = first ? push(w, at, i->child, at.j) : push(w, at, at.i, j->child);
  if (status) return status;
  return first ? push(w, at, i->child + 1, at.j) : push(w, at, at.i, j->child + 1);
}

static hr2d_status link(walk *w, const two *at) {
  hr2di_clusters *made = w->made;
  if (hr2di_alloc_reserve(&made->alloc, &made->link, &made->link_capacity, made->links + 1,
                          sizeof *made->link))
    return HR2D_ENOMEM;
  made->link[made->links++] = (hr2di_cluster_link){at->i, at->j};
  return HR2D_OK;
}

static double pairs_of(const walk *w, const two *at) {
  return (double)hr2di_cluster_size(&w->tree.cluster[at->i]) *
         hr2di_cluster_size(&w->tree.cluster[at->j]);
}

/* Whether a link of the two costs less than their pairs. */
static int link_pays(const walk *w, const two *at) {
  return w->far && (double)hr2di_expansion_points(&w->far[at->i]) *
                           (double)hr2di_expansion_points(&w->far[at->j]) <=
                       HR2DI_CHOICE_CLUSTERS_PAIR * pairs_of(w, at);
}

static int may_link(const walk *w, const two *at) {
  return link_pays(w, at) &&
         hr2di_expansion_apart(&w->tree.cluster[at->i], &w->far[at->i], &w->tree.cluster[at->j],
                               &w->far[at->j], w->made->accuracy);
}

/* Completes what is known of a pair that may be linked, until it is known not to be. */
static int is_clear(walk *w, two *at) {
  if (hr2di_watch_work(w->watch, HR2DI_CHOICE_CLUSTERS_LOOK)) return 0;
  if (!at->facing)
    at->facing = hr2di_cluster_on(&w->tree, at->i, at->j, HR2DI_SIDE_FRONT) &&
                 hr2di_cluster_on(&w->tree, at->j, at->i, HR2DI_SIDE_FRONT);
  if (at->facing && !at->clear)
    at->clear = (unsigned char)hr2di_clusters_clear(&w->tree, at->i, at->j, &at->suspect);
  return at->facing && at->clear;
}

/* The smaller cluster comes first: its patches are looked from, and short ones see less. */
static hr2d_status put_off(walk *w, two at) {
  if (hr2di_alloc_reserve(&w->tree.alloc, &w->later, &w->later_capacity, w->laters + 1,
                          sizeof *w->later))
    return HR2D_ENOMEM;
  const hr2di_cluster *i = &w->tree.cluster[at.i], *j = &w->tree.cluster[at.j];
  const int swap = hypot(i->x1 - i->x0, i->y1 - i->y0) > hypot(j->x1 - j->x0, j->y1 - j->y0);
  if (swap) at = (two){.i = at.j, .j = at.i};
  w->later[w->laters++] = at;
  return HR2D_OK;
}

static hr2d_status settle(walk *w, two at) {
  const hr2d_status status = hr2di_watch_work(w->watch, 10);
  if (status) return status;
  const hr2di_cluster *i = &w->tree.cluster[at.i], *j = &w->tree.cluster[at.j];
  if (at.i == at.j) return part(w, at);
  if (!at.facing) {
    const hr2di_clusters_facing facing = hr2di_clusters_face(&w->tree, at.i, at.j);
    if (facing == HR2DI_CLUSTERS_APART) return HR2D_OK;
    at.facing = facing == HR2DI_CLUSTERS_FACING;
  }
  if (may_link(w, &at) && is_clear(w, &at)) return link(w, &at);
  if (!at.clear) {
    const int few = pairs_of(w, &at) <= HR2DI_CHOICE_CLUSTERS_PUT_OFF && !link_pays(w, &at);
    if (few && !is_clear(w, &at)) return put_off(w, at);
    if (hr2di_watch_work(w->watch, HR2DI_CHOICE_CLUSTERS_LOOK))
      return hr2di_watch_status(w->watch);
    if (!few && hr2di_clusters_blocked(w->walls, i, j)) return HR2D_OK;
  }
  if (i->child || j->child) return part(w, at);
  return hand_over(w, w->tree.patch[i->first], w->tree.patch[j->first]);
}

static int by_first(const void *left, const void *right) {
  const two *l = left, *r = right;
  if (l->i != r->i) return l->i < r->i ? -1 : 1;
  return (l->j > r->j) - (l->j < r->j);
}

/* What was put off, to be settled by what patches see. */
typedef struct settling {
  walk *w;
  size_t *start;   /* per cluster: its first of walk::later; one more */
  uint32_t *place; /* per patch: its place in the tree */
  uint32_t *mark;  /* per cluster: 1 + the patch it was put off for last */
} settling;

static uint32_t child_at(const hr2di_cluster *all, uint32_t k, uint32_t place) {
  return all[k].child + (place >= all[all[k].child].last);
}

/* Marks the clusters that were put off for those that hold a patch; returns whether there are
   any. */
static int mark_put_off(settling *s, uint32_t patch) {
  const hr2di_cluster *all = s->w->tree.cluster;
  int any = 0;
  for (uint32_t k = 0;; k = child_at(all, k, s->place[patch])) {
    for (size_t m = s->start[k]; m < s->start[k + 1]; m++)
      s->mark[s->w->later[m].j] = patch + 1;
    any |= s->start[k] < s->start[k + 1];
    if (!all[k].child) return any;
  }
}

static int was_put_off(const settling *s, uint32_t patch, uint32_t other) {
  const hr2di_cluster *all = s->w->tree.cluster;
  for (uint32_t k = 0;; k = child_at(all, k, s->place[other])) {
    if (s->mark[k] == patch + 1) return 1;
    if (!all[k].child) return 0;
  }
}

/* Hands over what a patch sees of what was put off for it. */
static hr2d_status settle_row(void *ctx, size_t worker, const hr2di_row *row) {
  (void)worker;
  settling *s = ctx;
  hr2d_status status = hr2di_watch_work(s->w->watch, 1 + row->count / 4);
  if (status || !mark_put_off(s, row->patch)) return status;
  for (size_t k = 0; k < row->count && !status; k++) {
    const uint32_t other = row->column[k] & ~HR2DI_PARTIAL;
    if (was_put_off(s, row->patch, other)) status = hand_over(s->w, row->patch, other);
  }
  return status;
}

/* A task may be left out if nothing was put off for its patches. */
static hr2d_status settle_rows(settling *s, const hr2d_scene *scene) {
  hr2di_row_assembly rows;
  hr2d_status status = hr2di_row_assembly_init(&rows, scene, 1, 1, s->w->watch);
  for (size_t k = 0; k < rows.tasks && !status; k++) {
    int any = 0;
    for (uint32_t m = rows.task[k].first; m < rows.task[k].last && !any; m++)
      any = mark_put_off(s, scene->runs.patch[m]);
    status = hr2di_watch_work(s->w->watch, 1);
    if (any && !status) status = hr2di_row_assembly_run(&rows, k, k + 1, settle_row, s);
  }
  hr2di_row_assembly_clear(&rows);
  return status;
}

static hr2d_status settle_later(walk *w, const hr2d_scene *scene) {
  if (w->laters == 0) return HR2D_OK;
  const hr2d_allocator *alloc = &w->tree.alloc;
  settling s = {.w = w,
                .start = hr2di_alloc(alloc, w->tree.clusters + 1, sizeof *s.start),
                .place = hr2di_alloc(alloc, scene->patches, sizeof *s.place),
                .mark = hr2di_alloc_zero(alloc, w->tree.clusters, sizeof *s.mark)};
  hr2d_status status = s.start && s.place && s.mark ? HR2D_OK : HR2D_ENOMEM;
  if (!status) status = hr2di_sort(w->later, w->laters, sizeof *w->later, by_first, w->watch);
  if (!status) status = hr2di_watch_work(w->watch, w->tree.clusters / 8);
  for (size_t k = 0, m = 0; k <= w->tree.clusters && !status; s.start[k++] = m)
    while (m < w->laters && w->later[m].i < k) m++;
  for (uint32_t k = 0; k < scene->patches && !status; k++) s.place[w->tree.patch[k]] = k;
  if (!status) status = settle_rows(&s, scene);
  hr2di_alloc_free(alloc, s.start);
  hr2di_alloc_free(alloc, s.place);
  hr2di_alloc_free(alloc, s.mark);
  return status;
}

static hr2d_status make_far(walk *w) {
  const double accuracy = w->made->accuracy;
  if (!(accuracy > 0)) return HR2D_OK;
  w->tree.slack = accuracy / SLACK;
  w->far = hr2di_alloc(&w->tree.alloc, w->tree.clusters, sizeof *w->far);
  if (!w->far) return HR2D_ENOMEM;
  for (size_t k = 0; k < w->tree.clusters; k++)
    w->far[k] = hr2di_expansion_of(&w->tree.cluster[k], accuracy);
  return hr2di_watch_work(w->watch, w->tree.clusters);
}

static hr2d_status sort_pairs(walk *w, const hr2d_scene *scene) {
  const hr2d_allocator *alloc = &w->made->alloc;
  hr2d_status status = hr2di_cluster_tree_init(&w->tree, scene, alloc, w->watch);
  if (!status) status = make_far(w);
  if (status) return status;
  const int shaded = scene->effect[HR2D_EFFECT_OCCLUSION].on;
  if (shaded) w->walls = &scene->walls;
  if (shaded) hr2di_clusters_order(&w->tree, w->watch);
  status = push(w, (two){.clear = !shaded}, 0, 0);
  while (!status && w->count > 0) status = settle(w, w->stack[--w->count]);
  if (!status) status = settle_later(w, scene);
  return status ? status : flush(w);
}

hr2d_status hr2di_clusters_create(const hr2d_scene *scene, const hr2d_allocator *alloc,
                                  double accuracy, hr2di_near_fn near, void *ctx,
                                  hr2di_watch *watch, hr2di_clusters **clusters) {
  hr2di_clusters *made = hr2di_alloc_zero(alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  *made = (hr2di_clusters){.alloc = *alloc, .scene = scene, .accuracy = accuracy};
  walk w = {.made = made, .near = near, .ctx = ctx, .watch = watch};
  hr2d_status status = sort_pairs(&w, scene);
  if (!status) status = hr2di_watch_work(watch, w.tree.clusters);
  if (!status) status = hr2di_clusters_keep(made, &w.tree, w.far);
  if (!status) status = hr2di_clusters_find_levels(made);
  hr2di_cluster_tree_clear(&w.tree);
  hr2di_alloc_free(alloc, w.far);
  hr2di_alloc_free(alloc, w.stack);
  hr2di_alloc_free(alloc, w.later);
  if (status)
    hr2di_clusters_destroy(made);
  else
    *clusters = made;
  return status;
}

hr2d_status hr2di_clusters_finer(const hr2di_clusters *of, double accuracy,
                                 hr2di_clusters **clusters) {
  hr2di_clusters *made = hr2di_alloc_zero(&of->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  *made = (hr2di_clusters){.alloc = of->alloc, .scene = of->scene, .accuracy = accuracy};
  hr2d_status status = hr2di_clusters_keep_finer(made, of);
  if (!status) status = hr2di_clusters_find_levels(made);
  if (status)
    hr2di_clusters_destroy(made);
  else
    *clusters = made;
  return status;
}

void hr2di_clusters_destroy(hr2di_clusters *clusters) {
  if (!clusters) return;
  const hr2d_allocator alloc = clusters->alloc;
  hr2di_alloc_free(&alloc, clusters->linked);
  hr2di_alloc_free(&alloc, clusters->home);
  hr2di_alloc_free(&alloc, clusters->link);
  hr2di_alloc_free(&alloc, clusters->point);
  hr2di_alloc_free(&alloc, clusters->cosine);
  hr2di_alloc_free(&alloc, clusters->levels.cluster);
  hr2di_alloc_free(&alloc, clusters->levels.begin);
  hr2di_alloc_free(&alloc, clusters);
}

uint64_t hr2di_clusters_links(const hr2di_clusters *clusters) {
  return clusters->links;
}

uint64_t hr2di_clusters_bytes(const hr2di_clusters *c) {
  const uint64_t n = HR2DI_EXPANSION_POINTS, cosines = n * (n + 1) * (2 * n + 1) / 6;
  uint64_t bytes = sizeof *c + c->link_capacity * sizeof *c->link;
  if (c->links > 0)
    bytes += c->linked_count * (sizeof *c->linked + 4 * sizeof(uint32_t)) +
             c->points * sizeof *c->point + c->scene->patches * sizeof *c->home +
             cosines * sizeof *c->cosine;
  return bytes;
}
