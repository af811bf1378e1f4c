/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Genomes. */
#include "adversary/genome.h"

#include <math.h>

static const double coarsest = -1, finest = -9;

/* The sizes of steps, as decimal logarithms: errors rise over much of a family, and have peaks
   that are narrow. */
static const double min_step = -5, largest_step = -0.3;

static double normal(adv_random *r) {
  const double u = adv_real(r, 0, 1), v = adv_real(r, 0, 1);
  return sqrt(-2 * log(1 - u)) * cos(6.283185307179586 * v);
}

/* Beyond 0 or 1 a gene is reflected. */
static double reflected(double gene) {
  gene = fmod(fabs(gene), 2);
  return gene > 1 ? 2 - gene : gene;
}

/* Steps of any size; now and then another place, a round number, or the value of another gene:
   so vertices come into line. */
static double mutated(const adv_genome *g, int genes, int k, adv_random *r) {
  const double what = adv_real(r, 0, 1);
  if (what < 0.05) return adv_real(r, 0, 1);
  if (what < 0.1) {
    const double parts = adv_int(r, 2, 32);
    return round(g->gene[k] * parts) / parts;
  }
  if (what < 0.15) return g->gene[adv_int(r, 0, genes - 1)];
  const double step = pow(10, adv_real(r, min_step, largest_step));
  return reflected(g->gene[k] + step * normal(r));
}

adv_genome adv_draw_genome(int genes, unsigned long seed, adv_random *r) {
  adv_genome g = {.target = adv_real(r, finest, coarsest)};
  for (int k = 0; k < genes; k++) g.gene[k] = adv_real(r, 0, 1);
  for (int k = 0; k < ADV_IMPORTANT; k++) g.important[k] = adv_real(r, 0, 1);
  if (seed / 4 % 2) g.important_count = adv_chance(r, 0.7) ? 1 : ADV_IMPORTANT;
  if (!g.important_count && seed / 8 % 3 == 0) g.norm = HR2D_NORM_SUP;
  return g;
}

/* One gene in half of all cases, otherwise about four. */
adv_genome adv_mutate(const adv_genome *parent, int genes, adv_random *r) {
  adv_genome g = *parent;
  const double share = adv_chance(r, 0.5) ? 0 : 3.0 / genes;
  const int one = adv_int(r, 0, genes - 1);
  for (int k = 0; k < genes; k++)
    if (k == one || adv_chance(r, share)) g.gene[k] = mutated(parent, genes, k, r);
  if (adv_chance(r, 0.25)) g.target += pow(10, adv_real(r, -3, 0)) * normal(r);
  g.target = fmin(coarsest, fmax(finest, g.target));
  if (adv_chance(r, 0.05)) g.important[adv_int(r, 0, ADV_IMPORTANT - 1)] = adv_real(r, 0, 1);
  return g;
}

adv_question adv_question_of(const adv_genome *genome, size_t patches) {
  adv_question q = {.error = pow(10, genome->target), .norm = genome->norm, .floor = 1e-6};
  q.important_count = genome->important_count;
  for (size_t k = 0; k < ADV_IMPORTANT; k++)
    q.important[k] = (size_t)fmin(genome->important[k] * (double)patches, (double)patches - 1);
  return q;
}
