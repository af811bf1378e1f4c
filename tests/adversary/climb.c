/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Climbs. */
#include "adversary/climb.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "adversary/genome.h"
#include "adversary/listed.h"
#include "adversary/measure.h"

/* Evaluations without progress until another climb begins, and scenes that are drawn for its
   start.  A percent is progress. */
enum { PATIENCE = 60, DRAWS = 8 };
#define PROGRESS 1.01

/* Ten times too low is an estimate of no use. */
#define LOW 10

/* Quantiles of |error|/estimate: its decimal logarithms from FIRST on, ten bins a decade. */
enum { FIRST = -10, PARTS = 10, BINS = 20 * PARTS };

typedef struct record {
  unsigned long climbs, evaluations, refused, violations, low;
  double worst[ADV_OBJECTIVES];
  double severity; /* of the worst violation */
  unsigned long bin[BINS];
} record;

/* The worst violation of a climb. */
typedef struct finding {
  double severity;
  unsigned long steps; /* scenes until it was found, those without an answer included */
  adv_scene scene;
  adv_measure measure;
} finding;

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void count(record *sum, const adv_measure *m) {
  sum->evaluations++;
  sum->violations += adv_violations(&m->outcome) > 0;
  for (int o = 0; o < ADV_OBJECTIVES; o++) sum->worst[o] = fmax(sum->worst[o], m->ratio[o]);
  const double low = m->ratio[ADV_CLIMB_ESTIMATE];
  sum->low += low > LOW;
  const double at = (log10(low) - FIRST) * PARTS;
  sum->bin[!(at > 0) ? 0 : at < BINS - 1 ? (int)at : BINS - 1]++;
}

static void keep_worst(finding *worst, const adv_scene *scene, const adv_measure *m,
                       unsigned long steps) {
  double max = 0;
  for (int check = 0; check < ADV_CHECKS; check++) max = fmax(max, m->outcome.worst[check]);
  if (!(max > worst->severity)) return;
  worst->severity = max;
  worst->steps = steps;
  worst->scene = *scene;
  worst->measure = *m;
}

static void print_error(FILE *file, const char *name, hr2d_error e) {
  fprintf(file, "  %s: estimate %.3g, bound %.3g\n", name, e.estimate, e.bound);
}

/* The question as the program is asked it, and the answer. */
static void print_finding(FILE *file, const char *scene, const finding *f) {
  const adv_answer *a = &f->measure.asked;
  fprintf(file, "  hr2d solve %s --target-error %.17g%s", scene, a->question.error,
          a->question.norm == HR2D_NORM_SUP ? " --norm sup" : "");
  for (size_t k = 0; k < a->question.important_count; k++)
    fprintf(file, " --importance p%zu", a->question.important[k]);
  fprintf(file, "\n");
  print_error(file, "average B", a->account.average);
  print_error(file, "average H", a->account.irradiance);
  print_error(file, "point B", a->account.sup);
  print_error(file, "point H", a->account.irradiance_sup);
  for (int check = 0; check < ADV_CHECKS; check++)
    if (f->measure.outcome.worst[check] > 1)
      fprintf(file, "  VIOLATED %s: %.3g; %s\n", adv_check_name[check],
              f->measure.outcome.worst[check], f->measure.outcome.text[check]);
}

static void describe(const adv_climbing *s, const char *family, unsigned long seed,
                     const finding *worst) {
  char scene[300], text[300];
  FILE *file[] = {stderr, NULL};
  snprintf(scene, sizeof scene, "%s/%s-%lu.geojson", s->folder ? s->folder : ".", family, seed);
  snprintf(text, sizeof text, "%s/%s-%lu.txt", s->folder ? s->folder : ".", family, seed);
  if (s->folder && adv_write(&worst->scene, scene)) file[1] = fopen(text, "w");
  for (int k = 0; k < 2 && file[k]; k++) {
    fprintf(file[k], "--climb %lu --family %s --seed %lu\n", worst->steps, family, seed);
    print_finding(file[k], scene, worst);
  }
  if (file[1]) fclose(file[1]);
}

/* Whether time or evaluations are used up. */
static int is_over(const adv_climbing *s, const record *sum, double end) {
  return sum->evaluations + sum->refused >= s->evaluations || now() > end;
}

/* Evaluates a genome; returns whether there is a scene and an answer. */
static int evaluate(const adv_climbing *s, const adv_family *family, const adv_genome *g,
                    adv_scene *scene, adv_measure *m) {
  adv_express(family, g->gene, scene);
  if (!scene->count) return 0;
  adv_question q = adv_question_of(g, scene->count);
  q.stop = s->stop;
  if (s->error > 0) q.error = s->error;
  if (s->norm >= 0) q.norm = s->norm ? HR2D_NORM_SUP : HR2D_NORM_AVERAGE;
  adv_take_measure(scene, &q, s->corruption, m);
  return m->exists;
}

/* One climb: the fittest of some scenes, and its fitter descendants. */
static void climb(const adv_climbing *s, const adv_family *family, unsigned long seed,
                  double end, record *sum) {
  static adv_scene scene;
  static adv_measure m;
  static finding worst;
  const unsigned long before = sum->evaluations + sum->refused;
  const int genes = family->genes, objective = (int)(seed % ADV_OBJECTIVES);
  adv_random r = adv_seed(seed, family->name);
  adv_genome best;
  double fitness = 0;
  int drawn = 0;
  worst.severity = 1;
  for (int idle = 0; idle < PATIENCE && !is_over(s, sum, end); idle++) {
    const adv_genome g =
        drawn < DRAWS ? adv_draw_genome(genes, seed, &r) : adv_mutate(&best, genes, &r);
    if (!evaluate(s, family, &g, &scene, &m)) {
      sum->refused++;
      continue;
    }
    count(sum, &m);
    keep_worst(&worst, &scene, &m, sum->evaluations + sum->refused - before);
    if (m.ratio[objective] > PROGRESS * fitness) idle = 0;
    if (m.ratio[objective] >= fitness || !drawn) best = g;
    fitness = fmax(fitness, m.ratio[objective]);
    drawn++;
  }
  sum->climbs++;
  sum->severity = fmax(sum->severity, worst.severity);
  if (worst.severity > 1) describe(s, family->name, seed, &worst);
}

/* 999 of 1000 evaluations are below this. */
static double quantile(const record *sum) {
  unsigned long above = 0;
  int k = BINS;
  while (k > 0 && above <= sum->evaluations / 1000) above += sum->bin[--k];
  return k > 0 ? pow(10, FIRST + (k + 1.0) / PARTS) : 0;
}

static void print_head(void) {
  printf("| family | climbs | evaluations | no answer | violations | average B | average H "
         "| points | error/estimate | 99.9 %% of these | above %d |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|\n",
         LOW);
}

static void print_record(const char *name, const record *sum) {
  printf("| %s | %lu | %lu | %lu | %lu |", name, sum->climbs, sum->evaluations, sum->refused,
         sum->violations);
  for (int o = 0; o < ADV_OBJECTIVES; o++) printf(" %.2g |", sum->worst[o]);
  printf(" %.2g | %.2g %% |\n", quantile(sum),
         100 * (double)sum->low / fmax(1, (double)sum->evaluations));
  fflush(stdout);
}

int adv_climb(const adv_climbing *s) {
  unsigned long evaluations = 0, violations = 0;
  double severity = 0;
  int families = 0, done = 0;
  const double start = now();
  for (const adv_family *f = adv_families; f->name; f++)
    families += adv_listed(s->families, f->name);
  print_head();
  for (const adv_family *f = adv_families; f->name; f++) {
    if (!adv_listed(s->families, f->name)) continue;
    record sum = {0};
    const double end = s->seconds > 0 ? start + s->seconds * ++done / families : INFINITY;
    for (unsigned long seed = s->seed; !is_over(s, &sum, end); seed++)
      climb(s, f, seed, end, &sum);
    print_record(f->name, &sum);
    evaluations += sum.evaluations;
    violations += sum.violations;
    severity = fmax(severity, sum.severity);
  }
  printf("\n%lu evaluations, %lu of them with violations; %.0f s\n", evaluations, violations,
         now() - start);
  return severity > s->allow;
}
