/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In the place of complain.c, progress.c, output.c and state.c of the program.  Of all messages
   the first one counts: it is the reason, and others follow from it. */
#include "host.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

#include "glue.h"
#include "output/clock.h"
#include "output/complain.h"
#include "output/output.h"
#include "output/progress.h"
#include "run/state.h"

enum { LINE = 2048, PAGE_KIB = 64 };

static struct {
  hr2d_status status;
  char message[LINE];
} first;

void host_forget(void) {
  first.status = HR2D_OK;
  *first.message = '\0';
}

const char *host_message(void) {
  return first.message;
}

hr2d_status host_status(void) {
  return first.status;
}

__attribute__((format(printf, 2, 0))) static void keep(hr2d_status status, const char *format,
                                                       va_list arguments) {
  if (first.status) return;
  first.status = status;
  vsnprintf(first.message, sizeof first.message, format, arguments);
}

int complain(const char *where, const char *format, ...) {
  va_list arguments;
  (void)where;
  va_start(arguments, format);
  keep(HR2D_EINVAL, format, arguments);
  va_end(arguments);
  return EXIT_FAILED;
}

void complain_about(const char *command) {
  (void)command;
}

int complain_usage(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  keep(HR2D_EINVAL, format, arguments);
  va_end(arguments);
  return EXIT_USAGE;
}

int complain_memory(void) {
  return complain_call(NULL, "", HR2D_ENOMEM);
}

int complain_call(const char *path, const char *message, hr2d_status status) {
  const int is_first = !first.status;
  complain(path, "%s", *message ? message : hr2d_strerror(status));
  if (is_first) first.status = status;
  return status == HR2D_STOPPED ? EXIT_INTERRUPTED : EXIT_FAILED;
}

void progress_start(progress *p, int quiet) {
  (void)quiet;
  *p = (progress){.start = clock_seconds()};
}

void progress_end(void) {}

hr2d_status progress_show(void *ctx, const hr2d_progress *now) {
  progress *p = ctx;
  if (!strcmp(now->phase, "coefficients")) p->coefficients = clock_seconds();
  p->late = p->deadline > 0 && clock_seconds() > p->deadline;
  return p->late || !go_on(now->phase, now->fraction) ? HR2D_STOPPED : HR2D_OK;
}

void progress_clear(progress *p) {
  (void)p;
}

int output_is_stdout(const char *path) {
  return path && !strcmp(path, "-");
}

int output_is_same(const char *path, const char *other) {
  return !strcmp(path, other);
}

int state_load(run *r) {
  (void)r;
  return EXIT_DONE;
}

int state_save(run *r) {
  (void)r;
  return EXIT_DONE;
}

void state_mention(const run *r) {
  (void)r;
}

/* The memory of a module only grows. */
int getrusage(int who, struct rusage *usage) {
  (void)who;
  memset(usage, 0, sizeof *usage);
  usage->ru_maxrss = (long)(PAGE_KIB * __builtin_wasm_memory_size(0));
  return 0;
}
