/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What of a text from outside may be shown: terminals obey control characters, and pictures in
   XML have none. */
#ifndef HR2D_TOOLS_OUTPUT_PRINTABLE_H
#define HR2D_TOOLS_OUTPUT_PRINTABLE_H

#include <stddef.h>
#include <stdio.h>

/* The length of the UTF-8 character at `text`, which has one; 0: its first byte is to be shown
   as
   '?', because it begins no character, or one that controls a terminal (C0, C1), turns the
   direction of texts (U+202A to U+202E, U+2066 to U+2069) or is none (U+FFFE, U+FFFF). */
size_t printable_length(const char *text);

/* Copies a text into `room` bytes, with such bytes as '?', cut at a whole character. */
void printable_copy(char *to, size_t room, const char *text);

/* Prints a text, with such bytes as '?'. */
void printable_put(const char *text, FILE *stream);

#endif
