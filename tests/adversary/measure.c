/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evaluations of climbs. */
#include "adversary/measure.h"

#include <math.h>
#include <string.h>

#include "adversary/law.h"

/* The truth is a solve with all patches, for a target a thousand times smaller, and so small
   that what remains is a tenth of the estimates of averages.  Nothing smaller than 1e-12 is
   asked for: there roundings are what remains. */
static adv_question finer(const adv_answer *a) {
  adv_question q = a->question;
  const double estimate = fmin(a->account.average.estimate, a->account.irradiance.estimate);
  q.error = fmax(1e-12, fmin(1e-3 * q.error, 0.1 * estimate));
  q.important_count = 0;
  return q;
}

/* |error| / estimate of averages of B, with what the truth may be off taken from the error.  An
   estimate of 0 is right if the error is none. */
static double over_estimate(const adv_measure *m) {
  const adv_answer *a = &m->asked;
  double most = 0;
  for (size_t k = 0; k < a->scene->count; k++) {
    if (!adv_is_asked(&a->question, k)) continue;
    const adv_claim *one = &m->claimed.average[ADV_B][k][0];
    const adv_claim *two = &m->right.average[ADV_B][k][0];
    const double scale =
        fmax(fabs(two->value), a->question.floor * m->truth.brightest[ADV_B][0]);
    const double off = fabs(one->value - two->value) - two->error - 0x1p-53 * one->value;
    if (off > 0) most = fmax(most, off / scale / a->account.average.estimate);
  }
  return most;
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

/* The largest values at points may be elsewhere, and the truth may be the one that is off. */
static void doubt(adv_measure *m, const adv_points *points) {
  adv_question q = finer(&m->truth);
  q.error = fmax(1e-13, fmin(q.error, 1e-9));
  adv_forget(&m->truth);
  adv_ask(m->asked.scene, q, points, &m->truth);
  adv_look_closely(&m->asked);
  adv_look_closely(&m->truth);
  if (m->truth.solution) compare(m);
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
  if (m->asked.solution) adv_ask(scene, finer(&m->asked), &points, &m->truth);
  if (m->truth.solution) {
    m->exists = 1;
    compare(m);
    if (adv_violations(&m->outcome)) doubt(m, &points);
  }
  adv_forget(&m->asked);
  adv_forget(&m->truth);
}
