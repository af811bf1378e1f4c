/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of commit that finds the two sides of each pane. */
#include "scene/panes.h"

#include <float.h>

#include "base/alloc.h"
#include "base/sort.h"

/* Whether a patch has another side: a shield passes heat on, whatever it does with light. */
static int transmits(const hr2d_scene *scene, size_t patch) {
  if (hr2di_shield_is(scene, patch)) return 1;
  for (size_t b = 0; b < scene->bands; b++)
    if (hr2d_scene_transmittance(scene, patch, b) > 0) return 1;
  return 0;
}

/* A side of a pane, by the place where the pane is: sides of one have the same. */
typedef struct side {
  hr2d_point low, high;
  uint32_t patch;
} side;

static int is_before(hr2d_point a, hr2d_point b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

static int compare_points(hr2d_point a, hr2d_point b) {
  return is_before(a, b) ? -1 : is_before(b, a);
}

static int compare_places(const side *x, const side *y) {
  const int low = compare_points(x->low, y->low);
  return low ? low : compare_points(x->high, y->high);
}

static int by_place(const void *x, const void *y) {
  const side *a = x, *b = y;
  const int place = compare_places(a, b);
  return place ? place : a->patch < b->patch ? -1 : a->patch > b->patch;
}

static side side_of(const hr2d_scene *scene, size_t patch) {
  const hr2d_segment s = scene->patch[patch].scaled;
  return is_before(s.a, s.b) ? (side){s.a, s.b, (uint32_t)patch}
                             : (side){s.b, s.a, (uint32_t)patch};
}

static hr2d_status refuse_single(hr2d_scene *scene, size_t patch) {
  if (hr2di_shield_is(scene, patch))
    return hr2di_message_fail(
        &scene->message, HR2D_ESCENE,
        "%s is a side of a shield, and no patch with the same ends is the other side: write "
        "\"sides\": \"both\", or add the other side",
        hr2di_patch_label(scene, patch).text);
  return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                            "%s has a transmittance, and no patch with the same ends has one "
                            "on its other side: write "
                            "\"sides\": \"both\", or add the other side",
                            hr2di_patch_label(scene, patch).text);
}

/* Both sides have one transmittance, and neither gives more than it gets. */
static hr2d_status check_pane(hr2d_scene *scene, size_t front, size_t back) {
  if (hr2di_shield_is(scene, front) && hr2di_shield_is(scene, back)) return HR2D_OK;
  if (hr2di_shield_is(scene, front) || hr2di_shield_is(scene, back))
    return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                              "%s and %s are the sides of one sheet, and only one is a shield: "
                              "both must be, or neither",
                              hr2di_patch_label(scene, front).text,
                              hr2di_patch_label(scene, back).text);
  for (size_t b = 0; b < scene->bands; b++) {
    const double tau[] = {hr2d_scene_transmittance(scene, front, b),
                          hr2d_scene_transmittance(scene, back, b)};
    if (tau[0] != tau[1])
      return hr2di_message_fail(
          &scene->message, HR2D_ESCENE,
          "%s and %s are the sides of a pane, and their transmittances in band %zu are %g and "
          "%g: light passes a pane both ways alike, so that they must be the same",
          hr2di_patch_label(scene, front).text, hr2di_patch_label(scene, back).text, b, tau[0],
          tau[1]);
    for (int k = 0; k < 2; k++) {
      const size_t patch = k ? back : front;
      const double rho = hr2d_scene_reflectance(scene, patch, b);
      if (rho + tau[k] > 1 + 4 * DBL_EPSILON)
        return hr2di_message_fail(
            &scene->message, HR2D_ESCENE,
            "%s: reflectance %.17g and transmittance %.17g in band %zu are together above 1",
            hr2di_patch_label(scene, patch).text, rho, tau[k], b);
    }
  }
  return HR2D_OK;
}

static hr2d_status match(hr2d_scene *scene, const side *of, size_t sides) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < sides && !status; k += 2) {
    const int pair = k + 1 < sides && compare_places(&of[k], &of[k + 1]) == 0;
    const uint32_t i = of[k].patch, j = pair ? of[k + 1].patch : i;
    if (!pair) return refuse_single(scene, i);
    scene->other_side[i] = j;
    scene->other_side[j] = i;
    status = check_pane(scene, i, j);
  }
  return status;
}

/* The other side of an image is an image of the other side. */
static void match_images(hr2d_scene *scene) {
  const hr2di_symmetry *s = &scene->symmetry;
  const size_t cell = hr2di_scene_cell(scene), end = s->motion ? s->motions * cell : cell;
  for (size_t k = cell; k < end; k++)
    scene->other_side[k] = (uint32_t)(k - k % cell + scene->other_side[k % cell]);
}

static hr2d_status find_sides(hr2d_scene *scene, side **of, size_t *sides, hr2di_watch *watch) {
  const size_t cell = hr2di_scene_cell(scene);
  hr2d_status status = HR2D_OK;
  *sides = 0;
  for (size_t k = 0; k < cell && !status; k++) {
    *sides += (size_t)transmits(scene, k);
    status = hr2di_watch_work(watch, 1 + scene->bands / 16);
  }
  if (status || *sides == 0) return status;
  *of = hr2di_alloc(&scene->alloc, *sides, sizeof **of);
  if (!*of) return HR2D_ENOMEM;
  for (size_t k = 0, at = 0; k < cell; k++)
    if (transmits(scene, k)) (*of)[at++] = side_of(scene, k);
  return hr2di_sort(*of, *sides, sizeof **of, by_place, watch);
}

hr2d_status hr2di_scene_match_panes(hr2d_scene *scene, hr2di_watch *watch) {
  side *of = NULL;
  size_t sides = 0;
  hr2d_status status = find_sides(scene, &of, &sides, watch);
  const int wanted = sides > 0 || scene->effect[HR2D_EFFECT_PANES].forced;
  if (!status && wanted) {
    scene->other_side = hr2di_alloc(&scene->alloc, scene->patches, sizeof *scene->other_side);
    status = scene->other_side ? HR2D_OK : HR2D_ENOMEM;
  }
  for (size_t k = 0; k < scene->patches && scene->other_side; k++)
    scene->other_side[k] = (uint32_t)k;
  int refused = 0;
  if (!status && sides > 0) {
    status = match(scene, of, sides);
    refused = status != HR2D_OK;
  }
  if (!status && wanted) match_images(scene);
  hr2di_alloc_free(&scene->alloc, of);
  return status && !refused ? hr2di_scene_fail(scene, status, watch, "the panes") : status;
}
