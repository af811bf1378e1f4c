/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pair sees each other freely if its exchange area is that without walls, bit for bit; if
   what is in the way hides less than a rounding of it, that is in the margins.

   The exchange area is half a difference of lengths of strings.  The two strings that bound a
   class of lines move with its ends: ends that are off by d change a length by 2d at most. */
#include "enclosure/enclosure-links.h"

#include <math.h>

#include "geometry/predicates.h"

/* The error of exchange areas: geometry.h, visibility.h with an extent below 4. */
#define FREE 4e-15
#define PAST 0x1p-44

static hr2di_enclosed enclosed_of(const hr2d_hierarchy *h, uint32_t at) {
  const hr2d_element *e = &h->element[at], *patch = &h->element[e->patch];
  hr2di_enclosed made;
  hr2di_enclosed_init(&made, (hr2d_segment){e->a, e->b}, (hr2d_segment){patch->a, patch->b},
                      h->level[at]);
  return made;
}

/* Whether an element is an image that runs the other way. */
static int is_turned(const hr2d_hierarchy *h, uint32_t at) {
  const hr2di_symmetry *s = &h->scene->symmetry;
  const size_t motion = s->motion ? h->element[at].patch / s->cell : 0;
  return s->motion && motion < s->motions && s->motion[motion].turned;
}

static hr2di_strip turned(hr2di_strip s) {
  return (hr2di_strip){{s.at[1], s.at[0]}};
}

/* Where something is in the way, any part of it may be. */
static hr2di_strip weighed(hr2di_strip s, double weight, int is_free) {
  if (!is_free) {
    const hr2di_range any = {0, weight * fmax(s.at[0].upper, s.at[1].upper)};
    return (hr2di_strip){{any, any}};
  }
  for (int k = 0; k < 2; k++) {
    s.at[k].lower *= weight;
    s.at[k].upper *= weight;
  }
  return s;
}

static void make(const hr2d_linkset *links, const hr2d_link *link, hr2di_enclosed_link *out) {
  const hr2d_hierarchy *h = links->hierarchy;
  const hr2di_enclosed i = enclosed_of(h, link->pair.first);
  const hr2di_enclosed j = enclosed_of(h, link->pair.second);
  const double weight = hr2di_linkset_weight(links, link->pair);
  const double area = ldexp(link->exchange_area, -h->scene->exponent);
  const int is_free = area == weight * hr2d_exchange_area(&i.part, &j.part);
  const double off = (is_free ? FREE * area : PAST) + 8 * (i.off + j.off);
  out->factor[0] = weighed(hr2di_factor_strip(&i, &j), weight, is_free);
  out->factor[1] = weighed(hr2di_factor_strip(&j, &i), weight, is_free);
  if (is_turned(h, link->pair.first)) out->factor[0] = turned(out->factor[0]);
  if (is_turned(h, link->pair.second)) out->factor[1] = turned(out->factor[1]);
  out->area = (hr2di_range){fmax(0, area - off), area + off};
  out->spread = is_free ? weight * hr2di_kernel_spread(&i, &j) : INFINITY;
}

void hr2di_enclosed_links_make(const hr2d_linkset *links, const uint32_t *original,
                               uint64_t first, size_t count, hr2di_enclosed_link *out) {
  for (size_t k = 0; k < count; k++) {
    const hr2d_link link = hr2d_linkset_get(links, first + k);
    make(links, &link, &out[k]);
    out[k].of[0] = original ? original[link.pair.first] : link.pair.first;
    out[k].of[1] = original ? original[link.pair.second] : link.pair.second;
  }
}
