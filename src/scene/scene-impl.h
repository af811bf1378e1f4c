/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The struct of a scene, for the modules that build, check and read it. */
#ifndef HR2D_SRC_SCENE_SCENE_IMPL_H
#define HR2D_SRC_SCENE_SCENE_IMPL_H

#include <hr2d/scene.h>
#include <hr2d/thermal.h>
#include <math.h>

#include "base/message.h"
#include "base/watch.h"
#include "occlusion/walls.h"
#include "scene/gas.h"
#include "scene/patch-runs.h"
#include "scene/plane.h"
#include "scene/reading-notes.h"
#include "scene/side-parts.h"
#include "scene/sky.h"
#include "scene/spectrum.h"
#include "scene/sunlight.h"
#include "scene/symmetry.h"

/* Emission and reflectance of a patch, and its thermal properties.  The segments of a feature,
   both sides of a patch and the pieces of a patch share one: otherwise a file of many values
   and many segments would take memory for the product of their numbers. */
typedef struct hr2di_light {
  size_t users;
  size_t emission_bands; /* 0, 1 or as many as the scene has; so are the others */
  size_t reflectance_bands;
  size_t transmittance_bands;
  size_t emissivity_bands;
  hr2d_heat heat;
  double given;   /* T or q; 0 without heat */
  double power;   /* of all patches with this light, from which q follows; 0: q is given */
  double across;  /* their length */
  size_t kelvins; /* for which there is an emissivity; 0: for all T the same */
  hr2d_emissivity_fn emissivity_of; /* NULL: none */
  void *emissivity_ctx;
  double value[]; /* emission, then reflectance, then emissivity, for each of the kelvins, then
                     these, then transmittance */
} hr2di_light;

typedef struct hr2di_patch {
  hr2d_segment given;  /* as added, in scene lengths */
  hr2d_segment scaled; /* divided by the unit; set by commit */
  double length;       /* of the scaled segment; set by commit */
  char *name;
  uint32_t
      feature; /* that of its file, counted from 1, which has no name; 0: none of several */
  unsigned char looks_in; /* it is a side of a polygon, and its front is inside */
  hr2di_light *light;
} hr2di_patch;

struct hr2d_scene {
  hr2d_allocator alloc;
  hr2di_message message;
  hr2d_progress_fn progress; /* for calls without one in their options */
  void *progress_ctx;
  int committed;
  hr2di_patch *patch;
  size_t patches, capacity;
  size_t bands;
  double *background; /* background_bands values; NULL for none */
  size_t background_bands;
  hr2di_sky sky;
  hr2d_sun *sun; /* sun_bands of them; NULL for none */
  size_t sun_bands;
  hr2di_spectrum spectrum;
  hr2di_symmetry symmetry;
  hr2di_gases gases;
  struct hr2di_regions *regions; /* made by commit if a gas has a border; else NULL */
  hr2di_notes notes;
  int exponent;      /* the unit is 2^exponent */
  hr2di_walls walls; /* the occluders; made by commit, as all that follows */
  hr2di_runs runs;
  hr2di_plane plane;      /* empty without the effects of occlusion and of the background, */
  hr2di_side_parts parts; /* and so are these; during commit there once they were needed */
  struct {
    int is;           /* during commit: there can be no plane, */
    uint32_t wall[2]; /* as of these walls, and too many others, nobody knows how they cross */
  } unclear;
  hr2di_sunlight sunlight; /* of the suns */
  unsigned char *dark;     /* per patch: 1 if no light reaches it; NULL if light reaches all */
  uint32_t *other_side;    /* per patch: see panes.h; NULL without the effect */
  struct {
    int on;
    int called_for; /* on although not forced */
    int forced;
    char reason[400];
  } effect[HR2D_EFFECT_COUNT];
  hr2d_scene **group; /* groups of bands through gas, see band-groups.h; NULL: one */
  size_t groups;
  const hr2d_scene
      *lender;      /* of a scene with other light, see relit-scene.h; otherwise NULL, */
  void *own_lights; /* as this: the lights of its patches that it owns, */
  size_t *band_of; /* and this: per band that of the lender; NULL: those of the lender repeat */
  const hr2d_scene *origin;  /* of a scene of frozen temperatures, see frozen-temperatures.h;
                                otherwise NULL, */
  struct hr2di_found *found; /* as this; per patch */
};

/* For readers of scene files. */
const hr2d_allocator *hr2di_scene_allocator(const hr2d_scene *scene);
hr2di_message *hr2di_scene_message(hr2d_scene *scene);
int hr2di_scene_committed(const hr2d_scene *scene);
hr2di_notes *hr2di_scene_notes(hr2d_scene *scene);

/* Whether a sun is valid; `number` is for the message.  HR2D_OK or HR2D_ESCENE. */
hr2d_status hr2di_scene_check_sun(hr2d_scene *scene, const hr2d_sun *sun, size_t number);

/* The scene owns an array of valid suns from its hooks from now on. */
void hr2di_scene_take_sun(hr2d_scene *scene, hr2d_sun *sun, size_t bands);

/* As hr2d_scene_add(), with thermal properties, which are valid, or NULL.  With a flux E may be
   negative. */
hr2d_status hr2di_scene_add(hr2d_scene *scene, const hr2d_patch *patch,
                            const hr2d_thermal *thermal, size_t *index);

/* As hr2d_scene_add(), but with the light of patch `like`. */
hr2d_status hr2di_scene_add_alike(hr2d_scene *scene, const hr2d_patch *patch, size_t like);

/* Removes all patches but the first `patches`. */
void hr2di_scene_truncate(hr2d_scene *scene, size_t patches);

/* Copies a patch, with a name of its own and another use of the light, so that `patch` can be
   freed.  A number from 1 on is added to the name.  HR2D_OK, or HR2D_ENOMEM with neither. */
hr2d_status hr2di_patch_copy(const hr2d_allocator *alloc, const hr2di_patch *patch,
                             size_t number, hr2di_patch *copy);

/* A patch as messages name it: patch 3 ("wall"). */
typedef struct hr2di_label {
  char text[128];
} hr2di_label;

hr2di_label hr2di_patch_label(const hr2d_scene *scene, size_t patch);

/* Of the patch that is to be added next, with a name or NULL. */
hr2di_label hr2di_new_patch_label(const hr2d_scene *scene, const char *name);

/* Removes the plane and its side parts. */
void hr2di_scene_clear_plane(hr2d_scene *scene);

/* Removes the results of commit. */
void hr2di_scene_clear_commit(hr2d_scene *scene);

/* Replaces a callback that is NULL by that of the scene, which may be NULL too. */
void hr2di_scene_choose_progress(const hr2d_scene *scene, hr2d_progress_fn *progress,
                                 void **ctx);

/* Sets up a watch that asks `progress`, or the callback of the scene if that is NULL. */
void hr2di_scene_watch(const hr2d_scene *scene, hr2di_watch *watch, hr2d_progress_fn progress,
                       void *ctx, const char *phase);

/* Leaves a message; returns `status`: that of the watch, or HR2D_ENOMEM for `what`. */
hr2d_status hr2di_scene_fail(hr2d_scene *scene, hr2d_status status, const hr2di_watch *watch,
                             const char *what);

/* Makes the plane and its side parts unless they are there, or cannot be: then that is unclear,
   and nothing is made.  HR2D_OK, HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_scene_need_plane(hr2d_scene *scene, hr2di_watch *watch);

/* Parts of commit, in the order of their calls.  Each leaves a message if it fails. */
hr2d_status hr2di_scene_check_bands(hr2d_scene *scene, hr2di_watch *watch);
hr2d_status hr2di_scene_check_thermal(hr2d_scene *scene, hr2di_watch *watch);
hr2d_status hr2di_scene_scale(hr2d_scene *scene, hr2di_watch *watch);
hr2d_status hr2di_scene_check_overlaps(hr2d_scene *scene, hr2di_watch *watch);
hr2d_status hr2di_scene_match_panes(hr2d_scene *scene, hr2di_watch *watch);
hr2d_status hr2di_scene_make_walls(hr2d_scene *scene, hr2di_watch *watch);
hr2d_status hr2di_scene_analyse_effects(hr2d_scene *scene, hr2di_watch *watch);
hr2d_status hr2di_scene_find_light(hr2d_scene *scene, hr2di_watch *watch);

static inline int hr2di_scene_has_sun(const hr2d_scene *scene) {
  for (size_t k = 0; k < scene->sun_bands; k++)
    if (scene->sun[k].irradiance > 0) return 1;
  return 0;
}

/* Whether a piece of the sky has light. */
static inline int hr2di_scene_has_sky(const hr2d_scene *scene) {
  const hr2di_sky *sky = &scene->sky;
  for (size_t k = 0; k < sky->pieces; k++)
    for (size_t b = 0; b < sky->bands; b++)
      if (sky->value[k * sky->terms * sky->bands + b] > 0) return 1;
  return 0;
}

/* The patches that were given; those behind them are images, and the ends of a period. */
static inline size_t hr2di_scene_cell(const hr2d_scene *scene) {
  return hr2di_symmetry_cell(&scene->symmetry, scene->patches);
}

/* The bands that wavelengths or weights make; 1 without. */
static inline size_t hr2di_scene_spectral_bands(const hr2d_scene *scene) {
  return hr2di_spectrum_bands(&scene->spectrum);
}

/* See spectrum.h. */
static inline double hr2di_scene_band_part(const hr2d_scene *scene, double kelvin,
                                           size_t band) {
  return hr2di_spectrum_part(&scene->spectrum, kelvin, band);
}
static inline double hr2di_scene_band_rise(const hr2d_scene *scene, double kelvin,
                                           size_t band) {
  return hr2di_spectrum_rise(&scene->spectrum, kelvin, band);
}

/* Whether a caller's index is that of a patch, or of an image. */
static inline int hr2di_scene_has(const hr2d_scene *scene, size_t patch) {
  return scene && patch < scene->patches;
}

/* The number of bands is not known before commit. */
static inline int hr2di_scene_has_band(const hr2d_scene *scene, size_t band) {
  return scene && (band < scene->bands || !scene->committed);
}

/* The patch of which another one is an image; itself, if it is none. */
static inline size_t hr2di_scene_original(const hr2d_scene *scene, size_t patch) {
  return hr2di_symmetry_original(&scene->symmetry, patch);
}

/* The other side of a pane; of any other patch itself. */
static inline size_t hr2di_scene_other_side(const hr2d_scene *scene, size_t patch) {
  return scene->other_side ? scene->other_side[patch] : patch;
}

static inline int hr2di_shield_is(const hr2d_scene *scene, size_t patch) {
  return scene->patch[patch].light->heat == HR2D_HEAT_SHIELD;
}

/* Whether its heat is given, and its temperature follows: of a shield that of both sides. */
static inline int hr2di_scene_has_flux(const hr2d_scene *scene, size_t patch) {
  return scene->patch[patch].light->heat == HR2D_HEAT_FLUX || hr2di_shield_is(scene, patch);
}

/* What leaves a patch of what falls on it: ρ, on a pane ρ + τ. */
static inline double hr2di_scene_scattered(const hr2d_scene *scene, size_t patch, size_t band) {
  const double rho = hr2d_scene_reflectance(scene, patch, band);
  return scene->other_side ? fmin(1, rho + hr2d_scene_transmittance(scene, patch, band)) : rho;
}

/* What stays there. */
static inline double hr2di_scene_absorptance(const hr2d_scene *scene, size_t patch,
                                             size_t band) {
  return 1 - hr2di_scene_scattered(scene, patch, band);
}

static inline int hr2di_scene_lit(const hr2d_scene *scene, size_t patch) {
  return !scene->dark || !scene->dark[patch];
}

#endif
