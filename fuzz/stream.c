/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

hr2d_status fuzz_record(void *stream, const void *data, size_t size) {
  fuzz_stream *s = stream;
  if (s->size + size > s->room) {
    const size_t room = 2 * (s->size + size);
    uint8_t *grown = realloc(s->byte, room);
    if (!grown) return HR2D_EIO;
    s->byte = grown;
    s->room = room;
  }
  memcpy(s->byte + s->size, data, size);
  s->size += size;
  return HR2D_OK;
}

hr2d_status fuzz_play(void *stream, void *data, size_t size) {
  fuzz_stream *s = stream;
  if (size > s->size - s->at) return HR2D_ESYNTAX;
  memcpy(data, s->byte + s->at, size);
  s->at += size;
  return HR2D_OK;
}
