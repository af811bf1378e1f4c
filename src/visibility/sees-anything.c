/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "visibility/sees-anything.h"

#include "visibility/point-view-impl.h"

typedef struct look {
  int sky, sees;
} look;

static hr2d_status notice(void *ctx, const hr2di_stretch *s, const hr2di_glimpse *g) {
  look *l = ctx;
  (void)g;
  l->sees = s->patch == HR2DI_SEEN_SKY ? l->sky : s->patch != HR2DI_SEEN_NOBODY;
  return l->sees ? HR2D_STOPPED : HR2D_OK;
}

hr2d_status hr2di_sees_anything(hr2di_viewer *viewer, size_t patch, int sky, int *sees) {
  static const double at[] = {.5, .25, .75, 0x1p-10, 1 - 0x1p-10, .125, .375, .625, .875};
  look l = {.sky = sky};
  hr2di_view_from seen;
  hr2d_status status = HR2D_OK;
  viewer->show = notice;
  /* cppcheck-suppress autoVariables ; until the end of this function */
  viewer->ctx = &l;
  for (size_t k = 0; k < sizeof at / sizeof *at && !l.sees && !status; k++)
    status = hr2di_view_at(viewer, patch, at[k], &seen);
  viewer->show = NULL;
  viewer->ctx = NULL;
  *sees = l.sees;
  return l.sees ? HR2D_OK : status;
}
