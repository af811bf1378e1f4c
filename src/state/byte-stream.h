/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as bytes, the same on every machine, with a hash of them all. */
#ifndef HR2D_SRC_STATE_BYTE_STREAM_H
#define HR2D_SRC_STATE_BYTE_STREAM_H

#include <hr2d/state.h>
#include <stdint.h>

enum { HR2DI_BYTES_AT_ONCE = 4096 };

/* FNV-1a of 64 bits.  Each step maps hashes one to one, so a change within one byte always
   changes the hash. */
typedef uint64_t hr2di_hash;

#define HR2DI_HASH_INIT UINT64_C(0xcbf29ce484222325)

hr2di_hash hr2di_hash_bytes(hr2di_hash hash, const void *bytes, size_t size);
hr2di_hash hr2di_hash_word(hr2di_hash hash, uint64_t word);
hr2di_hash hr2di_hash_double(hr2di_hash hash, double value);

/* Once it has failed, nothing more is written. */
typedef struct hr2di_writer {
  hr2d_write_fn write;
  void *ctx;
  hr2di_hash hash;
  hr2d_status status;
  size_t used;
  unsigned char buffer[HR2DI_BYTES_AT_ONCE];
} hr2di_writer;

void hr2di_writer_init(hr2di_writer *w, hr2d_write_fn write, void *ctx);
void hr2di_writer_text(hr2di_writer *w, const char *text, size_t size);
void hr2di_writer_half(hr2di_writer *w, uint32_t word);
void hr2di_writer_word(hr2di_writer *w, uint64_t word);
void hr2di_writer_double(hr2di_writer *w, double value);

/* Writes the hash and the rest of the buffer.  Returns HR2D_OK, or the status of the first
   write that failed. */
hr2d_status hr2di_writer_end(hr2di_writer *w);

/* Once it has failed, every number is read as 0. */
typedef struct hr2di_reader {
  hr2d_read_fn read;
  void *ctx;
  hr2di_hash hash;
  hr2d_status status;
  uint64_t expected; /* announced bytes that are not yet in the buffer */
  size_t at, held;
  unsigned char buffer[HR2DI_BYTES_AT_ONCE];
} hr2di_reader;

void hr2di_reader_init(hr2di_reader *r, hr2d_read_fn read, void *ctx);

/* Announces `bytes` more bytes that will be asked for, so that they can be read in blocks. */
void hr2di_reader_expect(hr2di_reader *r, uint64_t bytes);

void hr2di_reader_text(hr2di_reader *r, char *text, size_t size);
uint32_t hr2di_reader_half(hr2di_reader *r);
uint64_t hr2di_reader_word(hr2di_reader *r);
double hr2di_reader_double(hr2di_reader *r);

/* Reads the hash.  Returns HR2D_OK, HR2D_ESYNTAX if it is not the hash of the bytes that were
   read, or the status of the first read that failed. */
hr2d_status hr2di_reader_end(hr2di_reader *r);

#endif
