/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A smaller scene with the same violation. */
#ifndef HR2D_TESTS_ADVERSARY_SHRINK_H
#define HR2D_TESTS_ADVERSARY_SHRINK_H

#include "adversary/law.h"

/* Leaves out patches, emissions and bands of the scene, and makes materials plain, while the
   law still violates one of the checks that it violates at first.  The scene is changed; the
   trial is the last one on it. */
void adv_shrink(adv_scene *scene, adv_trial *trial, const adv_law *law);

#endif
