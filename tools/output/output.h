/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Output files that are written whole or not at all. */
#ifndef HR2D_TOOLS_OUTPUT_OUTPUT_H
#define HR2D_TOOLS_OUTPUT_OUTPUT_H

#include <stdio.h>

typedef struct output {
  const char *path; /* as the user gave it */
  char *target;     /* the file to replace at the end; NULL: written in place */
  char *temporary;  /* beside the target */
  FILE *stream;
} output;

/* Whether a path, which may be NULL, is "-" for standard output. */
int output_is_stdout(const char *path);

/* Whether two paths, of which neither is NULL, lead to one regular file, or to one place where
   no file is yet. */
int output_is_same(const char *path, const char *other);

/* Opens an output.  Devices and pipes are written in place, files under a temporary name in the
   same directory.  Returns 0, or EXIT_FAILED after an error message. */
int output_open(output *out, const char *path);

/* Ends the output.  `status` is the result of the writing so far.  If it is 0 and all bytes
   could be written, they replace the file; otherwise the old file stays.  Returns `status`, or
   EXIT_FAILED after an error message if closing fails. */
int output_close(output *out, int status);

/* Checks, before the work starts, that an output can be written; NULL is no output.  Returns 0,
   or EXIT_FAILED after an error message. */
int output_check(const char *path);

/* Removes the temporary file that is open, if any.  A signal handler may call it. */
void output_abandon(void);

/* Writes out standard output; returns `status`, or EXIT_FAILED if that fails. */
int output_finish(int status);

#endif
