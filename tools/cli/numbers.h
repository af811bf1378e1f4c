/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as users write them.  The whole word has to be a number. */
#ifndef HR2D_TOOLS_CLI_NUMBERS_H
#define HR2D_TOOLS_CLI_NUMBERS_H

#include <stdint.h>

/* Reads a finite number, decimal or hexadecimal.  Returns 0, or -1. */
int number_real(const char *text, double *value);

/* Reads decimal digits, a number of at most `limit`.  Returns 0, or -1. */
int number_count(const char *text, uint64_t limit, uint64_t *value);

#endif
