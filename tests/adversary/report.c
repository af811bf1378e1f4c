/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables in Markdown, which are read as text as well. */
#include "adversary/report.h"

#include <math.h>

static double larger(double a, double b) {
  return a > b ? a : b;
}

void adv_add_outcome(adv_row *row, const adv_outcome *outcome) {
  row->runs++;
  row->answers += outcome->answers;
  row->unreached += outcome->unreached;
  row->none += outcome->none;
  row->compared += outcome->compared;
  row->vacuous += outcome->vacuous;
  row->violated += adv_violations(outcome) > 0;
  row->longest = larger(row->longest, outcome->longest);
  for (int check = 0; check < ADV_CHECKS; check++) {
    row->violations[check] += outcome->worst[check] > 1;
    row->worst[check] = larger(row->worst[check], outcome->worst[check]);
  }
}

void adv_add_row(adv_row *sum, const adv_row *row) {
  sum->runs += row->runs;
  sum->refused += row->refused;
  sum->answers += row->answers;
  sum->unreached += row->unreached;
  sum->none += row->none;
  sum->compared += row->compared;
  sum->vacuous += row->vacuous;
  sum->violated += row->violated;
  sum->longest = larger(sum->longest, row->longest);
  for (int check = 0; check < ADV_CHECKS; check++) {
    sum->violations[check] += row->violations[check];
    sum->worst[check] = larger(sum->worst[check], row->worst[check]);
  }
}

/* A ratio with two digits; bold if it is a violation. */
static void print_ratio(FILE *file, double ratio) {
  const char *bold = ratio > 1 ? "**" : "";
  if (isinf(ratio))
    fprintf(file, " %syes%s |", bold, bold);
  else
    fprintf(file, " %s%.2g%s |", bold, ratio, bold);
}

static void print_row(FILE *file, const adv_row *row) {
  double other = 0;
  for (int check = ADV_NEGATIVE; check < ADV_CHECKS; check++)
    other = larger(other, row->worst[check]);
  fprintf(file, "| %s | %u | %u | %u | %u | %u |", row->name, row->runs, row->violated,
          row->answers, row->unreached, row->none);
  for (int check = 0; check <= ADV_POWER; check++) print_ratio(file, row->worst[check]);
  if (other > 1)
    print_ratio(file, other);
  else
    fprintf(file, " no |");
  fprintf(file, " %.1f |\n", row->longest);
}

void adv_print_table(FILE *file, const char *title, const adv_row *row, size_t count) {
  adv_row all = {.name = "all"};
  fprintf(file, "| %s | runs | violated | solves | not reached | none |", title);
  for (int check = 0; check <= ADV_POWER; check++)
    fprintf(file, " %s |", adv_check_name[check]);
  fprintf(file, " other | longest, s |\n|---|---|---|---|---|---|");
  for (int check = 0; check <= ADV_POWER; check++) fprintf(file, "---|");
  fprintf(file, "---|---|\n");
  for (size_t k = 0; k < count; k++) {
    if (row[k].runs) print_row(file, &row[k]);
    adv_add_row(&all, &row[k]);
  }
  print_row(file, &all);
}

void adv_print_checks(FILE *file, const adv_row *all) {
  fprintf(file, "| check | runs that violate it | worst |\n|---|---|---|\n");
  for (int check = 0; check < ADV_CHECKS; check++) {
    fprintf(file, "| %s | %u |", adv_check_name[check], all->violations[check]);
    print_ratio(file, all->worst[check]);
    fprintf(file, "\n");
  }
}
