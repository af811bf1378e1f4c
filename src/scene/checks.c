/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Commit's checks of the patches against each other, and their common scale. */
#include <math.h>
#include <stdio.h>

#include "geometry/crossings.h"
#include "geometry/hull.h"
#include "geometry/vector.h"
#include "scene/back-to-back.h"
#include "scene/scene-impl.h"

hr2d_status hr2di_scene_check_bands(hr2d_scene *scene, hr2di_watch *watch) {
  size_t bands = 1, setter = 0;
  const hr2d_status status = hr2di_watch_work(watch, scene->patches / 16);
  if (status) return hr2di_scene_fail(scene, status, watch, "");
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2di_light *light = scene->patch[k].light;
    static const char *const what[] = {"emission", "reflectance", "transmittance"};
    const size_t count[] = {light->emission_bands, light->reflectance_bands,
                            light->transmittance_bands};
    for (int c = 0; c < 3; c++) {
      if (count[c] <= 1) continue;
      if (bands > 1 && count[c] != bands)
        return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                                  "%s has %zu bands of %s where %s has %zu bands",
                                  hr2di_patch_label(scene, k).text, count[c], what[c],
                                  hr2di_patch_label(scene, setter).text, bands);
      if (bands == 1) setter = k;
      bands = count[c];
    }
  }
  scene->bands = bands;
  return HR2D_OK;
}

/* Divides by 2^exponent.  Returns 0 if that loses a digit, else 1. */
static int scale_point(hr2d_point given, int exponent, hr2d_point *scaled) {
  scaled->x = ldexp(given.x, -exponent);
  scaled->y = ldexp(given.y, -exponent);
  return ldexp(scaled->x, exponent) == given.x && ldexp(scaled->y, exponent) == given.y;
}

static double largest_coordinate(const hr2d_scene *scene) {
  double max = 0;
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2d_segment s = scene->patch[k].given;
    max = fmax(max, fmax(fmax(fabs(s.a.x), fabs(s.a.y)), fmax(fabs(s.b.x), fabs(s.b.y))));
  }
  return max;
}

/* A scene that is fewer roundings across than this has too few digits to decide which points
   touch a line. */
#define FEWEST_ROUNDINGS 0x1p+10

static double extent(const hr2d_scene *scene) {
  hr2d_point low = {HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL};
  for (size_t k = 0; k < scene->patches; k++) {
    const hr2d_segment s = scene->patch[k].scaled;
    low = (hr2d_point){fmin(low.x, fmin(s.a.x, s.b.x)), fmin(low.y, fmin(s.a.y, s.b.y))};
    high = (hr2d_point){fmax(high.x, fmax(s.a.x, s.b.x)), fmax(high.y, fmax(s.a.y, s.b.y))};
  }
  return fmax(high.x - low.x, high.y - low.y);
}

/* *convex is whether no patch has an end of another behind it, by exact signs.  One or two
   patches always count as convex: nothing can stand between them. */
static hr2d_status examine_convexity(const hr2d_scene *scene, int *convex, hr2di_watch *watch) {
  hr2di_hull hull;
  *convex = 1;
  if (scene->patches <= 2) return HR2D_OK;
  hr2d_status status = hr2di_hull_init(&hull, &scene->alloc, &scene->patch[0].scaled,
                                       scene->patches, sizeof *scene->patch, watch);
  for (size_t k = 0; k < scene->patches && *convex && !status; k++) {
    status = hr2di_watch_work(watch, 1);
    if (!status) *convex = !(hr2di_hull_sides(&hull, scene->patch[k].scaled) & 2);
  }
  hr2di_hull_clear(&hull);
  return status;
}

static hr2d_status check_offset(hr2d_scene *scene, hr2di_watch *watch) {
  const double across = extent(scene);
  int convex = 1;
  if (across >= FEWEST_ROUNDINGS * 0x1p-50) return HR2D_OK;
  const hr2d_status status = examine_convexity(scene, &convex, watch);
  if (status) return hr2di_scene_fail(scene, status, watch, "the checks");
  if (convex) return HR2D_OK;
  return hr2di_message_fail(
      &scene->message, HR2D_ERANGE,
      "the scene is so far from the origin, %.3g for %.3g across, that rounding "
      "leaves too few digits: move it to the origin",
      ldexp(1, scene->exponent), ldexp(across, scene->exponent));
}

/* Scaling by a power of two is exact unless a coordinate becomes subnormal. */
hr2d_status hr2di_scene_scale(hr2d_scene *scene, hr2di_watch *watch) {
  scene->exponent = ilogb(largest_coordinate(scene));
  for (size_t k = 0; k < scene->patches; k++) {
    hr2di_patch *p = &scene->patch[k];
    const hr2d_status status = hr2di_watch_work(watch, 1);
    if (status) return hr2di_scene_fail(scene, status, watch, "");
    if (!scale_point(p->given.a, scene->exponent, &p->scaled.a) ||
        !scale_point(p->given.b, scene->exponent, &p->scaled.b))
      return hr2di_message_fail(
          &scene->message, HR2D_ERANGE,
          "%s: its coordinates are too small beside the largest of the scene, "
          "about %g",
          hr2di_patch_label(scene, k).text, ldexp(1, scene->exponent));
    p->length = hypot(p->scaled.b.x - p->scaled.a.x, p->scaled.b.y - p->scaled.a.y);
    if (!isfinite(ldexp(p->length, scene->exponent)))
      return hr2di_message_fail(&scene->message, HR2D_ERANGE,
                                "%s: its length is beyond a double",
                                hr2di_patch_label(scene, k).text);
  }
  return check_offset(scene, watch);
}

static hr2d_point in_scene_lengths(const hr2d_scene *scene, hr2d_point p) {
  return (hr2d_point){ldexp(p.x, scene->exponent), ldexp(p.y, scene->exponent)};
}

static int is_between(const hr2d_segment *s, hr2d_point p, hr2d_point q) {
  return (hr2di_point_same(s->a, p) && hr2di_point_same(s->b, q)) ||
         (hr2di_point_same(s->a, q) && hr2di_point_same(s->b, p));
}

/* An end that is through another patch by so small a part of its own was meant to touch it. */
#define OVERSHOOT .02

static double overshoot(const hr2d_segment *s, hr2d_point x) {
  const double a = hypot(s->a.x - x.x, s->a.y - x.y), b = hypot(s->b.x - x.x, s->b.y - x.y);
  return fmin(a, b) <= OVERSHOOT * (a + b) ? fmin(a, b) : HUGE_VAL;
}

/* Of patch i and of what is added for another: nothing can cut that. */
static hr2d_status fail_crossed_image(hr2d_scene *scene, size_t i, size_t j, hr2d_point x) {
  const hr2d_point at = in_scene_lengths(scene, x);
  return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                            "%s and %s cross at (%.9g, %.9g): patches have to end there",
                            hr2di_patch_label(scene, i).text, hr2di_patch_label(scene, j).text,
                            at.x, at.y);
}

static hr2d_status fail_crossing(hr2d_scene *scene, size_t i, size_t j, hr2d_point x) {
  const hr2d_point at = in_scene_lengths(scene, x);
  const double of_i = overshoot(&scene->patch[i].scaled, x),
               of_j = overshoot(&scene->patch[j].scaled, x), through = fmin(of_i, of_j);
  if (through < HUGE_VAL)
    return hr2di_message_fail(
        &scene->message, HR2D_ESCENE,
        "%s and %s cross at (%.9g, %.9g), and %s ends %.3g behind it: hr2d_scene_snap() or "
        "--snap %.2g lets it end there, hr2d_scene_split_crossings() or --split-crossings cuts "
        "them",
        hr2di_patch_label(scene, i).text, hr2di_patch_label(scene, j).text, at.x, at.y,
        hr2di_patch_label(scene, of_i <= of_j ? i : j).text, ldexp(through, scene->exponent),
        ldexp(1.5 * through, scene->exponent));
  return hr2di_message_fail(&scene->message, HR2D_ESCENE,
                            "%s and %s cross at (%.9g, %.9g): hr2d_scene_split_crossings() or "
                            "--split-crossings cuts them there",
                            hr2di_patch_label(scene, i).text, hr2di_patch_label(scene, j).text,
                            at.x, at.y);
}

/* The stretch on which two patches lie on one another, and its length. */
static hr2di_label describe_stretch(const hr2d_scene *scene, const hr2di_meeting *m) {
  const hr2d_point p = in_scene_lengths(scene, m->from), q = in_scene_lengths(scene, m->to);
  hr2di_label label;
  snprintf(label.text, sizeof label.text, "from (%.9g, %.9g) to (%.9g, %.9g), %.3g long", p.x,
           p.y, q.x, q.y, hypot(q.x - p.x, q.y - p.y));
  return label;
}

/* What is the same but for roundings becomes one within this part of the shorter patch, and
   nothing else does. */
#define SNAP_PART 1e-6

#define SNAP "hr2d_scene_snap() or --snap %.2g drops it"

static hr2d_status fail_overlap(hr2d_scene *scene, size_t i, size_t j, const hr2di_meeting *m) {
  const hr2d_segment *s = &scene->patch[i].scaled, *t = &scene->patch[j].scaled;
  const hr2di_label first = hr2di_patch_label(scene, i), second = hr2di_patch_label(scene, j);
  const hr2di_label where = describe_stretch(scene, m);
  const double tolerance = ldexp(SNAP_PART * fmin(hypot(s->b.x - s->a.x, s->b.y - s->a.y),
                                                  hypot(t->b.x - t->a.x, t->b.y - t->a.y)),
                                 scene->exponent);
  const char *within = m->collinear ? "" : " within rounding";
  if (m->kind == HR2DI_MEET_FACE)
    return hr2di_message_fail(
        &scene->message, HR2D_ESCENE,
        "%s and %s face each other with no more than a rounding between them, "
        "%s: hr2d_scene_split_crossings() or --split-crossings puts them back to "
        "back; or use \"sides\": \"both\"",
        first.text, second.text, where.text);
  if (hr2di_point_same(s->a, t->a) && hr2di_point_same(s->b, t->b))
    return hr2di_message_fail(&scene->message, HR2D_ESCENE, "%s is a copy of %s, %s: " SNAP,
                              second.text, first.text, where.text, tolerance);
  const int first_inside = is_between(s, m->from, m->to);
  if (first_inside || is_between(t, m->from, m->to))
    return hr2di_message_fail(
        &scene->message, HR2D_ESCENE,
        "%s lies on %s%s with its front on the same side, %s: hr2d_scene_snap() or --snap %.2g "
        "keeps %s there, which comes first; a door or window that is to be seen comes before "
        "its wall, and at a hole the wall ends",
        first_inside ? first.text : second.text, first_inside ? second.text : first.text,
        within, where.text, tolerance, i < j ? first.text : second.text);
  return hr2di_message_fail(
      &scene->message, HR2D_ESCENE,
      "%s and %s lie on one another%s with their fronts on the same side, %s: " SNAP,
      first.text, second.text, within, where.text, tolerance);
}

/* Two images by one motion meet as their patches do, which were looked at, up to the roundings
   of the motion; ends of a period see nothing. */
static int meet_as_others(const hr2di_symmetry *s, size_t i, size_t j) {
  if (!s->motion || i < s->cell) return 0;
  const size_t images = s->motions * s->cell;
  return i < images ? i / s->cell == j / s->cell : j >= images;
}

/* Images overlap by roundings of the whole scene, as their motions begin far away. */
#define TOUCH 0x1p-45

static int only_touch(const hr2di_meeting *m) {
  return hypot(m->to.x - m->from.x, m->to.y - m->from.y) <= TOUCH;
}

/* A crossing with what commit has added. */
typedef struct added_crossing {
  size_t patch[2]; /* both 0: there is none */
  hr2d_point at;
} added_crossing;

/* Pairs that are refused behind the first one are counted, up to MOST_REFUSED. */
enum { MOST_REFUSED = 10000 };

typedef struct checker {
  hr2d_scene *scene;
  hr2d_status refused; /* HR2D_OK, or that of the first pair, whose message is there */
  size_t more;         /* pairs that are refused as well, */
  double through;      /* and how far ends of them go through the other at most; 0: none does */
  hr2di_steps steps;
  added_crossing image, end; /* the first ones */
  int rounds;                /* that are left in which images are moved */
} checker;

/* Is told only if no two patches cross as they were drawn, and of ends only if no images do:
   those follow from the others. */
static void note_crossing(checker *c, size_t i, size_t j, hr2d_point x) {
  added_crossing *a = hr2di_symmetry_is_end(&c->scene->symmetry, j) ? &c->end : &c->image;
  if (a->patch[1] == 0) *a = (added_crossing){{i, j}, x};
}

static hr2d_status fail_noted(const checker *c) {
  const added_crossing *a = c->image.patch[1] ? &c->image : &c->end;
  return a->patch[1] ? fail_crossed_image(c->scene, a->patch[0], a->patch[1], a->at) : HR2D_OK;
}

/* Crossings, and patches on one another.  One message is for all, so that a drawing is repaired
   in one step. */
static hr2d_status refuse(checker *c, size_t i, size_t j, const hr2di_meeting *m) {
  const int crosses = m->kind == HR2DI_MEET_CROSS;
  if (crosses) {
    const double through = fmin(overshoot(&c->scene->patch[i].scaled, m->from),
                                overshoot(&c->scene->patch[j].scaled, m->from));
    if (through < HUGE_VAL) c->through = fmax(c->through, through);
  }
  if (c->refused) return ++c->more < MOST_REFUSED ? HR2D_OK : c->refused;
  c->refused =
      crosses ? fail_crossing(c->scene, i, j, m->from) : fail_overlap(c->scene, i, j, m);
  return HR2D_OK;
}

/* Adds the others to the message. */
static hr2d_status tell_others(const checker *c) {
  hr2di_message *message = &c->scene->message;
  const char *most = c->more == MOST_REFUSED ? " or more" : "";
  char help[80] = "";
  if (!c->more) return c->refused;
  if (c->through > 0)
    snprintf(help, sizeof help, "; --snap %.2g repairs or cuts all",
             ldexp(1.5 * c->through, c->scene->exponent));
  return hr2di_message_fail(message, c->refused,
                            "%s; %zu%s more pairs cross or lie on one another%s", message->text,
                            c->more, most, help);
}

static hr2d_status check_pair(void *ctx, size_t i, size_t j) {
  checker *c = ctx;
  hr2d_scene *scene = c->scene;
  const hr2di_meeting m =
      hr2di_crossings_meet(&scene->patch[i].scaled, &scene->patch[j].scaled);
  if (m.kind == HR2DI_MEET_FREE) return HR2D_OK;
  if (m.kind == HR2DI_MEET_FACE && c->rounds > 0 &&
      hr2di_symmetry_is_image(&scene->symmetry, j))
    return hr2di_steps_add(&c->steps, scene, i, j, &m);
  if (meet_as_others(&scene->symmetry, i, j)) return HR2D_OK;
  if (m.kind == HR2DI_MEET_LIE && hr2di_symmetry_is_image(&scene->symmetry, j) &&
      only_touch(&m))
    return HR2D_OK;
  if (m.kind == HR2DI_MEET_CROSS && hr2di_symmetry_is_image(&scene->symmetry, j)) {
    note_crossing(c, i, j, m.from);
    return HR2D_OK;
  }
  return refuse(c, i, j, &m);
}

/* Rounds in which images are put back to back: what is moved for one pair may be in front of
   another by a rounding. */
enum { ROUNDS = 8 };

hr2d_status hr2di_scene_check_overlaps(hr2d_scene *scene, hr2di_watch *watch) {
  checker c = {.scene = scene, .rounds = scene->symmetry.motion ? ROUNDS : 0};
  hr2d_status status;
  do {
    status = hr2di_crossings_find(&scene->alloc, &scene->patch[0].scaled, scene->patches,
                                  sizeof *scene->patch, NULL, check_pair, &c, watch);
    if (status || c.refused || c.steps.count == 0) break;
    status = hr2di_steps_take(&c.steps, scene, watch);
    c.rounds--;
  } while (!status);
  hr2di_alloc_free(&scene->alloc, c.steps.step);
  if (c.refused && (!status || status == c.refused)) return tell_others(&c);
  if (!status) status = fail_noted(&c);
  if (status == HR2D_ENOMEM || hr2di_watch_status(watch))
    hr2di_scene_fail(scene, status, watch, "the checks");
  return status;
}
