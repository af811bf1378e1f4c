/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Smaller scenes, by trying. */
#include "adversary/shrink.h"

#include <stdlib.h>
#include <string.h>

/* Without a wall a room is open: rows of the exchange matrix are no longer full. */
static int is_closed(const adv_scene *scene) {
  double *area = malloc(scene->count * scene->count * sizeof *area);
  hr2d_scene *built = NULL;
  int closed =
      area && !adv_build(scene, &built) && !hr2d_exchange_matrix(built, NULL, area, NULL);
  for (size_t i = 0; closed && i < scene->count; i++) {
    double rest = adv_length(scene, i), length = rest;
    for (size_t j = 0; j < scene->count; j++) rest -= area[i * scene->count + j];
    closed = rest < 1e-12 * length;
  }
  hr2d_scene_destroy(built);
  free(area);
  return closed;
}

/* The same random numbers may lead to other transformations of a changed scene: a few are
   tried. */
static int still(adv_scene *scene, adv_trial *trial, const adv_law *law, adv_check wanted) {
  hr2d_scene *built = NULL;
  hr2d_status status = adv_build(scene, &built);
  hr2d_scene_destroy(built);
  if (status) return 0;
  scene->closed = scene->closed && is_closed(scene);
  adv_call_original(scene);
  adv_random random = trial->random;
  int found = 0;
  for (int k = 0; !found && k < 4 && law->holds_for(scene); k++) {
    adv_random start = trial->random;
    adv_try(trial, law);
    found = trial->outcome.worst[wanted] > 1;
    if (found) random = start;
  }
  trial->random = random;
  return found;
}

static int without_patch(adv_scene *scene, size_t k) {
  if (scene->count < 2) return 0;
  scene->count--;
  memmove(&scene->patch[k], &scene->patch[k + 1], (scene->count - k) * sizeof scene->patch[0]);
  return 1;
}

static int without_piece(adv_scene *scene) {
  if (!scene->pieces) return 0;
  scene->pieces--;
  return 1;
}

static int set(double *value, double plain) {
  int differs = *value != plain;
  *value = plain;
  return differs;
}

/* Changes numbered from 0; returns 0 if a change changes nothing.  Absorbers stay absorbers,
   for they are a cause of their own. */
static int change(adv_scene *scene, size_t number) {
  size_t n = scene->count;
  if (number < n) return without_patch(scene, number);
  if (number < 2 * n) return set(&scene->patch[number - n].emission[0], 0);
  if (number < 3 * n) {
    double *rho = scene->patch[number - 2 * n].reflectance;
    return *rho > 0 && set(rho, 0.5);
  }
  if (number < 4 * n) {
    double *emission = scene->patch[number - 3 * n].emission;
    return *emission > 0 && set(emission, 1);
  }
  if (number == 4 * n) return without_piece(scene);
  if (number == 4 * n + 1) return set(&scene->sun[0].irradiance, 0);
  if (number == 4 * n + 2) return set(&scene->background[0], 0);
  if (scene->bands == 1) return 0;
  scene->bands = 1;
  return 1;
}

void adv_shrink(adv_scene *scene, adv_trial *trial, const adv_law *law) {
  adv_check wanted = 0;
  int changed = 1;
  adv_scene *old = malloc(sizeof *old);
  if (!old) return;
  trial->scene = scene;
  while (wanted + 1 < ADV_CHECKS && trial->outcome.worst[wanted] <= 1) wanted++;
  for (int round = 0; changed && round < 4; round++) {
    changed = 0;
    for (size_t number = 0; number <= 4 * scene->count + 3; number++) {
      *old = *scene;
      if (!change(scene, number)) continue;
      if (still(scene, trial, law, wanted))
        changed = 1;
      else
        *scene = *old;
    }
  }
  adv_call_original(scene);
  adv_random start = trial->random;
  adv_try(trial, law);
  trial->random = start;
  free(old);
}
