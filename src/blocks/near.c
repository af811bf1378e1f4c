/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of near pairs: Gauss rules on panels that shrink towards near points.

   On a panel that is far enough (panels.h), a rule of q points is accurate to 3.19^−2q, or to
   3.19^−(2q−p) if the integrand has a factor φ_p. */
#include <math.h>
#include <string.h>

#include "blocks/panels.h"

void hr2di_block_add_moments(hr2di_integrator *w, const hr2di_pair_frame *f, double s,
                             hr2di_span part, double *moment) {
  const size_t p = w->order;
  const hr2d_point x = {f->apart.x - s * f->along_i.x, f->apart.y - s * f->along_i.y};
  const double height = 0.5 * f->length_j * hr2di_block_mix(f->above_j, s);
  double phi[HR2D_MAX_ORDER];
  hr2di_panels panels = {.count = 1};
  if (!(part.to > part.from) || !(height > 0)) return;
  panels.stack[0] = part;
  while (panels.count > 0) {
    const hr2di_span panel = panels.stack[--panels.count];
    const double size = panel.to - panel.from, middle = 0.5 * (panel.from + panel.to);
    if (hr2di_panel_near(x, f->along_j, panel) && hr2di_panel_halved(&panels, panel)) continue;
    w->kernels += w->near.points;
    if (hr2di_watch_work(w->watch, 1 + w->near.points * (8 + 2 * p) / 32)) return;
    for (size_t q = 0; q < w->near.points; q++) {
      const double t = middle + 0.5 * size * w->near.at[q];
      const hr2d_point r = hr2di_block_along(x, f->along_j, t);
      const double square = r.x * r.x + r.y * r.y;
      if (!(square > 0)) continue; /* x and y round to one point: the heights are 0, too */
      const double g = size * w->near.weight[q] * height * hr2di_block_mix(f->above_i, t) /
                       (square * sqrt(square));
      hr2di_basis_at(&w->basis, 2 * t - 1, phi);
      for (size_t m = 0; m < p; m++) moment[m] += g * phi[m];
    }
  }
}

static void add_panel(hr2di_integrator *w, const hr2di_pair_frame *f, const hr2di_strip *strip,
                      hr2di_span panel, double *block) {
  const size_t p = w->order;
  const double size = panel.to - panel.from, middle = 0.5 * (panel.from + panel.to);
  double moment[HR2D_MAX_ORDER], phi[HR2D_MAX_ORDER];
  hr2di_span part[HR2DI_PARTS];
  for (size_t q = 0; q < w->near.points; q++) {
    const double s = middle + 0.5 * size * w->near.at[q];
    const size_t parts = strip->seen(strip->ctx, s, part);
    memset(moment, 0, p * sizeof *moment);
    for (size_t k = 0; k < parts; k++) hr2di_block_add_moments(w, f, s, part[k], moment);
    hr2di_basis_at(&w->basis, 2 * s - 1, phi);
    const double weight = f->length_i * size * w->near.weight[q];
    for (size_t l = 0; l < p; l++)
      for (size_t m = 0; m < p; m++) block[l * p + m] += weight * phi[l] * moment[m];
  }
}

static int is_near(const hr2di_pair_frame *f, hr2di_span panel, const hr2di_strip *strip) {
  const hr2d_segment s = {hr2di_block_along(f->i.a, f->along_i, panel.from),
                          hr2di_block_along(f->i.a, f->along_i, panel.to)};
  for (size_t k = 0; k < strip->singulars; k++)
    if (hr2di_ellipse(s, strip->singular[k]) < HR2DI_NEAR_ELLIPSE) return 1;
  return 0;
}

void hr2di_block_add_strip(hr2di_integrator *w, const hr2di_pair_frame *f,
                           const hr2di_strip *strip, double *block) {
  hr2di_panels panels = {.count = 1};
  panels.stack[0] = strip->across;
  while (panels.count > 0) {
    const hr2di_span panel = panels.stack[--panels.count];
    if (hr2di_watch_work(w->watch, 1 + strip->singulars / 8)) return;
    if (is_near(f, panel, strip) && hr2di_panel_halved(&panels, panel)) continue;
    if (panel.to > panel.from) add_panel(w, f, strip, panel, block);
  }
}

/* Every point of i sees the part of j that is in front of i. */
static size_t see_front(const void *ctx, double s, hr2di_span *part) {
  const hr2di_pair_frame *f = ctx;
  (void)s;
  part[0] = f->front_j;
  return 1;
}

void hr2di_block_near(hr2di_integrator *w, const hr2di_pair_frame *f, double *block) {
  const hr2d_point end[] = {hr2di_block_along(f->j.a, f->along_j, f->front_j.from),
                            hr2di_block_along(f->j.a, f->along_j, f->front_j.to)};
  const hr2di_strip strip = {f->front_i, end, 2, see_front, f};
  hr2di_block_add_strip(w, f, &strip, block);
}
