/* SPDX-License-Identifier: GPL-3.0-or-later */
/* View factors of points.  Threads make the rows of some groups of points and keep them; then
   the calling thread shows them in the order of the points. */
#include <hr2d/field.h>
#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "base/sized-struct.h"
#include "base/sort.h"
#include "base/team.h"
#include "field/field-impl.h"
#include "field/past-ends.h"
#include "geometry/vector.h"

/* Points of a task, and of a round. */
enum { GROUP = 32, ROUND = 1024 };

/* What is seen under some of the directions; sorted by patch, and by the place in the view. */
typedef struct interval {
  uint32_t patch, place;
  double share, factor;
  double far[2];   /* what is to be added to these for images that are cut off */
  int second_half; /* the image is of the later half */
} interval;

/* A row of a round, in the memory of its task. */
typedef struct kept_row {
  size_t first; /* among the entries of the task */
  size_t count;
  hr2d_place place;
  double sky[2], back[2]; /* share, factor */
} kept_row;

/* What is past the ends of a period: all of it, and what stands for fronts and sky there. */
typedef struct past {
  hr2di_far_view view;
  double ends[2], front[2], sky[2]; /* share, factor */
  double half_difference[2];        /* as in field-at.c */
  double second_half;               /* the share that the later half of the images has */
  double second_half_sky;
  double past_sky[2]; /* the share of sky that is past the ends */
} past;

/* The entries of a task. */
typedef struct store {
  uint32_t *patch;
  double *share, *factor;
  size_t used, room[3];
} store;

typedef struct visit {
  const hr2d_scene *scene;
  const hr2d_allocator *alloc;
  hr2di_watch *watch;
  const hr2d_point *at, *normal;
  size_t first, last; /* the points of the round */
  store store[ROUND / GROUP];
  kept_row *kept;
} visit;

/* One point. */
typedef struct observer {
  const hr2d_allocator *alloc;
  interval *interval;
  size_t count, room;
  hr2d_point normal;
  int has_normal;
  kept_row *row;
  double front;
  past past;
} observer;

/* ½ ∫ n·ω dω between two unit vectors, over n·ω > 0.  To the left the sine to the right, s,
   falls, and behind the horizon on the right it counts as 1, on the left as −1. */
static double form_factor(hr2d_point n, hr2d_point right, hr2d_point left) {
  const double above_right = hr2di_point_dot(n, right), above_left = hr2di_point_dot(n, left);
  const double right_sine = hr2di_point_cross(right, n), left_sine = hr2di_point_cross(left, n);
  if (above_right > 0 || above_left > 0)
    return fmax((above_right > 0 ? right_sine : 1) - (above_left > 0 ? left_sine : -1), 0) / 2;
  /* All of the half plane, or nothing of it. */
  return hr2di_point_dot(right, left) < -0.5 && right_sine > 0.5 ? 1 : 0;
}

static void add(double to[2], double weight, double share, double factor) {
  to[0] += weight * share;
  to[1] += weight * factor;
}

static double factor_of(const observer *l, hr2d_point right, hr2d_point left) {
  return l->has_normal ? form_factor(l->normal, hr2di_point_unit(right), hr2di_point_unit(left))
                       : 0;
}

static void take_far_sky(void *ctx, const hr2di_far_part *part) {
  observer *l = ctx;
  const double share = part->angle / (2 * HR2DI_PI),
               factor = factor_of(l, part->right, part->left);
  if (part->past) {
    add(l->past.past_sky, 1, share, factor);
    return;
  }
  add(l->past.sky, part->weight, share, factor);
  if (part->second_half) l->past.second_half_sky += share;
  l->past.half_difference[1] += (part->weight - part->half) * share;
}

/* As take_late() of field-at.c. */
static void take_second_half(observer *l, const double all[2]) {
  past *p = &l->past;
  const double shares = p->second_half + p->second_half_sky;
  p->front[0] = p->front[1] = 0;
  for (int m = 0; m < 2; m++) p->sky[m] = shares > 0 ? all[m] * p->second_half_sky / shares : 0;
  for (size_t k = 0; k < l->count; k++)
    for (int m = 0; m < 2; m++) {
      interval *g = &l->interval[k];
      g->far[m] = g->second_half && shares > 0 ? all[m] * g->share / shares : 0;
      p->front[m] += g->far[m];
    }
}

/* Where nothing is past the ends, roundings of what stands for it are nothing, too. */
static void join(observer *l) {
  past *p = &l->past;
  const double all[2] = {p->ends[0] + p->past_sky[0], p->ends[1] + p->past_sky[1]};
  if (!(all[0] > 0)) {
    for (size_t k = 0; k < l->count; k++) l->interval[k].far[0] = l->interval[k].far[1] = 0;
    return;
  }
  const double half_difference = fmax(fabs(p->half_difference[0]), fabs(p->half_difference[1]));
  if (p->view.far || half_difference > HR2DI_FAR_UNSETTLED * all[0]) take_second_half(l, all);
  for (int m = 0; m < 2; m++) {
    l->row->sky[m] += p->sky[m] - p->past_sky[m];
    l->row->back[m] += all[m] - p->front[m] - p->sky[m];
  }
}

static hr2d_status take(void *ctx, const hr2di_polygon_arc *s) {
  observer *l = ctx;
  const hr2d_scene *scene = l->past.view.scene;
  const double share = s->angle / (2 * HR2DI_PI), factor = factor_of(l, s->right, s->left);
  if (!(s->angle > 0)) return HR2D_OK;
  if (s->patch >= HR2DI_ROUND_SKY) {
    add(s->patch == HR2DI_ROUND_SKY ? l->row->sky : l->row->back, 1, share, factor);
    if (s->patch == HR2DI_ROUND_SKY) hr2di_far_sky(&l->past.view, s, take_far_sky, l);
    return HR2D_OK;
  }
  if (hr2di_symmetry_is_end(&scene->symmetry, s->patch)) {
    add(l->past.ends, 1, share, factor);
    return HR2D_OK;
  }
  const hr2di_tail *t = &scene->symmetry.points;
  const unsigned term =
      scene->symmetry.motion ? hr2di_symmetry_term(&scene->symmetry, s->patch) : 0;
  const double weight = t->weight[term];
  const int second_half = 2 * term > scene->symmetry.copies;
  l->past.half_difference[0] += (weight - t->half[term]) * share;
  if (second_half) l->past.second_half += share;
  add(l->past.front, weight, share, factor);
  l->front += share;
  if (hr2di_alloc_reserve(l->alloc, &l->interval, &l->room, l->count + 1, sizeof *l->interval))
    return HR2D_ENOMEM;
  l->interval[l->count] = (interval){(uint32_t)hr2di_scene_original(scene, s->patch),
                                     (uint32_t)l->count,
                                     share,
                                     factor,
                                     {weight * share, weight * factor},
                                     second_half};
  l->count++;
  return HR2D_OK;
}

static int by_patch(const void *left, const void *right) {
  const interval *l = left, *r = right;
  if (l->patch != r->patch) return l->patch < r->patch ? -1 : 1;
  return (l->place > r->place) - (l->place < r->place);
}

/* Adds a row to the entries of a task, with one entry for each patch. */
static hr2d_status keep(const observer *l, store *s) {
  const size_t needed = s->used + l->count;
  if (hr2di_alloc_reserve(l->alloc, &s->patch, &s->room[0], needed, sizeof *s->patch) ||
      hr2di_alloc_reserve(l->alloc, &s->share, &s->room[1], needed, sizeof *s->share) ||
      hr2di_alloc_reserve(l->alloc, &s->factor, &s->room[2], needed, sizeof *s->factor))
    return HR2D_ENOMEM;
  l->row->first = s->used;
  for (size_t k = 0; k < l->count; k++) {
    const interval *g = &l->interval[k];
    const int more = k > 0 && g->patch == g[-1].patch;
    const size_t place = more ? s->used - 1 : s->used;
    s->patch[place] = g->patch;
    s->share[place] = g->share + g->far[0] + (more ? s->share[place] : 0);
    s->factor[place] = g->factor + g->far[1] + (more ? s->factor[place] : 0);
    s->used = place + 1;
  }
  l->row->count = s->used - l->row->first;
  return HR2D_OK;
}

static hr2d_status make_row(visit *v, hr2di_field_worker *w, observer *l, size_t point,
                            store *s) {
  int touches;
  l->row = &v->kept[point - v->first];
  *l->row = (kept_row){.place = HR2D_PLACE_BETWEEN};
  l->count = 0;
  l->front = 0;
  l->has_normal = v->normal != NULL;
  if (v->normal) l->normal = hr2di_point_unit(v->normal[point]);
  w->view.take = take;
  w->view.ctx = l;
  const hr2d_point x = hr2di_far_home(v->scene, hr2di_field_scaled(v->scene, v->at[point]));
  l->past = (past){.second_half = 0};
  hr2di_far_view_init(&l->past.view, v->scene, x);
  hr2d_status status = hr2di_beams_all_round(&w->view, x, &touches);
  join(l);
  l->row->place = hr2di_field_place(v->scene, l->front, l->row->sky[0], touches);
  if (!status)
    status = hr2di_sort(l->interval, l->count, sizeof *l->interval, by_patch, w->watch);
  return status ? status : keep(l, s);
}

static hr2d_status do_group(void *ctx, hr2di_field_worker *w, size_t task) {
  visit *v = ctx;
  store *s = &v->store[task];
  observer l = {.alloc = v->alloc};
  hr2d_status status = HR2D_OK;
  s->used = 0;
  for (size_t k = v->first + task * GROUP; k < v->last && k < v->first + (task + 1) * GROUP;
       k++) {
    if (!status) status = make_row(v, w, &l, k, s);
  }
  hr2di_alloc_free(v->alloc, l.interval);
  return status;
}

static hr2d_status show_row(const visit *v, size_t point, hr2d_field_row_fn show, void *ctx) {
  const kept_row *r = &v->kept[point - v->first];
  const store *s = &v->store[(point - v->first) / GROUP];
  const hr2d_field_row row = {.struct_size = sizeof row,
                              .point = point,
                              .place = r->place,
                              .count = r->count,
                              .patch = s->patch ? s->patch + r->first : NULL,
                              .share = s->share ? s->share + r->first : NULL,
                              .factor = v->normal && s->factor ? s->factor + r->first : NULL,
                              .sky = fmin(fmax(r->sky[0], 0), 1),
                              .back = fmin(fmax(r->back[0], 0), 1),
                              .sky_factor = r->sky[1],
                              .back_factor = r->back[1]};
  const hr2d_status status = show(ctx, &row);
  return status ? status : hr2di_watch_work(v->watch, 1 + r->count / 32);
}

static hr2d_status show_all(visit *v, hr2di_field_team *team, size_t count,
                            hr2d_field_row_fn show, void *ctx) {
  hr2d_status status = HR2D_OK;
  uint64_t steps = 0;
  for (v->first = 0; v->first < count && !status; v->first = v->last) {
    v->last = count - v->first > ROUND ? v->first + ROUND : count;
    status = hr2di_field_team_run(team, (v->last - v->first + GROUP - 1) / GROUP, &steps);
    for (size_t k = v->first; k < v->last && !status; k++) status = show_row(v, k, show, ctx);
  }
  return status;
}

static hr2d_status run(visit *v, const hr2d_field_options *o, size_t count,
                       hr2d_field_row_fn show, void *ctx) {
  hr2di_field_team team = {.scene = v->scene,
                           .watch = v->watch,
                           .threads = (unsigned)hr2di_team_threads(o->threads),
                           .run = do_group,
                           .ctx = v};
  v->kept = hr2di_alloc(v->alloc, count < ROUND ? count : ROUND, sizeof *v->kept);
  const hr2d_status status = v->kept ? show_all(v, &team, count, show, ctx) : HR2D_ENOMEM;
  for (size_t k = 0; k < ROUND / GROUP; k++) {
    hr2di_alloc_free(v->alloc, v->store[k].patch);
    hr2di_alloc_free(v->alloc, v->store[k].share);
    hr2di_alloc_free(v->alloc, v->store[k].factor);
  }
  hr2di_alloc_free(v->alloc, v->kept);
  return status ? status : hr2di_watch_ask(v->watch);
}

static int are_normals(const hr2d_point *normal, size_t count) {
  for (size_t k = 0; k < count && normal; k++)
    if (!(hypot(normal[k].x, normal[k].y) > 0)) return 0;
  return !normal || hr2di_field_finite(normal, count);
}

hr2d_status hr2d_field_rows_visit(const hr2d_scene *scene, const hr2d_point *at,
                                  const hr2d_point *normal, size_t count,
                                  const hr2d_field_options *options, hr2d_field_row_fn show,
                                  void *ctx) {
  if (!scene || !show || (count && !at)) return HR2D_EINVAL;
  if (!scene->committed) return HR2D_ESTATE;
  if (hr2di_scene_has_gas(scene)) return HR2D_EUNSUPPORTED;
  hr2d_field_options o = HR2D_FIELD_OPTIONS_INIT;
  hr2d_status status = hr2di_sized_copy(&o, sizeof o, options);
  if (status || !hr2di_field_finite(at, count) || !are_normals(normal, count))
    return HR2D_EINVAL;
  hr2di_watch watch;
  hr2di_with_plane with;
  hr2di_scene_watch(scene, &watch, o.progress, o.progress_ctx, "field");
  status = hr2di_field_scene_init(&with, scene, &watch);
  visit v = {.scene = &with.scene,
             .alloc = &scene->alloc,
             .watch = &watch,
             .at = at,
             .normal = normal};
  if (!status) status = run(&v, &o, count, show, ctx);
  hr2di_with_plane_clear(&with);
  return status;
}
