/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Output files that are written whole or not at all. */
#ifndef HR2D_TOOLS_OUTPUT_OUTPUT_H
#define HR2D_TOOLS_OUTPUT_OUTPUT_H

#include <stdio.h>

typedef struct output {
  const char *path; /* as the user gave it */
  char *target;     /* what is replaced at the end; NULL: written in place */
  char *temporary;  /* beside the target */
  FILE *stream;
} output;

/* Opens an output; "-" is standard output.  Devices and pipes are written in place,
   everything else under a temporary name in the same directory.  Returns 0, or
   EXIT_FAILED after complaining. */
int output_open(output *out, const char *path);

/* Ends the output: all of it takes the place of the file, or nothing does and a
   complaint is printed.  `status` is that of the writing so far; it is returned
   unless closing fails. */
int output_close(output *out, int status);

/* Whether an output could be made there, before the work starts; NULL is fine. */
int output_check(const char *path);

/* Removes the temporary file that is open, if any; may be called from a signal handler. */
void output_abandon(void);

/* Writes out standard output; returns `status`, or EXIT_FAILED if that fails. */
int output_finish(int status);

#endif
