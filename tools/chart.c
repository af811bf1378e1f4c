/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot reads the script from its standard input and draws to its standard output,
   so that no file name has to pass through its syntax. */
#include "chart.h"

#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "complain.h"
#include "output.h"
#include "suffix.h"

extern char **environ;

/* A string of gnuplot in single quotes, in which only the quote itself is special. */
static void write_quoted(FILE *script, const char *text) {
  fputc('\'', script);
  for (; *text; text++) {
    if (*text == '\'') fputc('\'', script);
    fputc((unsigned char)*text < ' ' ? ' ' : *text, script);
  }
  fputc('\'', script);
}

static const char *terminal(const char *path) {
  switch (suffix_of(path)) {
  case SUFFIX_SVG:
    return "svg size 800,560 dynamic font 'sans-serif,14' background 'white'";
  case SUFFIX_PDF:
    return "pdfcairo size 8,5.6 font 'sans-serif,14'";
  default:
    return "pngcairo size 1600,1120 font 'sans-serif,14' fontscale 1.6 linewidth 2";
  }
}

static void write_title(FILE *script, const options *o) {
  const char *slash = strrchr(o->scene, '/');
  char title[512];
  snprintf(title, sizeof title, "%s: oracle %s, variant %s", slash ? slash + 1 : o->scene,
           o->oracle->name, o->policy->name);
  fputs("set title ", script);
  write_quoted(script, title);
  fputs(" noenhanced\n", script);
}

static void write_fit(FILE *script, const hr2d_study_fit *fit) {
  char key[128];
  snprintf(key, sizeof key, "%.4g %c %.4g N %c %.4g N²,  R² = %.6f", fit->a,
           fit->b < 0 ? '-' : '+', fit->b < 0 ? -fit->b : fit->b, fit->c < 0 ? '-' : '+',
           fit->c < 0 ? -fit->c : fit->c, fit->r2);
  fprintf(script, "f(x) = %.17g + x*(%.17g + x*(%.17g))\n", fit->a, fit->b, fit->c);
  fputs("plot f(x) with lines linewidth 2 linecolor rgb '#21918c' title ", script);
  write_quoted(script, key);
  fputs(" noenhanced, ", script);
}

static void write_script(FILE *script, const options *o, const hr2d_study_row *rows,
                         size_t count, const hr2d_study_fit *fit) {
  double most = 0;
  fputs("set encoding utf8\n$rows << END\n", script);
  for (size_t k = 0; k < count; k++) {
    const double n = (double)rows[k].counts.elements;
    most = n > most ? n : most;
    fprintf(script, "%.17g %.17g\n", n, (double)rows[k].counts.links);
  }
  fprintf(script, "END\nset terminal %s\n", terminal(o->plot));
  write_title(script, o);
  fprintf(script, "set xrange [0:%.17g]\nset yrange [0:*]\n", 1.04 * most);
  fputs("set xlabel 'elements N'\nset ylabel 'links L'\n"
        "set format '%.7g'\nset key top left reverse Left spacing 1.3\n"
        "set border 3 linecolor rgb '#404040'\nset tics nomirror\n"
        "set grid linecolor rgb '#c8c8c8'\nset samples 500\n",
        script);
  if (fit)
    write_fit(script, fit);
  else
    fputs("plot ", script);
  fputs("$rows with points pointtype 7 pointsize 1.1 linecolor rgb '#440154'"
        " title 'measured'\n",
        script);
}

static int start(pid_t *child, int script, int picture, int complaints) {
  static char *arguments[] = {"gnuplot", "--default-settings", NULL};
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  sigset_t standard;
  sigemptyset(&standard);
  sigaddset(&standard, SIGPIPE);
  int error = posix_spawn_file_actions_init(&actions);
  if (error) return error;
  error = posix_spawnattr_init(&attributes);
  if (!error) {
    posix_spawnattr_setsigdefault(&attributes, &standard);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    error = posix_spawn_file_actions_adddup2(&actions, script, STDIN_FILENO);
    if (!error) error = posix_spawn_file_actions_adddup2(&actions, picture, STDOUT_FILENO);
    if (!error) error = posix_spawn_file_actions_adddup2(&actions, complaints, STDERR_FILENO);
    if (!error)
      error = posix_spawnp(child, "gnuplot", &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
  }
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/* The first line that says something. */
static int fail_gnuplot(const char *path, FILE *complaints) {
  char line[256] = "";
  rewind(complaints);
  while (fgets(line, sizeof line, complaints))
    if (line[strspn(line, " \t\r\n^")]) break;
  line[strcspn(line, "\n")] = '\0';
  return fail(path, "gnuplot failed: %s", *line ? line : "no reason given");
}

static int run_gnuplot(const char *path, FILE *script, FILE *picture, FILE *complaints) {
  pid_t child = 0;
  int status = 0;
  rewind(script);
  const int error = start(&child, fileno(script), fileno(picture), fileno(complaints));
  if (error == ENOENT) return fail(path, "cannot be plotted: gnuplot is not installed");
  if (error) return fail(path, "cannot run gnuplot: %s", strerror(error));
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return fail(path, "cannot wait for gnuplot: %s", strerror(errno));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    return fail(path, "cannot be plotted: gnuplot is not installed");
  if (status || lseek(fileno(picture), 0, SEEK_END) == 0) return fail_gnuplot(path, complaints);
  return EXIT_DONE;
}

int chart_study(const options *o, const hr2d_study_row *rows, size_t count,
                const hr2d_study_fit *fit) {
  output out;
  int status = output_open(&out, o->plot);
  if (status) return status;
  FILE *script = tmpfile(), *complaints = tmpfile();
  if (script && complaints) {
    write_script(script, o, rows, count, fit);
    if (fflush(script) || ferror(script))
      status = fail(o->plot, "cannot write the script for gnuplot");
    else
      status = run_gnuplot(o->plot, script, out.stream, complaints);
  } else
    status = fail(o->plot, "cannot make a temporary file: %s", strerror(errno));
  if (script) fclose(script);
  if (complaints) fclose(complaints);
  return output_close(&out, status);
}
