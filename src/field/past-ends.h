/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a point between the patches sees past the ends of a period, from what it sees of the
   last images: of each the light is a series in 1/k, see scene/period-weights.c. */
#ifndef HR2D_SRC_FIELD_PAST_ENDS_H
#define HR2D_SRC_FIELD_PAST_ENDS_H

#include "field/visibility-polygon.h"

/* A part of the view that stands for others, or is unknown. */
typedef struct hr2di_far_part {
  int past;                        /* it is past the end; then the next ones are 0 */
  double weight;                   /* how often it counts beside itself */
  double check[HR2DI_TAIL_CHECKS]; /* what checks of its series leave of that */
  double half;                     /* the same from periods up to ½K, less those that follow */
  hr2d_point right, left;
  double angle;
  double bearing;  /* of the sky past the end */
  int second_half; /* of more than ½K periods */
} hr2di_far_part;

typedef void (*hr2di_far_fn)(void *ctx, const hr2di_far_part *part);

/* The view from a point; nothing is past ends without a period. */
typedef struct hr2di_far_view {
  const hr2d_scene *scene;
  hr2di_quadrant quadrant[4];
  int quadrants;
  int far; /* x is so far above or below the patches that no series holds */
} hr2di_far_view;

/* The angle with the period under which points see the images that the series takes, at most;
   0 without a period. */
double hr2di_far_angle(const hr2di_far_view *v);

/* From x, scaled.  *far: x is so far from the patches that the series in 1/k do not hold yet.
 */
void hr2di_far_view_init(hr2di_far_view *v, const hr2d_scene *scene, hr2d_point x);

/* The same point between the patches themselves, which sees what x sees. */
hr2d_point hr2di_far_home(const hr2d_scene *scene, hr2d_point x);

/* Shows the parts of a stretch of sky that are in periods that stand for others, and those past
   the ends. */
void hr2di_far_sky(const hr2di_far_view *v, const hr2di_polygon_arc *s, hr2di_far_fn show,
                   void *ctx);

/* Where images are seen through gaps between others, what shows of them goes
   to and fro with k, and there is no series.  Then what half of the images say of fronts and
   sky past the ends differs from what all say by more than this part of it, and the light past
   the ends is that of the later half of the images, direction by direction: between nothing and
   the largest radiosity. */
#define HR2DI_FAR_UNSETTLED 0.1

/* Whether a piece of the sky ends between two directions past the ends: the light from there is
   not that of the horizon alone. */
int hr2di_far_changes(const hr2d_scene *scene, hr2d_point right, hr2d_point left);

/* Whether points where x is, scaled, or nearer to the strip may see a sun past the ends. */
int hr2di_far_sees_suns(const hr2d_scene *scene, hr2d_point x);

/* Whether the sun of a band shines on x, scaled, past all images for ever: exact, as a ray to
   it leaves the strip somewhere. */
int hr2di_far_sun_shines(const hr2d_scene *scene, hr2d_point x, size_t band);

#endif
