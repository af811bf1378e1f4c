/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What evolves in a climb: the genes of a scene and the target. */
#ifndef HR2D_TESTS_ADVERSARY_GENOME_H
#define HR2D_TESTS_ADVERSARY_GENOME_H

#include "adversary/answer.h"
#include "adversary/families.h"

typedef struct adv_genome {
  double gene[ADV_GENES];          /* each in [0, 1] */
  double important[ADV_IMPORTANT]; /* which patches count, each in [0, 1] */
  double target;                   /* the decimal logarithm, from −9 to −1 */
  size_t important_count;          /* does not evolve */
  hr2d_norm norm;                  /* does not evolve */
} adv_genome;

/* Any genome with this many genes.  Half of all seeds tell which patches count, which is for
   averages; a third of the others are in the sup norm. */
adv_genome adv_draw_genome(int genes, unsigned long seed, adv_random *r);

/* A parent with changes. */
adv_genome adv_mutate(const adv_genome *parent, int genes, adv_random *r);

/* What is asked of a scene with these patches. */
adv_question adv_question_of(const adv_genome *genome, size_t patches);

#endif
