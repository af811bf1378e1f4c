/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs a harness on given files, or on its corpus, under any compiler. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

enum { PATH_SIZE = 4096 };

static int replay_file(const char *path) {
  FILE *in = fopen(path, "rb");
  if (!in) {
    perror(path);
    return -1;
  }
  uint8_t *data = NULL;
  size_t size = 0, capacity = 0, got;
  do {
    capacity = 2 * capacity + 4096;
    uint8_t *const more = realloc(data, capacity);
    if (!more) break;
    data = more;
    got = fread(data + size, 1, capacity - size, in);
    size += got;
  } while (size == capacity);
  const int failed = ferror(in) || !data;
  fclose(in);
  /* In a block of its own size, so that a sanitizer sees a byte too many. */
  uint8_t *const exact = malloc(size ? size : 1);
  if (!failed && exact) {
    memcpy(exact, data, size);
    LLVMFuzzerTestOneInput(exact, size);
  }
  free(exact);
  free(data);
  return failed || !exact ? -1 : 0;
}

/* All that is in a folder; the number of files, or -1. */
static int replay_folder(const char *folder) {
  DIR *directory = opendir(folder);
  int files = 0;
  if (!directory) {
    perror(folder);
    return -1;
  }
  for (struct dirent *entry; files >= 0 && (entry = readdir(directory));) {
    char path[2 * PATH_SIZE];
    if (entry->d_name[0] == '.') continue;
    snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    fprintf(stderr, "%s\n", entry->d_name); /* the last one is the one that failed */
    files = replay_file(path) ? -1 : files + 1;
  }
  closedir(directory);
  return files;
}

/* replay-scene replays corpus/scene. */
static int replay_corpus(const char *program) {
  const char *source = getenv("HR2D_SRCDIR"), *name = strstr(program, "replay-");
  char folder[PATH_SIZE];
  if (!name) return -1;
  for (const char *next; (next = strstr(name + 1, "replay-"));) name = next;
  snprintf(folder, sizeof folder, "%s/fuzz/corpus/%s", source ? source : ".",
           name + strlen("replay-"));
  return replay_folder(folder);
}

int main(int argc, char **argv) {
  int files = 0;
  for (int k = 1; k < argc; k++, files++)
    if (replay_file(argv[k])) return EXIT_FAILURE;
  if (argc == 1) files = replay_corpus(argv[0]);
  if (files <= 0) return EXIT_FAILURE;
  printf("%d files replayed\n", files);
  return EXIT_SUCCESS;
}
