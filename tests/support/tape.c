/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/tape.h"

#include <stdlib.h>
#include <string.h>

#include "support/support.h"

static int fails(tape *t) {
  return t->until_failure >= 0 && t->until_failure-- == 0;
}

hr2d_status tape_record(void *ctx, const void *bytes, size_t size) {
  tape *t = ctx;
  if (fails(t)) return t->failure;
  t->byte = realloc(t->byte, t->size + size);
  memcpy(t->byte + t->size, bytes, size);
  t->size += size;
  return HR2D_OK;
}

hr2d_status tape_play(void *ctx, void *bytes, size_t size) {
  tape *t = ctx;
  if (fails(t)) return t->failure;
  if (t->touched) ck_assert_int_eq(hr2d_refine(t->touched, NULL), HR2D_ESTATE);
  if (t->at + size > t->size) return HR2D_ESYNTAX;
  memcpy(bytes, t->byte + t->at, size);
  t->at += size;
  return HR2D_OK;
}
