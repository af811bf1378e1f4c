/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One look from a point: sums of the light of all arcs, and what stands for those that are past
   the ends of a period. */
#include "field/look.h"

#include <math.h>

#include "base/pi.h"
#include "field/above-plane.h"
#include "field/past-ends.h"

/* Takes the arcs of a view.  `sum` is the light that is seen, `far` that of images that are cut
   off, extrapolated by series, `second_half` that of the later half of the images, `past` that
   of the sky which shows past the ends although more images hide it, and `current` that of one
   arc. */
typedef struct observer {
  hr2di_field_worker *worker;
  const hr2d_point *normal; /* of the plane above which it looks; NULL: all round */
  hr2di_light_sum sum, far, second_half, past, current;
  hr2di_far_view view;
  double *off;     /* per check of the series, and band: what it leaves of ∫ B dω */
  double ends;     /* angles of the ends, */
  double past_sky; /* and of sky that is past them */
  int mixed;       /* a piece of the sky ends there */
  /* Whether there is a series, which a plane does not change: all round. */
  double half_difference[2]; /* angles of fronts and of sky past the ends: as extrapolated from
                                all images, minus as extrapolated from half of them */
  double all;                /* what is past the ends */
} observer;

static void clear(hr2di_light_sum *sum, size_t bands) {
  sum->front = sum->back = sum->sky = 0;
  sum->clearance = HUGE_VAL;
  for (size_t b = 0; b < bands; b++) sum->mean[b] = sum->error[b] = 0;
  for (size_t b = 0; b < 2 * bands && sum->flux; b++) sum->flux[b] = 0;
}

static void add_times(hr2di_light_sum *to, double factor, const hr2di_light_sum *sum) {
  const size_t bands = to->of->solution->bands;
  to->front += factor * sum->front;
  to->sky += factor * sum->sky;
  for (size_t b = 0; b < bands; b++) {
    to->mean[b] += factor * sum->mean[b];
    to->error[b] += factor * sum->error[b];
  }
  for (size_t b = 0; b < 2 * bands && to->flux; b++) to->flux[b] += factor * sum->flux[b];
}

/* Adds `current` times the weights of its image in the extrapolation. */
static void add_current(observer *l, const hr2di_far_part *part) {
  const size_t bands = l->sum.of->solution->bands;
  add_times(&l->far, part->weight, &l->current);
  if (part->second_half) add_times(&l->second_half, 1, &l->current);
  for (size_t b = 0; b < bands; b++) {
    l->off[b] += part->check[0] * l->current.mean[b];
    l->off[bands + b] += part->check[1] * l->current.mean[b];
  }
}

/* Notes what is past the ends between two directions, and adds the suns that shine from there.
   Returns whether it is more than the sky at the horizon. */
static int note_far(observer *l, hr2d_point right, hr2d_point left) {
  const hr2di_light_source *of = l->sum.of;
  const int mixed = hr2di_far_changes(l->view.scene, right, left);
  int suns = 0;
  l->mixed |= mixed;
  for (size_t b = 0; b < of->solution->bands; b++) {
    if (!hr2di_light_has_sun(of, right, left, b)) continue;
    suns = 1;
    if (hr2di_far_sun_shines(l->view.scene, l->sum.x, b)) hr2di_light_add_sun(&l->sum, b);
  }
  return mixed || suns;
}

static void take_far_sky(void *ctx, const hr2di_far_part *part) {
  observer *l = ctx;
  clear(&l->current, l->sum.of->solution->bands);
  if (part->past && note_far(l, part->right, part->left)) {
    hr2di_light_add(&l->current, &(hr2di_polygon_arc){.patch = HR2DI_ROUND_SKY,
                                                      .right = part->right,
                                                      .left = part->left,
                                                      .angle = part->angle});
  } else {
    hr2di_light_add_sky(&l->current, part->right, part->left, part->angle, part->bearing, 1);
  }
  if (!part->past) {
    add_current(l, part);
    return;
  }
  add_times(&l->past, 1, &l->current);
  l->past_sky += part->angle;
}

static void take_far(observer *l, const hr2di_polygon_arc *s) {
  const hr2di_symmetry *all = &l->view.scene->symmetry;
  if (s->patch == HR2DI_ROUND_SKY) {
    hr2di_far_sky(&l->view, s, take_far_sky, l);
    return;
  }
  if (s->patch == HR2DI_ROUND_BACK) return;
  if (hr2di_symmetry_is_end(all, s->patch)) {
    l->ends += s->angle;
    l->sum.front -= s->angle;
    note_far(l, s->right, s->left);
    return;
  }
  const unsigned term = hr2di_symmetry_term(all, s->patch);
  if (all->points.weight[term] == 0 && all->points.half[term] == 0) return;
  const hr2di_far_part part = {
      .weight = all->points.weight[term],
      .check = {all->points.check[0][term], all->points.check[1][term]},
      .half = all->points.half[term],
      .second_half = 2 * term > all->copies};
  clear(&l->current, l->sum.of->solution->bands);
  hr2di_light_add(&l->current, s);
  add_current(l, &part);
}

static void measure_far_sky(void *ctx, const hr2di_far_part *part) {
  observer *l = ctx;
  if (part->past)
    l->all += part->angle;
  else
    l->half_difference[1] += (part->weight - part->half) * part->angle;
}

static void measure_far(observer *l, const hr2di_polygon_arc *s) {
  const hr2di_symmetry *all = &l->view.scene->symmetry;
  if (s->patch == HR2DI_ROUND_SKY) {
    hr2di_far_sky(&l->view, s, measure_far_sky, l);
  } else if (s->patch == HR2DI_ROUND_BACK) {
    return;
  } else if (hr2di_symmetry_is_end(all, s->patch)) {
    l->all += s->angle;
  } else {
    const unsigned term = hr2di_symmetry_term(all, s->patch);
    l->half_difference[0] += (all->points.weight[term] - all->points.half[term]) * s->angle;
  }
}

static hr2d_status take(void *ctx, const hr2di_polygon_arc *s) {
  observer *l = ctx;
  hr2di_polygon_arc seen = *s;
  if (l->view.quadrants > 0) measure_far(l, s);
  l->sum.x = l->current.x = l->worker->view.x;
  if (l->normal && !hr2di_arc_above_plane(&seen, l->view.scene, l->sum.x, *l->normal))
    return hr2di_watch_status(l->worker->watch);
  hr2di_light_add(&l->sum, &seen);
  if (l->view.quadrants > 0) take_far(l, &seen);
  return hr2di_watch_status(l->worker->watch);
}

/* Without a series: what is past the ends is as the later half of the images is. */
static void take_second_half(observer *l, double all) {
  const hr2di_light_source *of = l->sum.of;
  const size_t bands = of->solution->bands;
  const double angle = l->second_half.front + l->second_half.sky;
  clear(&l->far, bands);
  if (angle > 0) add_times(&l->far, all / angle, &l->second_half);
  for (size_t b = 0; b < bands; b++) l->off[b] = HUGE_VAL;
}

/* A bound of the error of the light past the ends: from the checks of its series, but no more
   than the distance to nothing, or to the brightest light from all of that angle.  Where a
   piece of the sky ends there, the series takes the light of the horizon, and the checks do not
   show the error. */
static double off_by(const observer *l, size_t band, double all) {
  const hr2di_light_source *of = l->sum.of;
  const double max = all * fmax(of->leaves.scale[band], hr2di_sky_max(of->scene, band));
  const double is = l->far.mean[band];
  const double off =
      l->mixed ? HUGE_VAL : fmax(fabs(l->off[band]), fabs(l->off[of->solution->bands + band]));
  return fmin(HR2DI_TAIL_BOUND * off, fmax(is, max - fmin(is, 0)));
}

/* Adds the light past the ends; if the view has none, not even roundings of it are added. */
static void join(observer *l) {
  const double all = l->ends + l->past_sky;
  if (!(all > 0)) return;
  const double half_difference = fmax(fabs(l->half_difference[0]), fabs(l->half_difference[1]));
  if (l->view.far || half_difference > HR2DI_FAR_UNSETTLED * l->all) take_second_half(l, all);
  l->sum.back += all - l->far.front - l->far.sky;
  add_times(&l->sum, 1, &l->far);
  add_times(&l->sum, -1, &l->past);
  for (size_t b = 0; b < l->sum.of->solution->bands; b++) l->sum.error[b] += off_by(l, b, all);
}

/* The sums have the room of the worker one after the other. */
static void set_sum(observer *l, hr2di_light_sum *sum, const hr2di_light_source *of,
                    double *room) {
  const size_t bands = of->solution->bands;
  *sum = (hr2di_light_sum){
      .of = of, .watch = l->worker->watch, .mean = room, .error = room + 3 * bands};
  sum->flux = room + bands;
  clear(sum, bands);
  if (!of->wants_flux && !l->normal) sum->flux = NULL;
}

static double part_of(double angle) {
  return fmin(fmax(angle, 0) / (2 * HR2DI_PI), 1);
}

/* Sums up what is seen from x, all round or above a plane. */
static hr2d_status observe(observer *l, const hr2di_light_source *of, hr2d_point x,
                           int *touches) {
  const size_t bands = of->solution->bands;
  double *room = l->worker->room;
  hr2di_light_sum *const sums[] = {&l->sum, &l->far, &l->second_half, &l->past, &l->current};
  for (size_t k = 0; k < 5; k++) set_sum(l, sums[k], of, room + 4 * k * bands);
  l->off = room + 5 * 4 * bands;
  for (size_t b = 0; b < 2 * bands; b++) l->off[b] = 0;
  l->worker->view.take = take;
  l->worker->view.ctx = l;
  x = hr2di_far_home(of->scene, x);
  hr2di_far_view_init(&l->view, of->scene, x);
  const hr2d_status status = hr2di_beams_all_round(&l->worker->view, x, touches);
  join(l);
  return status;
}

hr2d_status hr2di_field_look(hr2di_field_worker *w, const hr2di_light_source *of, hr2d_point x,
                             hr2di_field_look_at *seen) {
  const size_t bands = of->solution->bands;
  observer l = {.worker = w};
  hr2di_light_sum *sum = &l.sum;
  int touches;
  const hr2d_status status = observe(&l, of, x, &touches);
  double *flux = w->room + bands;
  seen->place = hr2di_field_place(of->scene, sum->front, sum->sky, touches);
  const int dark = seen->place == HR2D_PLACE_OUTSIDE;
  const int knows = of->patch_error || of->element_error;
  seen->clearance = sqrt(sum->clearance);
  seen->mean = sum->mean;
  seen->flux = flux;
  seen->error = sum->error;
  seen->sky = part_of(sum->sky);
  seen->back = part_of(sum->back);
  seen->cut_off = part_of(l.ends + l.past_sky);
  for (size_t b = 0; b < bands; b++) {
    sum->mean[b] = dark ? NAN : sum->mean[b] / (2 * HR2DI_PI);
    flux[2 * b] = dark ? NAN : flux[2 * b] / 2;
    flux[2 * b + 1] = dark ? NAN : flux[2 * b + 1] / 2;
    sum->error[b] = dark || !knows ? NAN : sum->error[b] / (2 * HR2DI_PI);
  }
  return status;
}

hr2d_status hr2di_field_look_above(hr2di_field_worker *w, const hr2di_light_source *of,
                                   hr2d_point x, hr2d_point normal, hr2di_field_above *seen) {
  const size_t bands = of->solution->bands;
  observer l = {.worker = w, .normal = &normal};
  int touches;
  const hr2d_status status = observe(&l, of, x, &touches);
  seen->flux = l.sum.flux;
  seen->error = l.sum.error;
  for (size_t b = 0; b < bands; b++) {
    l.sum.flux[2 * b] /= 2;
    l.sum.flux[2 * b + 1] /= 2;
    l.sum.error[b] /= 2;
  }
  return status;
}
