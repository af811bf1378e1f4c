/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Negative controls: answers that are wrong by a few times their stated errors, and accounts
   that are wrong.  The adversary must report each of them. */
#include <math.h>
#include <string.h>

#include "adversary/law.h"

const char *const adv_corruptions[] = {
    "average-b", "average-h", "point-b", "point-h", "end-b",  "end-h", "power", "negative",
    "estimate",  "infinite",  "bound",   "status",  "reason", "hill",  NULL};

/* Every average is too large by some of its errors. */
static void raise_averages(adv_answer *a, int q, double errors) {
  double wrong[ADV_PATCHES][ADV_BANDS];
  for (size_t k = 0; k < a->scene->count; k++)
    for (size_t band = 0; band < a->scene->bands; band++)
      wrong[k][band] = a->average[q][k][band] + errors * adv_average_error(a, q, k, band);
  for (size_t k = 0; k < a->scene->count; k++)
    memcpy(a->average[q][k], wrong[k], a->scene->bands * sizeof(double));
}

static void raise_points(adv_answer *a, int q, int first, int end) {
  for (size_t k = 0; k < a->scene->count; k++) {
    int source = a->scene->patch[k].source;
    for (int j = first; source >= 0 && j < end; j++)
      for (size_t band = 0; band < a->scene->bands; band++)
        a->point[q][source][j][band] += 10 * adv_point_error(a, q, k, band);
  }
}

/* The errors of B are the larger, the closer the length of the first patch is to 1.5: a hundred
   of those that are stated within a thousandth of it, where few scenes are by chance, and a
   tenth far away. */
static void raise_hill(adv_answer *a) {
  const double away = fabs(log(adv_length(a->scene, 0) / 1.5));
  raise_averages(a, ADV_B, 1000 / (1 + 1e4 * away));
}

static void divide_bounds(adv_answer *a) {
  a->account.average.bound *= 1e-9;
  a->account.average.estimate *= 1e-9;
  a->account.sup.bound *= 1e-9;
  a->account.sup.estimate *= 1e-9;
#if ADV_ACCOUNT_OF_H
  a->account.irradiance.bound *= 1e-9;
  a->account.irradiance.estimate *= 1e-9;
  a->account.irradiance_sup.bound *= 1e-9;
  a->account.irradiance_sup.estimate *= 1e-9;
#endif
}

void adv_corrupt(const char *how, adv_answer *a, int last) {
  static const char *const part[] = {"-b", "-h"};
  if (!a->solution) return;
  if (!strcmp(how, "bound")) divide_bounds(a);
  if (!last) return;
  for (int q = 0; q < ADV_QUANTITIES; q++) {
    const char *end = strrchr(how, '-');
    if (!end || strcmp(end, part[q])) continue;
    if (!strncmp(how, "average", 7)) raise_averages(a, q, 10);
    if (!strncmp(how, "point", 5)) raise_points(a, q, ADV_ENDS, ADV_POINTS);
    if (!strncmp(how, "end", 3)) raise_points(a, q, 0, ADV_ENDS);
  }
  if (!strcmp(how, "hill")) raise_hill(a);
  if (!strcmp(how, "power")) a->power[0].escaped += 1e-3 * a->power[0].emitted;
  if (!strcmp(how, "negative")) a->average[ADV_H][0][0] = -1e-300;
  if (!strcmp(how, "estimate")) a->account.sup.estimate = a->account.sup.bound * (1 + 1e-15);
  if (!strcmp(how, "infinite")) a->account.average.bound = INFINITY, a->status = HR2D_OK;
  if (!strcmp(how, "status")) a->status = HR2D_OK, a->question.error = 0;
  if (!strcmp(how, "reason")) strcpy(a->account.reason, "no reason");
}
