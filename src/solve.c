/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Setting up and solving B = E + ρ K B on the leaves.

   With B = E + √ρ y the equation becomes (I − √ρ K √ρ) y = √ρ K E.  Its operator is
   self-adjoint in Σ A x y, because A_i K_ij = AF_ij = A_j K_ji, and positive definite
   where light is lost; patches with ρ = 0 drop out by themselves. */
#include <float.h>
#include <hr2d/solve.h>
#include <math.h>

#include "alloc.h"
#include "closure.h"
#include "existence.h"
#include "hierarchy-impl.h"
#include "krylov.h"
#include "options.h"
#include "rows.h"
#include "scene-impl.h"
#include "solution-impl.h"
#include "sum.h"
#include "transport.h"

typedef struct solver {
  hr2d_linkset *links;
  hr2d_solve_options options;
  hr2di_transport transport;
  size_t field;     /* leaves × bands */
  double *space;    /* holds what follows */
  double *weight;   /* A of each leaf */
  double *emission; /* fields */
  double *root_rho; /* √ρ */
  double *radiosity;
  double *irradiance;
  double *y, *b, *work;
  double *norm[2]; /* per band */
  uint64_t row_sums;
  uint64_t looks; /* at the residual: one before the first iteration, one after each */
} solver;

static hr2d_status check_options(solver *s) {
  hr2di_message *message = &s->links->message;
  const hr2d_solve_options *o = &s->options;
  if (!(o->tolerance >= 1e-15))
    return hr2di_fail(message, HR2D_EINVAL, "tolerance %g is below 1e-15", o->tolerance);
  if (o->start && o->start->hierarchy != s->links->hierarchy)
    return hr2di_fail(message, HR2D_EINVAL, "the warm start is from another hierarchy");
  if (s->links->counts.elements == 0)
    return hr2di_fail(message, HR2D_ESTATE, "the link set was never refined");
  return HR2D_OK;
}

/* Where nothing reflects there is nothing to iterate. */
static int iterates(const solver *s) {
  return s->links->hierarchy->scene->effect[HR2D_EFFECT_INTERREFLECTION].on;
}

/* Where nothing reflects there is nothing to close. */
static int reflects(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->patches; k++)
    for (size_t band = 0; band < scene->bands; band++)
      if (hr2d_scene_reflectance(scene, k, band) > 0) return 1;
  return 0;
}

/* What each leaf sees besides patches and their backs. */
static hr2d_status set_sky(hr2di_transport *t, const hr2di_rows *rows) {
  t->sky = hr2di_alloc(&t->alloc, t->leaves, sizeof *t->sky);
  if (!t->sky) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->leaves; k++) {
    const uint32_t leaf = t->leaf[k];
    t->sky[k] = fmax(0, 1 - rows->front[leaf] - rows->back[leaf]);
  }
  return HR2D_OK;
}

/* Closure, and the view of the background, need what leaves see of all patches. */
static hr2d_status integrate_rows(solver *s) {
  const int closure = s->options.closure && reflects(s->links->hierarchy->scene);
  const int background = s->links->hierarchy->scene->effect[HR2D_EFFECT_BACKGROUND].on;
  if (!closure && !background) return HR2D_OK;
  hr2di_rows rows;
  hr2d_status status = hr2di_rows_make(&rows, &s->transport, background);
  if (!status && background) status = set_sky(&s->transport, &rows);
  if (!status && closure) status = hr2di_close(&s->transport, &rows);
  s->row_sums = rows.leaves;
  hr2di_rows_clear(&rows);
  return status;
}

static hr2d_status set_up(solver *s) {
  hr2di_transport *t = &s->transport;
  if (hr2di_transport_init(t, s->links, s->options.threads)) return HR2D_ENOMEM;
  if (integrate_rows(s)) return HR2D_ENOMEM;
  const size_t leaves = t->leaves, bands = t->bands;
  s->field = leaves * bands;
  s->space =
      hr2di_calloc(&s->links->alloc, leaves + 7 * s->field + 2 * bands, sizeof *s->space);
  if (!s->space) return HR2D_ENOMEM;
  double **const field[] = {&s->emission, &s->root_rho, &s->radiosity, &s->irradiance,
                            &s->y,        &s->b,        &s->work};
  s->weight = s->space;
  for (size_t k = 0; k < 7; k++) *field[k] = s->space + leaves + k * s->field;
  s->norm[0] = s->space + leaves + 7 * s->field;
  s->norm[1] = s->norm[0] + bands;
  const hr2d_scene *scene = t->hierarchy->scene;
  for (size_t k = 0; k < leaves; k++) {
    const hr2d_element *e = &t->hierarchy->element[t->leaf[k]];
    s->weight[k] = e->length;
    for (size_t b = 0; b < bands; b++) {
      s->emission[k * bands + b] = hr2d_scene_emission(scene, e->patch, b);
      s->root_rho[k * bands + b] = sqrt(hr2d_scene_reflectance(scene, e->patch, b));
    }
  }
  return HR2D_OK;
}

/* out = √ρ K √ρ in */
static void apply(void *ctx, const double *in, double *out) {
  solver *s = ctx;
  for (size_t k = 0; k < s->field; k++) s->work[k] = s->root_rho[k] * in[k];
  hr2di_gather(&s->transport, s->work, out);
  for (size_t k = 0; k < s->field; k++) out[k] *= s->root_rho[k];
}

/* B = E + √ρ y */
static void set_radiosity(solver *s, const double *y) {
  for (size_t k = 0; k < s->field; k++)
    s->radiosity[k] = s->emission[k] + s->root_rho[k] * y[k];
}

static hr2di_system make_system(solver *s);

static void scale(void *ctx, const double *y, double *norm) {
  solver *s = ctx;
  const hr2di_system system = make_system(s);
  set_radiosity(s, y);
  hr2di_dot(&system, s->radiosity, s->radiosity, norm);
  for (size_t b = 0; b < system.bands; b++) norm[b] = sqrt(norm[b]);
}

static hr2d_status tell(void *ctx, double residual) {
  solver *s = ctx;
  s->looks++;
  if (!s->options.progress) return HR2D_OK;
  const double digits = residual > 0 ? log(residual) / log(s->options.tolerance) : 1;
  const hr2d_progress progress = {.struct_size = sizeof progress,
                                  .phase = "solve",
                                  .elements = s->transport.elements,
                                  .links = s->links->store.count,
                                  .fraction = fmin(fmax(digits, 0), 1),
                                  .residual = residual};
  return s->options.progress(s->options.progress_ctx, &progress);
}

static hr2di_system make_system(solver *s) {
  return (hr2di_system){.alloc = &s->links->alloc,
                        .size = s->transport.leaves,
                        .bands = s->transport.bands,
                        .weight = s->weight,
                        .symmetric = !s->links->directed,
                        .apply = apply,
                        .scale = scale,
                        .tell = tell,
                        .ctx = s,
                        .tolerance = s->options.tolerance,
                        .max_iterations = s->options.max_iterations};
}

/* y = (B − E)/√ρ of a former solution; leaves it does not know take the value of
   their youngest ancestor that it does. */
static void warm_start(solver *s) {
  const hr2d_solution *start = s->options.start;
  const hr2di_transport *t = &s->transport;
  for (size_t k = 0; k < t->leaves; k++) {
    uint32_t e = t->leaf[k];
    while (e >= start->elements) e = t->hierarchy->parent[e];
    for (size_t b = 0; b < t->bands; b++) {
      const size_t at = k * t->bands + b;
      if (s->root_rho[at] > 0)
        s->y[at] = (hr2d_solution_element(start, e, b) - s->emission[at]) / s->root_rho[at];
    }
  }
}

/* H = K B, and what comes from the background. */
static void gather_all(solver *s, const double *radiosity) {
  hr2di_gather(&s->transport, radiosity, s->irradiance);
  hr2di_add_background(&s->transport, s->irradiance);
}

static hr2d_status iterate(solver *s) {
  gather_all(s, s->emission);
  for (size_t k = 0; k < s->field; k++) s->b[k] = s->root_rho[k] * s->irradiance[k];
  if (s->options.start) warm_start(s);
  const hr2di_system system = make_system(s);
  double residual = 0;
  const hr2d_status status = hr2di_krylov(&system, s->b, s->y, &residual);
  if (status == HR2D_ENOT_CONVERGED)
    return hr2di_fail(&s->links->message, status,
                      "the relative residual is %.1e where %.1e was asked for, after %llu "
                      "gathers",
                      residual, s->options.tolerance, (unsigned long long)s->transport.sweeps);
  if (status) return hr2di_fail(&s->links->message, status, "solve: %s", hr2d_strerror(status));
  set_radiosity(s, s->y);
  gather_all(s, s->radiosity);
  return HR2D_OK;
}

/* Where every ρ is 0 nothing is solved: B = E, and one gather gives the irradiance. */
static void gather_once(solver *s) {
  set_radiosity(s, s->y);
  gather_all(s, s->radiosity);
}

/* ‖E + ρH − B‖/‖B‖, the largest over the bands. */
static double true_residual(solver *s) {
  const hr2di_system system = make_system(s);
  for (size_t k = 0; k < s->field; k++)
    s->work[k] =
        s->emission[k] + s->root_rho[k] * s->root_rho[k] * s->irradiance[k] - s->radiosity[k];
  hr2di_dot(&system, s->work, s->work, s->norm[0]);
  hr2di_dot(&system, s->radiosity, s->radiosity, s->norm[1]);
  double most = 0;
  for (size_t b = 0; b < system.bands; b++)
    if (s->norm[0][b] > 0) most = fmax(most, sqrt(s->norm[0][b] / s->norm[1][b]));
  return most;
}

/* Powers in scene lengths: everything that arrives was sent, so that what is sent
   and does not arrive has escaped. */
static hr2d_power sum_power(const solver *s, size_t band) {
  const hr2di_transport *t = &s->transport;
  const hr2d_scene *scene = t->hierarchy->scene;
  hr2di_sum emitted = {0, 0}, received = {0, 0}, absorbed = {0, 0}, escaped = {0, 0};
  const double background = hr2d_scene_background(scene, band);
  for (size_t k = 0; k < t->leaves; k++) {
    const size_t at = k * t->bands + band, patch = t->hierarchy->element[t->leaf[k]].patch;
    const double absorbance = 1 - hr2d_scene_reflectance(scene, patch, band);
    hr2di_add(&emitted, s->weight[k] * s->emission[at]);
    hr2di_add(&absorbed, s->weight[k] * (absorbance * s->irradiance[at]));
    hr2di_add(&escaped, s->weight[k] * s->radiosity[at]);
    hr2di_add(&escaped, -s->weight[k] * s->irradiance[at]);
    if (!t->sky) continue;
    hr2di_add(&received, s->weight[k] * (t->sky[k] * background));
    hr2di_add(&escaped, s->weight[k] * (t->sky[k] * background));
  }
  const double unit = hr2d_scene_unit(scene);
  return (hr2d_power){unit * hr2di_total(&emitted), unit * hr2di_total(&received),
                      unit * hr2di_total(&absorbed), unit * hr2di_total(&escaped)};
}

static hr2d_status make_solution(solver *s, hr2d_solution **solution) {
  hr2di_transport *t = &s->transport;
  hr2d_solution *made = hr2di_calloc(&s->links->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  *made = (hr2d_solution){.alloc = s->links->alloc,
                          .hierarchy = t->hierarchy,
                          .elements = t->elements,
                          .bands = t->bands,
                          .work = {.gathers = t->sweeps,
                                   .iterations = s->looks ? s->looks - 1 : 0,
                                   .row_sums = s->row_sums,
                                   .background_rows = t->sky ? s->row_sums : 0},
                          .residual = true_residual(s)};
  made->power = hr2di_alloc(&made->alloc, t->bands, sizeof *made->power);
  made->value = hr2di_alloc(&made->alloc, t->elements * t->bands, sizeof *made->value);
  if (!made->power || !made->value) {
    hr2d_solution_destroy(made);
    return HR2D_ENOMEM;
  }
  for (size_t band = 0; band < t->bands; band++) made->power[band] = sum_power(s, band);
  hr2di_pull(t, s->radiosity);
  for (size_t k = 0; k < t->elements * t->bands; k++) made->value[k] = t->up[k];
  hr2di_pull(t, s->irradiance);
  made->irradiance = t->up;
  t->up = NULL;
  *solution = made;
  return HR2D_OK;
}

hr2d_status hr2d_solve(hr2d_linkset *links, const hr2d_solve_options *options,
                       hr2d_solution **solution) {
  solver s = {.links = links, .options = HR2D_SOLVE_OPTIONS_INIT};
  if (options) hr2di_copy_sized(&s.options, sizeof s.options, options);
  hr2d_status status = check_options(&s);
  if (!status) status = hr2di_check_existence(links);
  if (status) return status;
  s.transport.alloc = links->alloc;
  status = set_up(&s);
  if (!status) {
    if (iterates(&s))
      status = iterate(&s);
    else
      gather_once(&s);
  }
  if (!status) status = make_solution(&s, solution);
  if (status == HR2D_ENOMEM) hr2di_fail(&links->message, status, "out of memory for the solve");
  hr2di_transport_clear(&s.transport);
  hr2di_free(&links->alloc, s.space);
  return status;
}
