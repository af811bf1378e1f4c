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

/* Of a committed scene: light, and what fronts see; and suns. */
hr2d_status hr2di_lint_light(const hr2di_lint *lint);
hr2d_status hr2di_lint_views(const hr2di_lint *lint);
hr2d_status hr2di_lint_suns(const hr2di_lint *lint);

#endif
