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
#include "output/printable.h"
#include "output/progress.h"
#include "output/table.h"

/* Two sums, two errors and a length for each row, and a row. */
static int make_room(factors *f) {
  const size_t n = f->count = hr2d_scene_patches(f->scene);
  f->name = calloc(n, sizeof *f->name);
  f->row_sum =
      n <= SIZE_MAX / 6 / sizeof *f->row_sum ? malloc(6 * n * sizeof *f->row_sum) : NULL;
  if (!f->row_sum || !f->name) return complain_memory();
  f->missing = f->row_sum + n;
  f->row = f->missing + n;
  f->off[0] = f->row + n;
  f->off[1] = f->off[0] + n;
  f->length = f->off[1] + n;
  for (size_t k = 0; k < n; k++) {
    f->name[k] = hr2d_scene_name(f->scene, k);
    f->length[k] = hr2d_scene_length(f->scene, k);
  }
  return 0;
}

static void release(factors *f) {
  for (size_t k = 0; k < f->owns_names; k++) free((char *)(uintptr_t)f->name[k]);
  free(f->name);
  free(f->row_sum);
  free(f->own.start);
  free(f->own.column);
  free(f->own.area);
  hr2d_exchange_rows_destroy(f->rows);
}

static int integrate(factors *f) {
  progress p;
  hr2d_matrix_options how = HR2D_MATRIX_OPTIONS_INIT;
  progress_start(&p, f->options->quiet);
  how.threads = options_threads(f->options);
  how.progress = progress_show;
  how.progress_ctx = &p;
  how.cut_off_estimate = f->off[0];
  how.cut_off_bound = f->off[1];
  const double start = clock_seconds();
  const hr2d_status status = hr2d_exchange_rows_create(f->scene, &how, &f->rows, &f->counts);
  f->seconds = clock_seconds() - start;
  progress_clear(&p);
  progress_end();
  if (status == HR2D_ENOMEM)
    return complain(f->options->scene, "out of memory: the factors of %zu patches do not fit",
                    f->count);
  if (status) return scene_complain(f->options, f->scene, status);
  f->start = hr2d_exchange_rows_start(f->rows);
  f->column = hr2d_exchange_rows_column(f->rows);
  f->area = hr2d_exchange_rows_area(f->rows);
  return 0;
}

/* In a closed scene 1 − Σ F_ij is a small difference: the rounding errors of the sum are
   summed, too (Neumaier). */
static void sum_rows(factors *f) {
  const double *area = f->area;
  for (size_t i = 0; i < f->count; i++) {
    const double length = f->length[i];
    double sum = 0, lost = 0;
    for (uint64_t k = f->start[i]; k < f->start[i + 1]; k++) {
      const double next = sum + area[k];
      lost += sum >= area[k] ? (sum - next) + area[k] : (area[k] - next) + sum;
      sum = next;
    }
    f->row_sum[i] = (sum + lost) / length;
    f->missing[i] = ((length - sum) - lost) / length;
    for (int k = 0; k < 2; k++) f->off[k][i] /= length;
  }
}

static void print_patches(const factors *f) {
  const int width = table_names_width(f->name, f->count);
  table_patch_titles(width);
  printf("  %12s  %12s\n", "row sum", "1 - row sum");
  for (size_t k = 0; k < f->count; k++)
    if (table_row(k, f->count, f->name[k], f->length[k], width))
      printf("  %12.9f  %12.3e\n", f->row_sum[k], f->missing[k]);
  puts("");
}

static size_t find_worst(const factors *f) {
  size_t worst = 0;
  for (size_t k = 1; k < f->count; k++)
    if (fabs(f->missing[k]) > fabs(f->missing[worst])) worst = k;
  return worst;
}

/* The worst rows. */
static void print_cut_off(const factors *f) {
  double off[2] = {0, 0};
  for (size_t i = 0; i < f->count; i++)
    for (int k = 0; k < 2; k++) off[k] = fmax(off[k], f->off[k][i]);
  printf("cut off   images of the period make about %.1e of a row sum, at most %.1e\n", off[0],
         off[1]);
}

static void print_factors(const factors *f, double total_seconds) {
  const hr2d_matrix_counts *n = &f->counts;
  const size_t worst = find_worst(f);
  const effort list[] = {{"exchange areas", n->exchange_areas},
                         {"visibility tests", n->visibility_tests}};
  scene_print(f->options, 10, f->cuts);
  printf("patches   %zu\n", hr2d_scene_patches(f->scene));
  if (f->options->group) printf("features  %zu\n", f->count);
  printf("pairs     %llu clear, %llu partly visible, %llu see nothing of each other\n",
         (unsigned long long)(n->exchange_areas - n->partial_pairs),
         (unsigned long long)n->partial_pairs, (unsigned long long)factors_unseen(f));
  print_patches(f);
  char name[64]; /* the table above has it whole */
  printable_copy(name, sizeof name, f->name[worst]);
  printf("worst     |1 - row sum| = %.3e, of %s %zu (%s)\n", fabs(f->missing[worst]),
         f->options->group ? "feature" : "patch", worst, name);
  if (hr2d_scene_cut_off(f->scene) > 0) print_cut_off(f);
  table_print_work(list, sizeof list / sizeof *list);
  printf("seconds   factors %.3f, total %.3f\n", f->seconds, total_seconds);
}

static int report(const factors *f, double start) {
  const options *o = f->options;
  int status = 0;
  if (options_want_table(o)) print_factors(f, clock_seconds() - start);
  if (o->csv) status = factors_write_csv(f);
  if (o->mtx && !status) status = factors_write_mtx(f);
  if (o->elmer && !status) status = factors_write_elmer(f);
  if (o->moose && !status) status = factors_write_moose(f);
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
  status = make_room(&f);
  if (!status) status = integrate(&f);
  if (!status && o->group) status = factors_group(&f);
  if (!status) {
    sum_rows(&f);
    status = report(&f, start);
  }
  release(&f);
  hr2d_scene_destroy(scene);
  return status;
}
