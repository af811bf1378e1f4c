/* SPDX-License-Identifier: GPL-3.0-or-later */
/* M(φ) of a sky in space as polynomials.  Between two places where M is not smooth, pieces are
   halved until

     |M − Σ c_l φ_l| · width ≤ τ E max(width/π, 1/64)

   at places between the nodes, with the sum E of the irradiances.  So the integral of the error
   is about τ E: wide pieces have a share of τ, and those narrower than π/64, which become
   narrower by halves towards a place, another one for all of a side. */
#include <hr2d/sky.h>
#include <math.h>

#include "base/alloc.h"
#include "base/pi.h"
#include "scene/scene-impl.h"
#include "scene/sky-model.h"
#include "scene/sky.h"

#define DEGREE (HR2DI_PI / 180)

/* Degrees: places that are nearer are one. */
#define SAME 1e-9

enum { NODES = HR2DI_SKY_TERMS, PLACES = 4, DEPTH = 40, WORK = 300 /* for a value of M */ };

/* Places between the nodes: beside both ends, and inside. */
static const double place[PLACES] = {-0.997, -0.384, 0.377, 0.998};

typedef struct fit {
  hr2d_scene *scene;
  hr2di_sky_section *section; /* per band */
  double *sample;             /* (nodes + places) × bands, of a piece */
  double *mark;               /* places between which pieces are halved, degrees, in order */
  size_t marks;
  hr2di_rule rule;
  hr2di_basis basis;
  hr2di_sky sky;
  size_t piece_room, row_room, goes_on_room;
  double tolerance;
  hr2di_watch *watch;
} fit;

static double irradiance_of(const hr2d_sky *sky) {
  return sky->irradiance + sky->disc_irradiance + sky->horizon_irradiance;
}

static hr2d_status refuse(fit *f, size_t band, const char *why) {
  return hr2di_message_fail(&f->scene->message, HR2D_ESCENE, "the sky of band %zu: %s", band,
                            why);
}

/* M at the nodes and the places of a piece. */
static hr2d_status take_samples(fit *f, hr2d_sky_piece p) {
  for (size_t q = 0; q < NODES + PLACES; q++) {
    const double xi = q < NODES ? f->rule.at[q] : place[q - NODES];
    const double bearing = (0.5 * (p.from + p.to) + 0.5 * (p.to - p.from) * xi) * DEGREE;
    for (size_t b = 0; b < f->sky.bands; b++) {
      const hr2d_status status = hr2di_watch_work(f->watch, WORK);
      if (status) return status;
      const double value = hr2di_sky_section_at(&f->section[b], bearing);
      if (!(value >= 0 && isfinite(value)))
        return refuse(f, b, "the radiosity is out of range");
      f->sample[q * f->sky.bands + b] = value;
    }
  }
  return HR2D_OK;
}

/* c_l is the mean of M φ_l: the polynomial through the nodes. */
static void set_coefficients(const fit *f, size_t band, double *c) {
  double phi[NODES];
  for (size_t l = 0; l < NODES; l++) c[l] = 0;
  for (size_t q = 0; q < NODES; q++) {
    hr2di_basis_at(&f->basis, f->rule.at[q], phi);
    for (size_t l = 0; l < NODES; l++)
      c[l] += f->rule.weight[q] * f->sample[q * f->sky.bands + band] * phi[l];
  }
}

static int fits(const fit *f, hr2d_sky_piece p) {
  const double width = (p.to - p.from) * DEGREE, share = fmax(width / HR2DI_PI, 1. / 64);
  for (size_t b = 0; b < f->sky.bands; b++) {
    double c[NODES], off = 0;
    set_coefficients(f, b, c);
    for (size_t q = 0; q < PLACES; q++)
      off = fmax(off, fabs(hr2di_basis_sum(&f->basis, place[q], c, 1) -
                           f->sample[(NODES + q) * f->sky.bands + b]));
    if (!(off * width <= f->tolerance * irradiance_of(&f->section[b].sky) * share)) return 0;
  }
  return 1;
}

static hr2d_status add_piece(fit *f, hr2d_sky_piece p, int goes_on) {
  hr2di_sky *sky = &f->sky;
  const hr2d_allocator *alloc = &f->scene->alloc;
  const size_t k = sky->pieces, row = sky->terms * sky->bands;
  if (k == HR2DI_SKY_PIECES)
    return hr2di_message_fail(
        &f->scene->message, HR2D_ESCENE,
        "the skies need more than %d pieces: a larger tolerance helps, or "
        "fewer bands",
        (int)HR2DI_SKY_PIECES);
  if (hr2di_alloc_reserve(alloc, &sky->piece, &f->piece_room, k + 1, sizeof *sky->piece) ||
      hr2di_alloc_reserve(alloc, &sky->goes_on, &f->goes_on_room, k + 1,
                          sizeof *sky->goes_on) ||
      hr2di_alloc_reserve(alloc, &sky->value, &f->row_room, k + 1, row * sizeof *sky->value))
    return HR2D_ENOMEM;
  for (size_t b = 0; b < sky->bands; b++) {
    double c[NODES];
    set_coefficients(f, b, c);
    for (size_t l = 0; l < NODES; l++) sky->value[k * row + l * sky->bands + b] = c[l];
  }
  sky->piece[k] = p;
  sky->goes_on[k] = goes_on != 0;
  sky->pieces++;
  return hr2di_watch_work(f->watch, row);
}

/* From left to right. */
static hr2d_status halve(fit *f, hr2d_sky_piece whole) {
  hr2d_sky_piece stack[DEPTH + 2];
  int count = 0;
  const size_t first = f->sky.pieces;
  const double least = ldexp(whole.to - whole.from, -DEPTH);
  stack[count++] = whole;
  while (count > 0) {
    const hr2d_sky_piece p = stack[--count];
    const double middle = 0.5 * (p.from + p.to);
    hr2d_status status = take_samples(f, p);
    if (status) return status;
    if (fits(f, p) || p.to - p.from < 2 * least) {
      status = add_piece(f, p, f->sky.pieces > first);
      if (status) return status;
    } else {
      stack[count++] = (hr2d_sky_piece){middle, p.to};
      stack[count++] = (hr2d_sky_piece){p.from, middle};
    }
  }
  return HR2D_OK;
}

/* Puts a mark into its place, unless it is one that is there. */
static void add_mark(fit *f, double at) {
  size_t k = f->marks;
  for (size_t m = 0; m < f->marks; m++)
    if (fabs(f->mark[m] - at) <= SAME) return;
  for (; k > 0 && f->mark[k - 1] > at; k--) f->mark[k] = f->mark[k - 1];
  f->mark[k] = at;
  f->marks++;
}

static hr2d_status find_marks(fit *f) {
  add_mark(f, -90);
  add_mark(f, 90);
  for (size_t b = 0; b < f->sky.bands; b++) {
    double at[HR2DI_SKY_BREAKS];
    const int count = hr2di_sky_section_breaks(&f->section[b], at);
    for (int k = 0; k < count; k++) add_mark(f, at[k] / DEGREE);
    const hr2d_status status = hr2di_watch_work(f->watch, f->marks);
    if (status) return status;
  }
  return HR2D_OK;
}

/* Skies lie struct_size apart, that of the caller. */
static hr2d_status read_skies(fit *f, const hr2d_sky *sky) {
  const size_t size = sky->struct_size;
  f->tolerance = 1;
  for (size_t b = 0; b < f->sky.bands; b++) {
    hr2d_sky own;
    const hr2d_sky *from = (const hr2d_sky *)(const void *)((const char *)sky + b * size);
    if (from->struct_size != size || size % sizeof(double) || hr2di_sky_copy(&own, from))
      return hr2di_message_fail(&f->scene->message, HR2D_EINVAL,
                                "the sky of band %zu has no struct_size", b);
    const char *problem = hr2di_sky_problem(&own);
    if (problem) return refuse(f, b, problem);
    f->tolerance = fmin(f->tolerance, hr2di_sky_tolerance(&own));
    const hr2d_status status = hr2di_watch_work(f->watch, (uint64_t)WORK * 1000);
    if (status) return status;
    hr2di_sky_section_init(&f->section[b], &own);
  }
  return HR2D_OK;
}

static hr2d_status make(fit *f, const hr2d_sky *sky) {
  const hr2d_allocator *alloc = &f->scene->alloc;
  const size_t bands = f->sky.bands;
  f->section = hr2di_alloc(alloc, bands, sizeof *f->section);
  f->sample = hr2di_alloc(alloc, bands, (NODES + PLACES) * sizeof *f->sample);
  f->mark = hr2di_alloc(alloc, bands, (HR2DI_SKY_BREAKS + 2) * sizeof *f->mark);
  hr2d_status status = f->section && f->sample && f->mark ? HR2D_OK : HR2D_ENOMEM;
  hr2di_rule_init(&f->rule, NODES);
  hr2di_basis_init(&f->basis, NODES);
  if (!status) status = read_skies(f, sky);
  if (!status) status = find_marks(f);
  for (size_t k = 0; k + 1 < f->marks && !status; k++)
    status = halve(f, (hr2d_sky_piece){f->mark[k], f->mark[k + 1]});
  return status ? status : hr2di_scene_check_sky(f->scene, &f->sky);
}

hr2d_status hr2di_scene_make_sky(hr2d_scene *scene, const hr2d_sky *sky, size_t bands,
                                 hr2di_watch *watch, hr2di_sky *made) {
  fit f = {.scene = scene, .watch = watch, .sky = {.terms = NODES, .bands = bands}};
  hr2d_status status = make(&f, sky);
  hr2di_alloc_free(&scene->alloc, f.section);
  hr2di_alloc_free(&scene->alloc, f.sample);
  hr2di_alloc_free(&scene->alloc, f.mark);
  *made = f.sky;
  if (!status) return HR2D_OK;
  hr2di_sky_clear(made, &scene->alloc);
  return status == HR2D_ENOMEM || hr2di_watch_status(watch)
             ? hr2di_scene_fail(scene, status, watch, "the sky")
             : status;
}

hr2d_status hr2d_scene_set_continuous_sky(hr2d_scene *scene, const hr2d_sky *sky,
                                          size_t bands) {
  hr2di_watch watch;
  hr2di_sky made;
  if (!scene || (bands && !sky)) return HR2D_EINVAL;
  if (scene->committed || bands == 0) return hr2d_scene_set_sky(scene, NULL, 0, NULL, 0);
  hr2di_scene_watch(scene, &watch, NULL, NULL, "sky");
  const hr2d_status status = hr2di_scene_make_sky(scene, sky, bands, &watch, &made);
  if (!status) hr2di_scene_take_sky(scene, &made);
  return status;
}
