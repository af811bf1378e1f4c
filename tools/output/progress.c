/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line appears after a second at the earliest, and at most ten times a second. */
#include "output/progress.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "output/clock.h"
#include "output/complain.h"
#include "output/output.h"

static volatile sig_atomic_t stopped;
static volatile sig_atomic_t heeded;   /* progress_show() will be called */
static volatile sig_atomic_t terminal; /* a line may stand on it */

/* If no progress_show() will look at `stopped`, or none has looked since the first interrupt,
   the program ends here. */
static void on_interrupt(int number) {
  static const char line[] = "\nhr2d: interrupted\n";
  (void)number;
  if (heeded && !stopped) {
    stopped = 1;
    return;
  }
  const int skipped = !(heeded && terminal);
  const ssize_t written =
      write(STDERR_FILENO, line + skipped, sizeof line - 1 - (size_t)skipped);
  (void)written;
  output_abandon();
  _exit(EXIT_INTERRUPTED);
}

/* A signal that is ignored, as under nohup(1), stays ignored.  Without SA_RESTART a line that
   is being written to a slow pipe would be lost. */
static void catch_interrupts(void) {
  static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU};
  struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
    struct sigaction before;
    if (!sigaction(numbers[k], NULL, &before) && before.sa_handler != SIG_IGN)
      sigaction(numbers[k], &action, NULL);
  }
}

void progress_start(progress *p, int quiet) {
  *p = (progress){.wanted = !quiet && isatty(STDERR_FILENO), .start = clock_seconds()};
  p->last = p->start;
  terminal = p->wanted;
  heeded = 1;
  catch_interrupts();
}

void progress_end(void) {
  heeded = 0;
}

int progress_due(progress *p) {
  const double time = clock_seconds();
  if (time - p->start <= 1 || time - p->last <= 0.1) return 0;
  p->last = time;
  return 1;
}

void progress_line(progress *p, const char *line) {
  const int width = (int)strlen(line);
  fprintf(stderr, "\r%-*s", p->width > width ? p->width : width, line);
  fflush(stderr);
  p->width = width;
}

static void show(progress *p, const hr2d_progress *now) {
  char line[80], step[32] = "";
  if (p->steps > 1) snprintf(step, sizeof step, "%u/%u ", p->step + 1, p->steps);
  if (!strcmp(now->phase, "refine"))
    snprintf(line, sizeof line, "%s%s %3.0f %%  N %llu  L %llu", step, now->phase,
             100 * now->fraction, (unsigned long long)now->elements,
             (unsigned long long)now->links);
  else if (!strcmp(now->phase, "solve"))
    snprintf(line, sizeof line, "%s%s %3.0f %%  residual %.1e", step, now->phase,
             100 * now->fraction, now->residual);
  else
    snprintf(line, sizeof line, "%s%s %3.0f %%", step, now->phase, 100 * now->fraction);
  progress_line(p, line);
}

hr2d_status progress_show(void *ctx, const hr2d_progress *now) {
  progress *p = ctx;
  if (!strcmp(now->phase, "coefficients")) p->coefficients = clock_seconds();
  p->late = !stopped && p->deadline > 0 && clock_seconds() > p->deadline;
  if (stopped || p->late) return HR2D_STOPPED;
  if (p->wanted && progress_due(p)) show(p, now);
  return HR2D_OK;
}

void progress_clear(progress *p) {
  if (p->width) fprintf(stderr, "\r%*s\r", p->width, "");
  p->width = 0;
}
