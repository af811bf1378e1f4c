/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panes: of what falls on one side they reflect a part and let a part through, both diffusely.

   A pane is two patches back to back, end to end.  It is opaque to lines, so that elements and
   links know nothing of panes.  Where B = E + ρH is an equation of a patch, it is one of both
   sides:
     B = E + SH,   S = ((ρ, τ), (τ, ρ′)),
   with H at one place on either side.  S is symmetric, and its rows are at most 1.

   hr2d_scene::other_side has the other side of each patch; it is the patch itself unless it is
   a side of a pane.  NULL: the scene does not call for the effect. */
#ifndef HR2D_SRC_SCENE_PANES_H
#define HR2D_SRC_SCENE_PANES_H

#include "scene/scene-impl.h"

/* Whether light passes through a patch. */
static inline int hr2di_pane_is(const hr2d_scene *scene, size_t patch) {
  return hr2di_scene_other_side(scene, patch) != patch;
}

/* The most of ρ + τ of both sides: an error of H is at most so much of one of B on either. */
static inline double hr2di_pane_scattered(const hr2d_scene *scene, size_t patch, size_t band) {
  return fmax(hr2di_scene_scattered(scene, patch, band),
              hr2di_scene_scattered(scene, hr2di_scene_other_side(scene, patch), band));
}

/* ρ of own plus τ of that on the other side, on a patch with values of H in a band. */
static inline double hr2di_pane_sum(const hr2d_scene *scene, size_t patch, size_t band,
                                    double own, double other) {
  const double reflected = hr2d_scene_reflectance(scene, patch, band) * own;
  if (!hr2di_pane_is(scene, patch)) return reflected;
  return reflected + hr2d_scene_transmittance(scene, patch, band) * other;
}

/* A symmetric matrix ((a, c), (c, d)). */
typedef struct hr2di_pane_matrix {
  double a, c, d;
} hr2di_pane_matrix;

/* S of a pane in a band, as seen from a side. */
static inline hr2di_pane_matrix hr2di_pane_scattering(const hr2d_scene *scene, size_t patch,
                                                      size_t band) {
  return (hr2di_pane_matrix){
      hr2d_scene_reflectance(scene, patch, band), hr2d_scene_transmittance(scene, patch, band),
      hr2d_scene_reflectance(scene, hr2di_scene_other_side(scene, patch), band)};
}

#endif
