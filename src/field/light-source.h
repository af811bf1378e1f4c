/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the points of a call for a field have in common. */
#ifndef HR2D_SRC_FIELD_LIGHT_SOURCE_H
#define HR2D_SRC_FIELD_LIGHT_SOURCE_H

#include "base/legendre.h"
#include "field/leaves.h"

/* Gauss rules, of more points each. */
enum { HR2DI_LIGHT_RULES = 15 };

/* Those of the first of these rules may take a whole leaf that is far enough. */
enum { HR2DI_LIGHT_FAR = 5 };

/* From which size of the ellipse through the point on a rule may take an element. */
typedef struct hr2di_light_far {
  float from[HR2DI_LIGHT_FAR];
} hr2di_light_far;

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
  double *gas_error;         /* per band: the same of E_g; or NULL */
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

/* The first rule that has so many points, or the last one. */
const hr2di_rule *hr2di_light_rule(const hr2di_light_source *of, double points);

/* The patch of the solution that has the leaves of one of the scene, which may have more images
   of a period; HR2DI_NOBODY for an end of it. */
static inline uint32_t hr2di_light_patch(const hr2di_light_source *of, uint32_t patch) {
  const hr2di_symmetry *s = &of->scene->symmetry;
  if (!s->motion || !s->by.periodic) return patch;
  if (hr2di_symmetry_is_end(s, patch)) return HR2DI_NOBODY;
  const size_t reflection = patch / s->cell & (((size_t)1 << s->by.mirrors) - 1);
  return (uint32_t)(reflection * s->cell + patch % s->cell);
}

#endif
