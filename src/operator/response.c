/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Columns of (I − ρK)⁻¹: solves for patches that alone emit 1, several at once. */
#include "base/alloc.h"
#include "operator/operator-impl.h"
#include "solution/solution-impl.h"
#include "solve/solve-how.h"

/* Columns at once: from some on a gather costs the least for each, and memory grows with them.
 */
enum { AT_ONCE = 16 };

/* A packed array of one light as one that repeats. */
static void repeat(hr2d_values *v, size_t bands) {
  if (v->stride[0] == 0 && v->stride[1] == 0 && v->stride[2] == 0) {
    v->stride[1] = (ptrdiff_t)bands;
    v->stride[2] = 1;
  }
  v->stride[0] = 0;
}

/* The light of column m is that of patch first + m, or none if there is no such patch. */
static void set_units(hr2d_operator *op, size_t first, size_t end) {
  hr2d_scene *relit = op->kept->relit;
  const size_t own = op->scene->bands;
  for (size_t k = 0; k < hr2di_scene_cell(relit); k++) {
    double *emission = hr2di_relit_emission(relit, k);
    for (size_t b = 0; b < relit->bands; b++)
      emission[b] = first + b / own == k && k < end ? 1 : 0;
  }
  for (size_t b = 0; b < relit->bands; b++) {
    relit->background[b] = 0;
    if (relit->sun) relit->sun[b].irradiance = 0;
    for (size_t k = 0; k < hr2di_sky_rows(&relit->sky); k++)
      relit->sky.value[k * relit->bands + b] = 0;
  }
}

static void put(const hr2d_solution *solution, size_t bands, size_t from, size_t columns,
                double *response) {
  const hr2d_scene *scene = solution->hierarchy->scene;
  for (size_t k = 0; k < hr2di_scene_cell(scene); k++)
    for (size_t m = from; m < columns && m < from + AT_ONCE; m++)
      for (size_t b = 0; b < bands; b++)
        response[(k * columns + m) * bands + b] =
            hr2d_solution_average(solution, k, (m - from) * bands + b);
}

static hr2d_status respond(hr2d_operator *op, const hr2d_light *light, size_t first,
                           size_t columns, double *response) {
  hr2d_status status = hr2di_operator_relight(op, light);
  for (size_t from = 0; from < columns && !status; from += AT_ONCE) {
    hr2d_solution *solution = NULL;
    set_units(op, first + from, first + columns);
    status = hr2di_operator_begin(op);
    op->eq.enough = (hr2di_stopping_test){0};
    if (!status) status = hr2di_solve_again(&op->eq, NULL, &solution);
    if (!status) put(solution, op->scene->bands, from, columns, response);
    hr2d_solution_destroy(solution);
  }
  return status;
}

hr2d_status hr2d_operator_response(hr2d_operator *op, const hr2d_light *given, size_t first,
                                   size_t columns, double *response) {
  hr2d_light light;
  if (!op || !response) return HR2D_EINVAL;
  const size_t patches = hr2di_scene_cell(op->scene);
  hr2d_status status = hr2di_operator_enter(op);
  if (status) return status;
  status = hr2di_operator_light_of(op, given, &light);
  if (!status && (light.count > 1 || first > patches || columns > patches - first))
    status = hr2di_message_fail(&op->message, HR2D_EINVAL,
                                "columns are those of patches, and the light is one");
  if (status) return hr2di_operator_end(op, status);
  hr2d_light all = HR2D_LIGHT_INIT;
  all.count = AT_ONCE;
  all.reflectance = light.reflectance;
  repeat(&all.reflectance, op->scene->bands);
  status = respond(op, &all, first, columns, response);
  return hr2di_operator_end(op, status);
}
