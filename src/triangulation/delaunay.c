/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inserts points one by one: walks to the triangle, splits it, flips (Lawson 1977).

   The order is that of Amenta, Choi and Rote (2003): rounds of random points, each of eight
   times as many as those before, and along the Hilbert curve within a round.  It is as fast as
   the curve alone, and no order of the input makes it quadratic. */
#include "triangulation/delaunay.h"

#include "base/alloc.h"
#include "geometry/orient-sign.h"
#include "triangulation/in-circle.h"

/* An insertion in units of the watch. */
enum { INSERTION = 12 };

static uint64_t scatter(uint64_t k) {
  k = (k ^ k >> 31) * UINT64_C(0xbf58476d1ce4e5b9);
  k = (k ^ k >> 27) * UINT64_C(0x94d049bb133111eb);
  return k ^ k >> 31;
}

/* The round of vertex k, counted from the last: each three bits 0 are one round earlier. */
static int round_of(size_t k, int rounds) {
  uint64_t bits = scatter(k + 1);
  int round = 0;
  for (; round + 1 < rounds && (bits & 7) == 0; bits >>= 3) round++;
  return round;
}

/* The triangle or the edge in which p lies. */
typedef struct place {
  int32_t h;
  int on_edge; /* p lies on h, else in its triangle */
} place;

typedef struct walk {
  uint64_t random;
  int32_t triangle; /* where it begins */
} walk;

/* The edge of the triangle of `from` through which the walk goes on, or -1 if p is not outside;
   then *on is an edge that p lies on, or -1.  Edges are tried from a random one on, or walks
   might go round in circles where circles are in doubt. */
static int32_t way_out(const hr2di_mesh *m, int32_t t, int32_t from, uint64_t *random,
                       hr2d_point p, int32_t *on) {
  *random = *random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  int k = (int)((*random >> 33) % 3);
  *on = -1;
  for (int turn = 0; turn < 3; turn++, k = hr2di_corner_after(k)) {
    const int32_t h = 4 * t + k;
    if (h == from) continue;
    const int side =
        hr2di_orient_sign(m->at[hr2di_mesh_from(m, h)], m->at[hr2di_mesh_to(m, h)], p);
    if (side < 0) return h;
    if (side == 0) *on = h;
  }
  return -1;
}

static hr2d_status locate(const hr2di_mesh *m, walk *w, hr2d_point p, place *found) {
  int32_t t = w->triangle, from = -1, on;
  for (;;) {
    const int32_t out = way_out(m, t, from, &w->random, p, &on);
    if (out < 0) break;
    from = hr2di_mesh_across(m, out);
    t = from >> 2;
    if (hr2di_watch_work(m->watch, 1)) return hr2di_watch_status(m->watch);
  }
  *found = (place){on < 0 ? 4 * t : on, on >= 0};
  return HR2D_OK;
}

/* Flips edges opposite to corner 2 of triangle t, and of those around it, while the circle says
   so.  A flip gives the corner one more triangle, which comes next in the turn. */
static hr2d_status flip_around(hr2di_mesh *m, int32_t t) {
  const int32_t start = t;
  for (;;) {
    const hr2di_triangle *here = &m->triangle[t];
    const int32_t back = here->across[0];
    if (back >= 0 && hr2di_in_circle(m->at[here->corner[0]], m->at[here->corner[1]],
                                     m->at[here->corner[2]], m->at[hr2di_mesh_apex(m, back)])) {
      if (hr2di_watch_work(m->watch, 1)) return hr2di_watch_status(m->watch);
      hr2di_mesh_flip(m, 4 * t);
      continue;
    }
    t = here->across[1] >> 2;
    if (t == start) return HR2D_OK;
  }
}

static hr2d_status insert(hr2di_mesh *m, walk *w, uint32_t v) {
  place found = {0};
  hr2d_status status = hr2di_watch_work(m->watch, INSERTION);
  if (!status) status = locate(m, w, m->at[v], &found);
  if (status) return status;
  w->triangle = found.h >> 2;
  if (found.on_edge)
    hr2di_mesh_split_edge(m, found.h, v);
  else
    hr2di_mesh_split(m, w->triangle, v);
  return flip_around(m, w->triangle);
}

hr2d_status hr2di_delaunay_init(hr2di_mesh *m) {
  const size_t points = m->vertices - 4, max = 2 * points + 2;
  m->triangle = hr2di_alloc(m->alloc, max, sizeof *m->triangle);
  if (!m->triangle) return HR2D_ENOMEM;
  walk w = {.random = 1};
  hr2d_status status = hr2di_mesh_start(m);
  int rounds = 1;
  for (size_t n = points; n > 64; n /= 8) rounds++;
  for (int round = rounds; round-- > 0 && !status;)
    for (size_t k = 0; k < points && !status; k++) {
      if (k % 256 == 0) status = hr2di_watch_work(m->watch, 16);
      if (!status && round_of(k, rounds) == round) status = insert(m, &w, (uint32_t)k);
    }
  return status;
}
