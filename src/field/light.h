/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light that a point gets from what it sees. */
#ifndef HR2D_SRC_FIELD_LIGHT_H
#define HR2D_SRC_FIELD_LIGHT_H

#include "base/legendre.h"
#include "field/leaves.h"
#include "field/visibility-polygon.h"

/* Gauss rules, of more points each. */
enum { HR2DI_LIGHT_RULES = 15 };

/* Those of the first of these rules may take a whole leaf that is far enough. */
enum { HR2DI_LIGHT_FAR = 5 };

/* From which size of the ellipse through the point on a rule may take an element. */
typedef struct hr2di_light_far {
  float from[HR2DI_LIGHT_FAR];
} hr2di_light_far;

/* What the points of a call have in common. */
typedef struct hr2di_light_source {
  const hr2d_solution *solution;
  const hr2d_scene *scene;
  hr2di_leaves leaves;
  double allowed; /* the error of ∫ B dω along an element, as a part of its angle times the
                     largest coefficient */
  hr2di_light_far *far; /* of each element; NULL: none is far */
  hr2di_basis basis;
  hr2di_rule rule[HR2DI_LIGHT_RULES];
  int has_gas; /* between the patches */
  int wants_flux;
  int lit_sky;               /* whether there is light where nothing stands */
  const double *patch_error; /* patches × bands, or NULL */
  double *element_error;     /* elements × bands, see leaf-errors.h; or NULL */
} hr2di_light_source;

/* HR2D_OK, HR2D_ENOMEM or the status of the watch; to be ended by hr2di_light_source_clear() in
   any case. */
hr2d_status hr2di_light_source_init(hr2di_light_source *of, const hr2d_solution *solution,
                                    hr2di_watch *watch);
void hr2di_light_source_clear(hr2di_light_source *of);

/* From now on the field may have an error of `max` per band, of M, and π times that of Φ.
   HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_light_source_relax(hr2di_light_source *of, const double *max,
                                     hr2di_watch *watch);

/* The patch of the solution that has the leaves of one of the scene, which may have more images
   of a period; HR2DI_NOBODY for an end of it. */
static inline uint32_t hr2di_light_patch(const hr2di_light_source *of, uint32_t patch) {
  const hr2di_symmetry *s = &of->scene->symmetry;
  if (!s->motion || !s->by.periodic) return patch;
  if (hr2di_symmetry_is_end(s, patch)) return HR2DI_NOBODY;
  const size_t reflection = patch / s->cell & (((size_t)1 << s->by.mirrors) - 1);
  return (uint32_t)(reflection * s->cell + patch % s->cell);
}

/* The sums of one point, over stretches so far. */
typedef struct hr2di_light_sum {
  const hr2di_light_source *of;
  hr2d_point x; /* where the view is from */
  hr2di_watch *watch;
  double *mean;            /* per band: ∫ B dω */
  double *flux;            /* per band, x and y: ∫ B ω dω; NULL: not wanted */
  double *error;           /* per band: ∫ of the error of the patch or the leaf */
  double front, back, sky; /* angles */
  double clearance;        /* the square of how near an end of a stretch or a jump of B is */
} hr2di_light_sum;

/* Adds a stretch of the view from x. */
void hr2di_light_add(hr2di_light_sum *sum, const hr2di_polygon_arc *s);

/* Whether the sun of a band is seen in a direction from the right one on and before the left
   one; adds its light. */
int hr2di_light_has_sun(const hr2di_light_source *of, hr2d_point right, hr2d_point left,
                        size_t band);
void hr2di_light_add_sun(hr2di_light_sum *sum, size_t band);

/* Adds `factor` times the light of the sky at a bearing between two directions. */
void hr2di_light_add_sky(hr2di_light_sum *sum, hr2d_point right, hr2d_point left, double angle,
                         double bearing, double factor);

#endif
