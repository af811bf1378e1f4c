/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as users write them: the whole word or nothing. */
#ifndef HR2D_TOOLS_CLI_NUMBERS_H
#define HR2D_TOOLS_CLI_NUMBERS_H

#include <stdint.h>

/* Reads a finite number, decimal or hexadecimal; returns 0, or -1. */
int read_real(const char *text, double *value);

/* Reads digits that make at most `limit`; returns 0, or -1. */
int read_count(const char *text, uint64_t limit, uint64_t *value);

#endif
