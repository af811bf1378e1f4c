/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches of one feature become one row and one column.  Exchange areas of what a body is made
   of add up: AF_GH = Σ AF_ij over i in G and j in H, and F_GH = AF_GH / Σ A_i. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "factors/factors.h"
#include "output/complain.h"

/* The rows of groups while they are summed. */
typedef struct groups {
  size_t count;
  uint32_t *of; /* patch by patch */
  double *sum;  /* of the row at hand, and roundings that it lost (Neumaier) */
  double *lost;
  size_t room;
} groups;

/* NAME of "NAME/3" and "NAME (back)" of "NAME/3 (back)"; the caller frees it. */
static char *group_name(const char *name) {
  static const char back[] = " (back)";
  char *copy = strdup(name);
  if (!copy) return NULL;
  const size_t length = strlen(copy), tail = sizeof back - 1;
  const int is_back = length > tail && !strcmp(copy + length - tail, back);
  char *end = copy + length - (is_back ? tail : 0), *digit = end;
  while (digit > copy && isdigit((unsigned char)digit[-1])) digit--;
  if (digit < end && digit > copy + 1 && digit[-1] == '/')
    strcpy(digit - 1, is_back ? back : "");
  return copy;
}

typedef struct named {
  char *name;
  size_t patch;
} named;

static int by_name(const void *a, const void *b) {
  const named *x = a, *y = b;
  const int order = strcmp(x->name, y->name);
  return order ? order : (x->patch > y->patch) - (x->patch < y->patch);
}

static int by_patch(const void *a, const void *b) {
  const named *x = a, *y = b;
  return (x->patch > y->patch) - (x->patch < y->patch);
}

/* Numbers the groups in the order of their first patches, and takes their names over. */
static void number_groups(factors *f, groups *g, named *list) {
  const size_t n = f->count;
  qsort(list, n, sizeof *list, by_name);
  for (size_t k = 0, first = 0; k < n; k++) {
    if (k && strcmp(list[k].name, list[first].name)) first = k;
    g->of[list[k].patch] = (uint32_t)list[first].patch;
  }
  qsort(list, n, sizeof *list, by_patch);
  for (size_t k = 0; k < n; k++) {
    if (g->of[k] == k) {
      f->name[g->count] = list[k].name;
      g->of[k] = (uint32_t)g->count++;
    } else {
      free(list[k].name);
      g->of[k] = g->of[g->of[k]];
    }
  }
}

static int find_groups(factors *f, groups *g) {
  named *list = calloc(f->count, sizeof *list);
  int failed = !list;
  for (size_t k = 0; k < f->count && !failed; k++) {
    list[k] = (named){group_name(f->name[k]), k};
    failed = !list[k].name;
  }
  if (!failed) {
    number_groups(f, g, list);
    f->owns_names = g->count;
  }
  for (size_t k = 0; failed && list && k < f->count; k++) free(list[k].name);
  free(list);
  return failed ? complain_memory() : 0;
}

static void add(groups *g, uint32_t to, double area) {
  const double next = g->sum[to] + area;
  g->lost[to] += g->sum[to] >= area ? (g->sum[to] - next) + area : (area - next) + g->sum[to];
  g->sum[to] = next;
}

/* Appends the sums that are not 0 as the row of a group, and clears them. */
static int end_row(factors *f, groups *g, size_t group) {
  uint64_t at = f->own.start[group];
  if (at + g->count > g->room) {
    g->room = 2 * (at + g->count);
    uint32_t *column = realloc(f->own.column, g->room * sizeof *column);
    if (column) f->own.column = column;
    double *area = realloc(f->own.area, g->room * sizeof *area);
    if (area) f->own.area = area;
    if (!column || !area) return complain_memory();
  }
  for (size_t k = 0; k < g->count; k++) {
    if (g->sum[k] > 0) {
      f->own.column[at] = (uint32_t)k;
      f->own.area[at++] = g->sum[k] + g->lost[k];
    }
    g->sum[k] = g->lost[k] = 0;
  }
  f->own.start[group + 1] = at;
  return 0;
}

/* The patches of a group, one after the other: `next` of each is the one behind it. */
static int sum_rows(factors *f, groups *g, const size_t *first, const size_t *next) {
  int status = 0;
  for (size_t k = 0; k < g->count && !status; k++) {
    for (size_t i = first[k]; i < f->count; i = next[i])
      for (uint64_t e = f->start[i]; e < f->start[i + 1]; e++)
        add(g, g->of[f->column[e]], f->area[e]);
    status = end_row(f, g, k);
  }
  return status;
}

static int sum_groups(factors *f, groups *g) {
  const size_t n = f->count;
  size_t *first = malloc((2 * n + 1) * sizeof *first), *next = first ? first + n : NULL;
  if (!first) return complain_memory();
  for (size_t k = 0; k < n; k++) first[k] = n;
  for (size_t i = n; i-- > 0;) {
    next[i] = first[g->of[i]];
    first[g->of[i]] = i;
  }
  const int status = sum_rows(f, g, first, next);
  free(first);
  return status;
}

/* Groups begin no later than their patches: lengths and errors are summed in place. */
static void sum_patches(factors *f, const groups *g) {
  double *const list[] = {f->length, f->off[0], f->off[1]};
  for (size_t m = 0; m < sizeof list / sizeof *list; m++)
    for (size_t i = 0, seen = 0; i < f->count; i++) {
      const uint32_t to = g->of[i];
      if (to == seen)
        list[m][seen++] = list[m][i];
      else
        list[m][to] += list[m][i];
    }
}

int factors_group(factors *f) {
  const size_t n = f->count;
  groups g = {.of = malloc(n * sizeof *g.of), .sum = calloc(2 * n, sizeof *g.sum)};
  g.lost = g.sum ? g.sum + n : NULL;
  f->own.start = calloc(n + 1, sizeof *f->own.start);
  int status = g.of && g.sum && f->own.start ? find_groups(f, &g) : complain_memory();
  if (!status) status = sum_groups(f, &g);
  if (!status) {
    sum_patches(f, &g);
    f->count = g.count;
    f->start = f->own.start;
    f->column = f->own.column;
    f->area = f->own.area;
  }
  free(g.of);
  free(g.sum);
  return status;
}
