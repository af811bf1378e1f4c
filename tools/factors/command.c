/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `hr2d factors`: the view factors between all patches. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/scene.h"
#include "factors/factors.h"
#include "output/clock.h"
#include "output/complain.h"
#include "output/progress.h"
#include "output/table.h"

/* The matrix, and two rows more for the sums. */
static int make_room(factors *f) {
  const size_t n = f->patches;
  const double bytes = (double)n * ((double)n + 2) * sizeof *f->factor;
  if (n + 2 <= SIZE_MAX / sizeof *f->factor / n)
    f->factor = malloc(n * (n + 2) * sizeof *f->factor);
  if (!f->factor)
    return complain(f->options->scene, "out of memory: the factors of %zu patches take %.3g MB",
                    n, bytes / 1e6);
  f->row_sum = f->factor + n * n;
  f->missing = f->row_sum + n;
  return 0;
}

static int integrate(factors *f) {
  progress p;
  hr2d_matrix_options matrix = HR2D_MATRIX_OPTIONS_INIT;
  progress_start(&p, f->options->quiet);
  matrix.threads = options_threads(f->options);
  matrix.progress = progress_show;
  matrix.progress_ctx = &p;
  const double start = clock_seconds();
  const hr2d_status status = hr2d_exchange_matrix(f->scene, &matrix, f->factor, &f->counts);
  f->seconds = clock_seconds() - start;
  progress_clear(&p);
  progress_end();
  return status ? complain_call(f->options->scene, "", status) : 0;
}

/* From AF to F.  In a closed scene 1 − Σ F_ij is a small difference: the rounding errors of the
   sum are summed, too (Neumaier). */
static void divide(factors *f) {
  const size_t n = f->patches;
  for (size_t i = 0; i < n; i++) {
    const double length = hr2d_scene_length(f->scene, i);
    double *row = f->factor + i * n, sum = 0, lost = 0;
    for (size_t j = 0; j < n; j++) {
      const double next = sum + row[j];
      lost += sum >= row[j] ? (sum - next) + row[j] : (row[j] - next) + sum;
      sum = next;
      row[j] /= length;
    }
    f->row_sum[i] = (sum + lost) / length;
    f->missing[i] = ((length - sum) - lost) / length;
  }
}

static void print_patches(const factors *f) {
  const int width = table_name_width(f->scene);
  table_patch_titles(width);
  printf("  %12s  %12s\n", "row sum", "1 - row sum");
  for (size_t k = 0; k < f->patches; k++)
    if (table_patch(f->scene, k, width))
      printf("  %12.9f  %12.3e\n", f->row_sum[k], f->missing[k]);
  puts("");
}

static size_t find_worst(const factors *f) {
  size_t worst = 0;
  for (size_t k = 1; k < f->patches; k++)
    if (fabs(f->missing[k]) > fabs(f->missing[worst])) worst = k;
  return worst;
}

static void print_factors(const factors *f, double total_seconds) {
  const hr2d_matrix_counts *n = &f->counts;
  const size_t worst = find_worst(f);
  const effort list[] = {{"exchange areas", n->exchange_areas},
                         {"visibility tests", n->visibility_tests}};
  scene_print(f->options, 10, f->cuts);
  printf("patches   %zu\n", f->patches);
  printf("pairs     %llu clear, %llu partly visible, %llu blocked\n",
         (unsigned long long)(n->exchange_areas - n->partial_pairs),
         (unsigned long long)n->partial_pairs, (unsigned long long)n->blocked_pairs);
  print_patches(f);
  printf("worst     |1 - row sum| = %.3e, of patch %zu (%s)\n", fabs(f->missing[worst]), worst,
         hr2d_scene_name(f->scene, worst));
  table_print_work(list, sizeof list / sizeof *list);
  printf("seconds   factors %.3f, total %.3f\n", f->seconds, total_seconds);
}

static int report(const factors *f, double start) {
  const options *o = f->options;
  int status = 0;
  if (options_want_table(o)) print_factors(f, clock_seconds() - start);
  if (o->csv) status = factors_write_csv(f);
  if (o->json && !status) status = factors_write_json(f, o->json);
  return status;
}

int factors_command(const options *o) {
  const double start = clock_seconds();
  hr2d_scene *scene = NULL;
  factors f = {.options = o};
  int status = options_check_outputs(o);
  if (!status) status = scene_load(o, o->force, &scene, &f.cuts);
  if (status) return status;
  f.scene = scene;
  f.patches = hr2d_scene_patches(scene);
  status = make_room(&f);
  if (!status) status = integrate(&f);
  if (!status) {
    divide(&f);
    status = report(&f, start);
  }
  free(f.factor);
  hr2d_scene_destroy(scene);
  return status;
}
