/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Climbs. */
#include "adversary/climb.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "adversary/families.h"
#include "adversary/measure.h"

/* What evolves.  Important patches are numbers in [0, 1), too. */
typedef struct genome {
  double gene[ADV_GENES], important[ADV_IMPORTANT], target; /* its decimal logarithm */
  size_t important_count;
  hr2d_norm norm;
  int objective;
} genome;

/* Errors divided by estimates, in decades of ten parts from 10^-10 on. */
enum { FIRST = -10, DECADES = 20, PARTS = 10, BINS = DECADES * PARTS };

typedef struct record {
  unsigned long evaluations, refused, climbs, violations, low; /* estimates 10 times too low */
  double worst[ADV_OBJECTIVES];
  unsigned long bin[BINS];
} record;

/* Evaluations without progress until another climb begins, and scenes that are drawn for its
   start.  A percent is progress. */
enum { PATIENCE = 60, DRAWS = 8 };
#define PROGRESS 1.01

static const double coarsest = -1, finest = -9; /* decimal logarithms of targets */

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double normal(adv_random *r) {
  const double u = adv_real(r, 0, 1), v = adv_real(r, 0, 1);
  return sqrt(-2 * log(1 - u)) * cos(6.283185307179586 * v);
}

/* Beyond 0 or 1 a gene is reflected. */
static double reflected(double gene) {
  gene = fmod(fabs(gene), 2);
  return gene > 1 ? 2 - gene : gene;
}

/* Steps of any size; now and then another place, a round number, or another gene's: vertices
   in a line are found so. */
static double mutated(const genome *g, int genes, int k, adv_random *r) {
  const double what = adv_real(r, 0, 1);
  if (what < 0.05) return adv_real(r, 0, 1);
  if (what < 0.1) {
    const double parts = adv_int(r, 2, 32);
    return round(g->gene[k] * parts) / parts;
  }
  if (what < 0.15) return g->gene[adv_int(r, 0, genes - 1)];
  return reflected(g->gene[k] + normal(r) * pow(10, adv_real(r, -5, -0.3)));
}

static genome child(const genome *parent, int genes, adv_random *r) {
  genome g = *parent;
  const double share = adv_chance(r, 0.5) ? 0 : 3.0 / genes;
  for (int k = 0; k < genes; k++)
    if (adv_chance(r, share)) g.gene[k] = mutated(parent, genes, k, r);
  const int one = adv_int(r, 0, genes - 1);
  g.gene[one] = mutated(parent, genes, one, r);
  if (adv_chance(r, 0.25)) g.target += normal(r) * pow(10, adv_real(r, -3, 0));
  g.target = fmin(coarsest, fmax(finest, g.target));
  if (adv_chance(r, 0.05)) g.important[adv_int(r, 0, ADV_IMPORTANT - 1)] = adv_real(r, 0, 1);
  return g;
}

/* Half of all climbs tell which patches count, a third are in the sup norm. */
static genome drawn(int genes, unsigned long seed, adv_random *r) {
  genome g = {.target = adv_real(r, finest, coarsest), .objective = (int)(seed % 4)};
  for (int k = 0; k < genes; k++) g.gene[k] = adv_real(r, 0, 1);
  for (int k = 0; k < ADV_IMPORTANT; k++) g.important[k] = adv_real(r, 0, 1);
  if (seed / 4 % 2) g.important_count = adv_chance(r, 0.7) ? 1 : 2;
  if (seed / 8 % 3 == 0) g.norm = HR2D_NORM_SUP;
  return g;
}

static adv_question question_of(const genome *g, size_t patches, double stop) {
  adv_question q = {.error = pow(10, g->target), .norm = g->norm, .floor = 1e-6, .stop = stop};
  q.important_count = g->important_count;
  for (size_t k = 0; k < ADV_IMPORTANT; k++)
    q.important[k] = (size_t)fmin(g->important[k] * (double)patches, (double)patches - 1);
  return q;
}

static void count(record *sum, const adv_measure *m) {
  sum->evaluations++;
  sum->violations += adv_violations(&m->outcome) > 0;
  for (int o = 0; o < ADV_OBJECTIVES; o++) sum->worst[o] = fmax(sum->worst[o], m->ratio[o]);
  const double low = m->ratio[ADV_CLIMB_ESTIMATE];
  sum->low += low > 10;
  const double at = (log10(low) - FIRST) * PARTS;
  sum->bin[!(at > 0) ? 0 : at < BINS - 1 ? (int)at : BINS - 1]++;
}

static void print_command(FILE *file, const char *path, const adv_question *q) {
  fprintf(file, "  hr2d solve %s --target-error %.17g%s", path, q->error,
          q->norm == HR2D_NORM_SUP ? " --norm sup" : "");
  for (size_t k = 0; k < q->important_count; k++)
    fprintf(file, " --importance p%zu", q->important[k]);
  fprintf(file, "\n");
}

static void print_violation(FILE *file, const adv_measure *m) {
  const hr2d_account *a = &m->asked.account;
  fprintf(file, "  B %.3g <= %.3g, H %.3g <= %.3g, points: B %.3g <= %.3g, H %.3g <= %.3g\n",
          a->average.estimate, a->average.bound, a->irradiance.estimate, a->irradiance.bound,
          a->sup.estimate, a->sup.bound, a->irradiance_sup.estimate, a->irradiance_sup.bound);
  fprintf(file, "  order %u, N = %llu, L = %llu, target of the truth %g\n", a->order,
          (unsigned long long)a->elements, (unsigned long long)a->links,
          m->truth.question.error);
  for (int check = 0; check < ADV_CHECKS; check++)
    if (m->outcome.worst[check] > 1)
      fprintf(file, "  VIOLATED %s: %.3g; %s\n", adv_check_name[check], m->outcome.worst[check],
              m->outcome.text[check]);
}

/* Tells of the worst violation of a climb. */
static void describe(const adv_climbing *settings, const adv_family *family, unsigned long seed,
                     const adv_measure *m) {
  char path[300];
  snprintf(path, sizeof path, "%s/%s-%lu.geojson", settings->folder ? settings->folder : ".",
           family->name, seed);
  FILE *file[2] = {stderr, NULL};
  if (settings->folder) {
    adv_write(m->asked.scene, path);
    char text[320];
    snprintf(text, sizeof text, "%s.txt", path);
    file[1] = fopen(text, "w");
  }
  for (int k = 0; k < 2 && file[k]; k++) {
    fprintf(file[k], "adversary --climb 100000 --family %s --seed %lu\n", family->name, seed);
    print_command(file[k], path, &m->asked.question);
    print_violation(file[k], m);
  }
  if (file[1]) fclose(file[1]);
}

static double severity(const adv_measure *m) {
  double most = 0;
  for (int check = 0; check < ADV_CHECKS; check++) most = fmax(most, m->outcome.worst[check]);
  return most;
}

/* Whether time or evaluations are used up. */
static int is_over(const adv_climbing *s, const record *sum, double end) {
  return sum->evaluations + sum->refused >= s->evaluations || now() > end;
}

/* One climb: the fittest of some scenes, and its fitter descendants. */
static void climb(const adv_climbing *s, const adv_family *family, unsigned long seed,
                  double end, record *sum) {
  static adv_scene scene, kept;
  static adv_measure m, violation;
  adv_random r = {seed};
  for (const char *c = family->name; *c; c++) r.state = adv_next(&r) ^ (unsigned char)*c;
  genome best = {.objective = 0};
  double fitness = 0, most = 1;
  int draws = 0;
  for (int idle = 0; idle < PATIENCE && !is_over(s, sum, end); idle++) {
    genome g = draws < DRAWS ? drawn(family->genes, seed, &r) : child(&best, family->genes, &r);
    adv_express(family, g.gene, &scene);
    const adv_question q = question_of(&g, scene.count, s->stop);
    if (scene.count) adv_take_measure(&scene, &q, s->corruption, &m);
    if (!scene.count || !m.exists) {
      sum->refused++;
      continue;
    }
    count(sum, &m);
    draws++;
    if (m.ratio[g.objective] > PROGRESS * fitness) idle = 0;
    if (m.ratio[g.objective] >= fitness) best = g, fitness = m.ratio[g.objective];
    if (severity(&m) > most) {
      most = severity(&m);
      kept = scene;
      violation = m;
      violation.asked.scene = &kept;
    }
  }
  if (most > 1) describe(s, family, seed, &violation);
  sum->climbs++;
}

/* Below this are 999 of 1000 evaluations. */
static double quantile(const record *sum) {
  unsigned long above = 0;
  int k = BINS;
  while (k > 0 && above <= sum->evaluations / 1000) above += sum->bin[--k];
  return k ? pow(10, FIRST + (k + 1.0) / PARTS) : 0;
}

static void print_record(const char *name, const record *sum) {
  printf("| %s | %lu | %lu | %lu | %lu | %.2g | %.2g | %.2g | %.2g | %.2g | %.2g |\n", name,
         sum->climbs, sum->evaluations, sum->refused, sum->violations, sum->worst[ADV_CLIMB_B],
         sum->worst[ADV_CLIMB_H], sum->worst[ADV_CLIMB_POINT], sum->worst[ADV_CLIMB_ESTIMATE],
         quantile(sum), (double)sum->low / fmax(1, (double)sum->evaluations));
  fflush(stdout);
}

int adv_climb(const adv_climbing *s) {
  unsigned long violations = 0;
  int families = 0, done = 0;
  for (const adv_family *f = adv_families; f->name; f++)
    families += !s->family || !strcmp(s->family, f->name);
  printf(
      "| family | climbs | evaluations | refused | violations | average B | average H | points "
      "| error/estimate | 99.9 %% of it | share above 10 |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  const double start = now();
  for (const adv_family *f = adv_families; f->name; f++) {
    if (s->family && strcmp(s->family, f->name)) continue;
    record sum = {0};
    const double end = s->seconds > 0 ? start + s->seconds * ++done / families : start + 1e9;
    for (unsigned long seed = s->seed; !is_over(s, &sum, end); seed++)
      climb(s, f, seed, end, &sum);
    print_record(f->name, &sum);
    violations += sum.violations;
  }
  printf("%lu violations; %.0f s\n", violations, now() - start);
  return violations > 0;
}
