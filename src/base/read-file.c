/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads a whole file into memory, in growing blocks: the size of a pipe is not known
   beforehand, and the size of any other file cannot be trusted. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif

#include "base/read-file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/alloc.h"

enum { FIRST_BLOCK = 16384, MOST_AT_ONCE = 1 << 19 };

/* strerror() is not thread-safe, and strerror_r() has two signatures, but none on Windows. */
#ifdef _WIN32
static const char *reason_of(int error, char *buffer, size_t room) {
  return strerror_s(buffer, room, error) ? "unknown error" : buffer;
}
#else
static const char *posix_reason(int failed, const char *buffer) {
  return failed ? "unknown error" : buffer;
}

static const char *gnu_reason(const char *text, const char *buffer) {
  (void)buffer;
  return text;
}

static const char *reason_of(int error, char *buffer, size_t room) {
  return _Generic(strerror_r(error, buffer, room), int: posix_reason, char *: gnu_reason)(
      strerror_r(error, buffer, room), buffer);
}
#endif

static hr2d_status fail_errno(hr2di_message *message, const char *what, int error) {
  char buffer[128];
  return hr2di_message_fail(message, error == ENOMEM ? HR2D_ENOMEM : HR2D_EIO, "%s: %s", what,
                            reason_of(error, buffer, sizeof buffer));
}

static hr2d_status read_stream(const hr2d_allocator *alloc, FILE *stream, char **text,
                               size_t *size, hr2di_message *message, hr2di_watch *watch) {
  size_t capacity = 0;
  for (;;) {
    if (hr2di_alloc_reserve(alloc, text, &capacity, *size ? *size + 1 : FIRST_BLOCK, 1))
      return hr2di_message_fail(message, HR2D_ENOMEM,
                                "out of memory after %zu bytes of the file", *size);
    errno = 0;
    const size_t room = capacity - *size, some = room < MOST_AT_ONCE ? room : MOST_AT_ONCE;
    const hr2d_status status = hr2di_watch_work(watch, some / 128);
    if (status) return status;
    size_t got = fread(*text + *size, 1, some, stream);
    *size += got;
    if (ferror(stream)) return fail_errno(message, "cannot read", errno);
    if (feof(stream)) return HR2D_OK;
  }
}

hr2d_status hr2di_file_read(const hr2d_allocator *alloc, const char *path, char **text,
                            size_t *size, hr2di_message *message, hr2di_watch *watch) {
  *text = NULL;
  *size = 0;
  errno = 0;
  FILE *stream = fopen(path, "rb");
  if (!stream) return fail_errno(message, "cannot open", errno);
  /* Unbuffered: the blocks are large, and a stream's buffer would not come from the hooks. */
  setvbuf(stream, NULL, _IONBF, 0);
  hr2d_status status = read_stream(alloc, stream, text, size, message, watch);
  fclose(stream);
  if (status) {
    hr2di_alloc_free(alloc, *text);
    *text = NULL;
    *size = 0;
  }
  return status;
}
