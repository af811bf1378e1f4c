/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of a study as CSV, with 17 digits so that ε can be recognised by its bits. */
#include "output/csv.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/numbers.h"
#include "output/complain.h"
#include "output/output.h"
#include "study/study.h"

/* The first ones are counted; the last two are N and L by the law, with --law. */
enum { COUNTED = 6, FIELDS = 8 };

static const char *const columns_of_study[FIELDS] = {"epsilon",      "elements",     "leaves",
                                                     "links",        "oracle_calls", "seconds",
                                                     "law_elements", "law_links"};

static void write_row(FILE *stream, const study *s, const hr2d_study_row *row) {
  const hr2d_refine_counts *n = &row->counts;
  fprintf(stream, "%.17g,%llu,%llu,%llu,%llu,%.17g", row->epsilon,
          (unsigned long long)n->elements, (unsigned long long)n->leaves,
          (unsigned long long)n->links, (unsigned long long)n->oracle_calls, row->seconds);
  if (s->lawful)
    fprintf(stream, ",%.10g,%.10g", study_law_at(s->law.elements, row->epsilon),
            study_law_at(s->law.links, row->epsilon));
  putc('\n', stream);
}

int study_write_csv(const study *s) {
  output out;
  int status = output_open(&out, s->options->csv);
  if (status) return status;
  status = csv_begin(out.stream, s->options->csv_comment);
  const int fields = s->lawful ? FIELDS : COUNTED;
  for (int k = 0; k < fields; k++)
    fprintf(out.stream, "%s%c", columns_of_study[k], k + 1 < fields ? ',' : '\n');
  for (size_t k = 0; k < s->count; k++)
    if (s->rows[k].counts.elements) write_row(out.stream, s, &s->rows[k]);
  return output_close(&out, status);
}

int study_can_rewrite_csv(const study *s) {
  struct stat old;
  const char *path = s->options->csv;
  if (!path || output_is_stdout(path)) return 0;
  return stat(path, &old) ? errno == ENOENT : S_ISREG(old.st_mode);
}

/* Splits a line in place.  Returns the number of fields, FIELDS + 1 if there are more than
   FIELDS. */
static int split(char *line, char *field[FIELDS]) {
  int count = 1;
  field[0] = line;
  for (; *line; line++)
    if (*line == ',') {
      if (count == FIELDS) return FIELDS + 1;
      *line = '\0';
      field[count++] = line + 1;
    }
  return count;
}

/* Of a study without or with the law. */
static int is_header(char *field[FIELDS], int fields) {
  if (fields != COUNTED && fields != FIELDS) return 0;
  for (int k = 0; k < fields; k++)
    if (strcmp(field[k], columns_of_study[k])) return 0;
  return 1;
}

static int refuse(const char *path, size_t number, const char *what) {
  return complain(path, "cannot be resumed: line %zu %s", number, what);
}

static int read_row(const char *path, size_t number, char *field[FIELDS], hr2d_study_row *row) {
  uint64_t count[FIELDS] = {0};
  *row = (hr2d_study_row){0};
  if (number_real(field[0], &row->epsilon) || row->epsilon <= 0)
    return refuse(path, number, "does not begin with an epsilon");
  for (int k = 1; k < COUNTED - 1; k++)
    if (number_count(field[k], UINT64_MAX, &count[k]) || !count[k])
      return complain(path, "cannot be resumed: line %zu: '%s' is no number of %s", number,
                      field[k], k == 4 ? "oracle calls" : columns_of_study[k]);
  if (number_real(field[COUNTED - 1], &row->seconds) || row->seconds < 0)
    return refuse(path, number, "has no seconds");
  row->counts.elements = count[1];
  row->counts.leaves = count[2];
  row->counts.links = count[3];
  row->counts.oracle_calls = count[4];
  return 0;
}

/* The first line, but for comments, has to be the header, which sets the number of fields;
   other lines are rows. */
static int read_line(const char *path, size_t number, char *line, size_t size, int *fields,
                     hr2d_study_row *row) {
  char *field[FIELDS];
  const int first = !*fields;
  if (strlen(line) < size) return refuse(path, number, "contains a NUL byte");
  if (line[size - 1] != '\n') return refuse(path, number, "is cut off");
  line[--size] = '\0';
  if (size && line[size - 1] == '\r') line[--size] = '\0';
  const int count = split(line, field);
  if (first) *fields = count;
  if (first)
    return is_header(field, count) ? 0 : refuse(path, number, "is not the header of a study");
  if (count != *fields)
    return complain(path, "cannot be resumed: line %zu has %s fields, not %d", number,
                    count < *fields ? "fewer" : "more", *fields);
  return read_row(path, number, field, row);
}

static int append(hr2d_study_row **rows, size_t *count, const hr2d_study_row *row) {
  /* The array grows at each power of two. */
  if (!(*count & (*count - 1))) {
    const size_t capacity = *count ? 2 * *count : 1;
    hr2d_study_row *grown = realloc(*rows, capacity * sizeof *grown);
    if (!grown) return complain_memory();
    *rows = grown;
  }
  (*rows)[(*count)++] = *row;
  return 0;
}

static int read_lines(const char *path, FILE *stream, hr2d_study_row **rows, size_t *count) {
  char *line = NULL;
  size_t capacity = 0, number = 0;
  int status = 0, fields = 0;
  hr2d_study_row row;
  for (ssize_t size; !status && (size = getline(&line, &capacity, stream)) > 0;) {
    const int head = !fields;
    number++;
    if (head && *line == '#') continue;
    status = read_line(path, number, line, (size_t)size, &fields, &row);
    if (!status && !head) status = append(rows, count, &row);
  }
  free(line);
  if (!status && !feof(stream)) status = complain(path, "cannot be read: %s", strerror(errno));
  return !status && !fields ? complain(path, "cannot be resumed: it is empty") : status;
}

int study_read_csv(const char *path, hr2d_study_row **rows, size_t *count) {
  struct stat old;
  *rows = NULL;
  *count = 0;
  if (stat(path, &old)) return errno == ENOENT ? 0 : complain(path, "%s", strerror(errno));
  if (!S_ISREG(old.st_mode)) return complain(path, "cannot be resumed: it is not a file");
  FILE *stream = fopen(path, "rb");
  if (!stream) return complain(path, "cannot be read: %s", strerror(errno));
  const int status = read_lines(path, stream, rows, count);
  fclose(stream);
  return status;
}
