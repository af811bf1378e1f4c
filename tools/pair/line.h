/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line of `hr2d pair`. */
#ifndef HR2D_TOOLS_PAIR_LINE_H
#define HR2D_TOOLS_PAIR_LINE_H

typedef struct pair_line {
  double x[8];
  int found;        /* the number of numbers in the line */
  const char *word; /* the first word that is no number, within the line; or NULL */
} pair_line;

/* Whether a line holds no pair: it is blank or a comment. */
int pair_is_empty(const char *line);

/* Reads a line of exactly 8 numbers, which it cuts in words.  Returns 0, or -1. */
int pair_read(char *line, pair_line *numbers);

/* Scales tiny segments up: a view factor has more digits than an exchange area that is
   denormal. Returns the exponent e of the exact division by 2^e; other segments stay as they
   are, e = 0. */
int pair_grow(double x[8]);

#endif
