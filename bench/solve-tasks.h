/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes, and the targets that they are solved to. */
#ifndef HR2D_BENCH_SOLVE_TASKS_H
#define HR2D_BENCH_SOLVE_TASKS_H

#include <hr2d/scene.h>

typedef struct solve_task {
  const char *name, *file; /* of the source tree; NULL: made */
  hr2d_scene *(*make)(size_t size);
  size_t size;
  double error, bar; /* in u; 0 for none */
} solve_task;

/* Rooms, and scenes of thousands of patches. */
extern const solve_task solve_tasks[], long_solve_tasks[];
extern const size_t solve_task_count, long_solve_task_count;

/* The scene, committed; ends the program without it. */
hr2d_scene *solve_task_scene(const solve_task *task);

/* About as many patches of small squares, of walls anywhere, or of a city; NULL if that fails.
 */
hr2d_scene *solve_task_squares(size_t patches);
hr2d_scene *solve_task_soup(size_t patches);
hr2d_scene *solve_task_city(size_t patches);

#endif
