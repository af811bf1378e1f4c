/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers are put together from bytes, so the byte order of the machine does not matter. */
#include "state/byte-stream.h"

#include <string.h>

hr2di_hash hr2di_hash_bytes(hr2di_hash hash, const void *bytes, size_t size) {
  const unsigned char *byte = bytes;
  for (size_t k = 0; k < size; k++) hash = (hash ^ byte[k]) * UINT64_C(0x100000001b3);
  return hash;
}

static void encode(unsigned char *byte, uint64_t word, size_t size) {
  for (size_t k = 0; k < size; k++) byte[k] = (unsigned char)(word >> 8 * k);
}

static uint64_t decode(const unsigned char *byte, size_t size) {
  uint64_t word = 0;
  for (size_t k = 0; k < size; k++) word |= (uint64_t)byte[k] << 8 * k;
  return word;
}

hr2di_hash hr2di_hash_word(hr2di_hash hash, uint64_t word) {
  unsigned char byte[8];
  encode(byte, word, sizeof byte);
  return hr2di_hash_bytes(hash, byte, sizeof byte);
}

hr2di_hash hr2di_hash_double(hr2di_hash hash, double value) {
  uint64_t word;
  memcpy(&word, &value, sizeof word);
  return hr2di_hash_word(hash, word);
}

void hr2di_writer_init(hr2di_writer *w, hr2d_write_fn write, void *ctx) {
  w->write = write;
  w->ctx = ctx;
  w->hash = HR2DI_HASH_INIT;
  w->status = HR2D_OK;
  w->used = 0;
}

static void flush(hr2di_writer *w) {
  if (!w->status && w->used) w->status = w->write(w->ctx, w->buffer, w->used);
  w->used = 0;
}

void hr2di_writer_text(hr2di_writer *w, const char *text, size_t size) {
  if (size > sizeof w->buffer - w->used) flush(w);
  memcpy(w->buffer + w->used, text, size);
  w->hash = hr2di_hash_bytes(w->hash, text, size);
  w->used += size;
}

static void put(hr2di_writer *w, uint64_t word, size_t size) {
  unsigned char byte[8];
  encode(byte, word, size);
  hr2di_writer_text(w, (const char *)byte, size);
}

void hr2di_writer_half(hr2di_writer *w, uint32_t word) {
  put(w, word, 4);
}

void hr2di_writer_word(hr2di_writer *w, uint64_t word) {
  put(w, word, 8);
}

void hr2di_writer_double(hr2di_writer *w, double value) {
  uint64_t word;
  memcpy(&word, &value, sizeof word);
  put(w, word, 8);
}

hr2d_status hr2di_writer_end(hr2di_writer *w) {
  put(w, w->hash, 8);
  flush(w);
  return w->status;
}

void hr2di_reader_init(hr2di_reader *r, hr2d_read_fn read, void *ctx) {
  r->read = read;
  r->ctx = ctx;
  r->hash = HR2DI_HASH_INIT;
  r->status = HR2D_OK;
  r->expected = 0;
  r->at = r->held = 0;
}

void hr2di_reader_expect(hr2di_reader *r, uint64_t bytes) {
  r->expected += bytes;
}

/* Moves the unread bytes to the front of the buffer and fills it up. */
static void fill(hr2di_reader *r) {
  const size_t left = r->held - r->at, room = sizeof r->buffer - left;
  const size_t some = r->expected < room ? (size_t)r->expected : room;
  memmove(r->buffer, r->buffer + r->at, left);
  r->at = 0;
  r->held = left + some;
  r->expected -= some;
  if (some) r->status = r->read(r->ctx, r->buffer + left, some);
}

void hr2di_reader_text(hr2di_reader *r, char *text, size_t size) {
  if (!r->status && r->held - r->at < size) fill(r);
  if (!r->status && r->held - r->at < size) r->status = HR2D_ESYNTAX;
  memset(text, 0, size);
  if (r->status) return;
  memcpy(text, r->buffer + r->at, size);
  r->at += size;
  r->hash = hr2di_hash_bytes(r->hash, text, size);
}

static uint64_t get(hr2di_reader *r, size_t size) {
  unsigned char byte[8];
  hr2di_reader_text(r, (char *)byte, size);
  return decode(byte, size);
}

uint32_t hr2di_reader_half(hr2di_reader *r) {
  return (uint32_t)get(r, 4);
}

uint64_t hr2di_reader_word(hr2di_reader *r) {
  return get(r, 8);
}

double hr2di_reader_double(hr2di_reader *r) {
  const uint64_t word = get(r, 8);
  double value;
  memcpy(&value, &word, sizeof value);
  return value;
}

hr2d_status hr2di_reader_end(hr2di_reader *r) {
  const hr2di_hash hash = r->hash;
  const uint64_t stored = get(r, 8);
  if (!r->status && stored != hash) r->status = HR2D_ESYNTAX;
  return r->status;
}
