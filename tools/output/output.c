/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Output goes to a temporary file beside the target, which is renamed when all of it is on the
   disk. */
#include "output/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "output/complain.h"

enum { MOST_LINKS = 40, LINK_SIZE = 4096 };

/* The temporary file, for the signal handler.  Only one output is open at a time. */
static const char *volatile pending;

static int failed(const char *path, const char *what) {
  return errno ? complain(path, "%s: %s", what, strerror(errno)) : complain(path, "%s", what);
}

/* The directory part of a path, "." if there is none.  The caller frees it. */
static char *directory_of(const char *path) {
  const char *slash = strrchr(path, '/');
  if (!slash) return strdup(".");
  return strndup(path, slash == path ? 1 : (size_t)(slash - path));
}

/* DIRECTORY/name with the directory of the path.  The caller frees it. */
static char *inside_directory_of(const char *path, const char *name) {
  char *directory = directory_of(path);
  const size_t size = directory ? strlen(directory) + strlen(name) + 2 : 0;
  char *joined = directory ? malloc(size) : NULL;
  if (joined) snprintf(joined, size, "%s/%s", directory, name);
  free(directory);
  return joined;
}

/* The end of a chain of links, even if no file is there yet: the rename has to replace the file
   and not the link to it.  The caller frees it. */
static char *target_of(const char *path) {
  char link[LINK_SIZE], *at = strdup(path);
  for (int k = 0; at && k < MOST_LINKS; k++) {
    const ssize_t size = readlink(at, link, sizeof link);
    if (size < 0 || (size_t)size == sizeof link) break;
    link[size] = '\0';
    char *next = *link == '/' ? strdup(link) : inside_directory_of(at, link);
    free(at);
    at = next;
  }
  return at;
}

/* The mode of the old file, or as fopen() sets it: 0666 without the bits of the umask. */
static mode_t permissions(const char *target) {
  struct stat old;
  if (!stat(target, &old)) return old.st_mode & 07777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

/* The name is pending before the file exists: an interrupt between the two would leave it. */
static int open_temporary(output *out) {
  out->temporary = inside_directory_of(out->target, ".hr2d-XXXXXX");
  if (!out->temporary) return complain_memory();
  pending = out->temporary;
  const int fd = mkstemp(out->temporary);
  if (fd < 0) {
    const int status = failed(out->path, "cannot be written");
    pending = NULL;
    free(out->temporary);
    out->temporary = NULL;
    return status;
  }
  if (fchmod(fd, permissions(out->target)) || !(out->stream = fdopen(fd, "wb"))) {
    const int status = failed(out->path, "cannot be written");
    close(fd);
    return status;
  }
  return 0;
}

static void release(output *out) {
  if (out->temporary) unlink(out->temporary);
  pending = NULL;
  free(out->temporary);
  free(out->target);
  *out = (output){0};
}

/* A file that is protected against writing is not replaced, although a rename could do it. */
static int check_place(const char *path, const char *target) {
  struct stat old;
  if (!stat(path, &old)) {
    if (S_ISDIR(old.st_mode)) return complain(path, "cannot be written: is a directory");
    if (!S_ISREG(old.st_mode)) return 0;
    if (access(path, W_OK)) return failed(path, "cannot be written");
  } else if (errno != ENOENT) {
    return failed(path, "cannot be written");
  }
  char *directory = directory_of(target);
  if (!directory) return complain_memory();
  const int bad = access(directory, W_OK | X_OK);
  const int status = bad ? failed(path, "cannot be written") : 0;
  free(directory);
  return status;
}

int output_is_stdout(const char *path) {
  return path && !strcmp(path, "-");
}

static int is_same_directory(const char *path, const char *other) {
  char *first = directory_of(path), *second = directory_of(other);
  struct stat a, b;
  const int same = first && second && !stat(first, &a) && !stat(second, &b) &&
                   a.st_dev == b.st_dev && a.st_ino == b.st_ino;
  free(first);
  free(second);
  return same;
}

static const char *last_part(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

int output_is_same(const char *path, const char *other) {
  struct stat a, b;
  if (!strcmp(path, other)) return 1;
  if (output_is_stdout(path) || output_is_stdout(other)) return 0;
  const int missing = stat(path, &a) != 0, other_missing = stat(other, &b) != 0;
  if (missing && other_missing)
    return !strcmp(last_part(path), last_part(other)) && is_same_directory(path, other);
  return !missing && !other_missing && S_ISREG(a.st_mode) && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino;
}

int output_check(const char *path) {
  if (!path || output_is_stdout(path)) return 0;
  char *target = target_of(path);
  const int status = target ? check_place(path, target) : complain_memory();
  free(target);
  return status;
}

int output_open(output *out, const char *path) {
  *out = (output){.path = path};
  if (output_is_stdout(path)) {
    out->stream = stdout;
    return 0;
  }
  struct stat old;
  if (!stat(path, &old) && !S_ISREG(old.st_mode)) {
    out->stream = fopen(path, "wb");
    return out->stream ? 0 : failed(path, "cannot be written");
  }
  out->target = target_of(path);
  int status = out->target ? check_place(path, out->target) : complain_memory();
  if (!status) status = open_temporary(out);
  if (status) release(out);
  return status;
}

/* The rename must not come before the bytes are on the disk: a power failure could lose them.
   Some file systems do not support fsync(). */
static int is_on_disk(FILE *stream) {
  return !fsync(fileno(stream)) || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

/* The reason of an earlier failed write is no longer in errno: another write sets it again. */
static int is_complete(const output *out) {
  const int lost = ferror(out->stream);
  errno = 0;
  if (lost && out->temporary) fputc('\n', out->stream);
  return !fflush(out->stream) && !lost && (!out->temporary || is_on_disk(out->stream));
}

static int replace(output *out) {
  if (rename(out->temporary, out->target)) return -1;
  pending = NULL;
  free(out->temporary);
  out->temporary = NULL;
  return 0;
}

int output_close(output *out, int status) {
  if (!out->stream) return status;
  int complete = is_complete(out), reason = errno;
  if (out->stream != stdout && fclose(out->stream) && complete) {
    complete = 0;
    reason = errno;
  }
  if (complete && !status && out->temporary && replace(out)) {
    complete = 0;
    reason = errno;
  }
  errno = reason;
  if (!complete && !status) status = failed(out->path, "cannot be written");
  release(out);
  return status;
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
