/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Error messages, and the exit status that goes with each. */
#ifndef HR2D_TOOLS_OUTPUT_COMPLAIN_H
#define HR2D_TOOLS_OUTPUT_COMPLAIN_H

#include <hr2d/status.h>

/* Another program may use these files. */
#ifndef PROGRAM_NAME
#define PROGRAM_NAME "hr2d"
#endif

enum {
  EXIT_DONE = 0,
  EXIT_FAILED = 1, /* a failed solve or bad input */
  EXIT_USAGE = 2,
  EXIT_INTERRUPTED = 130 /* 128 + SIGINT, as shells have it */
};

/* From now on complain() prints nothing: another process says the same. */
void complain_silently(void);

/* Prints "hr2d: WHERE: …" on stderr and returns EXIT_FAILED; `where` may be NULL. */
__attribute__((format(printf, 2, 3))) int complain(const char *where, const char *format, ...);

/* From now on complain_usage() names the help of this command. */
void complain_about(const char *command);

/* Prints "hr2d: …; try 'hr2d COMMAND --help'" on stderr and returns EXIT_USAGE. */
__attribute__((format(printf, 1, 2))) int complain_usage(const char *format, ...);

/* Out of memory; returns EXIT_FAILED. */
int complain_memory(void);

/* A library call failed while the program worked on a file.  Prints the message of the library
   object, or the meaning of the status if `message` is empty.  Returns EXIT_INTERRUPTED for
   HR2D_STOPPED, else EXIT_FAILED. */
int complain_call(const char *path, const char *message, hr2d_status status);

/* The exit code of two steps: that of the first that failed, but an interrupt stays one. */
int complain_join(int first, int second);

#endif
