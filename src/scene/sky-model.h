/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sky in space, and its radiosity in a section. */
#ifndef HR2D_SRC_SCENE_SKY_MODEL_H
#define HR2D_SRC_SCENE_SKY_MODEL_H

#include <hr2d/sky.h>

#include "base/legendre.h"
#include "base/watch.h"
#include "scene/sky.h"

/* The least, and the default tolerance. */
#define HR2DI_SKY_TOLERANCE 1e-12

/* Copies a sky of any struct_size.  HR2D_OK, or HR2D_EINVAL. */
hr2d_status hr2di_sky_copy(hr2d_sky *to, const hr2d_sky *from);

/* The tolerance, or its default. */
double hr2di_sky_tolerance(const hr2d_sky *sky);

/* What is wrong with a sky; NULL: nothing. */
const char *hr2di_sky_problem(const hr2d_sky *sky);

/* Gradation times indicatrix, for cos Z in [0,1] and χ in [0,π]. */
double hr2di_sky_shape(const hr2d_sky *sky, double cos_zenith, double chi);

/* Angles in radians.  The sun is at (q sin φ_s, q cos φ_s, sin β_s) over +x, +y and e. */
typedef struct hr2di_sky_section {
  hr2d_sky sky;
  hr2di_rule rule;
  double q, bearing, along; /* q = cos β_s, φ_s, sin β_s */
  double across;            /* the tolerance of integrals over β */
  double scale;             /* s */
  double disc, band;        /* radiances */
  double sine, height;      /* of the radius of the disc, and the height of the band */
} hr2di_sky_section;

/* Of a sky without a problem. */
void hr2di_sky_section_init(hr2di_sky_section *section, const hr2d_sky *sky);

/* M(φ), |φ| ≤ π/2. */
double hr2di_sky_section_at(const hr2di_sky_section *section, double bearing);

/* Where M is not smooth between the horizons, bearings in radians: the sun and its opposite,
   the ends of the disc and of the band. Returns how many. */
enum { HR2DI_SKY_BREAKS = 6 };
int hr2di_sky_section_breaks(const hr2di_sky_section *section,
                             double bearing[HR2DI_SKY_BREAKS]);

/* Makes a scene's sky of one for each band.  HR2D_OK, or a status with a message of the scene
   and nothing made. */
hr2d_status hr2di_scene_make_sky(hr2d_scene *scene, const hr2d_sky *sky, size_t bands,
                                 hr2di_watch *watch, hr2di_sky *made);

#endif
