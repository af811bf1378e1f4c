/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evaluations of climbs. */
#include "adversary/measure.h"

#include <math.h>
#include <string.h>

#include "adversary/law.h"

/* The truth is a solve with all patches, for a target a thousand times smaller, or for a tenth
   of the estimates of averages.  Nothing smaller than 1e-12 is asked for: there roundings are
   what remains. */
static adv_question finer(const adv_answer *a, int sharp) {
  adv_question q = a->question;
  const double estimate = fmin(a->account.average.estimate, a->account.irradiance.estimate);
  q.error = fmax(1e-12, fmin(1e-3 * q.error, sharp ? 0.1 * estimate : INFINITY));
  q.important_count = 0;
  q.stop *= 4;
  return q;
}

/* Errors of averages that are larger than they should be, and of which the truth may be the
   reason. */
static int is_blurred(const adv_measure *m) {
  const adv_answer *a = &m->asked;
  for (size_t k = 0; k < a->scene->count; k++)
    for (int q = 0; q < ADV_QUANTITIES; q++) {
      const adv_claim *one = &m->claimed.average[q][k][0], *two = &m->right.average[q][k][0];
      const double apart = fabs(one->value - two->value);
      const hr2d_error *e = q ? &a->account.irradiance : &a->account.average;
      const double likely = one->error * (e->bound > 0 ? e->estimate / e->bound : 1);
      if (apart > fmin(3 * likely, one->error / 2) && two->error > apart / 10) return 1;
    }
  return 0;
}

/* Bounds below this are bounds of roundings, of which estimates know nothing. */
#define ROUNDINGS 1e-11

/* |error| / estimate of averages of B, with what the truth may be off taken from the error, and
   what roundings may be.  An estimate of 0 is right if nothing remains. */
static double over_estimate(const adv_measure *m) {
  const adv_answer *a = &m->asked;
  double max = 0;
  for (size_t k = 0; k < a->scene->count; k++) {
    if (!adv_is_asked(&a->question, k)) continue;
    const adv_claim *one = &m->claimed.average[ADV_B][k][0];
    const adv_claim *two = &m->right.average[ADV_B][k][0];
    const double scale =
        fmax(fabs(two->value), a->question.floor * m->truth.brightest[ADV_B][0]);
    const double off = fabs(one->value - two->value) - two->error -
                       fmin(one->error, ROUNDINGS * scale) - 0x1p-53 * one->value;
    if (off > 0) max = fmax(max, off / scale / a->account.average.estimate);
  }
  return max;
}

static double worst(const adv_outcome *o, adv_check one, adv_check two) {
  return fmax(o->worst[one], o->worst[two]);
}

/* Compares the claims of both answers. */
static void compare(adv_measure *m) {
  adv_outcome *o = &m->outcome;
  memset(o, 0, sizeof *o);
  adv_claims_of(&m->asked, m->asked.scene, &m->claimed);
  adv_claims_of(&m->truth, m->truth.scene, &m->right);
  adv_judge_alone(&m->asked, o);
  adv_judge_claims(&m->claimed, &m->right, o);
  m->ratio[ADV_CLIMB_B] = o->worst[ADV_AVERAGE_B];
  m->ratio[ADV_CLIMB_H] = o->worst[ADV_AVERAGE_H];
  m->ratio[ADV_CLIMB_POINT] =
      fmax(worst(o, ADV_END_B, ADV_POINT_B), worst(o, ADV_END_H, ADV_POINT_H));
  m->ratio[ADV_CLIMB_ESTIMATE] = over_estimate(m);
}

/* A truth for a larger target than this may be the one that is off. */
#define SURE 1e-8

/* Whether errors at points may come from a largest value that was not read. */
static int points_are_doubtful(const adv_measure *m) {
  return m->ratio[ADV_CLIMB_POINT] > 1;
}

static void doubt(adv_measure *m, const adv_points *points) {
  if (m->truth.question.error > SURE) {
    adv_question q = m->truth.question;
    q.error = fmin(SURE, 1e-3 * q.error);
    adv_forget(&m->truth);
    adv_ask(m->asked.scene, q, points, &m->truth);
    m->exists = m->truth.solution != NULL;
    if (!m->exists) return;
    compare(m);
  }
  if (!points_are_doubtful(m)) return;
  adv_look_closely(&m->asked);
  adv_look_closely(&m->truth);
  compare(m);
}

void adv_take_measure(const adv_scene *scene, const adv_question *question,
                      const char *corruption, adv_measure *m) {
  adv_random r = {scene->count};
  const adv_points points = adv_choose_points(&r, adv_bits(scene));
  m->exists = 0;
  memset(m->ratio, 0, sizeof m->ratio);
  memset(&m->truth, 0, sizeof m->truth);
  adv_ask(scene, *question, &points, &m->asked);
  if (corruption) adv_corrupt(corruption, &m->asked, 1);
  for (int sharp = 0; sharp < 2 && m->asked.solution; sharp++) {
    adv_forget(&m->truth);
    adv_ask(scene, finer(&m->asked, sharp), &points, &m->truth);
    m->exists = m->truth.solution != NULL;
    if (!m->exists) break;
    compare(m);
    if (!is_blurred(m)) break;
  }
  if (m->exists && adv_violations(&m->outcome)) doubt(m, &points);
  adv_forget(&m->asked);
  adv_forget(&m->truth);
}
