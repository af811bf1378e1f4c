/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/radiosity-scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void set_patch(radiosity_scene *s, double ax, double ay, double bx, double by, double e,
                      double rho) {
  const double all[] = {ax, ay, bx, by, e, rho};
  memcpy(s->patch[s->patches++], all, sizeof all);
}

/* The unit square, counter-clockwise from the bottom. */
static void set_square(radiosity_scene *s, double bottom, double others, double rho) {
  set_patch(s, 0, 0, 1, 0, bottom, rho);
  set_patch(s, 1, 0, 1, 1, others, rho);
  set_patch(s, 1, 1, 0, 1, others, rho);
  set_patch(s, 0, 1, 0, 0, others, rho);
}

int radiosity_scene_name(radiosity_scene *s, const char *name) {
  double d, rho;
  *s = (radiosity_scene){.patches = 0};
  snprintf(s->name, sizeof s->name, "%s", name);
  if (sscanf(name, "par_d%lf_rho%lf", &d, &rho) == 2) {
    set_patch(s, 0, 0, 1, 0, 1, rho);
    set_patch(s, 1, d, 0, d, 0, rho);
  } else if (sscanf(name, "par%lf", &d) == 1) {
    set_patch(s, 0, 0, 1, 0, 1, .5);
    set_patch(s, 1, d, 0, d, 0, .5);
  } else if (sscanf(name, "orth_touch_rho%lf", &rho) == 1) {
    set_patch(s, 0, 0, 1, 0, 1, rho);
    set_patch(s, 0, 1, 0, 0, 0, rho);
  } else if (sscanf(name, "orth%lf", &d) == 1) {
    set_patch(s, d, 0, 1 + d, 0, 1, .5);
    set_patch(s, 0, 1 + d, 0, d, 0, .5);
  } else if (sscanf(name, "square_rho%lf", &rho) == 1) {
    set_square(s, 1, 0, rho);
  } else if (sscanf(name, "square_furnace_rho%lf", &rho) == 1) {
    set_square(s, 1 - rho, 1 - rho, rho);
  } else if (sscanf(name, "occ_square_walls%lf_occ%lf", &rho, &d) == 2) {
    set_square(s, 1, 0, rho);
    set_patch(s, .3, .5, .7, .5, 0, d);
    set_patch(s, .7, .5, .3, .5, 0, d);
  }
  return s->patches > 0 ? 0 : -1;
}

/* Takes a line to its scene, which is the last one or a new one; `row` counts its patches. */
static int add_line(radiosity_scenes *all, const char *line, size_t *row) {
  char name[64], label[32];
  double average, quarter, half;
  if (sscanf(line, "%63[^,],%31[^,],%lf,%lf,%lf", name, label, &average, &quarter, &half) != 5)
    return -1;
  if (all->count == 0 || strcmp(all->scene[all->count - 1].name, name) != 0) {
    if (all->count == RADIOSITY_MOST_SCENES) return -1;
    radiosity_scene *fresh = &all->scene[all->count++];
    if (radiosity_scene_name(fresh, name)) return -1;
    *row = 0;
  }
  radiosity_scene *s = &all->scene[all->count - 1];
  if (*row == s->patches) return -1;
  memcpy(s->label[*row], label, sizeof label);
  s->average[*row] = average;
  s->quarter[*row] = quarter;
  s->half[(*row)++] = half;
  return 0;
}

int radiosity_scenes_read(const char *path, radiosity_scenes *all) {
  char line[512];
  size_t row = 0;
  FILE *in = fopen(path, "r");
  memset(all, 0, sizeof *all);
  if (!in) return -1;
  int bad = !fgets(line, sizeof line, in) || strncmp(line, "scene,patch,avgB,B_quarter,", 27);
  while (!bad && fgets(line, sizeof line, in)) bad = add_line(all, line, &row) != 0;
  fclose(in);
  return bad || all->count == 0 ? -1 : 0;
}

const radiosity_scene *radiosity_scenes_find(const radiosity_scenes *all, const char *name) {
  for (size_t k = 0; k < all->count; k++)
    if (strcmp(all->scene[k].name, name) == 0) return &all->scene[k];
  return NULL;
}

hr2d_scene *radiosity_scene_make(const radiosity_scene *s, const hr2d_allocator *hooks) {
  hr2d_scene *scene = NULL;
  hr2d_status status = hr2d_scene_create(hooks, &scene);
  for (size_t k = 0; k < s->patches && !status; k++) {
    const double *p = s->patch[k];
    const hr2d_patch patch = {.a = {p[0], p[1]},
                              .b = {p[2], p[3]},
                              .name = s->label[k],
                              .emission = &p[4],
                              .emission_bands = 1,
                              .reflectance = &p[5],
                              .reflectance_bands = 1};
    status = hr2d_scene_add(scene, &patch, NULL);
  }
  if (!status) status = hr2d_scene_commit(scene);
  if (!status) return scene;
  hr2d_scene_destroy(scene);
  return NULL;
}

double radiosity_average_error(const radiosity_scene *s, const hr2d_solution *solution) {
  double worst = 0;
  for (size_t k = 0; k < s->patches; k++)
    worst = fmax(worst, fabs(hr2d_solution_average(solution, k, 0) / s->average[k] - 1));
  return worst;
}
