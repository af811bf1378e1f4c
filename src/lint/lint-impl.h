/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the groups of warnings. */
#ifndef HR2D_SRC_LINT_LINT_IMPL_H
#define HR2D_SRC_LINT_LINT_IMPL_H

#include <hr2d/lint.h>

#include "scene/scene-impl.h"

typedef struct hr2di_lint {
  const hr2d_scene *scene;
  hr2d_warning_fn warn;
  void *ctx;
  double gap;
  hr2di_watch *watch;
} hr2di_lint;

/* The names of the first of some places, and how many more there are. */
enum { HR2DI_LINT_PLACES = 3 };
typedef struct hr2di_lint_places {
  char text[HR2DI_LINT_PLACES * sizeof(hr2di_label) + 40];
} hr2di_lint_places;

hr2di_lint_places hr2di_lint_places_of(const char *const *name, size_t names, size_t count);

/* Patches that one warning tells. */
typedef struct hr2di_lint_patches {
  size_t count, patch[HR2DI_LINT_PLACES]; /* the first of them */
} hr2di_lint_patches;

void hr2di_lint_add(hr2di_lint_patches *report, size_t patch);
hr2di_lint_places hr2di_lint_labels(const hr2d_scene *scene, const hr2di_lint_patches *report);

/* Gives a warning its text, as printf would, and shows it.  Returns the status of the visitor.
 */
__attribute__((format(printf, 3, 4))) hr2d_status
hr2di_lint_warn(const hr2di_lint *lint, hr2d_warning warning, const char *format, ...);

/* Ends of patches and narrow openings. */
hr2d_status hr2di_lint_gaps(const hr2di_lint *lint);

/* Temperatures and wavelengths that look like those of other units, and two-sided patches of
   given flux. */
hr2d_status hr2di_lint_heat(const hr2di_lint *lint);

/* What to do about a front that looks to the wrong side. */
#define HR2DI_LINT_TURN                                                                        \
  "the front is on the left from a to b: swap the ends, or for a polygon \"faces\""

/* Of a committed scene: light, and what fronts see; and suns.  *blind receives whether it was
   told that no front sees the surroundings, where the suns are. */
hr2d_status hr2di_lint_light(const hr2di_lint *lint, int *blind);
hr2d_status hr2di_lint_views(const hr2di_lint *lint, int *blind);
hr2d_status hr2di_lint_suns(const hr2di_lint *lint, int blind);

#endif
