/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the parts of the .vs2 reader: lines and words of the text, fields of records. */
#ifndef HR2D_SRC_FORMATS_VS2_IMPL_H
#define HR2D_SRC_FORMATS_VS2_IMPL_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/scene.h>
#include <stddef.h>

#include "base/c-locale.h"
#include "base/message.h"
#include "base/watch.h"

/* A part of the text. */
typedef struct hr2di_vs2_span {
  const char *at, *end;
} hr2di_vs2_span;

/* Moves the next line from `text` to `line`, without its end (LF, CR LF or CR).  Returns 0 if
   there is none, else 1. */
int hr2di_vs2_line(hr2di_vs2_span *text, hr2di_vs2_span *line);

/* Moves the next word from `line` to `word`.  Returns 0 if there is none before the end of the
   line or a comment, else 1. */
int hr2di_vs2_word(hr2di_vs2_span *line, hr2di_vs2_span *word);

typedef struct hr2di_vs2 {
  hr2d_scene *scene;
  const hr2d_allocator *alloc;
  hr2di_message *message;
  hr2di_watch *watch;
  hr2di_c_locale numbers;
  size_t line; /* the number of the current line, from 1 */

  char *word; /* the current field, terminated */
  size_t word_capacity;

  hr2d_point *vertex;
  size_t vertices, vertex_capacity;
  size_t surfaces;
} hr2di_vs2;

/* Each takes the next field off `line`; `what` is its name in messages.  A number must be
   finite.  An integer beyond a long long becomes the nearest long long, which is the number of
   no vertex or surface.  Returns HR2D_OK; or HR2D_ESYNTAX or HR2D_ENOMEM with a message. */
hr2d_status hr2di_vs2_field(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what);
hr2d_status hr2di_vs2_number(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what,
                             double *value);
hr2d_status hr2di_vs2_integer(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what,
                              long long *value);

/* Takes a name off `line`, which must be UTF-8, as all names of patches. */
hr2d_status hr2di_vs2_name(hr2di_vs2 *reader, hr2di_vs2_span *line);

/* The current field, quoted for messages. */
hr2di_message_quoted hr2di_vs2_quote(hr2di_vs2 *reader);

#endif
