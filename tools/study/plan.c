/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ε of a study: a geometric sequence, and with --resume also those of the CSV. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/scene.h"
#include "output/complain.h"
#include "study/study.h"

typedef struct range {
  double from, to;
} range;

/* The default sequences take N through about six doublings.  Where max(A)/r reaches ε, its
   square reaches ε²; estimates of bf are smaller.  The L¹ error and its bound are lengths; at a
   given distance they fall like A³. */
static void choose_usual(const hr2d_oracle *oracle, const hr2d_scene *scene, double *from,
                         double *ratio) {
  *from = 1;
  *ratio = 64;
  if (oracle == hr2d_oracle_size2()) {
    *ratio = 64 * 64;
  } else if (oracle == hr2d_oracle_bf()) {
    *from = 0.25;
    *ratio = 256;
  } else if (!strncmp(oracle->name, "l1", 2) || oracle == hr2d_oracle_bounds()) {
    *from = scene_longest_patch(scene) / 64;
    *ratio = 64 * 64 * 64;
  }
}

static int choose_range(const options *o, const hr2d_scene *scene, range *r) {
  double from = 0, ratio = 0;
  choose_usual(o->oracle, scene, &from, &ratio);
  r->from = o->from > 0 ? o->from : from;
  r->to = o->to > 0 ? o->to : r->from / ratio;
  if (r->to < r->from) return 0;
  return complain_usage("--from %g is not greater than --to %g", r->from, r->to);
}

/* Through logarithms to base 2, so that powers of two are exact. */
static double step_epsilon(const range *r, unsigned step, unsigned steps) {
  if (step == 0) return r->from;
  if (step + 1 == steps) return r->to;
  const double fraction = (double)step / (steps - 1);
  return exp2(log2(r->from) + fraction * (log2(r->to) - log2(r->from)));
}

static int by_falling_epsilon(const void *a, const void *b) {
  const double x = ((const hr2d_study_row *)a)->epsilon;
  const double y = ((const hr2d_study_row *)b)->epsilon;
  return (x < y) - (x > y);
}

static void sort(hr2d_study_row *rows, size_t count) {
  if (count) qsort(rows, count, sizeof *rows, by_falling_epsilon);
}

/* Refuses rows that no study of this scene can have written: a split adds two elements and one
   leaf. */
static int check_known(const study *s, const hr2d_scene *scene) {
  const char *path = s->options->csv;
  const uint64_t patches = hr2d_scene_patches(scene);
  for (size_t k = 0; k < s->known; k++) {
    const hr2d_study_row *row = &s->rows[k];
    if (k && row->epsilon == row[-1].epsilon)
      return complain(path, "cannot be resumed: epsilon %.17g is there twice", row->epsilon);
    if (row->counts.leaves - patches != row->counts.elements - row->counts.leaves)
      return complain(path,
                      "cannot be resumed: at epsilon %.17g, N = %llu and %llu leaves do not "
                      "belong to a scene of %llu patches",
                      row->epsilon, (unsigned long long)row->counts.elements,
                      (unsigned long long)row->counts.leaves, (unsigned long long)patches);
  }
  return 0;
}

/* Appends the ε that the CSV does not have. */
static int add_sequence(study *s, const range *r) {
  const unsigned steps = s->options->steps;
  hr2d_study_row *rows = realloc(s->rows, (s->count + steps) * sizeof *rows);
  if (!rows) return complain_memory();
  s->rows = rows;
  for (unsigned k = 0; k < steps; k++) {
    const hr2d_study_row row = {.epsilon = step_epsilon(r, k, steps)};
    if (k && row.epsilon == step_epsilon(r, k - 1, steps)) continue;
    if (s->known && bsearch(&row, rows, s->known, sizeof row, by_falling_epsilon)) continue;
    rows[s->count++] = row;
  }
  return 0;
}

int study_plan(study *s, const hr2d_scene *scene) {
  range r;
  int status = choose_range(s->options, scene, &r);
  if (!status && s->options->resume)
    status = study_read_csv(s->options->csv, &s->rows, &s->count);
  s->known = s->count;
  sort(s->rows, s->count);
  if (!status) status = check_known(s, scene);
  if (!status) status = add_sequence(s, &r);
  sort(s->rows, s->count);
  return status;
}

void study_drop_uncounted(study *s) {
  size_t kept = 0;
  for (size_t k = 0; k < s->count; k++)
    if (s->rows[k].counts.elements) s->rows[kept++] = s->rows[k];
  s->count = kept;
}
