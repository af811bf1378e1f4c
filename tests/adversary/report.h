/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of many trials. */
#ifndef HR2D_TESTS_ADVERSARY_REPORT_H
#define HR2D_TESTS_ADVERSARY_REPORT_H

#include <stdio.h>

#include "adversary/judge.h"

typedef struct adv_row {
  const char *name;
  unsigned runs, refused; /* refused: scenes that were drawn again */
  unsigned answers, unreached, none, compared, vacuous;
  unsigned violated; /* runs with a violation */
  unsigned violations[ADV_CHECKS];
  double worst[ADV_CHECKS];
  double longest;
} adv_row;

void adv_add_outcome(adv_row *row, const adv_outcome *outcome);

/* Adds a row to another. */
void adv_add_row(adv_row *sum, const adv_row *row);

/* A table with a line per row that has runs, and one for all. */
void adv_print_table(FILE *file, const char *title, const adv_row *row, size_t count);

/* Violations by check. */
void adv_print_checks(FILE *file, const adv_row *all);

#endif
