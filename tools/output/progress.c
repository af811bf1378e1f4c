/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The terminal is touched ten times a second at most, and never before a second is over. */
#include "output/progress.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "output/complain.h"
#include "output/output.h"

static volatile sig_atomic_t stopped;
static volatile sig_atomic_t heeded;   /* whether progress_show() is going to be called */
static volatile sig_atomic_t terminal; /* whether a line may stand there */

double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Said at once where nobody is going to look at `stopped`, or nobody did. */
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

/* What is ignored, as under nohup(1), stays so.  Without SA_RESTART a line on its way to a
   slow pipe would be lost. */
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
  *p = (progress){.wanted = !quiet && isatty(STDERR_FILENO), .start = seconds()};
  p->last = p->start;
  terminal = p->wanted;
  heeded = 1;
  catch_interrupts();
}

void progress_end(void) {
  heeded = 0;
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
  const int width = (int)strlen(line);
  fprintf(stderr, "\r%-*s", p->width > width ? p->width : width, line);
  fflush(stderr);
  p->width = width;
}

hr2d_status progress_show(void *ctx, const hr2d_progress *now) {
  progress *p = ctx;
  if (!strcmp(now->phase, "coefficients")) p->coefficients = seconds();
  if (stopped) return HR2D_STOPPED;
  if (!p->wanted) return HR2D_OK;
  const double time = seconds();
  if (time - p->start > 1 && time - p->last > 0.1) {
    p->last = time;
    show(p, now);
  }
  return HR2D_OK;
}

void progress_clear(progress *p) {
  if (p->width) fprintf(stderr, "\r%*s\r", p->width, "");
  p->width = 0;
}
