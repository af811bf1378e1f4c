/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The adversary: random scenes, solved as they are and in ways from which the answer is known;
   disagreements are judged against the errors that both answers state.  It knows of the library
   what a user knows, the public headers. */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "adversary/climb.h"
#include "adversary/families.h"
#include "adversary/kinds.h"
#include "adversary/law.h"
#include "adversary/listed.h"
#include "adversary/report.h"
#include "adversary/shrink.h"
#include "adversary/transform.h"

enum { KINDS = 128, LAWS = 16 };

typedef struct settings {
  unsigned long seed, runs, lines;
  double seconds, limit; /* of all runs, of one solve */
  double error;          /* 0: drawn */
  double allow;          /* of a climb */
  int norm;              /* −1: drawn */
  const char *kinds, *law, *transforms, *corruption, *folder, *families;
  int one, shrink, list, climb;
} settings;

static const char usage[] =
    "adversary [OPTION]...: random scenes and their transformations, judged by stated errors\n"
    "  --runs N          trials (200)\n"
    "  --for SECONDS     ends earlier, after this time\n"
    "  --seed S          of the first trial (1); each next trial has the next seed\n"
    "  --only KIND,...   these kinds of scenes\n"
    "  --case SEED       one trial, of the kind of --only, with all details; writes the "
    "scenes\n"
    "  --shrink          and looks for a smaller scene with the same violation\n"
    "  --law NAME        copy, finer, superposition, reciprocity, furnace, narrow\n"
    "  --transform LIST  of copies\n"
    "  --error E         the target of all solves but finer; otherwise 1e-2 to 1e-12\n"
    "  --norm average|sup\n"
    "  --limit SECONDS   the budget of each solve (2), or when one ends (0.1)\n"
    "  --folder FOLDER   where scenes are written (.); violated ones only with this option\n"
    "  --corrupt NAME    falsifies answers, a negative control\n"
    "  --lines N         violations to be described (40)\n"
    "  --climb N         climbs on error/bound instead: N evaluations of each family\n"
    "  --family NAME,... of these families of scenes\n"
    "  --allow X         errors of up to X times what is stated leave the exit status 0 (1)\n"
    "  --list            families, kinds, laws, transformations, corruptions\n"
    "Exit status: 0 without a violation, 1 with one, 2 for a wrong option.\n";

static void print_lists(void) {
  for (const adv_family *f = adv_families; f->name; f++)
    printf("family %-14s %s\n", f->name, f->what);
  for (size_t k = 0; k < adv_kinds(); k++)
    printf("kind %-16s %s\n", adv_kind_at(k)->name, adv_kind_at(k)->what);
  for (const adv_law *law = adv_laws; law->name; law++) printf("law %s\n", law->name);
  for (const adv_transform *t = adv_transforms; t->name; t++)
    printf("transformation %s\n", t->name);
  for (const char *const *name = adv_corruptions; *name; name++)
    printf("corruption %s\n", *name);
}

static int number(const char *text, double min, double *value) {
  char *end;
  *value = strtod(text, &end);
  return end != text && !*end && *value >= min;
}

static int parse(int argc, char **argv, settings *s) {
  static const struct option names[] = {
      {"runs", 1, 0, 'r'},    {"for", 1, 0, 'f'},       {"seed", 1, 0, 's'},
      {"only", 1, 0, 'o'},    {"case", 1, 0, 'c'},      {"shrink", 0, 0, 'k'},
      {"law", 1, 0, 'w'},     {"transform", 1, 0, 't'}, {"error", 1, 0, 'e'},
      {"norm", 1, 0, 'n'},    {"limit", 1, 0, 'l'},     {"folder", 1, 0, 'd'},
      {"corrupt", 1, 0, 'x'}, {"lines", 1, 0, 'i'},     {"list", 0, 0, 'h'},
      {"climb", 1, 0, 'b'},   {"family", 1, 0, 'y'},    {"allow", 1, 0, 'a'},
      {NULL, 0, 0, 0}};
  for (int id; (id = getopt_long(argc, argv, "", names, NULL)) != -1;) {
    double value = 0;
    if (strchr("rfscleiba", id) && !number(optarg, 0, &value)) return 0;
    switch (id) {
    case 'b':
      s->climb = 1; /* fall through */
    case 'r':
      s->runs = (unsigned long)value;
      break;
    case 'f':
      s->seconds = value;
      break;
    case 'c':
      s->one = 1;
      s->runs = 1; /* fall through */
    case 's':
      s->seed = strtoul(optarg, NULL, 10);
      break;
    case 'l':
      s->limit = value;
      break;
    case 'e':
      s->error = value;
      break;
    case 'a':
      s->allow = value;
      break;
    case 'i':
      s->lines = (unsigned long)value;
      break;
    case 'o':
      s->kinds = optarg;
      break;
    case 'k':
      s->shrink = 1;
      break;
    case 'w':
      s->law = optarg;
      break;
    case 't':
      s->transforms = optarg;
      break;
    case 'n':
      s->norm = !strcmp(optarg, "sup");
      break;
    case 'd':
      s->folder = optarg;
      break;
    case 'x':
      s->corruption = optarg;
      break;
    case 'y':
      s->families = optarg;
      break;
    case 'h':
      s->list = 1;
      break;
    default:
      return 0;
    }
  }
  return optind == argc;
}

/* What a user may ask: averages three times out of four. */
static adv_question draw_question(const settings *s, adv_random *r, unsigned long seed) {
  static const double floors[] = {1e-6, 1e-3, 1e-6, 1e-9};
  adv_question q = {.error = pow(10, -adv_int(r, 2, 12)), .seconds = s->limit, .floor = 1e-6};
  if (ADV_ACCOUNT_OF_H) q.floor = floors[seed % 4];
  if (adv_chance(r, 0.25)) q.norm = HR2D_NORM_SUP;
  if (s->error > 0) q.error = s->error;
  if (s->norm >= 0) q.norm = s->norm ? HR2D_NORM_SUP : HR2D_NORM_AVERAGE;
  return q;
}

static const adv_law *law_of(const settings *s, const adv_scene *scene, adv_random *r) {
  const adv_law *drawn = adv_draw_law(scene, r);
  for (const adv_law *law = adv_laws; s->law && law->name; law++)
    if (!strcmp(law->name, s->law) && law->holds_for(scene)) return law;
  return drawn;
}

static void print_answer(FILE *file, const adv_answer *a) {
  if (!a->scene) return;
  fprintf(file, "  %zu patches, target %g (%s, floor %g): %s%s%s\n", a->scene->count,
          a->question.error, a->question.norm == HR2D_NORM_SUP ? "sup" : "average",
          a->question.floor, hr2d_strerror(a->status), *a->account.reason ? ": " : "",
          a->account.reason);
  fprintf(file, "    average %.3g <= %.3g, sup %.3g <= %.3g", a->account.average.estimate,
          a->account.average.bound, a->account.sup.estimate, a->account.sup.bound);
#if ADV_ACCOUNT_OF_H
  fprintf(file, ", H %.3g <= %.3g, sup H %.3g <= %.3g", a->account.irradiance.estimate,
          a->account.irradiance.bound, a->account.irradiance_sup.estimate,
          a->account.irradiance_sup.bound);
#endif
  fprintf(file, "; p = %u, N = %llu, L = %llu, %.2f s\n", a->account.order,
          (unsigned long long)a->account.elements, (unsigned long long)a->account.links,
          a->seconds);
}

static void write_scenes(FILE *file, const settings *s, const adv_trial *trial,
                         const char *kind, unsigned long seed) {
  char path[300];
  const char *folder = s->folder ? s->folder : ".";
  for (int c = -1; c < trial->copies; c++) {
    const adv_scene *scene = c < 0 ? trial->scene : &trial->copy[c];
    snprintf(path, sizeof path, c < 0 ? "%s/%s-%lu.geojson" : "%s/%s-%lu-copy%d.geojson",
             folder, kind, seed, c + 1);
    if (adv_write(scene, path)) fprintf(file, "  written: %s\n", path);
  }
}

/* One case is what was asked for; in a long run violations stand beside the tables. */
static void describe(const settings *s, const adv_trial *trial, const char *kind,
                     const adv_law *law, unsigned long seed) {
  FILE *file = s->one ? stdout : stderr;
  fprintf(file, "--only %s --case %lu: %s %s\n", kind, seed, law->name, trial->applied);
  for (int c = 0; s->one && c < 3; c++) print_answer(file, &trial->answer[c]);
  for (int check = 0; check < ADV_CHECKS; check++)
    if (s->one || trial->outcome.worst[check] > 1)
      fprintf(file, "  %s%s: %.3g; %s\n", trial->outcome.worst[check] > 1 ? "VIOLATED " : "",
              adv_check_name[check], trial->outcome.worst[check], trial->outcome.text[check]);
  if (s->one || s->folder) write_scenes(file, s, trial, kind, seed);
}

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct tables {
  adv_row kind[KINDS], law[LAWS], all;
} tables;

/* One trial of a kind; returns whether a check was violated. */
static int run(const settings *s, size_t k, unsigned long seed, adv_trial *trial, tables *t,
               unsigned long *lines) {
  static adv_scene scene;
  const adv_kind *kind = adv_kind_at(k);
  adv_random r = adv_seed(seed, kind->name);
  t->kind[k].refused += (unsigned)adv_draw(kind, &r, &scene);
  trial->scene = &scene;
  trial->question = draw_question(s, &r, seed);
  trial->fixed = s->error > 0;
  trial->transforms = s->transforms;
  trial->corruption = s->corruption;
  const adv_law *law = law_of(s, &scene, &r);
  trial->random = r;
  adv_try(trial, law);
  trial->random = r;
  int violated = adv_violations(&trial->outcome) > 0;
  if (violated && s->shrink) adv_shrink(&scene, trial, law);
  adv_add_outcome(&t->kind[k], &trial->outcome);
  adv_add_outcome(&t->law[law - adv_laws], &trial->outcome);
  adv_add_outcome(&t->all, &trial->outcome);
  if (s->one || (violated && *lines < s->lines)) {
    describe(s, trial, kind->name, law, seed);
    (*lines)++;
  }
  return violated;
}

static int run_all(const settings *s) {
  static adv_trial trial;
  static tables t;
  size_t kinds = adv_kinds(), laws = 0;
  unsigned long lines = 0, done = 0, violated = 0;
  double start = now();
  if (kinds > KINDS) {
    fputs("adversary: more kinds than its table has rows\n", stderr);
    return 2;
  }
  for (size_t k = 0; k < kinds; k++) t.kind[k].name = adv_kind_at(k)->name;
  for (; adv_laws[laws].name; laws++) t.law[laws].name = adv_laws[laws].name;
  for (unsigned long seed = s->seed; done < s->runs; seed++)
    for (size_t k = 0; k < kinds && done < s->runs; k++) {
      if (!adv_listed(s->kinds, t.kind[k].name)) continue;
      if (s->seconds > 0 && now() - start > s->seconds) goto out;
      violated += (unsigned long)run(s, k, seed, &trial, &t, &lines);
      done++;
    }
out:
  adv_end_trial(&trial);
  if (!s->one) {
    printf("\n");
    adv_print_table(stdout, "kind", t.kind, kinds);
    printf("\n");
    adv_print_table(stdout, "law", t.law, laws);
    printf("\n");
    adv_print_checks(stdout, &t.all);
    printf("\n");
  }
  printf("%lu runs, %u solves, %u values compared, %u of these without a claim; "
         "%lu runs with violations; %.0f s\n",
         done, t.all.answers, t.all.compared, t.all.vacuous, violated, now() - start);
  return violated > 0;
}

static const char *kind_name(size_t k) {
  return k < adv_kinds() ? adv_kind_at(k)->name : NULL;
}

static const char *family_name(size_t k) {
  return adv_families[k].name;
}

/* Whether all names of a list are names of something. */
static int all_known(const char *list, const char *(*name_at)(size_t)) {
  for (const char *at = list; at; at = strchr(at, ',')) {
    at += *at == ',';
    size_t k = 0, length = strcspn(at, ",");
    for (const char *name; (name = name_at(k)); k++)
      if (strlen(name) == length && !strncmp(at, name, length)) break;
    if (!name_at(k)) return 0;
  }
  return 1;
}

static int climb(const settings *s) {
  return adv_climb(&(adv_climbing){.seed = s->seed,
                                   .evaluations = s->runs,
                                   .seconds = s->seconds,
                                   .stop = s->limit,
                                   .error = s->error,
                                   .norm = s->norm,
                                   .allow = s->allow,
                                   .families = s->families,
                                   .corruption = s->corruption,
                                   .folder = s->folder});
}

int main(int argc, char **argv) {
  settings s = {.seed = 1, .runs = 200, .lines = 40, .norm = -1, .allow = 1};
  if (!parse(argc, argv, &s) || !all_known(s.kinds, kind_name) ||
      !all_known(s.families, family_name) || (s.one && !s.kinds)) {
    fputs(usage, stderr);
    return 2;
  }
  if (s.list) {
    print_lists();
    return 0;
  }
  if (!(s.limit > 0)) s.limit = s.climb ? 0.1 : 2;
  return s.climb ? climb(&s) : run_all(&s);
}
