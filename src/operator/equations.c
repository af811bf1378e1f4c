/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equation of an operator's solutions, for one light or several. */
#include "operator/operator-impl.h"

void hr2di_operator_clear_equations(hr2d_operator *op) {
  if (op->is_made) hr2di_equation_clear(&op->eq);
  if (op->has_finer) hr2di_finer_clear(&op->finer);
  op->is_made = op->has_finer = 0;
}

/* With blocks of the finer one, which is made when an account is asked for: it shares them. */
hr2d_status hr2di_operator_make_equation(hr2d_operator *op) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  options.threads = op->target.threads;
  options.tolerance = op->fineness.tolerance;
  options.progress = op->target.progress;
  options.progress_ctx = op->target.progress_ctx;
  const hr2di_equation_how how = {
      .block_order = op->target.no_error ? 0 : hr2di_resolution_finer(&op->fineness).order,
      .single = op->fineness.single};
  op->is_made = 1;
  return hr2di_equation_init(&op->eq, op->kept->links, op->kept->relit, &how, &options);
}

hr2d_status hr2di_operator_resize(hr2d_operator *op, size_t count) {
  hr2d_scene *made = NULL, *relit = op->kept->relit;
  if (op->count == count) return HR2D_OK;
  hr2d_status status = hr2di_relit_create(op->scene, count, &made);
  if (status) return status;
  const hr2d_scene old = *relit;
  *relit = *made; /* trees and links have its address */
  *made = old;
  hr2di_relit_destroy(made);
  hr2di_operator_clear_equations(op);
  op->count = 0;
  status = hr2di_operator_make_equation(op);
  if (status)
    hr2di_operator_clear_equations(op);
  else
    op->count = count;
  return status;
}

void hr2di_operator_watch(const hr2d_operator *op, hr2di_equation *eq) {
  hr2di_scene_watch(op->scene, &eq->watch, op->target.progress, op->target.progress_ctx,
                    "solve");
  eq->watch.report.elements = op->base.elements;
  eq->watch.report.links = op->base.links;
  eq->transport.failed = HR2D_OK;
}

hr2d_status hr2di_operator_begin(hr2d_operator *op) {
  hr2di_operator_watch(op, &op->eq);
  return hr2di_equation_set_light(&op->eq);
}
