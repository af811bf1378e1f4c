/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A column is as wide as its characters, not its bytes: names may be UTF-8. */
#include "output/table.h"

#include <stdio.h>

#include "output/printable.h"

enum { MOST_ROWS = 60, END_ROWS = 20 };

void table_print_work(const effort *list, size_t count) {
  int column = 0;
  for (size_t k = 0; k < count; k++) {
    char text[64];
    if (!list[k].count) continue;
    const int width = snprintf(text, sizeof text, " %s %llu", list[k].what,
                               (unsigned long long)list[k].count);
    if (!column || column + 1 + width > 79)
      column = printf(column ? ",\n%-9s" : "%-9s", column ? "" : "work");
    else
      column += printf(",");
    column += printf("%s", text);
  }
  if (column) puts("");
}

static int count_columns(const char *text) {
  int n = 0;
  for (size_t length; *text; text += length ? length : 1, n++) length = printable_length(text);
  return n;
}

static void print_padded(const char *text, int width) {
  const int n = count_columns(text);
  printable_put(text, stdout);
  printf("%*s", width > n ? width - n : 0, "");
}

int table_names_width(const char *const *name, size_t count) {
  int width = 4;
  for (size_t k = 0; k < count; k++) {
    const int n = count_columns(name[k]);
    if (n > width) width = n;
  }
  return width;
}

int table_name_width(const hr2d_scene *scene) {
  int width = 4;
  for (size_t k = 0; k < hr2d_scene_patches(scene); k++) {
    const int n = count_columns(hr2d_scene_name(scene, k));
    if (n > width) width = n;
  }
  return width;
}

void table_patch_titles(int name_width) {
  printf("\npatch  ");
  print_padded("name", name_width);
  printf("  %12s", "length");
}

static int is_skipped(size_t k, size_t count) {
  const size_t skipped = count > MOST_ROWS ? count - 2 * END_ROWS : 0;
  if (!skipped || k < END_ROWS || k >= count - END_ROWS) return 0;
  if (k == END_ROWS)
    printf("  ...  %zu more patches; --json and --csv have all of them\n", skipped);
  return 1;
}

int table_row(size_t k, size_t count, const char *name, double length, int name_width) {
  if (is_skipped(k, count)) return 0;
  printf("%5zu  ", k);
  print_padded(name, name_width);
  printf("  %12.6g", length);
  return 1;
}

int table_patch(const hr2d_scene *scene, size_t k, int name_width) {
  return table_row(k, hr2d_scene_patches(scene), hr2d_scene_name(scene, k),
                   hr2d_scene_length(scene, k), name_width);
}
