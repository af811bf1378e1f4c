/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solving on a set of links: from a former solution perhaps, to a solution and its powers. */
#include <hr2d/solve.h>
#include <math.h>

#include "alloc.h"
#include "equation.h"
#include "existence.h"
#include "hierarchy-impl.h"
#include "options.h"
#include "scene-impl.h"
#include "solution-impl.h"
#include "sum.h"

static hr2d_status check_options(hr2d_linkset *links, const hr2d_solve_options *o) {
  hr2di_message *message = &links->message;
  if (!(o->tolerance >= 1e-15))
    return hr2di_fail(message, HR2D_EINVAL, "tolerance %g is below 1e-15", o->tolerance);
  if (o->start && o->start->hierarchy != links->hierarchy)
    return hr2di_fail(message, HR2D_EINVAL, "the warm start is from another hierarchy");
  if (links->counts.elements == 0)
    return hr2di_fail(message, HR2D_ESTATE, "the link set was never refined");
  return HR2D_OK;
}

/* y = (B − E)/√ρ of a former solution, perhaps of another order and on younger leaves; with c
   for closed components taken off. */
static void warm_start(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  hr2di_restrict(s->options.start, t->hierarchy, t->leaf, t->leaves, t->order, s->radiosity);
  for (size_t k = 0; k < s->field; k++)
    if (s->root_rho[k] > 0) s->y[k] = (s->radiosity[k] - s->source[k]) / s->root_rho[k];
  hr2di_equation_balance(s);
  for (size_t k = 0; k < t->leaves && s->balance.count > 0; k++)
    for (size_t b = 0; b < t->bands; b++) {
      const size_t at = k * t->width + b;
      s->y[at] -= s->root_rho[at] * hr2di_balance_at(&s->balance, t, k, b);
    }
}

/* Powers in scene lengths: everything that arrives was sent, so that what is sent
   and does not arrive has escaped; from closed components nothing. */
static hr2d_power sum_power(const hr2di_equation *s, size_t band) {
  const hr2di_transport *t = &s->transport;
  const hr2d_scene *scene = t->hierarchy->scene;
  hr2di_sum emitted = {0, 0}, received = {0, 0}, absorbed = {0, 0}, escaped = {0, 0};
  const double background = hr2d_scene_background(scene, band);
  for (size_t k = 0; k < t->leaves; k++) {
    const size_t at = k * t->width + band, patch = t->hierarchy->element[t->leaf[k]].patch;
    const double absorbance = 1 - hr2d_scene_reflectance(scene, patch, band);
    const double area = s->weight[k * t->order];
    hr2di_add(&emitted, area * s->source[at]);
    hr2di_add(&absorbed, area * (absorbance * s->irradiance[at]));
    if (!hr2di_balance_holds(&s->balance, k)) {
      hr2di_add(&escaped, area * s->radiosity[at]);
      hr2di_add(&escaped, -area * s->irradiance[at]);
    }
    if (!t->sky) continue;
    hr2di_add(&received, area * (t->sky[k * t->order] * background));
    hr2di_add(&escaped, area * (t->sky[k * t->order] * background));
  }
  const double unit = hr2d_scene_unit(scene);
  return (hr2d_power){unit * hr2di_total(&emitted), unit * hr2di_total(&received),
                      unit * hr2di_total(&absorbed), unit * hr2di_total(&escaped)};
}

static hr2d_status make_solution(hr2di_equation *s, hr2d_solution **solution) {
  hr2di_transport *t = &s->transport;
  hr2d_solution *made = hr2di_calloc(&s->links->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  *made = (hr2d_solution){.alloc = s->links->alloc,
                          .links = s->links,
                          .hierarchy = t->hierarchy,
                          .elements = t->elements,
                          .order = t->order,
                          .bands = t->bands,
                          .work = {.gathers = t->sweeps,
                                   .iterations = s->looks ? s->looks - 1 : 0,
                                   .row_sums = s->row_sums,
                                   .background_rows = t->sky ? s->row_sums : 0,
                                   .kernels = s->kernels,
                                   .coefficients_seconds = s->coefficients_seconds},
                          .residual = hr2di_equation_residual(s)};
  made->power = hr2di_alloc(&made->alloc, t->bands, sizeof *made->power);
  made->value = hr2di_alloc(&made->alloc, t->elements * t->width, sizeof *made->value);
  if (!made->power || !made->value) {
    hr2d_solution_destroy(made);
    return HR2D_ENOMEM;
  }
  for (size_t band = 0; band < t->bands; band++) made->power[band] = sum_power(s, band);
  hr2di_raise(t, s->radiosity);
  for (size_t k = 0; k < t->elements * t->width; k++) made->value[k] = t->up[k];
  hr2di_raise(t, s->irradiance);
  made->irradiance = t->up;
  t->up = NULL;
  *solution = made;
  return HR2D_OK;
}

hr2d_status hr2d_solve(hr2d_linkset *links, const hr2d_solve_options *given,
                       hr2d_solution **solution) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  hr2di_equation eq;
  if (given) hr2di_copy_sized(&options, sizeof options, given);
  hr2d_status status = check_options(links, &options);
  if (!status) status = hr2di_check_existence(links);
  if (status) return status;
  status = hr2di_equation_init(&eq, links, &options);
  if (!status && links->hierarchy->scene->effect[HR2D_EFFECT_INTERREFLECTION].on) {
    if (options.start) warm_start(&eq);
    status = hr2di_equation_solve(&eq);
  } else if (!status) {
    status = hr2di_equation_take(&eq);
  }
  if (!status) status = make_solution(&eq, solution);
  if (status == HR2D_ENOMEM) hr2di_fail(&links->message, status, "out of memory for the solve");
  hr2di_equation_clear(&eq);
  return status;
}
