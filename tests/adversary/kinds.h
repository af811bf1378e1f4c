/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of scenes that the adversary makes. */
#ifndef HR2D_TESTS_ADVERSARY_KINDS_H
#define HR2D_TESTS_ADVERSARY_KINDS_H

#include "adversary/scene.h"

typedef struct adv_kind {
  const char *name;
  void (*make)(adv_scene *scene, adv_random *r); /* fills an empty scene, lengths about 4 */
  const char *what;
} adv_kind;

/* Tables that end with a name of NULL. */
extern const adv_kind adv_rooms[];    /* closed, ordinary proportions */
extern const adv_kind adv_extreme[];  /* closed, extreme proportions, reflectances, places */
extern const adv_kind adv_open[];     /* light leaves or comes in */
extern const adv_kind adv_day[];      /* under a sun, or a sky in pieces */
extern const adv_kind adv_symmetry[]; /* with mirrors, or a period */
extern const adv_kind adv_gases[];    /* full of gas */

/* The number of kinds, and each of them. */
size_t adv_kinds(void);
const adv_kind *adv_kind_at(size_t k);

/* Draws a scene that the library accepts; returns the number of those that it refused. */
int adv_draw(const adv_kind *kind, adv_random *r, adv_scene *scene);

/* Shapes that several kinds share. */

/* A room of about 4 by 3; *w and *h receive its size. */
void adv_room(adv_scene *scene, adv_random *r, double *w, double *h);

/* A convex polygon about the origin, or its front outside if `out`. */
void adv_convex(adv_scene *scene, adv_random *r, int corners, double radius, int out);

/* Up to `count` free screens of lengths from `shortest` to `longest` in a box. */
void adv_screens(adv_scene *scene, adv_random *r, int count, const double box[4],
                 double shortest, double longest);

#endif
