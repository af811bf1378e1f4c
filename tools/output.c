/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A temporary file beside the target, renamed once every byte is known to be there. */
#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700 /* realpath */
#endif

#include "output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "complain.h"
#include "options.h"

/* One output is open at a time; a signal handler must be able to find it. */
static const char *volatile pending;

static int failed(const char *path, const char *what) {
  return errno ? fail(path, "%s: %s", what, strerror(errno)) : fail(path, "%s", what);
}

/* The directory part of a path, for the caller to free; "." if there is none. */
static char *directory_of(const char *path) {
  const char *slash = strrchr(path, '/');
  if (!slash) return strdup(".");
  return strndup(path, slash == path ? 1 : (size_t)(slash - path));
}

/* Follows links, so that a rename replaces the file and not the link to it. */
static char *target_of(const char *path) {
  char *real = realpath(path, NULL);
  return real || errno == ENOMEM ? real : strdup(path);
}

/* As fopen() would give: what the umask leaves, or what the old file had. */
static mode_t permissions(const char *target) {
  struct stat old;
  if (!stat(target, &old)) return old.st_mode & 07777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

static int open_temporary(output *out) {
  char *directory = directory_of(out->target);
  if (!directory) return fail_memory();
  const size_t size = strlen(directory) + sizeof "/.hr2d-XXXXXX";
  out->temporary = malloc(size);
  if (out->temporary) snprintf(out->temporary, size, "%s/.hr2d-XXXXXX", directory);
  free(directory);
  if (!out->temporary) return fail_memory();
  const int fd = mkstemp(out->temporary);
  if (fd < 0) {
    free(out->temporary);
    out->temporary = NULL;
    return failed(out->path, "cannot be written");
  }
  pending = out->temporary;
  if (fchmod(fd, permissions(out->target)) || !(out->stream = fdopen(fd, "wb"))) {
    const int status = failed(out->path, "cannot be written");
    close(fd);
    return status;
  }
  return 0;
}

static void release(output *out) {
  if (out->temporary) {
    unlink(out->temporary);
    pending = NULL;
  }
  free(out->temporary);
  free(out->target);
  *out = (output){0};
}

int output_open(output *out, const char *path) {
  *out = (output){.path = path};
  if (to_stdout(path)) {
    out->stream = stdout;
    return 0;
  }
  struct stat old;
  if (!stat(path, &old) && !S_ISREG(old.st_mode)) {
    out->stream = fopen(path, "wb");
    return out->stream ? 0 : failed(path, "cannot be written");
  }
  out->target = target_of(path);
  const int status = out->target ? open_temporary(out) : fail_memory();
  if (status) release(out);
  return status;
}

int output_close(output *out, int status) {
  if (!out->stream) return status;
  errno = 0;
  int bad = fflush(out->stream) || ferror(out->stream);
  if (out->stream != stdout && fclose(out->stream)) bad = 1;
  if (!bad && !status && out->temporary) {
    bad = rename(out->temporary, out->target) != 0;
    if (!bad) {
      free(out->temporary);
      out->temporary = NULL;
      pending = NULL;
    }
  }
  if (bad && !status) status = failed(out->path, "cannot be written");
  release(out);
  return status;
}

int output_check(const char *path) {
  if (!path || to_stdout(path)) return 0;
  struct stat old;
  if (!stat(path, &old)) {
    if (S_ISDIR(old.st_mode)) return fail(path, "cannot be written: is a directory");
    if (!S_ISREG(old.st_mode)) return 0;
  }
  char *directory = directory_of(path);
  if (!directory) return fail_memory();
  const int bad = access(directory, W_OK | X_OK);
  free(directory);
  return bad ? failed(path, "cannot be written") : 0;
}

void output_abandon(void) {
  if (pending) unlink(pending);
}

int output_finish(int status) {
  errno = 0;
  const int bad = ferror(stdout) | fflush(stdout);
  if (!(bad | fclose(stdout))) return status;
  if (status) return status;
  return failed("standard output", "cannot be written");
}
