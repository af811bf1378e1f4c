/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The law of N and L: means over the phases of ε, which are known before anything is counted.
 */
#include <math.h>
#include <stdio.h>

#include "output/complain.h"
#include "study/study.h"

int study_find_law(study *s, hr2d_linkset *links, sweep *w) {
  hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
  refine.progress = sweep_show;
  refine.progress_ctx = w;
  if (!s->options->law) return 0;
  hr2d_status status = sweep_next(w, s, 0);
  if (!status) status = hr2d_study_law(links, &refine, &s->law);
  progress_clear(&w->line);
  s->lawful = !status;
  if (!status) return 0;
  s->count = 0; /* nothing to report */
  return complain_call(s->options->scene, hr2d_linkset_message(links), status);
}

double study_law_at(const hr2d_study_term term[STUDY_TERMS], double epsilon) {
  double sum = 0;
  for (int k = 0; k < STUDY_TERMS; k++)
    if (term[k].factor != 0) sum += term[k].factor * pow(epsilon, -term[k].power);
  return sum;
}

static double print_terms(const char *name, const hr2d_study_term term[STUDY_TERMS]) {
  double error = 0;
  int some = 0;
  printf("%s ≈ ", name);
  for (int k = 0; k < STUDY_TERMS; k++) {
    const double factor = term[k].factor;
    if (factor == 0) continue;
    if (some || factor < 0) printf(some ? " %c " : "%c", factor < 0 ? '-' : '+');
    printf("%.7g", fabs(factor));
    if (term[k].power > 0) printf(" ε^-%.4g", term[k].power);
    error = fmax(error, term[k].error);
    some = 1;
  }
  if (!some) putchar('0');
  return error;
}

void study_print_law(const study *s) {
  const hr2d_study_term *l = s->law.links, *n = s->law.elements;
  const double links = print_terms("\nlaw: L", l), elements = print_terms(", N", n);
  printf("\nmeans from ε to ε/%g; errors of the factors %.1e and %.1e", s->law.period, links,
         elements);
  if (n->factor > 0)
    printf("; L/N^%.4g → %.5g", l->power / n->power,
           l->factor / pow(n->factor, l->power / n->power));
  putchar('\n');
}
