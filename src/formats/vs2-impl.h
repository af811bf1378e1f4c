/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of the .vs2 reader share: the text in lines and words, the records. */
#ifndef HR2D_SRC_FORMATS_VS2_IMPL_H
#define HR2D_SRC_FORMATS_VS2_IMPL_H

#include <hr2d/geometry.h>
#include <hr2d/memory.h>
#include <hr2d/scene.h>
#include <locale.h>
#include <stddef.h>

#include "base/message.h"

/* A part of the text. */
typedef struct hr2di_vs2_span {
  const char *at, *end;
} hr2di_vs2_span;

/* Takes the next line off `text`, without its end: LF, CR LF, or CR.  0 if there is none. */
int hr2di_vs2_line(hr2di_vs2_span *text, hr2di_vs2_span *line);

/* Takes the next word off `line`; 0 if there is none before its end or a comment. */
int hr2di_vs2_word(hr2di_vs2_span *line, hr2di_vs2_span *word);

typedef struct hr2di_vs2 {
  hr2d_scene *scene;
  const hr2d_allocator *alloc;
  hr2di_message *message;
  locale_t numbers; /* in which the decimal sign is a point */
  size_t line;      /* the number of the line at hand, from 1 */

  char *word; /* the field at hand, terminated */
  size_t word_capacity;

  hr2d_point *vertex;
  size_t vertices, vertex_capacity;
  size_t surfaces;
} hr2di_vs2;

/* Each takes the next field off `line`; `what` is its name in messages.  A number is finite;
   of an integer beyond a long long the nearest is taken, which no vertex or surface has. */
hr2d_status hr2di_vs2_field(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what);
hr2d_status hr2di_vs2_number(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what,
                             double *value);
hr2d_status hr2di_vs2_integer(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what,
                              long long *value);

/* A name: UTF-8, as names of patches are. */
hr2d_status hr2di_vs2_name(hr2di_vs2 *reader, hr2di_vs2_span *line);

/* The field at hand for messages. */
hr2di_message_quoted hr2di_vs2_quote(hr2di_vs2 *reader);

#endif
