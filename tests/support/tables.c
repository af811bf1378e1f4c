/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/tables.h"

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/settings.h"

static char *read_reference(const char *file) {
  const char *path = test_data_path(file);
  FILE *in = fopen(path, "rb");
  ck_assert_msg(in != NULL, "cannot open %s", path);
  fseek(in, 0, SEEK_END);
  const long size = ftell(in);
  rewind(in);
  char *text = calloc((size_t)size + 1, 1);
  ck_assert_uint_eq(fread(text, 1, (size_t)size, in), (size_t)size);
  fclose(in);
  return text;
}

static char **split_line(char *line) {
  size_t cells = 1;
  for (const char *c = line; *c; c++) cells += *c == ',';
  char **cell = calloc(cells + 1, sizeof *cell);
  for (size_t k = 0; k < cells; k++) {
    cell[k] = line;
    line += strcspn(line, ",");
    if (*line) *line++ = '\0';
  }
  return cell;
}

test_table test_read_table(const char *file) {
  test_table table = {.text = read_reference(file)};
  size_t lines = 1;
  for (const char *c = table.text; *c; c++) lines += *c == '\n';
  table.cell = calloc(lines, sizeof *table.cell);
  for (char *line = strtok(table.text, "\r\n"); line; line = strtok(NULL, "\r\n"))
    table.cell[table.rows++] = split_line(line);
  ck_assert_msg(table.rows > 1, "%s has no rows", file);
  return table;
}

void test_free_table(test_table *table) {
  for (size_t k = 0; k < table->rows; k++) free(table->cell[k]);
  free(table->cell);
  free(table->text);
}

const char *test_cell(const test_table *table, size_t row, const char *column) {
  for (size_t k = 0; table->cell[0][k]; k++)
    if (strcmp(table->cell[0][k], column) == 0) return table->cell[row][k];
  ck_abort_msg("no column is called %s", column);
  return NULL;
}

double test_number(const test_table *table, size_t row, const char *column) {
  return strtod(test_cell(table, row, column), NULL);
}
