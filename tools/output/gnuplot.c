/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot reads the script from its standard input and draws to its standard output, so that
   its syntax never sees a file name.  The output is a pipe that this program copies to the
   file, because gnuplot does not notice when a disk is full, and with its provenance. */
#include "output/gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "output/complain.h"
#include "output/metadata.h"
#include "output/output.h"
#include "output/suffix.h"

extern char **environ;

void gnuplot_quote(FILE *script, const char *text) {
  fputc('\'', script);
  for (; *text; text++) {
    if (*text == '\'') fputc('\'', script);
    fputc((unsigned char)*text < ' ' ? ' ' : *text, script);
  }
  fputc('\'', script);
}

void gnuplot_title(FILE *script, const char *title) {
  fputs("set title ", script);
  gnuplot_quote(script, title);
  fputs(" noenhanced\n", script);
}

void gnuplot_terminal(FILE *script, const char *path, int width, int height) {
  switch (suffix_of(path)) {
  case SUFFIX_SVG:
    fprintf(script,
            "set terminal svg size %d,%d dynamic font 'sans-serif,14' background 'white'\n",
            width, height);
    break;
  case SUFFIX_PDF:
    fprintf(script, "set terminal pdfcairo size %g,%g font 'sans-serif,14'\n", 0.01 * width,
            0.01 * height);
    break;
  default:
    fprintf(script,
            "set terminal pngcairo size %d,%d font 'sans-serif,14' fontscale 1.6 linewidth 2\n",
            2 * width, 2 * height);
  }
}

static int start(pid_t *child, int script, int picture, int complaints) {
  static char *arguments[] = {"gnuplot", "--default-settings", NULL};
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  sigset_t standard;
  sigemptyset(&standard);
  sigaddset(&standard, SIGPIPE);
  sigaddset(&standard, SIGXFSZ);
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

/* Complains with the first line of gnuplot's messages that holds any text. */
static int fail_gnuplot(const char *path, FILE *complaints) {
  char line[256] = "";
  rewind(complaints);
  while (fgets(line, sizeof line, complaints))
    if (line[strspn(line, " \t\r\n^")]) break;
  line[strcspn(line, "\n")] = '\0';
  return complain(path, "gnuplot failed: %s", *line ? line : "no reason given");
}

/* Both ends are closed in the child, whose standard output is a copy of one.  A child that held
   the reading end would wait forever after this program has stopped reading. */
static int open_pipe(int ends[2]) {
  if (pipe(ends)) return -1;
  if (fcntl(ends[0], F_SETFD, FD_CLOEXEC) >= 0 && fcntl(ends[1], F_SETFD, FD_CLOEXEC) >= 0)
    return 0;
  close(ends[0]);
  close(ends[1]);
  return -1;
}

/* Writes the first block of a picture with its provenance, and others as they are.  Returns 0
   or the exit status; errors of the stream stay in it. */
static int put(FILE *picture, suffix format, const char *block, size_t size, int first) {
  if (first) return metadata_write(picture, format, block, size);
  fwrite(block, 1, size, picture);
  return EXIT_DONE;
}

/* Copies whole blocks until the pipe ends or the picture cannot be written.  *whole: the pipe
   was read to its end and was not empty.  Returns 0 or the exit status after an error message.
 */
static int copy(int from, suffix format, FILE *picture, int *whole) {
  char block[16384];
  size_t kept = 0, total = 0;
  int status = EXIT_DONE;
  *whole = 0;
  for (;;) {
    const ssize_t size = read(from, block + kept, sizeof block - kept);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return status;
    kept += (size_t)size;
    total += (size_t)size;
    if (size > 0 && kept < sizeof block) continue;
    if (kept > 0) status = put(picture, format, block, kept, total == kept);
    *whole = !status && size == 0 && total > 0 && !ferror(picture);
    if (status || size == 0 || ferror(picture)) return status;
    kept = 0;
  }
}

static int run_gnuplot(const char *path, FILE *script, FILE *picture, FILE *complaints) {
  pid_t child = 0;
  int status = 0, drawn = 0, failed = 0, ends[2];
  rewind(script);
  if (open_pipe(ends)) return complain(path, "cannot run gnuplot: %s", strerror(errno));
  const int error = start(&child, fileno(script), ends[1], fileno(complaints));
  close(ends[1]);
  if (!error) failed = copy(ends[0], suffix_of(path), picture, &drawn);
  close(ends[0]);
  if (error == ENOENT) return complain(path, "cannot be plotted: gnuplot is not installed");
  if (error) return complain(path, "cannot run gnuplot: %s", strerror(error));
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return complain(path, "cannot wait for gnuplot: %s", strerror(errno));
  if (failed) return failed;
  if (ferror(picture)) return EXIT_DONE; /* output_close() prints the reason */
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    return complain(path, "cannot be plotted: gnuplot is not installed");
  return status || !drawn ? fail_gnuplot(path, complaints) : EXIT_DONE;
}

int gnuplot_draw(const char *path, void (*write_script)(FILE *script, const void *ctx),
                 const void *ctx) {
  output out;
  int status = output_open(&out, path);
  if (status) return status;
  FILE *script = tmpfile(), *complaints = tmpfile();
  if (script && complaints) {
    write_script(script, ctx);
    if (fflush(script) || ferror(script))
      status = complain(path, "cannot write the script for gnuplot");
    else
      status = run_gnuplot(path, script, out.stream, complaints);
  } else
    status = complain(path, "cannot make a temporary file: %s", strerror(errno));
  if (script) fclose(script);
  if (complaints) fclose(complaints);
  return output_close(&out, status);
}
