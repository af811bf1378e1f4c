/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve-tasks.h"

#include <stdio.h>
#include <stdlib.h>

#include "many.h"
#include "support/slow-scenes.h"

static hr2d_scene *make(slow_kind kind, size_t patches) {
  hr2d_scene *scene = NULL;
  if (hr2d_scene_create(NULL, &scene)) return NULL;
  if (!slow_add(scene, kind, patches) && !hr2d_scene_commit(scene)) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

hr2d_scene *solve_task_squares(size_t patches) {
  return make(SLOW_SQUARES, patches);
}

hr2d_scene *solve_task_soup(size_t patches) {
  return make(SLOW_SOUP, patches);
}

hr2d_scene *solve_task_city(size_t patches) {
  return make(SLOW_CITY, patches);
}

const solve_task solve_tasks[] = {
    {"boxes-3", "bench/scenes/boxes-3.geojson", NULL, 0, 1e-6, 5},
    {"boxes-3", "bench/scenes/boxes-3.geojson", NULL, 0, 1e-9, 20},
    {"partition", "examples/scenes/partition.geojson", NULL, 0, 1e-6, 2},
    {"partition", "examples/scenes/partition.geojson", NULL, 0, 1e-9, 8},
    {"enfilade", "examples/scenes/enfilade.geojson", NULL, 0, 1e-6, 3},
    {"enfilade", "examples/scenes/enfilade.geojson", NULL, 0, 1e-9, 20},
    {"occluders-200", "examples/scenes/occluders-200.geojson", NULL, 0, 1e-3, 20},
    {"square-room", "examples/scenes/square-room.geojson", NULL, 0, 1e-6, 0},
};
const size_t solve_task_count = sizeof solve_tasks / sizeof *solve_tasks;

const solve_task long_solve_tasks[] = {
    {"occluders-200", "examples/scenes/occluders-200.geojson", NULL, 0, 1e-6, 120},
    {"random squares", NULL, many_random_squares, 1000, 1e-3, 200},
    {"fibres", NULL, many_fibres, 500, 1e-2, 100},
    {"city", NULL, solve_task_city, 8000, 1e-2, 100},
    {"round room", NULL, many_round, 100000, 1e-6, 3000},
};
const size_t long_solve_task_count = sizeof long_solve_tasks / sizeof *long_solve_tasks;

static hr2d_scene *read_scene(const char *file) {
  char path[4096];
  hr2d_scene *scene = NULL;
  snprintf(path, sizeof path, "%s/%s", BENCH_SOURCE, file);
  if (hr2d_scene_create(NULL, &scene)) return NULL;
  if (!hr2d_scene_read(scene, path) && !hr2d_scene_commit(scene)) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

hr2d_scene *solve_task_scene(const solve_task *task) {
  hr2d_scene *scene = task->file ? read_scene(task->file) : task->make(task->size);
  if (scene) return scene;
  fprintf(stderr, "no scene %s\n", task->name);
  exit(EXIT_FAILURE);
}
