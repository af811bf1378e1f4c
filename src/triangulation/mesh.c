/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The changes of a mesh that keep it a triangulation of the box. */
#include "triangulation/mesh.h"

#include "base/alloc.h"

void hr2di_mesh_set(hr2di_mesh *m, int32_t t, uint32_t a, uint32_t b, uint32_t c) {
  m->triangle[t] = (hr2di_triangle){{a, b, c}, {HR2DI_SKY, HR2DI_SKY, HR2DI_SKY}};
  if (!m->out) return;
  m->out[a] = 4 * t;
  m->out[b] = 4 * t + 1;
  m->out[c] = 4 * t + 2;
}

/* The box is three times as large as the scene, so that no rounding brings its border near. */
hr2d_status hr2di_mesh_start(hr2di_mesh *m) {
  hr2d_point low = m->at[0], high = m->at[0];
  const size_t first = m->vertices - 4;
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < first && !status; k++) {
    status = hr2di_mesh_poll(m, k);
    low = (hr2d_point){fmin(low.x, m->at[k].x), fmin(low.y, m->at[k].y)};
    high = (hr2d_point){fmax(high.x, m->at[k].x), fmax(high.y, m->at[k].y)};
  }
  const double extent = fmax(high.x - low.x, high.y - low.y);
  const double largest = fmax(fmax(fabs(low.x), fabs(low.y)), fmax(fabs(high.x), fabs(high.y)));
  const double wide = fmax(fmax(extent, 0x1p-40 * largest), 0x1p-500);
  m->at[first] = (hr2d_point){low.x - wide, low.y - wide};
  m->at[first + 1] = (hr2d_point){high.x + wide, low.y - wide};
  m->at[first + 2] = (hr2d_point){high.x + wide, high.y + wide};
  m->at[first + 3] = (hr2d_point){low.x - wide, high.y + wide};
  const uint32_t c = (uint32_t)first;
  hr2di_mesh_set(m, 0, c, c + 1, c + 2);
  hr2di_mesh_set(m, 1, c + 2, c + 3, c);
  hr2di_mesh_hook(m, 2, 6);
  m->triangles = 2;
  return status;
}

/* A ring of `count` edges around v, each with what is behind it, becomes as many triangles. */
typedef struct ring {
  uint32_t corner[4];
  int32_t across[4], triangle[4];
  int count;
} ring;

static void make_fan(hr2di_mesh *m, const ring *r, uint32_t v) {
  for (int k = 0; k < r->count; k++) {
    hr2di_mesh_set(m, r->triangle[k], r->corner[k], r->corner[(k + 1) % r->count], v);
    hr2di_mesh_hook(m, 4 * r->triangle[k], r->across[k]);
  }
  for (int k = 0; k < r->count; k++)
    hr2di_mesh_hook(m, 4 * r->triangle[k] + 1, 4 * r->triangle[(k + 1) % r->count] + 2);
}

void hr2di_mesh_split(hr2di_mesh *m, int32_t t, uint32_t v) {
  const hr2di_triangle old = m->triangle[t];
  const int32_t made = (int32_t)m->triangles;
  m->triangles += 2;
  const ring r = {.corner = {old.corner[0], old.corner[1], old.corner[2]},
                  .across = {old.across[0], old.across[1], old.across[2]},
                  .triangle = {t, made, made + 1},
                  .count = 3};
  make_fan(m, &r, v);
}

void hr2di_mesh_split_edge(hr2di_mesh *m, int32_t h, uint32_t v) {
  const int32_t back = hr2di_mesh_across(m, h), made = (int32_t)m->triangles;
  const int32_t side[4] = {hr2di_mesh_next(h), hr2di_mesh_before(h), hr2di_mesh_next(back),
                           hr2di_mesh_before(back)};
  ring r = {.triangle = {h >> 2, made, back >> 2, made + 1}, .count = 4};
  m->triangles += 2;
  for (int k = 0; k < 4; k++) {
    r.corner[k] = hr2di_mesh_from(m, side[k]);
    r.across[k] = hr2di_mesh_across(m, side[k]);
  }
  make_fan(m, &r, v);
}

void hr2di_mesh_flip(hr2di_mesh *m, int32_t h) {
  const int32_t back = hr2di_mesh_across(m, h), t = h >> 2, s = back >> 2;
  const uint32_t a = hr2di_mesh_from(m, h), b = hr2di_mesh_to(m, h);
  const uint32_t c = hr2di_mesh_apex(m, h), d = hr2di_mesh_apex(m, back);
  const int32_t bc = hr2di_mesh_across(m, hr2di_mesh_next(h)),
                ca = hr2di_mesh_across(m, hr2di_mesh_before(h)),
                ad = hr2di_mesh_across(m, hr2di_mesh_next(back)),
                db = hr2di_mesh_across(m, hr2di_mesh_before(back));
  hr2di_mesh_set(m, t, a, d, c);
  hr2di_mesh_set(m, s, d, b, c);
  hr2di_mesh_hook(m, 4 * t, ad);
  hr2di_mesh_hook(m, 4 * t + 2, ca);
  hr2di_mesh_hook(m, 4 * s, db);
  hr2di_mesh_hook(m, 4 * s + 1, bc);
  hr2di_mesh_hook(m, 4 * t + 1, 4 * s + 2);
}

hr2d_status hr2di_mesh_find_out(hr2di_mesh *m) {
  m->out = hr2di_alloc(m->alloc, m->vertices, sizeof *m->out);
  hr2d_status status = m->out ? HR2D_OK : HR2D_ENOMEM;
  for (size_t t = 0; t < m->triangles && !status; t++) {
    status = hr2di_mesh_poll(m, t);
    for (int k = 0; k < 3; k++) m->out[m->triangle[t].corner[k]] = (int32_t)(4 * t) + k;
  }
  return status;
}
