/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes with mirrors and periods, from the public interface alone. */
#ifndef HR2D_TESTS_SUPPORT_SYMMETRIC_SCENES_H
#define HR2D_TESTS_SUPPORT_SYMMETRIC_SCENES_H

#include <hr2d/hr2d.h>

typedef enum symmetric_kind {
  SYMMETRIC_NONE,
  SYMMETRIC_HALF,    /* half a room with a post, at a mirror that runs into two walls */
  SYMMETRIC_OBLIQUE, /* the same, turned */
  SYMMETRIC_QUARTER, /* a quarter of blocks around a lamp, under a background, in two bands */
  SYMMETRIC_PLATES, /* two plates for ever: B is 1/(1 − ρ₁ρ₂) and ρ₂/(1 − ρ₁ρ₂) */
  SYMMETRIC_STREETS, /* streets under a background; the ground is black */
  SYMMETRIC_PANELS,  /* panels over ground, which see for ever, under a background */
  SYMMETRIC_HALL,    /* between two mirrors, with a third one across */
  SYMMETRIC_ROW,     /* many blocks of a period beside a mirror along it */
  SYMMETRIC_SUNNY,   /* houses at a mirror, with a sun and a sky in pieces */
  SYMMETRIC_HEATED,  /* half a furnace: temperatures and fluxes in three bands */
  SYMMETRIC_KINDS
} symmetric_kind;

/* Adds the patches and what they are under; the scene is not committed.  HR2D_OK, or what the
   library says. */
hr2d_status symmetric_add(hr2d_scene *scene, symmetric_kind kind);

/* B of the two plates. */
void symmetric_plates_answer(double answer[2]);

#endif
