/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field at points, in groups of neighbours. */
#include "field/field-at.h"

#include <hr2d/field.h>
#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "base/sized-struct.h"
#include "base/team.h"
#include "field/leaf-errors.h"

/* Of E_g; 3 roundings were seen. */
#define GAS_ROUNDING 0x1p-48

/* Points of a task. */
enum { GROUP = 32 };

void hr2di_field_keep(const hr2d_field_values *v, size_t k, size_t bands,
                      const hr2di_field_look_at *seen) {
  for (size_t b = 0; b < bands; b++) {
    if (v->mean) v->mean[k * bands + b] = seen->mean[b];
    if (v->error) v->error[k * bands + b] = seen->error[b];
  }
  for (size_t b = 0; b < 2 * bands && v->flux; b++) v->flux[2 * k * bands + b] = seen->flux[b];
  if (v->sky) v->sky[k] = seen->sky;
  if (v->back) v->back[k] = seen->back;
  if (v->cut_off) v->cut_off[k] = seen->cut_off;
  if (v->place) v->place[k] = (unsigned char)seen->place;
}

typedef struct call {
  const hr2di_field_call *of;
  const hr2d_point *at;
  size_t count;
} call;

static hr2d_status do_group(void *ctx, hr2di_field_worker *w, size_t task) {
  const call *c = ctx;
  hr2d_status status = HR2D_OK;
  for (size_t k = task * GROUP; k < c->count && k < (task + 1) * GROUP && !status; k++) {
    hr2di_field_look_at seen;
    const hr2d_point x = hr2di_field_scaled(c->of->source.scene, c->at[k]);
    status = hr2di_field_look(w, &c->of->source, x, &seen);
    if (!status) hr2di_field_keep(&c->of->values, k, c->of->source.solution->bands, &seen);
    if (!status) status = hr2di_field_irradiance(w, c->of, x, seen.place, k);
  }
  return status;
}

/* Measures the errors of leaves if they are wanted, and the caller gave none. */
static hr2d_status find_errors(hr2di_field_call *f, const hr2d_solution *solution) {
  const hr2d_account *account = f->options.account;
  const int wanted = f->values.error || f->values.irradiance_error;
  if (!wanted || f->options.patch_error || !account || !isfinite(account->sup.bound))
    return HR2D_OK;
  return hr2di_leaf_errors(&f->source.leaves, solution, account->sup.bound, &f->watch,
                           &f->source.element_error);
}

/* The light of gas has roundings of its sum.  E_g of a gas of given heat is a mean of B, and so
   it is off by no more than B. */
static hr2d_status find_gas_error(hr2di_field_call *f) {
  hr2di_light_source *of = &f->source;
  const hr2d_scene *scene = hr2di_solution_scene(of->solution);
  const double *error = of->patch_error ? of->patch_error : of->element_error;
  const size_t bands = of->solution->bands;
  if (!error || !of->has_gas) return HR2D_OK;
  of->gas_error = hr2di_alloc_zero(&of->leaves.alloc, bands, sizeof *of->gas_error);
  if (!of->gas_error) return HR2D_ENOMEM;
  /* The first elements are the patches. */
  for (size_t k = 0; k < hr2di_scene_cell(scene) * bands && hr2di_scene_has_free_gas(scene);
       k++)
    of->gas_error[k % bands] = fmax(of->gas_error[k % bands], error[k]);
  for (size_t b = 0; b < bands; b++)
    of->gas_error[b] += GAS_ROUNDING * hr2di_solution_hottest(of->solution, b);
  return HR2D_OK;
}

/* Whether there is a normal for each point, if irradiances are wanted. */
static int has_normals(const hr2di_field_call *f, size_t count) {
  const hr2d_field_options *o = &f->options;
  if (!f->values.irradiance && !f->values.irradiance_error) return 1;
  if (!o->normal || (o->normals > 1 && o->normals != count)) return 0;
  for (size_t k = 0; k < o->normals || k < 1; k++)
    if (o->normal[k].x == 0 && o->normal[k].y == 0) return 0;
  return hr2di_field_finite(o->normal, o->normals > 1 ? o->normals : 1);
}

hr2d_status hr2di_field_open(hr2di_field_call *f, const hr2d_solution *solution, size_t count,
                             const hr2d_field_options *options,
                             const hr2d_field_values *values) {
  const hr2d_scene *scene = hr2di_solution_scene(solution);
  *f = (hr2di_field_call){.options = HR2D_FIELD_OPTIONS_INIT, .values = HR2D_FIELD_VALUES_INIT};
  hr2d_status status = hr2di_sized_copy(&f->options, sizeof f->options, options);
  if (!status) status = hr2di_sized_copy(&f->values, sizeof f->values, values);
  if (!status && !has_normals(f, count)) status = HR2D_EINVAL;
  if (status) return status;
  if (hr2di_scene_has_gas(scene) && scene->symmetry.by.periodic) return HR2D_EUNSUPPORTED;
  hr2di_scene_watch(scene, &f->watch, f->options.progress, f->options.progress_ctx, "field");
  status = hr2di_field_scene_init(&f->scene, scene, &f->watch);
  f->opened = 1;
  if (!status) status = hr2di_light_source_init(&f->source, solution, &f->watch);
  if (!status) status = find_errors(f, solution);
  f->source.scene = &f->scene.scene;
  f->source.wants_flux = f->values.flux != NULL;
  f->source.lit_sky = hr2di_field_lit_sky(scene);
  f->source.patch_error = f->options.patch_error;
  if (!status) status = find_gas_error(f);
  f->team = (hr2di_field_team){.scene = &f->scene.scene,
                               .watch = &f->watch,
                               .threads = (unsigned)hr2di_team_threads(f->options.threads),
                               .needs = HR2DI_FIELD_ROOM * solution->bands};
  return status;
}

void hr2di_field_close(hr2di_field_call *f) {
  if (!f->opened) return;
  if (f->source.solution) hr2di_light_source_clear(&f->source);
  hr2di_with_plane_clear(&f->scene);
}

hr2d_status hr2d_field_at(const hr2d_solution *solution, const hr2d_point *at, size_t count,
                          const hr2d_field_options *options, const hr2d_field_values *values) {
  if (!solution || (count && !at)) return HR2D_EINVAL;
  if (!hr2di_field_finite(at, count)) return HR2D_EINVAL;
  hr2di_field_call f;
  uint64_t steps = 0;
  hr2d_status status = hr2di_field_open(&f, solution, count, options, values);
  call c = {.of = &f, .at = at, .count = count};
  f.team.run = do_group;
  f.team.ctx = &c;
  if (!status)
    status = hr2di_field_team_run(&f.team, count / GROUP + (count % GROUP > 0), &steps);
  if (!status) status = hr2di_watch_ask(&f.watch);
  hr2di_field_close(&f);
  return status;
}
