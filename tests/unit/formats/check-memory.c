/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The memory that reading a scene takes: at most 256 bytes for each byte of the file, with
   jansson's tree, for any contents of the file. */
#include <jansson.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

/* The bound of hr2d_scene_parse(), and a constant that does not depend on the file. */
#define PER_BYTE 256
#define CONSTANT 32768

/* Bytes in use: the requested ones, and two words for each block, as in malloc(). */
typedef union header {
  size_t bytes;
  max_align_t align;
} header;

static size_t used, peak;

static void *get(size_t bytes) {
  header *h = malloc(sizeof *h + bytes);
  if (!h) return NULL;
  h->bytes = bytes + 2 * sizeof(size_t);
  used += h->bytes;
  if (used > peak) peak = used;
  return h + 1;
}

static void put(void *block) {
  if (!block) return;
  header *h = (header *)block - 1;
  used -= h->bytes;
  free(h);
}

static void *hook_get(void *ctx, size_t bytes) {
  (void)ctx;
  return get(bytes);
}

static void hook_put(void *ctx, void *block) {
  (void)ctx;
  put(block);
}

/* Old and new are there at once, as with the worst realloc(). */
static void *hook_change(void *ctx, void *block, size_t bytes) {
  void *made = hook_get(ctx, bytes);
  if (!made || !block) return made;
  const size_t before = ((header *)block - 1)->bytes - 2 * sizeof(size_t);
  memcpy(made, block, before < bytes ? before : bytes);
  put(block);
  return made;
}

/* A text that grows. */
typedef struct text {
  char *at;
  size_t size, capacity;
} text;

static void add(text *t, const char *part) {
  const size_t length = strlen(part);
  while (t->size + length > t->capacity) {
    t->capacity = t->capacity ? 2 * t->capacity : 4096;
    t->at = realloc(t->at, t->capacity);
    ck_assert_ptr_nonnull(t->at);
  }
  if (length) memcpy(t->at + t->size, part, length);
  t->size += length;
}

static void repeat(text *t, const char *part, size_t bytes) {
  for (size_t done = 0; done < bytes; done += strlen(part)) add(t, part);
}

static double parse(const char *name, const text *t, hr2d_status expected) {
  const hr2d_allocator hooks = {hook_get, hook_change, hook_put, NULL};
  hr2d_scene *scene = NULL;
  json_set_alloc_funcs(get, put);
  used = peak = 0;
  ck_assert_int_eq(hr2d_scene_create(&hooks, &scene), HR2D_OK);
  const hr2d_status status = hr2d_scene_parse(scene, t->at, t->size);
  ck_assert_msg(status == expected, "%s: %s", name, hr2d_scene_message(scene));
  ck_assert_msg(peak <= CONSTANT + PER_BYTE * t->size, "%s: %zu bytes of memory for %zu", name,
                peak, t->size);
  const double multiple = (double)(peak > CONSTANT ? peak - CONSTANT : 0) / (double)t->size;
  printf("%-40s %8zu bytes, %6.1f of memory for each\n", name, t->size, multiple);
  hr2d_scene_destroy(scene);
  ck_assert_uint_eq(used, 0);
  return multiple;
}

#define HEAD "{\"type\":\"FeatureCollection\",\"features\":["
#define FEATURE(properties, type)                                                              \
  "{\"type\":\"Feature\",\"properties\":{" properties "},\"geometry\":{\"type\":\"" type       \
  "\",\"coordinates\":"

/* `part` and `tail` are repeated: a file, half of the bytes each. */
typedef struct shape {
  const char *name, *head, *part, *middle, *tail, *end;
  hr2d_status status;
} shape;

static const shape shapes[] = {
    {"[[[[", "", "[", "", "", "", HR2D_ESYNTAX},
    {"{\"a\":{\"a\":", "", "{\"a\":", "", "", "", HR2D_ESYNTAX},
    {"[0,0,0,", "[", "0,", "0]", "", "", HR2D_ESYNTAX},
    {"[[],[],", "[", "[],", "[]]", "", "", HR2D_ESYNTAX},
    {"[{},{},", "[", "{},", "{}]", "", "", HR2D_ESYNTAX},
    {"[[0],[0],", "[", "[0],", "[0]]", "", "", HR2D_ESYNTAX},
    {"[{\"\":0},", "[", "{\"\":0},", "{}]", "", "", HR2D_ESYNTAX},
    {"[\"\",\"\",", "[", "\"\",", "\"\"]", "", "", HR2D_ESYNTAX},
    {"cut off", "[", "{},", "", "", "", HR2D_ESYNTAX},
    {"a number of many digits", HEAD "1", "0", "", "", "", HR2D_ESYNTAX},
    {"a name without end", HEAD "\"", "x", "", "", "", HR2D_ESYNTAX},
    {"escapes", HEAD "\"", "\\u00e9", "\"", "", "]}", HR2D_ESYNTAX},
    {"segments", HEAD FEATURE("", "LineString") "[[1,1]", ",[0,0],[1,0]", "]}}]}", "", "",
     HR2D_OK},
    {"segments of two sides", HEAD FEATURE("\"sides\":\"both\"", "LineString") "[[1,1]",
     ",[0,0],[1,0]", "]}}]}", "", "", HR2D_OK},
    {"named segments of two sides",
     HEAD FEATURE("\"name\":\"0123456789012345678901234567890123456789\",\"sides\":\"both\"",
                  "LineString") "[[1,1]",
     ",[0,0],[1,0]", "]}}]}", "", "", HR2D_OK},
    {"features", HEAD "{\"type\":\"Feature\"}", "," FEATURE("", "LineString") "[[0,0],[1,0]]}}",
     "]}", "", "", HR2D_OK},
    {"bands of one feature, segments of it",
     HEAD "{\"type\":\"Feature\",\"properties\":{\"emission\":[0", ",0",
     "]},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[1,1]", ",[0,0],[1,0]", "]}}]}",
     HR2D_OK},
    {"bands of the background", "{\"type\":\"FeatureCollection\",\"hr2d\":{\"background\":[0",
     ",0", "]},\"features\":[]}", "", "", HR2D_OK},
    {"a name of many segments", HEAD "{\"type\":\"Feature\",\"properties\":{\"name\":\"x", "x",
     "\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[1,1]", ",[0,0],[1,0]",
     "]}}]}", HR2D_ESYNTAX},
    {"a name of one segment", HEAD "{\"type\":\"Feature\",\"properties\":{\"name\":\"x", "x",
     "\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0,0],[1,1]]}}]}", "", "",
     HR2D_OK},
};

static size_t shape_size(void) {
  const double size = 400000 * test_multiplier();
  return size < 4000 ? 4000 : (size_t)size;
}

static text make(const shape *s, size_t size) {
  text t = {0};
  add(&t, s->head);
  if (*s->part) repeat(&t, s->part, *s->tail ? size / 2 : size);
  add(&t, s->middle);
  if (*s->tail) repeat(&t, s->tail, size / 2);
  add(&t, s->end);
  return t;
}

START_TEST(memory_is_a_multiple_of_the_file) {
  double max = 0;
  for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
    text t = make(&shapes[k], shape_size());
    const double multiple = parse(shapes[k].name, &t, shapes[k].status);
    if (multiple > max) max = multiple;
    free(t.at);
  }
  printf("at most %.1f\n", max);
}
END_TEST

/* The longest name that several segments may have, on the shortest segments there are; with a
   patch more than a power of two, so that the array of patches has just been doubled. */
START_TEST(names_of_segments_are_bounded) {
  size_t pairs = 256;
  while (24 * pairs < shape_size()) pairs *= 2;
  for (int length = 255; length < 257; length++) {
    text t = {0};
    add(&t, HEAD "{\"type\":\"Feature\",\"properties\":{\"sides\":\"both\",\"name\":\"");
    repeat(&t, "x", (size_t)length);
    add(&t, "\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[1,1]");
    repeat(&t, ",[0,0],[1,0]", 12 * (pairs + 1));
    add(&t, "]}}]}");
    parse("a long name of segments", &t, length > 255 ? HR2D_ESYNTAX : HR2D_OK);
    free(t.at);
  }
}
END_TEST

/* The shortest records of .vs2. */
START_TEST(vs2_takes_less) {
  text t = {0};
  char line[96];
  const size_t records = shape_size() / 20;
  for (size_t k = 1; k <= records; k++) {
    snprintf(line, sizeof line, "V %zu %zu 0\n", k, k);
    add(&t, line);
  }
  for (size_t k = 1; k < records; k++) {
    snprintf(line, sizeof line, "S %zu %zu %zu 0 0 0 1 a\n", k, k, k + 1);
    add(&t, line);
  }
  ck_assert_double_lt(parse("vertices and surfaces of .vs2", &t, HR2D_OK), 64);
  free(t.at);
}
END_TEST

/* Negative control: memory is counted. */
START_TEST(memory_is_counted) {
  text t = {0};
  add(&t, "[");
  repeat(&t, "{},", 30000);
  add(&t, "0]");
  ck_assert_double_gt(parse("[{},{},", &t, HR2D_ESYNTAX), 8);
  free(t.at);
}
END_TEST

TEST_SUITE("memory") {
  ADD_TESTS("files", memory_is_a_multiple_of_the_file, names_of_segments_are_bounded,
            vs2_takes_less, memory_is_counted);
}
