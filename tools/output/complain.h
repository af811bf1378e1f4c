/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the program says when something is wrong, and the exit status that goes with it. */
#ifndef HR2D_TOOLS_OUTPUT_COMPLAIN_H
#define HR2D_TOOLS_OUTPUT_COMPLAIN_H

enum {
  EXIT_DONE = 0,
  EXIT_FAILED = 1, /* a failed solve or bad input */
  EXIT_USAGE = 2,
  EXIT_INTERRUPTED = 130 /* 128 + SIGINT, as shells have it */
};

/* Prints "hr2d: WHERE: …" on stderr and returns EXIT_FAILED; `where` may be NULL. */
__attribute__((format(printf, 2, 3))) int fail(const char *where, const char *format, ...);

/* As fail(), with a pointer to the help, and returns EXIT_USAGE. */
__attribute__((format(printf, 1, 2))) int usage_error(const char *format, ...);

/* Out of memory; returns EXIT_FAILED. */
int fail_memory(void);

#endif
