/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix of gases of given heat has ∫m_k + Σ_l g_kl on its diagonal and −g_kl beside it: it
   is symmetric, and each row sums up to what leaves these gases.  Elimination needs no pivots,
   and adds only numbers of one sign to its inverse. */
#include "solve/gas-heat.h"

#include <string.h>

#include "base/alloc.h"
#include "base/neumaier-sum.h"
#include "scene/scene-impl.h"
#include "solve/gas-light.h"

/* The exchange areas of E_g between gases, summed over all links. */
static hr2d_status set_exchange(hr2di_transport *t) {
  const hr2di_link_blocks *b = &t->blocks;
  const size_t gases = b->gases, stride = hr2di_link_blocks_lost(b);
  if (!gases) return HR2D_OK;
  t->gas_exchange = hr2di_alloc_zero(&t->alloc, gases * gases, sizeof *t->gas_exchange);
  if (!t->gas_exchange) return HR2D_ENOMEM;
  for (uint64_t k = 0; k < b->links; k++) {
    const double *pair = b->lost + k * stride + 2 * (1 + gases) * b->lost_order;
    if (hr2di_watch_work(t->watch, 1 + gases * gases / 8)) break;
    for (size_t high = 1; high < gases; high++)
      for (size_t low = 0; low < high; low++) t->gas_exchange[high * gases + low] += *pair++;
  }
  for (size_t high = 1; high < gases; high++)
    for (size_t low = 0; low < high; low++)
      t->gas_exchange[low * gases + high] = t->gas_exchange[high * gases + low];
  return hr2di_transport_status(t);
}

static double exchange(const hr2di_transport *t, size_t gas, size_t other) {
  return t->gas_exchange ? t->gas_exchange[gas * t->scene->gases.count + other] : 0;
}

/* ∫m of a gas. */
static double all_of(const hr2di_transport *t, size_t gas) {
  const double *m = t->gas_of ? t->gas_of + gas * t->leaves * t->gas_order : t->gas;
  hr2di_sum all = {0, 0};
  for (size_t k = 0; k < t->leaves; k++)
    hr2di_sum_add(&all, hr2di_gas_light_area(t, k) * m[k * t->order]);
  return hr2di_sum_total(&all);
}

/* The matrix; rows and columns of other gases are those of 1. */
static void set_matrix(hr2di_transport *t) {
  const size_t gases = t->scene->gases.count;
  for (size_t k = 0; k < gases; k++) {
    double *row = t->gas_return + k * gases;
    const int free = hr2di_scene_gas_is_free(t->scene, k);
    row[k] = free ? all_of(t, k) : 1;
    for (size_t l = 0; l < gases && free; l++) {
      row[k] += l == k ? 0 : exchange(t, k, l);
      if (l != k && hr2di_scene_gas_is_free(t->scene, l)) row[l] = -exchange(t, k, l);
    }
  }
}

/* Gauss–Jordan, in place; returns the first gas without a pivot, or the number of gases. */
static size_t invert(double *a, size_t n) {
  for (size_t k = 0; k < n; k++) {
    const double pivot = a[k * n + k];
    if (!(pivot > 0)) return k;
    a[k * n + k] = 1;
    for (size_t l = 0; l < n; l++) a[k * n + l] /= pivot;
    for (size_t m = 0; m < n; m++) {
      const double factor = a[m * n + k];
      if (m == k || factor == 0) continue;
      a[m * n + k] = 0;
      for (size_t l = 0; l < n; l++) a[m * n + l] -= factor * a[k * n + l];
    }
  }
  return n;
}

/* The part of what a gas of given heat takes that ends in gases of given E_g. */
static double kept_by(const hr2di_transport *t, size_t gas) {
  const size_t gases = t->scene->gases.count;
  double part = 0;
  for (size_t k = 0; k < gases; k++)
    for (size_t l = 0; l < gases && hr2di_scene_gas_is_free(t->scene, k); l++)
      if (!hr2di_scene_gas_is_free(t->scene, l))
        part += t->gas_return[gas * gases + k] * exchange(t, k, l);
  return part;
}

static int all_are_free(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->gases.count; k++)
    if (!hr2di_scene_gas_is_free(scene, k) && hr2di_scene_scaled_absorption(scene, k) > 0)
      return 0;
  return 1;
}

static hr2d_status set_kept(hr2di_transport *t) {
  const size_t count = t->leaves * t->gas_order;
  if (all_are_free(t->scene)) return HR2D_OK;
  t->gas_kept = hr2di_alloc_zero(&t->alloc, count, sizeof *t->gas_kept);
  if (!t->gas_kept) return HR2D_ENOMEM;
  for (size_t k = 0; k < t->scene->gases.count; k++) {
    const double part = hr2di_scene_gas_is_free(t->scene, k) ? kept_by(t, k) : 1;
    for (size_t m = 0; m < count; m++) t->gas_kept[m] += part * t->gas_of[k * count + m];
  }
  return hr2di_watch_work(t->watch, count);
}

hr2d_status hr2di_gas_heat_set(hr2di_transport *t, hr2di_message *message) {
  const size_t gases = t->scene->gases.count;
  const hr2d_status status = set_exchange(t);
  if (status || !hr2di_scene_has_free_gas(t->scene)) return status;
  t->gas_return = hr2di_alloc_zero(&t->alloc, gases + 1, gases * sizeof *t->gas_return);
  if (!t->gas_return) return HR2D_ENOMEM;
  set_matrix(t);
  const size_t bad = invert(t->gas_return, gases);
  if (bad < gases)
    return hr2di_message_fail(message, HR2D_ENO_SOLUTION,
                              "gas %zu: its heat is given, and no line between patches passes "
                              "through it: nothing tells how hot it is",
                              bad);
  return set_kept(t);
}
