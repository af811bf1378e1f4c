/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which effects a scene calls for, each with its reason. */
#include <stdarg.h>
#include <stdio.h>

#include "geometry/crossings.h"
#include "geometry/predicates.h"
#include "geometry/vector.h"
#include "scene/facing-in-part.h"
#include "scene/find-occluder.h"
#include "scene/scene-impl.h"

static const char *const effect_name[HR2D_EFFECT_COUNT] = {
    [HR2D_EFFECT_OCCLUSION] = "occlusion", [HR2D_EFFECT_INTERREFLECTION] = "interreflection",
    [HR2D_EFFECT_EMISSION] = "emission",   [HR2D_EFFECT_BANDS] = "bands",
    [HR2D_EFFECT_TWO_SIDED] = "two-sided", [HR2D_EFFECT_FACING] = "facing",
    [HR2D_EFFECT_CORNER] = "corner",       [HR2D_EFFECT_BACKGROUND] = "background",
    [HR2D_EFFECT_PANES] = "panes",         [HR2D_EFFECT_MEDIUM] = "medium",
};

const char *hr2d_effect_name(hr2d_effect effect) {
  return (unsigned)effect < HR2D_EFFECT_COUNT ? effect_name[effect] : NULL;
}

int hr2d_scene_effect(const hr2d_scene *scene, hr2d_effect effect, const char **reason) {
  if (reason) *reason = "";
  if (!scene || (unsigned)effect >= HR2D_EFFECT_COUNT) return 0;
  if (reason) *reason = scene->effect[effect].reason;
  return scene->effect[effect].on;
}

__attribute__((format(printf, 4, 5))) static void set(hr2d_scene *scene, hr2d_effect effect,
                                                      int on, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  hr2di_message whole;
  hr2di_message_write(&whole, format, arguments);
  va_end(arguments);
  hr2di_message_copy(scene->effect[effect].reason, sizeof scene->effect[effect].reason,
                     whole.text);
  scene->effect[effect].on = on;
}

/* p lies on the closed segment. */
static int on_segment(const hr2d_segment *s, hr2d_point p) {
  const hr2d_point a = s->a, b = s->b;
  if ((p.x < a.x && p.x < b.x) || (p.x > a.x && p.x > b.x) || (p.y < a.y && p.y < b.y) ||
      (p.y > a.y && p.y > b.y))
    return 0;
  return hr2d_orientation(a, b, p) == 0;
}

static int touch(const hr2d_segment *i, const hr2d_segment *j) {
  return on_segment(i, j->a) || on_segment(i, j->b) || on_segment(j, i->a) ||
         on_segment(j, i->b);
}

/* What passes through a pane goes on as what is reflected does. */
static void analyse_panes(hr2d_scene *scene) {
  set(scene, HR2D_EFFECT_PANES, 0, "every transmittance is 0");
  for (size_t k = scene->patches; k-- > 0;) {
    if (hr2di_scene_other_side(scene, k) == k) continue;
    const hr2di_label label = hr2di_patch_label(scene, k);
    const char *what = hr2di_shield_is(scene, k) ? "heat" : "light";
    set(scene, HR2D_EFFECT_PANES, 1, "%s passes through %s", what, label.text);
    set(scene, HR2D_EFFECT_INTERREFLECTION, 1, "%s passes through %s", what, label.text);
  }
}

static hr2d_status analyse_materials(hr2d_scene *scene, hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  set(scene, HR2D_EFFECT_INTERREFLECTION, 0, "every reflectance is 0");
  set(scene, HR2D_EFFECT_EMISSION, 0, "no patch emits");
  analyse_panes(scene);
  if (scene->bands > 1)
    set(scene, HR2D_EFFECT_BANDS, 1, "%zu bands", scene->bands);
  else
    set(scene, HR2D_EFFECT_BANDS, 0, "one band");
  for (size_t k = scene->patches; k-- > 0 && !status;)
    for (size_t band = 0; band < scene->bands && !status; band++) {
      status = hr2di_watch_work(watch, 4);
      if (hr2d_scene_reflectance(scene, k, band) > 0)
        set(scene, HR2D_EFFECT_INTERREFLECTION, 1, "%s reflects",
            hr2di_patch_label(scene, k).text);
      if (hr2d_scene_emission(scene, k, band) != 0)
        set(scene, HR2D_EFFECT_EMISSION, 1, "%s emits", hr2di_patch_label(scene, k).text);
    }
  return status;
}

/* The light of the sun comes in from the surroundings, too. */
static void analyse_background(hr2d_scene *scene) {
  set(scene, HR2D_EFFECT_BACKGROUND, 0, "no light comes in from the surroundings");
  for (size_t k = scene->sun_bands; k-- > 0;)
    if (scene->sun[k].irradiance > 0)
      set(scene, HR2D_EFFECT_BACKGROUND, 1, "the sun sends %g", scene->sun[k].irradiance);
  for (size_t band = scene->bands; band-- > 0;) {
    const double background = hr2d_scene_background(scene, band);
    if (!(background > 0)) continue;
    set(scene, HR2D_EFFECT_BACKGROUND, 1, "the surroundings send %g", background);
  }
  for (size_t k = scene->sky.pieces * scene->sky.bands; k-- > 0;) {
    const hr2di_sky *sky = &scene->sky;
    const double mean = sky->value[k / sky->bands * sky->terms * sky->bands + k % sky->bands];
    if (mean > 0) set(scene, HR2D_EFFECT_BACKGROUND, 1, "a piece of the sky sends %g", mean);
  }
  if (scene->effect[HR2D_EFFECT_BACKGROUND].on && !scene->effect[HR2D_EFFECT_EMISSION].on)
    set(scene, HR2D_EFFECT_EMISSION, 1, "the surroundings send light in");
}

/* A gas that emits lights all patches. */
static void analyse_medium(hr2d_scene *scene) {
  if (!hr2di_scene_has_gas(scene)) {
    set(scene, HR2D_EFFECT_MEDIUM, 0, "no gas absorbs");
    return;
  }
  const hr2di_gas_range range = hr2di_scene_given_range(scene);
  if (range.least < range.most)
    set(scene, HR2D_EFFECT_MEDIUM, 1, "the gas absorbs %g to %g per length", range.least,
        range.most);
  else
    set(scene, HR2D_EFFECT_MEDIUM, 1, "the gas absorbs %g per length", range.most);
  if (hr2di_scene_gas_emits(scene) && !scene->effect[HR2D_EFFECT_EMISSION].on)
    set(scene, HR2D_EFFECT_EMISSION, 1, "the gas emits");
}

static int is_earlier(const hr2di_first_pair *than, size_t i, size_t j) {
  return !than->exists || i < than->i || (i == than->i && j < than->j);
}

typedef struct touching {
  const hr2d_scene *scene;
  hr2di_first_pair back, corner;
} touching;

/* Patches that touch have boxes that meet, or are of one star. */
static hr2d_status examine_touching(void *ctx, size_t i, size_t j) {
  touching *t = ctx;
  const hr2d_segment *p = &t->scene->patch[i].scaled, *q = &t->scene->patch[j].scaled;
  if (is_earlier(&t->back, i, j) && hr2di_point_same(p->a, q->b) &&
      hr2di_point_same(p->b, q->a))
    t->back = (hr2di_first_pair){1, i, j};
  if (is_earlier(&t->corner, i, j) && touch(p, q) && hr2di_facing_of(p, q) != HR2DI_FACING_NONE)
    t->corner = (hr2di_first_pair){1, i, j};
  return HR2D_OK;
}

/* Those of a star touch, and the first that see each other are found soon, if any do. */
static hr2d_status examine_star(touching *t, const uint32_t *member, size_t count,
                                hr2di_watch *watch) {
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < count && !status; k++) {
    if (t->corner.exists && member[k] > t->corner.i) break;
    for (size_t m = k + 1; m < count && !status; m++) {
      if (!is_earlier(&t->corner, member[k], member[m])) break;
      if (m % 8 == 0) status = hr2di_watch_work(watch, 1);
      if (!status) status = examine_touching(t, member[k], member[m]);
    }
  }
  return status;
}

static hr2d_status find_touching(touching *t, hr2di_watch *watch) {
  const hr2d_scene *scene = t->scene;
  const hr2d_segment *first = &scene->patch[0].scaled;
  hr2di_stars stars;
  hr2d_status status = hr2di_stars_init(&stars, &scene->alloc, first, scene->patches,
                                        sizeof *scene->patch, watch);
  for (uint32_t k = 0; k < stars.count && !status; k++)
    status = examine_star(t, &stars.member[stars.star[k].first],
                          stars.star[k].last - stars.star[k].first, watch);
  if (!status)
    status = hr2di_crossings_find(&scene->alloc, first, scene->patches, sizeof *scene->patch,
                                  &stars, examine_touching, t, watch);
  hr2di_stars_clear(&stars);
  return status;
}

static void set_pair(hr2d_scene *scene, hr2d_effect effect, const hr2di_first_pair *pair,
                     const char *what, const char *none) {
  if (!pair->exists) {
    set(scene, effect, 0, "%s", none);
    return;
  }
  const hr2di_label first = hr2di_patch_label(scene, pair->i),
                    second = hr2di_patch_label(scene, pair->j);
  set(scene, effect, 1, "%s and %s %s", first.text, second.text, what);
}

static hr2d_status analyse_pairs(hr2d_scene *scene, const hr2di_hull *hull,
                                 hr2di_watch *watch) {
  touching t = {.scene = scene};
  hr2di_first_pair part = {0};
  hr2d_status status = find_touching(&t, watch);
  if (!status) status = hr2di_facing_in_part_find(scene, hull, &part, watch);
  set_pair(scene, HR2D_EFFECT_TWO_SIDED, &t.back, "stand back to back",
           "no two patches stand back to back, end to end");
  set_pair(scene, HR2D_EFFECT_FACING, &part, "see each other in part",
           "patches see each other wholly or not at all");
  set_pair(scene, HR2D_EFFECT_CORNER, &t.corner, "touch",
           "patches that see each other do not touch");
  return status;
}

/* Turns on the forced effects that the scene does not call for; their reasons say so. */
static void force(hr2d_scene *scene) {
  for (int e = 0; e < HR2D_EFFECT_COUNT; e++) {
    scene->effect[e].called_for = scene->effect[e].on;
    if (!scene->effect[e].forced || scene->effect[e].on) continue;
    char reason[sizeof scene->effect[e].reason];
    snprintf(reason, sizeof reason, "%s", scene->effect[e].reason);
    set(scene, (hr2d_effect)e, 1, "forced, though %.350s", reason);
  }
}

static hr2d_status analyse_occlusion(hr2d_scene *scene, const hr2di_hull *hull,
                                     hr2di_watch *watch) {
  hr2di_occlusion found;
  const hr2d_status status = hr2di_occluder_find(scene, hull, &found, watch);
  if (status) return status;
  if (found.exists)
    set(scene, HR2D_EFFECT_OCCLUSION, 1, "%s can stand between %s and %s",
        hr2di_patch_label(scene, found.occluder).text, hr2di_patch_label(scene, found.i).text,
        hr2di_patch_label(scene, found.j).text);
  else
    set(scene, HR2D_EFFECT_OCCLUSION, 0,
        "nothing can stand between patches that see each other");
  return HR2D_OK;
}

hr2d_status hr2di_scene_analyse_effects(hr2d_scene *scene, hr2di_watch *watch) {
  hr2di_hull hull;
  hr2d_status status = hr2di_hull_init(&hull, &scene->alloc, &scene->patch[0].scaled,
                                       scene->patches, sizeof *scene->patch, watch);
  if (!status) status = analyse_materials(scene, watch);
  analyse_background(scene);
  analyse_medium(scene);
  if (!status) status = analyse_pairs(scene, &hull, watch);
  if (!status) status = analyse_occlusion(scene, &hull, watch);
  hr2di_hull_clear(&hull);
  if (status) return hr2di_scene_fail(scene, status, watch, "the analysis");
  force(scene);
  return HR2D_OK;
}
