/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All kinds, and shapes that they share. */
#include "adversary/kinds.h"

#include <math.h>

#define PI 3.14159265358979323846

static const adv_kind *const tables[] = {adv_rooms, adv_extreme,  adv_open,
                                         adv_day,   adv_symmetry, adv_gases};

const adv_kind *adv_kind_at(size_t k) {
  for (size_t t = 0; t < sizeof tables / sizeof *tables; t++)
    for (const adv_kind *kind = tables[t]; kind->name; kind++)
      if (!k--) return kind;
  return NULL;
}

size_t adv_kinds(void) {
  size_t k = 0;
  while (adv_kind_at(k)) k++;
  return k;
}

/* Random places can cross or overlap; the library says so, and another scene is drawn. */
int adv_draw(const adv_kind *kind, adv_random *r, adv_scene *scene) {
  for (int refused = 0;; refused++) {
    hr2d_scene *built = NULL;
    adv_clear(scene, -16);
    kind->make(scene, r);
    adv_call_original(scene);
    hr2d_status status = adv_build(scene, &built);
    hr2d_scene_destroy(built);
    if (!status || refused == 100) return refused;
  }
}

void adv_room(adv_scene *scene, adv_random *r, double *w, double *h) {
  *w = adv_int(r, 8, 24) / 4.0;
  *h = adv_int(r, 8, 16) / 4.0;
  adv_box(scene, 0, 0, *w, *h);
  scene->closed = 1;
}

void adv_convex(adv_scene *scene, adv_random *r, int corners, double radius, int out) {
  double corner[64][2], start = adv_real(r, 0, 2 * PI);
  for (int k = 0; k < corners; k++) {
    double angle = start + 2 * PI * (k + adv_real(r, 0, 0.7)) / corners;
    int at = out ? corners - 1 - k : k;
    corner[at][0] = radius * cos(angle);
    corner[at][1] = radius * sin(angle);
  }
  adv_ring(scene, (const double(*)[2])corner, (size_t)corners);
  scene->closed = 1;
}

void adv_screens(adv_scene *scene, adv_random *r, int count, const double box[4],
                 double shortest, double longest) {
  for (int tries = 0; count > 0 && tries < 200; tries++) {
    double x = adv_real(r, box[0], box[2]), y = adv_real(r, box[1], box[3]);
    double angle = adv_chance(r, 0.3) ? PI / 2 * adv_int(r, 0, 3) : adv_real(r, 0, 2 * PI);
    double length = adv_real(r, shortest, longest);
    double u = x + length * cos(angle), v = y + length * sin(angle);
    if (u < box[0] || u > box[2] || v < box[1] || v > box[3]) continue;
    if (!adv_free(scene, x, y, u, v)) continue;
    adv_screen(scene, x, y, u, v);
    count--;
  }
}
