/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve/reduced-equation.h"

#include <string.h>

#include "base/alloc.h"
#include "solve/leading-blocks.h"
#include "solve/shared-gather.h"

void hr2di_equation_part_take(const hr2di_equation *part, const hr2di_equation *whole,
                              const double *from, double *to) {
  const size_t width = part->transport.width, step = whole->transport.width;
  for (size_t k = 0; k < part->transport.leaves; k++)
    memcpy(to + k * width, from + k * step, width * sizeof *to);
}

void hr2di_equation_part_give(const hr2di_equation *part, const hr2di_equation *whole,
                              const double *from, double *to) {
  const size_t width = part->transport.width, step = whole->transport.width;
  for (size_t k = 0; k < part->transport.leaves; k++)
    memcpy(to + k * step, from + k * width, width * sizeof *to);
}

/* The first `order` entries of rows of `all`, of each of `count` rows. */
static double *first_of(const hr2d_allocator *alloc, const double *from, size_t count,
                        size_t all, size_t order) {
  double *to = hr2di_alloc(alloc, count, order * sizeof *to);
  for (size_t k = 0; k < count && to; k++)
    memcpy(to + k * order, from + k * all, order * sizeof *to);
  return to;
}

static hr2d_status set_transport(hr2di_transport *t, const hr2di_transport *of, size_t order) {
  *t = *of;
  t->order = order;
  t->width = order * t->bands;
  t->by_blocks = order > 1 || t->gas;
  t->sweeps = 0;
  t->trees = (hr2di_push_pull){0};
  t->shared = NULL;
  t->up = t->down = t->closure = t->sky = t->mean = t->leading = NULL;
  hr2d_status status =
      hr2di_push_pull_init(&t->trees, t->hierarchy, &t->alloc, order, t->bands, t->watch);
  t->up = hr2di_alloc(&t->alloc, t->elements, t->width * sizeof *t->up);
  t->down = hr2di_alloc(&t->alloc, t->elements * t->slices, t->width * sizeof *t->down);
  if (!status && of->closure) {
    void *closure = NULL;
    status = hr2di_leading_blocks(&closure, of->closure, sizeof *t->closure, t->leaves,
                                  of->order, order, &t->alloc, t->threads, t->watch);
    t->closure = closure;
  }
  if (!status) status = hr2di_transport_lead(t, &of->blocks);
  if (!status && of->shared && hr2di_shared_gather_init(t)) status = HR2D_ENOMEM;
  return t->up && t->down ? status : HR2D_ENOMEM;
}

hr2d_status hr2di_equation_part(hr2di_equation *part, const hr2di_equation *whole,
                                size_t order) {
  hr2di_transport *t = &part->transport;
  *part = (hr2di_equation){.links = whole->links,
                           .options = whole->options,
                           .balance = whole->balance,
                           .exponent = whole->exponent};
  part->balance.missing = NULL;
  hr2d_status status = set_transport(t, &whole->transport, order);
  if (!status && part->balance.count > 0) {
    part->balance.missing =
        first_of(&t->alloc, whole->balance.missing, t->leaves, whole->transport.order, order);
    status = part->balance.missing ? HR2D_OK : HR2D_ENOMEM;
  }
  if (!status) status = hr2di_equation_reserve(part);
  if (!status) status = hr2di_equation_set_surfaces(part);
  return status ? status : hr2di_watch_work(t->watch, t->leaves * t->width / 4);
}

void hr2di_equation_part_clear(hr2di_equation *part) {
  hr2di_transport *t = &part->transport;
  hr2di_shared_gather_clear(t);
  hr2di_push_pull_clear(&t->trees);
  hr2di_alloc_free(&t->alloc, part->balance.missing);
  hr2di_alloc_free(&t->alloc, t->up);
  hr2di_alloc_free(&t->alloc, t->down);
  hr2di_alloc_free(&t->alloc, t->closure);
  hr2di_alloc_free(&t->alloc, t->leading);
  hr2di_scattering_clear(&part->panes, &t->alloc);
  hr2di_alloc_free(&t->alloc, part->space);
}
