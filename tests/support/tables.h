/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads reference values: tables of comma-separated values with a header line. */
#ifndef HR2D_TESTS_SUPPORT_TABLES_H
#define HR2D_TESTS_SUPPORT_TABLES_H

#include <stddef.h>

typedef struct test_table {
  char *text;
  char ***cell; /* cell[row][column]; row 0 is the header */
  size_t rows;
} test_table;

/* Reads a table of tests/data/reference. */
test_table test_read_table(const char *file);
void test_free_table(test_table *table);

/* The cell below the header `column` in `row` ≥ 1. */
const char *test_cell(const test_table *table, size_t row, const char *column);
double test_number(const test_table *table, size_t row, const char *column);

#endif
