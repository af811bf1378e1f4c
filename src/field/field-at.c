/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field at points, in groups of neighbours. */
#include "field/field-at.h"

#include <hr2d/field.h>
#include <math.h>

#include "base/pi.h"
#include "base/sized-struct.h"

/* Points of a task. */
enum { GROUP = 32 };

/* Whether images of a period would be seen that are cut off: past an end; or from above or
   below all patches, where nothing stands although the direction leads back to them. */
static int is_cut_off(const hr2d_scene *scene, hr2d_point x, const hr2di_round_stretch *s) {
  const hr2di_symmetry *all = &scene->symmetry;
  if (!all->motion || !all->by.periodic) return 0;
  if (s->patch < scene->patches) return s->patch >= all->motions * all->cell;
  if (s->patch != HR2DI_ROUND_SKY) return 0;
  const double at = hr2di_symmetry_height(all, hr2d_scene_unit(scene), x);
  const hr2d_point up = {-all->by.period.y, all->by.period.x};
  const double right = s->right.x * up.x + s->right.y * up.y,
               left = s->left.x * up.x + s->left.y * up.y;
  return at > 0 ? fmin(right, left) < 0 : at < 0 && fmax(right, left) > 0;
}

static hr2d_status take(void *ctx, const hr2di_round_stretch *s) {
  hr2di_field_looker *l = ctx;
  if (is_cut_off(l->sum.of->scene, l->sum.x, s)) l->cut_off = 1;
  l->sum.x = l->worker->view.x;
  hr2di_light_add(&l->sum, s);
  return hr2di_watch_status(l->worker->watch);
}

static void clear(hr2di_light_sum *sum, size_t bands) {
  sum->front = sum->back = sum->sky = 0;
  sum->clearance = HUGE_VAL;
  for (size_t b = 0; b < bands; b++) sum->mean[b] = sum->error[b] = 0;
}

hr2d_status hr2di_field_look(hr2di_field_worker *w, const hr2di_light_source *of, hr2d_point x,
                             hr2di_field_look_at *seen) {
  const size_t bands = of->solution->bands;
  hr2di_field_looker l = {.worker = w, .sum = {.of = of, .watch = w->watch}};
  hr2di_light_sum *sum = &l.sum;
  int touches;
  sum->mean = w->room;
  double *flux = sum->mean + bands;
  sum->error = flux + 2 * bands;
  clear(sum, bands);
  for (size_t k = 0; k < 2 * bands; k++) flux[k] = 0;
  sum->flux = of->wants_flux ? flux : NULL;
  w->view.take = take;
  w->view.ctx = &l;
  const hr2d_status status = hr2di_look_round(&w->view, x, &touches);
  seen->place = l.cut_off ? HR2D_PLACE_OUTSIDE
                          : hr2di_field_place(of->scene, sum->front, sum->sky, touches);
  const int dark = seen->place == HR2D_PLACE_OUTSIDE;
  seen->clearance = sqrt(sum->clearance);
  seen->mean = sum->mean;
  seen->flux = flux;
  seen->error = sum->error;
  seen->sky = fmin(sum->sky / (2 * HR2DI_PI), 1);
  seen->back = fmin(sum->back / (2 * HR2DI_PI), 1);
  for (size_t b = 0; b < bands; b++) {
    sum->mean[b] = dark ? NAN : sum->mean[b] / (2 * HR2DI_PI);
    flux[2 * b] = dark ? NAN : flux[2 * b] / 2;
    flux[2 * b + 1] = dark ? NAN : flux[2 * b + 1] / 2;
    sum->error[b] = dark || !of->patch_error ? NAN : sum->error[b] / (2 * HR2DI_PI);
  }
  return status;
}

void hr2di_field_keep(const hr2d_field_values *v, size_t k, size_t bands,
                      const hr2di_field_look_at *seen) {
  for (size_t b = 0; b < bands; b++) {
    if (v->mean) v->mean[k * bands + b] = seen->mean[b];
    if (v->error) v->error[k * bands + b] = seen->error[b];
  }
  for (size_t b = 0; b < 2 * bands && v->flux; b++) v->flux[2 * k * bands + b] = seen->flux[b];
  if (v->sky) v->sky[k] = seen->sky;
  if (v->back) v->back[k] = seen->back;
  if (v->place) v->place[k] = (unsigned char)seen->place;
}

typedef struct call {
  const hr2di_light_source *of;
  const hr2d_point *at;
  size_t count;
  const hr2d_field_values *values;
} call;

static hr2d_status do_group(void *ctx, hr2di_field_worker *w, size_t task) {
  const call *c = ctx;
  hr2d_status status = HR2D_OK;
  for (size_t k = task * GROUP; k < c->count && k < (task + 1) * GROUP && !status; k++) {
    hr2di_field_look_at seen;
    const hr2d_point x = hr2di_field_scaled(c->of->scene, c->at[k]);
    status = hr2di_field_look(w, c->of, x, &seen);
    if (!status) hr2di_field_keep(c->values, k, c->of->solution->bands, &seen);
  }
  return status;
}

hr2d_status hr2di_field_open(hr2di_field_call *f, const hr2d_solution *solution,
                             const hr2d_field_options *options,
                             const hr2d_field_values *values) {
  const hr2d_scene *scene = solution->hierarchy->scene;
  *f = (hr2di_field_call){.options = HR2D_FIELD_OPTIONS_INIT, .values = HR2D_FIELD_VALUES_INIT};
  hr2d_status status = hr2di_sized_copy(&f->options, sizeof f->options, options);
  if (!status) status = hr2di_sized_copy(&f->values, sizeof f->values, values);
  if (status) return status;
  hr2di_scene_watch(scene, &f->watch, f->options.progress, f->options.progress_ctx, "field");
  status = hr2di_field_scene_init(&f->scene, scene, &f->watch);
  f->opened = 1;
  if (!status) status = hr2di_light_source_init(&f->source, solution, &f->watch);
  f->source.scene = &f->scene.scene;
  f->source.wants_flux = f->values.flux != NULL;
  f->source.lit_sky = hr2di_field_lit_sky(scene);
  f->source.patch_error = f->options.patch_error;
  f->team = (hr2di_field_team){.scene = &f->scene.scene,
                               .watch = &f->watch,
                               .threads = f->options.threads,
                               .needs = 4 * solution->bands};
  return status;
}

void hr2di_field_close(hr2di_field_call *f) {
  if (!f->opened) return;
  if (f->source.solution) hr2di_light_source_clear(&f->source);
  hr2di_with_plane_clear(&f->scene);
}

hr2d_status hr2d_field_at(const hr2d_solution *solution, const hr2d_point *at, size_t count,
                          const hr2d_field_options *options, const hr2d_field_values *values) {
  if (!hr2di_field_finite(at, count)) return HR2D_EINVAL;
  hr2di_field_call f;
  uint64_t steps = 0;
  hr2d_status status = hr2di_field_open(&f, solution, options, values);
  call c = {.of = &f.source, .at = at, .count = count, .values = &f.values};
  f.team.run = do_group;
  f.team.ctx = &c;
  if (!status)
    status = hr2di_field_team_run(&f.team, count / GROUP + (count % GROUP > 0), &steps);
  if (!status) status = hr2di_watch_ask(&f.watch);
  hr2di_field_close(&f);
  return status;
}
