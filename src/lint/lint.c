/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warnings about scenes: what was read, the coordinates, gaps and light. */
#include <math.h>
#include <stdio.h>

#include "base/sized-struct.h"
#include "lint/lint-impl.h"

static const char *const names[HR2D_WARNING_COUNT] = {
    [HR2D_WARNING_IGNORED] = "ignored",
    [HR2D_WARNING_MISPLACED] = "misplaced",
    [HR2D_WARNING_ALTITUDE] = "altitude",
    [HR2D_WARNING_DEGREES] = "degrees",
    [HR2D_WARNING_UNITS] = "units",
    [HR2D_WARNING_LOOSE_END] = "loose-end",
    [HR2D_WARNING_NARROW_GAP] = "narrow-gap",
    [HR2D_WARNING_NEAR_COPY] = "near-copy",
    [HR2D_WARNING_DARK_SCENE] = "dark-scene",
    [HR2D_WARNING_UNLIT] = "unlit",
    [HR2D_WARNING_SEES_NOTHING] = "sees-nothing",
    [HR2D_WARNING_NO_ABSORBER] = "no-absorber",
    [HR2D_WARNING_NO_SUNLIGHT] = "no-sunlight",
    [HR2D_WARNING_SEES_BACK] = "sees-back",
    [HR2D_WARNING_NO_SKY] = "no-sky",
    [HR2D_WARNING_SHIELD] = "shield",
    [HR2D_WARNING_LOW_SUN] = "low-sun",
    [HR2D_WARNING_SKIPPED] = "skipped",
};

const char *hr2d_warning_name(hr2d_warning_code code) {
  return (unsigned)code < HR2D_WARNING_COUNT ? names[code] : NULL;
}

static hr2di_lint_places places_of(const hr2di_note *n) {
  const char *name[HR2DI_NOTE_PLACES];
  for (size_t k = 0; k < n->places; k++) name[k] = n->place[k];
  return hr2di_lint_places_of(name, n->places, n->count);
}

static hr2d_status warn_of_note(const hr2di_lint *lint, const hr2di_note *n) {
  const hr2d_warning warning = {.code = n->code};
  const hr2di_lint_places at = places_of(n);
  const hr2di_message_quoted key = hr2di_message_quote(n->key);
  switch (n->code) {
  case HR2D_WARNING_ALTITUDE:
    if (*n->key)
      return hr2di_lint_warn(lint, warning,
                             "%s: some positions have two numbers, and others more, which are "
                             "not used: %s",
                             at.text, n->advice);
    return hr2di_lint_warn(lint, warning, "%s: third numbers of positions are not used: %s",
                           at.text, n->advice);
  case HR2D_WARNING_DEGREES: /* told with the coordinates */
    return HR2D_OK;
  case HR2D_WARNING_SKIPPED:
    return hr2di_lint_warn(lint, warning, "%s: %s", at.text, n->advice);
  default:
    return hr2di_lint_warn(lint, warning, "%s: %s is not used: %s", at.text, key.text,
                           n->advice);
  }
}

static hr2d_status warn_of_notes(const hr2di_lint *lint) {
  const hr2di_notes *notes = &lint->scene->notes;
  hr2d_status status = HR2D_OK;
  for (int code = 0; code < HR2D_WARNING_COUNT; code++)
    for (size_t k = 0; k < notes->count && !status; k++)
      if (notes->note[k].code == (hr2d_warning_code)code)
        status = warn_of_note(lint, &notes->note[k]);
  if (!status && notes->dropped)
    status = hr2di_lint_warn(lint, (hr2d_warning){.code = HR2D_WARNING_IGNORED},
                             "%zu more members of the file are not used, under other names "
                             "than those above",
                             notes->dropped);
  return status;
}

typedef struct box {
  double low[2], high[2];
  int whole; /* all coordinates are whole numbers */
} box;

static void enclose(box *b, hr2d_point p) {
  const double at[2] = {p.x, p.y};
  for (int k = 0; k < 2; k++) {
    b->low[k] = fmin(b->low[k], at[k]);
    b->high[k] = fmax(b->high[k], at[k]);
    b->whole &= at[k] == floor(at[k]);
  }
}

static int is_on_globe(const box *b) {
  return fmax(fabs(b->low[0]), fabs(b->high[0])) <= 180 &&
         fmax(fabs(b->low[1]), fabs(b->high[1])) <= 90;
}

/* A town is less than a degree across, and far from longitude 0 or from the equator. */
static int looks_like_degrees(const box *b, double across) {
  const double x = (b->low[0] + b->high[0]) / 2, y = (b->low[1] + b->high[1]) / 2;
  return across < 1 && fmax(fabs(x), fabs(y)) > 20 * across && !b->whole;
}

static int says_degrees(const hr2di_notes *notes) {
  size_t k = 0;
  while (k < notes->count && notes->note[k].code != HR2D_WARNING_DEGREES) k++;
  return k < notes->count;
}

/* The EPSG code of the zone of UTM, 6 degrees wide, around the middle of a box. */
static int utm_of(const box *b) {
  const int zone = (int)floor((b->low[0] + b->high[0]) / 12 + 30) % 60 + 1;
  return (b->low[1] + b->high[1] < 0 ? 32700 : 32600) + zone;
}

/* Some tools name a system of degrees beside any coordinates: what is beyond the globe has
   other lengths, whatever the file says. */
static hr2d_status warn_of_degrees(const hr2di_lint *lint, const box *b, double across) {
  const int said = says_degrees(&lint->scene->notes);
  if (!is_on_globe(b) || !(said || looks_like_degrees(b, across))) return HR2D_OK;
  return hr2di_lint_warn(lint, (hr2d_warning){.code = HR2D_WARNING_DEGREES},
                         "coordinates from (%.9g, %.9g) to (%.9g, %.9g) %s: lengths are then "
                         "in degrees, and the scene is distorted; project them to metres, for "
                         "example with ogr2ogr -t_srs EPSG:%d",
                         b->low[0], b->low[1], b->high[0], b->high[1],
                         said ? "are longitude and latitude, as \"crs\" says"
                              : "look like longitude and latitude",
                         utm_of(b));
}

/* Rooms of a hundred metres whose walls all have whole metres are rarer than drawings in
   centimetres. */
static int looks_like_centimetres(const box *b, double across) {
  return b->whole && across >= 100 && across <= 1e5;
}

static hr2d_status warn_of_coordinates(const hr2di_lint *lint) {
  box b = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, 1};
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < hr2di_scene_cell(lint->scene) && !status; k++) {
    status = hr2di_watch_work(lint->watch, 1);
    enclose(&b, lint->scene->patch[k].given.a);
    enclose(&b, lint->scene->patch[k].given.b);
  }
  const double across = fmax(b.high[0] - b.low[0], b.high[1] - b.low[1]);
  if (!status) status = warn_of_degrees(lint, &b, across);
  if (!status && looks_like_centimetres(&b, across))
    status = hr2di_lint_warn(
        lint, (hr2d_warning){.code = HR2D_WARNING_UNITS},
        "coordinates are whole numbers over a range of %.9g, like centimetres or millimetres: "
        "emission and power are then per centimetre or millimetre, too",
        across);
  return status;
}

static hr2d_status check_options(hr2d_lint_options *o, const hr2d_lint_options *given) {
  if (hr2di_sized_copy(o, sizeof *o, given)) return HR2D_EINVAL;
  if (!(o->gap >= 0 && o->gap <= .1)) return HR2D_EINVAL;
  if (o->gap == 0) o->gap = 1e-3;
  return HR2D_OK;
}

hr2d_status hr2d_scene_lint(const hr2d_scene *scene, hr2d_warning_fn warn, void *ctx,
                            const hr2d_lint_options *options) {
  if (!scene || !warn) return HR2D_EINVAL;
  hr2d_lint_options o = HR2D_LINT_OPTIONS_INIT;
  hr2di_watch watch;
  if (check_options(&o, options)) return HR2D_EINVAL;
  hr2di_scene_watch(scene, &watch, o.progress, o.progress_ctx, "lint");
  const hr2di_lint lint = {
      .scene = scene, .warn = warn, .ctx = ctx, .gap = o.gap, .watch = &watch};
  int blind = 0;
  hr2d_status status = warn_of_notes(&lint);
  if (scene->patches == 0) return status;
  if (!status) status = warn_of_coordinates(&lint);
  if (!status) status = hr2di_lint_heat(&lint);
  if (!status) status = hr2di_lint_gaps(&lint);
  if (!status && scene->committed) status = hr2di_lint_light(&lint, &blind);
  if (!status && scene->committed) status = hr2di_lint_suns(&lint, blind);
  return status;
}
