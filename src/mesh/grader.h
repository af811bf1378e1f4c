/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work space of grading, and its steps on several threads. */
#ifndef HR2D_SRC_MESH_GRADER_H
#define HR2D_SRC_MESH_GRADER_H

#include "mesh/mesh-grading.h"
#include "mesh/mirror-images.h"
#include "mesh/visible-vertices.h"

/* An end of a patch. */
typedef struct hr2di_grading_vertex {
  hr2d_point at;
  uint32_t patch;
  int last;   /* the end of the patch, not its start */
  int inside; /* neither: a border of sunlight, where B jumps */
} hr2di_grading_vertex;

/* A place on a patch where elements end, and how they are graded towards it: in halves to a
   size of 2^−halves, and in quarters to one of 2^−depth. */
typedef struct hr2di_grading_mark {
  double at;
  hr2d_point point;
  unsigned depth, halves;
} hr2di_grading_mark;

typedef struct hr2di_grader hr2di_grader;

/* The steps of one patch. */
typedef struct hr2di_grader_steps {
  int (*divides)(const hr2di_grader *g, uint32_t patch); /* whether its elements are divided */
  /* Finds the marks and the near points of a patch; depends on no other patch's elements. */
  hr2d_status (*trace)(hr2di_grader *g, uint32_t patch);
  /* Divides the elements of a patch that has looked, with what it has found in `g`. */
  hr2d_status (*divide)(hr2di_grader *g, uint32_t patch);
} hr2di_grader_steps;

struct hr2di_grader {
  const hr2di_grader_steps *steps;
  hr2d_hierarchy *h;
  const hr2di_grading *grading;
  hr2di_grading_vertex *vertex; /* by x */
  size_t vertices;
  uint32_t *under;         /* for the start and the end of each patch: 1 + the patch on whose
                              front, between its ends, it stands, or 0 */
  hr2di_image_points near; /* points in front of the current patch, and near to it: ends of
                              other patches that it sees, and mirror images */
  hr2di_visible_vertices *seen; /* NULL: nothing is in the way of anything */
  hr2di_grading_mark *mark;     /* of the current patch, by place */
  size_t marks, mark_capacity;
  int waits;      /* what `under` is to be waits in `feet`, as other threads read it */
  uint32_t *feet; /* places in `under` that are to have the current patch */
  size_t feet_count, feet_capacity;
  hr2di_survey survey;
  int all;         /* patches that reflect nothing are divided, too */
  double target;   /* of the patch under way */
  double distance; /* and how far ends must be from its elements */
  double shortest; /* no element of it is a shorter part of it */
  double last[3];  /* angle and ρ of the last corner, and its exponent */
};

/* Elements that are graded towards an end have it at an ellipse of 3; ends farther than that
   are not near. */
#define HR2DI_GRADING_FAR 3.0

/* grading-marks.c: */

/* Sets the vertices, and no feet.  HR2D_OK, HR2D_ENOMEM or the status of the watch, as all. */
hr2d_status hr2di_grading_list_vertices(hr2di_grader *g);

/* The largest ρ of a patch in any band, or ρ + τ. */
double hr2di_grading_reflectance(const hr2d_scene *scene, uint32_t patch);

/* How elements are graded towards a corner in gas, with an angle of this cosine, between
   patches of a mean ρ; `depth` is that of the patch. */
hr2di_grading_mark hr2di_grading_in_gas(const hr2di_grader *g, double cosine, double rho,
                                        double depth);

/* Adds a mark of the patch under way, and a point that is near to it, unless it is not. */
hr2d_status hr2di_grading_add_mark(hr2di_grader *g, double at, hr2d_point point,
                                   hr2di_grading_mark mark);
hr2d_status hr2di_grading_add_near(hr2di_grader *g, hr2d_segment patch, hr2d_point v);

/* gas-marks.c: adds what borders of gases make for a patch. */
hr2d_status hr2di_grading_mark_gas(hr2di_grader *g, uint32_t patch);

/* grading-marks.c: adds the vertices that are near to a patch to its marks and its near points.
 */
hr2d_status hr2di_grading_look_around(hr2di_grader *g, uint32_t patch);

/* Turns marks from number `first` on round, which are of the other side of a pane. */
void hr2di_grading_turn_marks(hr2di_grader *g, size_t first);

/* Adds marks at the feet of a patch and at its events, those of both sides of a pane, and sorts
   all. */
hr2d_status hr2di_grading_set_marks(hr2di_grader *g, uint32_t patch);

/* Looks from all patches and divides them, on several threads: patches look on any of them, and
   are divided in their order by the calling one.  No bit depends on the number of threads. */
hr2d_status hr2di_grader_team(hr2di_grader *g, size_t threads);

#endif
