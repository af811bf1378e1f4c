/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sentence an object keeps about its last failure. */
#ifndef HR2D_SRC_BASE_MESSAGE_H
#define HR2D_SRC_BASE_MESSAGE_H

#include <hr2d/status.h>
#include <stdarg.h>
#include <stddef.h>

typedef struct hr2di_message {
  char text[512];
} hr2di_message;

/* Writes the message as printf would, cut to fit on a whole UTF-8 character, and
   returns `status`, so that a failure can be reported in one line. */
__attribute__((format(printf, 3, 4))) hr2d_status
hr2di_message_fail(hr2di_message *message, hr2d_status status, const char *format, ...);

__attribute__((format(printf, 2, 0))) void
hr2di_message_write(hr2di_message *message, const char *format, va_list arguments);

/* The length of the UTF-8 character at `s`, in a terminated string; 0 if there is no valid
   character. */
size_t hr2di_message_utf8(const unsigned char *s);

/* Whether a whole text is UTF-8. */
int hr2di_message_is_utf8(const char *text);

/* Copies a text into `room` bytes, cut to fit on a whole UTF-8 character. */
void hr2di_message_copy(char *to, size_t room, const char *text);

/* A name as messages quote it: in quotation marks, cut so that the rest of the message has
   room, and without control characters, which a terminal would obey. */
typedef struct hr2di_message_quoted {
  char text[72];
} hr2di_message_quoted;

hr2di_message_quoted hr2di_message_quote(const char *name);

#endif
