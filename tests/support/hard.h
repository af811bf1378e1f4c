/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reports hard cases: the result of textbook code beside that of the library.  These reports
   are the source of the table in doc/hard-cases.md; see `make hard-cases`. */
#ifndef HR2D_TESTS_SUPPORT_HARD_H
#define HR2D_TESTS_SUPPORT_HARD_H

/* A cell of the table. */
typedef struct hard_text {
  char text[120];
} hard_text;

#ifdef __GNUC__
__attribute__((format(printf, 1, 2)))
#endif
hard_text
hard_format(const char *format, ...);

/* Adds a row to the file that the environment names in HR2D_HARD_CASES, if it does. */
void hard_case(const char *part, const char *name, hard_text textbook, hard_text library);

#endif
