/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line of `hr2d pair`. */
#ifndef HR2D_TOOLS_PAIR_LINE_H
#define HR2D_TOOLS_PAIR_LINE_H

typedef struct pair_line {
  double x[8];
  int found;        /* how many numbers there are */
  const char *word; /* what is no number, within the line; or NULL */
} pair_line;

/* Blank lines and comments hold no pair. */
int pair_is_empty(const char *line);

/* Reads 8 numbers and nothing else; returns 0, or -1.  Cuts the line in words. */
int pair_read(char *line, pair_line *numbers);

/* Makes tiny segments ordinary ones, because a view factor has more digits than an exchange
   area that is denormal.  Returns the exponent of the power of two that x was divided by,
   exactly; 0 for others, which are left alone. */
int pair_grow(double x[8]);

#endif
