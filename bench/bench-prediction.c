/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The times that hr2d_predict() promises beside the times that hr2d_solve_to() takes, on every
   kind of scene of the adversary, on one thread.

       bench-prediction [SCENES]     of each kind (1) */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "adversary/kinds.h"
#include "base/clock.h"

#define RUNS 3

typedef struct tally {
  int cases, within_two, within_range;
  double low, high; /* the extremes of actual/predicted */
} tally;

static void add(tally *t, double ratio, int in_range) {
  t->cases++;
  t->within_two += ratio >= 0.5 && ratio <= 2;
  t->within_range += in_range;
  t->low = fmin(t->low, ratio);
  t->high = fmax(t->high, ratio);
}

static void try_target(const char *kind, const hr2d_scene *scene, double error, tally *t) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_prediction p;
  hr2d_account account = {0};
  double seconds = HUGE_VAL;
  target.error = error;
  if (hr2d_predict(scene, &target, &p)) return;
  for (int run = 0; run < RUNS && (run == 0 || seconds < 1); run++) {
    hr2d_solution *solution = NULL;
    const double start = hr2di_clock_now();
    const hr2d_status status = hr2d_solve_to(scene, &target, &solution, &account);
    seconds = fmin(seconds, hr2di_clock_now() - start);
    hr2d_solution_destroy(solution);
    if (status && status != HR2D_EACCURACY) return;
  }
  const double ratio = seconds / p.seconds;
  const int in_range = seconds >= p.least_seconds && seconds <= p.most_seconds;
  add(t, ratio, in_range);
  printf("%-15s %7.0e %6u %9.2g %9.2g %9.2g %9.2g %6.2f %s\n", kind, error, account.solves,
         p.least_seconds, p.seconds, p.most_seconds, seconds, ratio, in_range ? "" : "outside");
  fflush(stdout);
}

int main(int argc, char **argv) {
  static const double error[] = {1e-2, 1e-4, 1e-6, 1e-9, 1e-12};
  const int scenes = argc > 1 ? atoi(argv[1]) : 1;
  tally t = {.low = HUGE_VAL};
  printf("%-15s %7s %6s %9s %9s %9s %9s %6s\n", "kind", "target", "solves", "least", "likely",
         "most", "seconds", "ratio");
  for (size_t k = 0; k < adv_kinds(); k++)
    for (int n = 0; n < scenes; n++) {
      static adv_scene drawn;
      adv_random r = {1000 * k + (unsigned)n + 1};
      hr2d_scene *scene;
      adv_draw(adv_kind_at(k), &r, &drawn);
      if (adv_build(&drawn, &scene)) continue;
      for (size_t e = 0; e < sizeof error / sizeof *error; e++)
        try_target(adv_kind_at(k)->name, scene, error[e], &t);
      hr2d_scene_destroy(scene);
    }
  printf("%d cases: %d within a factor of 2, %d within the range; actual / likely from %.2g to "
         "%.2g\n",
         t.cases, t.within_two, t.within_range, t.low, t.high);
  return 0;
}
