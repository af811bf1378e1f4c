/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each block came with the part of its light that is absorbed on the way, ∫∫ G V D φ_l, which
   has its own digits however thin the gas is: m is their sum.  On open patches m has the part
   of directions without a patch as well: 1 − σ with exact row sums at order 1, so that coarse
   links make nothing negative; above, 1 − K1 together with the sum. */
#include "solve/gas-rows.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/neumaier-sum.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "scene/with-plane.h"
#include "solve/closure.h"
#include "solve/gas-heat.h"
#include "solve/gas-light.h"
#include "solve/row-sums.h"
#include "visibility/back-visibility.h"

/* Adds what is absorbed on the way between clusters, whose patches are the first elements. */
static hr2d_status add_clusters(hr2di_transport *t) {
  const hr2d_scene *scene = t->hierarchy->scene;
  const hr2di_cluster_gather how = {.order = t->order,
                                    .bands = 1,
                                    .gas = hr2di_cluster_gas_of(scene, 1),
                                    .threads = t->threads,
                                    .watch = t->watch};
  if (!t->roots->clusters) return HR2D_OK;
  double *unit = hr2di_alloc_zero(&t->alloc, scene->patches * t->order, sizeof *unit);
  if (!unit) return HR2D_ENOMEM;
  for (size_t k = 0; k < scene->patches; k++) unit[k * t->order] = 1;
  const hr2d_status status = hr2di_clusters_gather(t->roots->clusters, &how, unit, t->down);
  hr2di_alloc_free(&t->alloc, unit);
  return status;
}

/* Sums numbers of links into t->down: on elements of i those at `on_i` of what a link loses to
   gas, on those of j those at `on_j`. */
static hr2d_status sum_links(hr2di_transport *t, size_t on_i, size_t on_j) {
  const hr2d_linkset *links = t->links;
  const size_t order = t->order, stride = hr2di_link_blocks_lost(&t->blocks);
  for (uint64_t k = 0; k < links->store.count; k++) {
    if (k % 64 == 0 && hr2di_watch_work(t->watch, 1 + 8 * order)) break;
    const hr2d_pair pair = hr2di_store_link(&links->store, k).pair;
    const double *lost = t->blocks.lost + k * stride;
    for (size_t l = 0; l < order; l++) t->down[pair.first * order + l] += lost[on_i + l];
    for (size_t l = 0; l < order && !links->directed; l++)
      t->down[pair.second * order + l] += lost[on_j + l];
  }
  hr2di_image_map_fold(&t->image_map, order, 1, t->down);
  for (size_t e = 0; e < t->elements; e++)
    for (size_t l = 0; l < order; l++)
      t->down[e * order + l] /= t->hierarchy->element[e].length;
  return hr2di_transport_status(t);
}

static void clear_down(hr2di_transport *t) {
  memset(t->down, 0, t->elements * t->order * sizeof *t->down);
}

/* What all gas takes, one link after the other. */
static hr2d_status sum_all(hr2di_transport *t) {
  clear_down(t);
  const hr2d_status status = add_clusters(t);
  return status ? status : sum_links(t, 0, t->blocks.lost_order);
}

/* Sets what each gas takes, where there are borders, in the way the whole of it was lowered. */
static hr2d_status set_parts(hr2di_transport *t) {
  const size_t gases = t->blocks.gases, order = t->blocks.lost_order;
  hr2d_status status = HR2D_OK;
  if (!gases) return HR2D_OK;
  t->gas_of = hr2di_alloc_zero(&t->alloc, gases * t->leaves, t->order * sizeof *t->gas_of);
  if (!t->gas_of) return HR2D_ENOMEM;
  for (size_t k = 0; k < gases && !status; k++) {
    clear_down(t);
    status = sum_links(t, (2 + k) * order, (2 + gases + k) * order);
    if (!status) hr2di_transport_lower(t, t->gas_of + k * t->leaves * t->order);
  }
  return status;
}

/* m = 1 − K1 on leaves of open patches, at an order above 1. */
static void take_rows(hr2di_transport *t) {
  for (size_t k = 0; k < t->leaves; k++) {
    if (t->closed[t->hierarchy->element[t->leaf[k]].patch]) continue;
    for (size_t l = 0; l < t->order; l++)
      t->gas[k * t->order + l] = (l == 0) - t->rows[k * t->order + l];
  }
}

static hr2d_status check_backs(hr2di_transport *t, const unsigned char *closed,
                               hr2di_message *message) {
  unsigned char *sees = NULL;
  const hr2d_scene *scene = t->hierarchy->scene;
  hr2di_with_plane with;
  hr2d_status status = hr2di_with_plane_init(&with, scene, &t->alloc, t->watch);
  if (!status)
    status = hr2di_back_visibility(&with.scene, &t->alloc, t->threads, &sees, t->watch);
  hr2di_with_plane_clear(&with);
  for (size_t k = 0; k < scene->patches && sees && !status; k++)
    if (sees[k] && !closed[k])
      status = hr2di_message_fail(message, HR2D_EUNSUPPORTED,
                                  "%s may see the back of a patch, which in a scene with gas "
                                  "this version does not do: give it both sides",
                                  hr2di_patch_label(scene, k).text);
  hr2di_alloc_free(&t->alloc, sees);
  return status;
}

/* Gas of given heat needs all of its light: what leaves the scene would heat gas outside.  And
   outside of a scene with borders there is nobody to say which gas there is. */
static hr2d_status take_heat(hr2di_transport *t, int all_closed, hr2di_message *message) {
  const hr2d_scene *scene = t->hierarchy->scene;
  if (!all_closed && t->blocks.gases)
    return hr2di_message_fail(message, HR2D_EUNSUPPORTED,
                              "a gas has a border, and the scene is open: draw black walls "
                              "around it, of reflectance 0, without emission if nothing comes "
                              "from there");
  if (!all_closed && hr2di_scene_has_free_gas(scene))
    return hr2di_message_fail(message, HR2D_EUNSUPPORTED,
                              "the heat of the gas is given, and the scene is open: light that "
                              "leaves it would heat gas without end");
  const hr2d_status status = set_parts(t);
  return status ? status : hr2di_gas_heat_set(t, message);
}

/* From here on the way is that of closure without gas. */
static hr2d_status close_order_1(hr2di_transport *t, int closed, uint64_t *leaves,
                                 hr2di_message *message) {
  double *absorbed = hr2di_alloc(&t->alloc, t->elements, sizeof *absorbed);
  hr2di_row_sums rows;
  if (!absorbed) return HR2D_ENOMEM;
  memcpy(absorbed, t->down, t->elements * sizeof *absorbed);
  hr2d_status status = hr2di_row_sums_init(&rows, t, 0);
  *leaves = rows.leaves;
  const int all_closed = !status && !memchr(rows.closed, 0, t->hierarchy->scene->patches);
  if (!status && !all_closed) status = check_backs(t, rows.closed, message);
  if (!status && closed) status = hr2di_closure_set(t, &rows, absorbed);
  memcpy(t->down, absorbed, t->elements * sizeof *absorbed);
  if (!status) hr2di_transport_lower(t, t->gas);
  for (size_t k = 0; k < t->leaves && !status; k++) {
    if (closed) t->closure[k] -= t->gas[k];
    t->gas[k] += fmax(0, 1 - rows.front[t->leaf[k]]);
  }
  hr2di_row_sums_clear(&rows);
  hr2di_alloc_free(&t->alloc, absorbed);
  return status ? status : take_heat(t, all_closed, message);
}

static hr2d_status close_order_p(hr2di_transport *t, int closed, hr2di_message *message) {
  hr2di_transport_lower(t, t->gas);
  hr2d_status status = hr2di_transport_status(t);
  if (!status) status = hr2di_closure_set_order_p(t);
  if (!status && !t->all_closed) status = check_backs(t, t->closed, message);
  if (!status) status = take_heat(t, t->all_closed, message);
  if (status) return status;
  take_rows(t);
  if (closed) return HR2D_OK;
  hr2di_alloc_free(&t->alloc, t->closure);
  hr2di_alloc_free(&t->alloc, t->closed);
  t->closure = NULL;
  t->closed = NULL;
  t->all_closed = 0;
  return HR2D_OK;
}

hr2d_status hr2di_gas_rows_set(hr2di_transport *t, int closed, uint64_t *leaves,
                               hr2di_message *message) {
  t->gas = hr2di_alloc_zero(&t->alloc, t->leaves * t->order, sizeof *t->gas);
  t->gas_order = t->order;
  if (!t->gas) return HR2D_ENOMEM;
  hr2d_status status = sum_all(t);
  if (status) return status;
  return t->order == 1 ? close_order_1(t, closed, leaves, message)
                       : close_order_p(t, closed, message);
}
