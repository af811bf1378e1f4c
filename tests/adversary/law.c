/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws. */
#include "adversary/law.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "adversary/listed.h"
#include "adversary/transform.h"

enum { MOST_TRANSFORMS = 32 };

static size_t applicable(const adv_scene *scene, const adv_transform **found) {
  const int has[] = {[ADV_ANY] = 1,
                     [ADV_DAY] = adv_has_sun(scene) || adv_has_sky(scene),
                     [ADV_SYMMETRY] = adv_is_symmetric(scene)};
  size_t count = 0;
  for (const adv_transform *t = adv_transforms; t->name && count < MOST_TRANSFORMS; t++)
    if (has[t->need]) found[count++] = t;
  return count;
}

/* One to three transformations of those that are chosen. */
static void transform(adv_trial *trial, adv_scene *copy) {
  const adv_transform *known[MOST_TRANSFORMS];
  size_t count = applicable(trial->scene, known),
         wanted = (size_t)adv_int(&trial->random, 1, 3);
  for (int tries = 0; wanted > 0 && tries < 60; tries++) {
    const adv_transform *t = known[adv_int(&trial->random, 0, (int)count - 1)];
    if (!adv_listed(trial->transforms, t->name) || !t->apply(copy, &trial->random)) continue;
    size_t used = strlen(trial->applied);
    snprintf(trial->applied + used, sizeof trial->applied - used, "%s%s", used ? "+" : "",
             t->name);
    wanted--;
  }
}

static int bits(const adv_trial *trial) {
  int max = adv_bits(trial->scene);
  for (int c = 0; c < trial->copies; c++) {
    int other = adv_bits(&trial->copy[c]);
    if (other > max) max = other;
  }
  return max;
}

/* Asks for each scene, and judges each answer by itself. */
static void ask_all(adv_trial *trial, int original, const adv_question *question) {
  adv_points points = adv_choose_points(&trial->random, bits(trial));
  for (int c = original ? -1 : 0; c < trial->copies; c++) {
    adv_answer *answer = &trial->answer[c + 1];
    adv_ask(c < 0 ? trial->scene : &trial->copy[c], question[c + 1], &points, answer);
    if (trial->corruption) adv_corrupt(trial->corruption, answer, c == trial->copies - 1);
    adv_judge_alone(answer, &trial->outcome);
    adv_claims_of(answer, trial->scene, &trial->claims[c + 1]);
  }
}

/* The largest B and H at points are those at the points that were read.  Before a violation is
   believed more are read, and the claims made anew. */
static int look_closely(adv_trial *trial) {
  int doubt = 0;
  if (trial->looked++) return 0;
  for (int check = ADV_END_B; check <= ADV_POINT_H; check++) {
    if (check == ADV_AVERAGE_H) continue;
    double ratio = trial->outcome.worst[check];
    doubt |= ratio > 1 && ratio < 4;
    if (ratio > 1 && ratio < 4) trial->outcome.worst[check] = 0;
  }
  for (int c = 0; doubt && c <= trial->copies; c++) {
    adv_look_closely(&trial->answer[c]);
    if (trial->answer[c].scene)
      adv_claims_of(&trial->answer[c], trial->scene, &trial->claims[c]);
  }
  return doubt;
}

static int always(const adv_scene *scene) {
  return scene->count > 0;
}

/* A copy, perhaps for a finer target. */
static void copies_agree(adv_trial *trial) {
  static const double finer[] = {1, 1, 1e-1, 1e-3};
  adv_question question[2] = {trial->question, trial->question};
  trial->copies = 1;
  trial->copy[0] = *trial->scene;
  transform(trial, &trial->copy[0]);
  double factor = finer[adv_int(&trial->random, 0, 3)];
  if (!trial->fixed) question[1].error = fmax(1e-12, question[0].error * factor);
  ask_all(trial, 1, question);
  do adv_judge_claims(&trial->claims[0], &trial->claims[1], &trial->outcome);
  while (look_closely(trial));
}

/* The same scene for a finer target. */
static void finer_agrees(adv_trial *trial) {
  adv_question question[2] = {trial->question, trial->question};
  trial->copies = 1;
  trial->copy[0] = *trial->scene;
  question[1].error = fmax(1e-13, question[0].error * 1e-3);
  ask_all(trial, 1, question);
  adv_judge_end(&trial->answer[0], &trial->answer[1], &trial->outcome);
  do adv_judge_claims(&trial->claims[0], &trial->claims[1], &trial->outcome);
  while (look_closely(trial));
}

static void add_claims(adv_claim *sum, const adv_claim *term, size_t count) {
  for (size_t k = 0; k < count; k++) {
    sum[k].value += term[k].value;
    sum[k].error += term[k].error + 0x1p-53 * fabs(sum[k].value);
  }
}

/* A sun and a sky in two parts; dyadic parts add up exactly. */
static void part_day(adv_trial *trial, size_t band) {
  adv_scene *one = &trial->copy[0], *other = &trial->copy[1];
  double part = one->sun[band].irradiance > 0 ? adv_int(&trial->random, 0, 4) / 4.0 : 1;
  one->sun[band].irradiance *= part;
  other->sun[band].irradiance *= 1 - part;
  for (size_t k = 0; k < one->pieces; k++) {
    /* A mirror wants the same of all. */
    if (k == 0 || !one->mirrors) part = adv_int(&trial->random, 0, 4) / 4.0;
    one->piece[k].value[band] *= part;
    other->piece[k].value[band] *= 1 - part;
  }
}

/* The emission in two parts, the second one in a copy: B is their sum.  Parts are multiples of
   1/64, so that they add up exactly; the background goes with the first. */
static void emissions_superpose(adv_trial *trial) {
  adv_question question[3] = {trial->question, trial->question, trial->question};
  trial->copies = 2;
  trial->copy[0] = trial->copy[1] = *trial->scene;
  for (size_t band = 0; band < trial->scene->bands; band++) {
    for (size_t k = 0; k < trial->scene->count; k++)
      trial->copy[adv_int(&trial->random, 0, 1)].patch[k].emission[band] = 0;
    trial->copy[1].background[band] = trial->copy[1].hot[band] = 0;
    part_day(trial, band);
  }
  transform(trial, &trial->copy[1]);
  ask_all(trial, 1, question);
  if (!trial->claims[1].exist || !trial->claims[2].exist) return;
  do {
    adv_claims *sum = &trial->claims[1], *term = &trial->claims[2];
    add_claims(&sum->average[0][0][0], &term->average[0][0][0],
               sizeof sum->average / sizeof(adv_claim));
    add_claims(&sum->point[0][0][0][0], &term->point[0][0][0][0],
               sizeof sum->point / sizeof(adv_claim));
    adv_judge_claims(&trial->claims[0], sum, &trial->outcome);
  } while (look_closely(trial));
}

static int has_pairs(const adv_scene *scene) {
  return scene->count > 1;
}

/* G = K + KρK + … is symmetric: with E = 1 on i alone, A_j H_j is A_i H_i with E = 1 on j. */
static void exchange_is_reciprocal(adv_trial *trial) {
  adv_question question[3] = {trial->question, trial->question, trial->question};
  int n = (int)trial->scene->count, end[2];
  end[0] = adv_int(&trial->random, 0, n - 1);
  end[1] = (end[0] + adv_int(&trial->random, 1, n - 1)) % n;
  trial->copies = 2;
  for (int c = 0; c < 2; c++) {
    trial->copy[c] = *trial->scene;
    for (size_t band = 0; band < trial->scene->bands; band++) {
      for (int k = 0; k < n; k++) trial->copy[c].patch[k].emission[band] = k == end[c];
      trial->copy[c].background[band] = trial->copy[c].hot[band] = 0;
      trial->copy[c].sun[band].irradiance = 0;
    }
    trial->copy[c].pieces = 0;
  }
  transform(trial, &trial->copy[1]);
  ask_all(trial, 0, question);
  if (!trial->claims[1].exist || !trial->claims[2].exist) return;
  for (size_t band = 0; band < trial->scene->bands; band++) {
    adv_claim power[2];
    for (int c = 0; c < 2; c++) {
      /* A product with a length of 2 roundings. */
      adv_claim h = trial->claims[c + 1].average[ADV_H][end[1 - c]][band];
      double length = adv_length(trial->scene, (size_t)end[1 - c]);
      power[c].value = length * h.value;
      power[c].error = length * h.error + 4 * 0x1p-53 * power[c].value;
    }
    char what[80];
    snprintf(what, sizeof what, "power between %d and %d, band %zu", end[0], end[1], band);
    adv_judge_pair(&trial->outcome, ADV_AVERAGE_H, power[0], power[1], what);
  }
}

static int is_closed(const adv_scene *scene) {
  return scene->closed;
}

/* E = 1 − ρ in a closed room, whatever the background: B = H = 1 everywhere, also in gas of
   E_g = 1 or without heat of its own. */
static void furnace_is_even(adv_trial *trial) {
  adv_question question[2] = {trial->question, trial->question};
  adv_scene *copy = &trial->copy[0];
  trial->copies = 1;
  *copy = *trial->scene;
  for (size_t band = 0; band < copy->bands; band++) {
    for (size_t k = 0; k < copy->count; k++)
      copy->patch[k].emission[band] = 1 - adv_scattered(&copy->patch[k], band);
    copy->background[band] = adv_has_gas(copy) ? 0 : adv_int(&trial->random, 0, 1) / 2.0;
    copy->hot[band] = !copy->heated;
    copy->warm = 1;
  }
  transform(trial, copy);
  ask_all(trial, 0, question);
  adv_claims *truth = &trial->claims[0];
  memset(truth, 0, sizeof *truth);
  truth->exist = 1;
  truth->count = trial->scene->count;
  truth->bands = trial->scene->bands;
  for (int q = 0; q < ADV_QUANTITIES; q++)
    for (size_t k = 0; k < truth->count; k++)
      for (size_t band = 0; band < truth->bands; band++) {
        truth->average[q][k][band].value = 1;
        for (int j = 0; j < ADV_POINTS; j++) truth->point[q][k][j][band].value = 1;
      }
  do adv_judge_claims(truth, &trial->claims[1], &trial->outcome);
  while (look_closely(trial));
}

static int has_one_sun(const adv_scene *scene) {
  return scene->bands == 1 && !scene->closed && adv_has_sun(scene) && !adv_has_sky(scene);
}

/* A piece of 2^-20 degrees about the sun, which gives I on a surface across it.  Its bearings
   are multiples of 2^-24 degrees; directions of them may be off by 2^-50. */
static void narrow_sky(adv_scene *scene) {
  const double degree = 3.14159265358979323846 / 180;
  adv_sun *sun = &scene->sun[0];
  double bearing = atan2(-(double)sun->x, -(double)sun->y) / degree;
  adv_piece *p = &scene->piece[scene->pieces++];
  p->from = ldexp(rint(ldexp(bearing, 24)) - 8, -24);
  p->to = p->from + 0x1p-20;
  p->value[0] = scene->background[0] + sun->irradiance / sin(0x1p-21 * degree);
  sun->irradiance = 0;
}

/* How far the light of the narrow sky is off.  An edge of a shadow is as wide as its angle δ at
   the distance D of what casts it: from each of 2n ends a patch gets up to IδD more power or
   less, and up to Iδ on its length.  All patches reflect up to ρ/(1 − ρ) of what they get, and
   all of that may come to one.  The width is known to 2^-50/δ. */
static void widen_for_narrow_sky(const adv_scene *scene, adv_claims *claims) {
  const double delta = 2e-8, rounding = 0x1p-50 / delta;
  adv_extent e = adv_extent_of(scene);
  double n = (double)scene->count, max = 0;
  double across = ldexp(hypot((double)(e.high[0] - e.low[0]), (double)(e.high[1] - e.low[1])),
                        scene->exponent);
  for (size_t k = 0; k < scene->count; k++) max = fmax(max, adv_scattered(&scene->patch[k], 0));
  for (size_t k = 0; k < scene->count; k++) {
    double length = adv_length(scene, k);
    double own =
        scene->sun[0].irradiance * (delta * (2 * n * across + length) + rounding * length);
    for (int q = 0; q < ADV_QUANTITIES; q++) {
      claims->average[q][k][0].error += own * (1 + n * max / (1 - max)) / length;
      for (int j = 0; j < ADV_POINTS; j++) claims->point[q][k][j][0].error = INFINITY;
    }
  }
}

/* Averages under a sun are those under a narrow bright piece of the sky. */
static void sun_is_a_narrow_sky(adv_trial *trial) {
  adv_question question[2] = {trial->question, trial->question};
  trial->copies = 1;
  trial->copy[0] = *trial->scene;
  narrow_sky(&trial->copy[0]);
  question[0].norm = question[1].norm = HR2D_NORM_AVERAGE;
  ask_all(trial, 1, question);
  widen_for_narrow_sky(trial->scene, &trial->claims[1]);
  adv_judge_claims(&trial->claims[0], &trial->claims[1], &trial->outcome);
}

const adv_law adv_laws[] = {{"copy", 10, always, copies_agree},
                            {"finer", 2, always, finer_agrees},
                            {"superposition", 2, always, emissions_superpose},
                            {"reciprocity", 2, has_pairs, exchange_is_reciprocal},
                            {"furnace", 2, is_closed, furnace_is_even},
                            {"narrow", 2, has_one_sun, sun_is_a_narrow_sky},
                            {NULL, 0, NULL, NULL}};

const adv_law *adv_draw_law(const adv_scene *scene, adv_random *r) {
  int sum = 0;
  for (const adv_law *law = adv_laws; law->name; law++)
    if (law->holds_for(scene)) sum += law->weight;
  int place = adv_int(r, 0, sum - 1);
  for (const adv_law *law = adv_laws;; law++) {
    if (law->holds_for(scene)) place -= law->weight;
    if (place < 0) return law;
  }
}

void adv_end_trial(adv_trial *trial) {
  for (int c = 0; c < 3; c++) {
    adv_forget(&trial->answer[c]);
    trial->answer[c].scene = NULL;
  }
}

void adv_try(adv_trial *trial, const adv_law *law) {
  adv_end_trial(trial);
  trial->copies = trial->looked = 0;
  trial->applied[0] = 0;
  memset(&trial->outcome, 0, sizeof trial->outcome);
  law->test(trial);
}
