/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The base of everything else: statuses, the version, memory and messages. */
#include <hr2d/hr2d.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/alloc.h"
#include "base/message.h"
#include "support/suite.h"

START_TEST(every_status_has_its_own_phrase) {
  for (int i = HR2D_OK; i <= HR2D_EACCURACY; i++) {
    const char *phrase = hr2d_strerror((hr2d_status)i);
    ck_assert_ptr_nonnull(phrase);
    ck_assert_uint_gt(strlen(phrase), 0);
    ck_assert_int_ne(phrase[strlen(phrase) - 1], '.');
    ck_assert_str_ne(phrase, "unknown status");
    for (int j = HR2D_OK; j < i; j++) ck_assert_str_ne(phrase, hr2d_strerror((hr2d_status)j));
  }
}
END_TEST

START_TEST(a_value_outside_the_enumeration_has_a_phrase) {
  const int values[] = {-1, HR2D_EACCURACY + 1, INT_MAX, INT_MIN};
  for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
    /* Through memory, since a conversion may assume the enumeration's range. */
    hr2d_status status;
    memcpy(&status, &values[i], sizeof status);
    ck_assert_str_eq(hr2d_strerror(status), "unknown status");
  }
}
END_TEST

START_TEST(the_version_is_that_of_the_header) {
  char text[32];
  snprintf(text, sizeof text, "%d.%d.%d", HR2D_VERSION_MAJOR, HR2D_VERSION_MINOR,
           HR2D_VERSION_PATCH);
  ck_assert_str_eq(hr2d_version(), HR2D_VERSION);
  ck_assert_str_eq(hr2d_version(), text);
}
END_TEST

/* Hooks that count, and that refuse from a chosen call on. */
typedef struct hook_state {
  unsigned calls, refuse_from;
  size_t largest;
} hook_state;

static int refused(hook_state *hooks, size_t bytes) {
  if (bytes > hooks->largest) hooks->largest = bytes;
  return ++hooks->calls >= hooks->refuse_from;
}

static void *hook_allocate(void *ctx, size_t bytes) {
  return refused(ctx, bytes) ? NULL : malloc(bytes);
}

static void *hook_reallocate(void *ctx, void *block, size_t bytes) {
  return refused(ctx, bytes) ? NULL : realloc(block, bytes);
}

static void hook_release(void *ctx, void *block) {
  (void)ctx;
  ck_assert_ptr_nonnull(block);
  free(block);
}

static hr2d_allocator counting(hook_state *hooks) {
  return (hr2d_allocator){hook_allocate, hook_reallocate, hook_release, hooks};
}

START_TEST(sizes_that_overflow_never_reach_the_hooks) {
  static const struct {
    size_t count, size;
  } refusals[] = {{SIZE_MAX, 2},
                  {2, SIZE_MAX},
                  {SIZE_MAX / 8 + 2, 8},
                  {(size_t)PTRDIFF_MAX + 1, 1},
                  {SIZE_MAX, SIZE_MAX},
                  {(size_t)1 << (sizeof(size_t) * 4), (size_t)1 << (sizeof(size_t) * 4)}};
  hook_state hooks = {0, UINT_MAX, 0};
  const hr2d_allocator alloc = counting(&hooks);
  for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
    char byte, *array = &byte;
    size_t capacity = 1;
    const size_t count = refusals[i].count, size = refusals[i].size;
    ck_assert_ptr_null(hr2di_alloc(&alloc, count, size));
    ck_assert_ptr_null(hr2di_alloc_zero(&alloc, count, size));
    ck_assert_int_eq(hr2di_alloc_reserve(&alloc, &array, &capacity, count, size), -1);
    ck_assert_ptr_eq(array, &byte);
    ck_assert_uint_eq(capacity, 1);
  }
  ck_assert_uint_eq(hooks.calls, 0);
}
END_TEST

START_TEST(an_array_of_nothing_is_not_a_failure) {
  hook_state hooks = {0, UINT_MAX, 0};
  const hr2d_allocator alloc = counting(&hooks);
  void *blocks[] = {hr2di_alloc(&alloc, 0, 8), hr2di_alloc(&alloc, 8, 0),
                    hr2di_alloc_zero(&alloc, 0, SIZE_MAX)};
  for (size_t i = 0; i < 3; i++) {
    ck_assert_ptr_nonnull(blocks[i]);
    hr2di_alloc_free(&alloc, blocks[i]);
  }
  hr2di_alloc_free(&alloc, NULL);
}
END_TEST

START_TEST(calloc_fills_with_zero) {
  const hr2d_allocator alloc = hr2di_alloc_default();
  unsigned char *bytes = hr2di_alloc_zero(&alloc, 1000, 1);
  ck_assert_ptr_nonnull(bytes);
  for (size_t i = 0; i < 1000; i++) ck_assert_uint_eq(bytes[i], 0);
  hr2di_alloc_free(&alloc, bytes);
}
END_TEST

START_TEST(reserve_keeps_what_is_there_and_doubles) {
  hook_state hooks = {0, UINT_MAX, 0};
  const hr2d_allocator alloc = counting(&hooks);
  size_t *array = NULL, capacity = 0;
  for (size_t i = 0; i < 100000; i++) {
    ck_assert_int_eq(hr2di_alloc_reserve(&alloc, &array, &capacity, i + 1, sizeof *array), 0);
    ck_assert_uint_ge(capacity, i + 1);
    array[i] = i;
  }
  for (size_t i = 0; i < 100000; i++) ck_assert_uint_eq(array[i], i);
  /* 2^17 is the first power of two above 100000. */
  ck_assert_uint_le(hooks.calls, 17);
  ck_assert_uint_le(capacity, 200000);

  const unsigned calls = hooks.calls;
  ck_assert_int_eq(hr2di_alloc_reserve(&alloc, &array, &capacity, 5, sizeof *array), 0);
  ck_assert_uint_eq(hooks.calls, calls);
  hr2di_alloc_free(&alloc, array);
}
END_TEST

START_TEST(a_refused_reserve_changes_nothing) {
  hook_state hooks = {0, 2, 0};
  const hr2d_allocator alloc = counting(&hooks);
  int *array = NULL;
  size_t capacity = 0;
  ck_assert_int_eq(hr2di_alloc_reserve(&alloc, &array, &capacity, 3, sizeof *array), 0);
  array[2] = 42;
  int *const before = array;
  const size_t capacity_before = capacity;
  ck_assert_int_eq(hr2di_alloc_reserve(&alloc, &array, &capacity, 1000, sizeof *array), -1);
  ck_assert_ptr_eq(array, before);
  ck_assert_uint_eq(capacity, capacity_before);
  ck_assert_int_eq(array[2], 42);
  hr2di_alloc_free(&alloc, array);
}
END_TEST

/* Near the largest size, doubling would overflow: then exactly the needed size is requested. */
START_TEST(reserve_does_not_double_beyond_the_largest_size) {
  hook_state hooks = {0, 1, 0};
  const hr2d_allocator alloc = counting(&hooks);
  char *array = NULL;
  size_t capacity = (size_t)PTRDIFF_MAX / 16 - 1;
  const size_t needed = (size_t)PTRDIFF_MAX / 8 - 1;
  ck_assert_int_eq(hr2di_alloc_reserve(&alloc, &array, &capacity, needed, 8), -1);
  ck_assert_uint_eq(hooks.calls, 1);
  ck_assert_uint_ge(hooks.largest, needed * 8);
  ck_assert_uint_le(hooks.largest, PTRDIFF_MAX);
}
END_TEST

START_TEST(fail_writes_and_returns) {
  hr2di_message message = {""};
  ck_assert_int_eq(hr2di_message_fail(&message, HR2D_ESCENE, "patch \"%s\": %d", "ceiling", 7),
                   HR2D_ESCENE);
  ck_assert_str_eq(message.text, "patch \"ceiling\": 7");
  ck_assert_int_eq(hr2di_message_fail(&message, HR2D_EIO, "file: %s", message.text), HR2D_EIO);
  ck_assert_str_eq(message.text, "file: patch \"ceiling\": 7");
}
END_TEST

/* 0 if text is whole UTF-8 characters. */
static int broken_utf8(const char *text) {
  const unsigned char *byte = (const unsigned char *)text;
  while (*byte) {
    int more = *byte >= 0xF0   ? 3
               : *byte >= 0xE0 ? 2
               : *byte >= 0xC0 ? 1
               : *byte >= 0x80 ? -1
                               : 0;
    if (more < 0) return 1;
    for (byte++; more > 0; more--, byte++)
      if ((*byte & 0xC0) != 0x80) return 1;
  }
  return 0;
}

/* Characters of 1 to 4 bytes, shifted so that the cut falls on each of their bytes. */
START_TEST(a_long_message_is_cut_between_characters) {
  static const char *const characters[] = {"x", "é", "∫", "𝛆"};
  const size_t room = sizeof((hr2di_message *)0)->text - 1;
  char argument[2 * sizeof(hr2di_message) + 8];
  for (size_t c = 0; c < 4; c++)
    for (size_t shift = 0; shift < 4; shift++) {
      const size_t width = strlen(characters[c]);
      size_t length = shift;
      memset(argument, '-', shift);
      for (; length < 2 * room; length += width)
        memcpy(argument + length, characters[c], width);
      argument[length] = '\0';

      hr2di_message message;
      hr2di_message_fail(&message, HR2D_ESCENE, "%s", argument);
      const size_t kept = strlen(message.text);
      ck_assert_uint_le(kept, room);
      ck_assert_uint_gt(kept + width, room);
      ck_assert_int_eq(broken_utf8(message.text), 0);
      ck_assert_mem_eq(message.text, argument, kept);
    }
}
END_TEST

START_TEST(a_message_that_just_fits_is_whole) {
  char argument[sizeof(hr2di_message)];
  memset(argument, '-', sizeof argument);
  memcpy(argument + sizeof argument - 4, "∫", 4);
  hr2di_message message;
  hr2di_message_fail(&message, HR2D_ESCENE, "%s", argument);
  ck_assert_str_eq(message.text, argument);
}
END_TEST

TEST_SUITE("status") {
  ADD_TESTS("status and version", every_status_has_its_own_phrase,
            a_value_outside_the_enumeration_has_a_phrase, the_version_is_that_of_the_header);
  ADD_TESTS("memory", sizes_that_overflow_never_reach_the_hooks,
            an_array_of_nothing_is_not_a_failure, calloc_fills_with_zero,
            reserve_keeps_what_is_there_and_doubles, a_refused_reserve_changes_nothing,
            reserve_does_not_double_beyond_the_largest_size);
  ADD_TESTS("messages", fail_writes_and_returns, a_long_message_is_cut_between_characters,
            a_message_that_just_fits_is_whole);
}
