/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels: parts of a segment that shrink towards a near point. */
#ifndef HR2D_SRC_SOLUTION_PANELS_H
#define HR2D_SRC_SOLUTION_PANELS_H

#include "base/bickley.h"
#include "blocks/block.h"
#include "geometry/bernstein-ellipse.h"
#include "scene/band-groups.h"
#include "scene/regions.h"

/* A panel is far enough from a point v at an ellipse of m = 1.75, ρ = 3.19 (see
   geometry/bernstein-ellipse.h). */
#define HR2DI_NEAR_ELLIPSE 1.75

/* A fraction of the element.  G integrates to at most 1, so less than this is lost. */
#define HR2DI_SMALLEST_PANEL 0x1p-46

enum { HR2DI_PANELS = 128 };

/* A part of a segment, in fractions. */
typedef struct hr2di_span {
  double from, to;
} hr2di_span;

/* The panels still to be treated; the next one is last. */
typedef struct hr2di_panels {
  hr2di_span stack[HR2DI_PANELS];
  size_t count;
} hr2di_panels;

/* Pushes the halves of a panel.  Returns 0 if it cannot be halved any more. */
static inline int hr2di_panel_halved(hr2di_panels *panels, hr2di_span panel) {
  const double middle = 0.5 * (panel.from + panel.to);
  if (!(panel.to - panel.from > HR2DI_SMALLEST_PANEL) || panels->count >= HR2DI_PANELS - 2)
    return 0;
  panels->stack[panels->count++] = (hr2di_span){middle, panel.to};
  panels->stack[panels->count++] = (hr2di_span){panel.from, middle};
  return 1;
}

/* How far a panel of the segment that leads from `from` along `along` is from the origin; near
   below HR2DI_NEAR_ELLIPSE. */
static inline double hr2di_panel_ellipse(hr2d_point from, hr2d_point along, hr2di_span panel) {
  const hr2d_segment around = {hr2di_block_along(from, along, panel.from),
                               hr2di_block_along(from, along, panel.to)};
  return hr2di_ellipse(around, (hr2d_point){0, 0});
}

/* In gas panels are no deeper than GAS_DEEP, and their rules no shorter than those of
   GAS_ELLIPSE: so the latter are enough for e^−κr. */
#define HR2DI_GAS_DEEP    2
#define HR2DI_GAS_ELLIPSE 2.5

/* Whether gas of a scene asks to halve a panel that is seen from x, to which `from` leads: dark
   ones count for nothing. */
static inline int hr2di_panel_is_deep(hr2d_point x, hr2d_point from, hr2d_point along,
                                      hr2di_span panel, const hr2d_scene *scene) {
  const hr2di_regions *regions = hr2di_scene_regions(scene);
  const hr2d_point a = hr2di_block_along(from, along, panel.from),
                   b = hr2di_block_along(from, along, panel.to);
  const double length = hypot(b.x - a.x, b.y - a.y);
  const double least = fmin(hypot(a.x, a.y), hypot(b.x, b.y)) - length;
  for (size_t g = 0; g < hr2di_band_groups(scene); g++) {
    const hr2di_gas_range absorption = hr2di_band_group_range(scene, g);
    if (absorption.most * length > HR2DI_GAS_DEEP && absorption.least * least < HR2DI_GAS_DARK)
      return 1;
  }
  return regions && hr2di_regions_is_rough(regions, x, a, b);
}

/* The end of the part of a panel behind which a border begins or ends, or the panel's end. */
static inline double hr2di_panel_cut(hr2d_point x, hr2d_point from, hr2d_point along,
                                     double after, double end, const hr2d_scene *scene) {
  const hr2di_regions *regions = hr2di_scene_regions(scene);
  return regions ? hr2di_regions_cut(regions, x, from, along, after, end) : end;
}

#endif
