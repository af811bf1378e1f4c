/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How to share out a refinement among processes, or to the machines of a cluster.  You learn to
   count what each patch takes, to cut the patches into shares of equal work, and to make the
   links of one share alone, which costs this share of the time.

   The scene is a city of square houses in a ring road.  Here one process makes all shares, one
   after the other. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

enum { SIDE = 12, RING = 64, PATCHES = 4 * SIDE * SIDE + RING, SHARES = 8 };

static const double lit = 1, grey = 0.5;

static hr2d_status add(hr2d_scene *scene, hr2d_point a, hr2d_point b, const double *emission) {
  hr2d_patch wall = HR2D_PATCH_INIT;
  wall.a = a;
  wall.b = b;
  wall.emission = emission;
  wall.emission_bands = emission ? 1 : 0;
  wall.reflectance = &grey;
  wall.reflectance_bands = 1;
  return hr2d_scene_add(scene, &wall, NULL);
}

static hr2d_status add_house(hr2d_scene *scene, double x, double y, double size) {
  const hr2d_point corner[] = {
      {x - size, y - size}, {x - size, y + size}, {x + size, y + size}, {x + size, y - size}};
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < 4 && !status; k++)
    status = add(scene, corner[k], corner[(k + 1) % 4], NULL);
  return status;
}

static hr2d_point on_ring(int k) {
  const double angle = 2 * 3.14159265358979323846 * (k % RING) / RING;
  return (hr2d_point){SIDE * cos(angle), SIDE * sin(angle)};
}

static hr2d_status make_city(hr2d_scene **scene) {
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (int k = 0; k < RING && !status; k++)
    status = add(*scene, on_ring(k), on_ring(k + 1), &lit);
  for (int k = 0; k < SIDE * SIDE && !status; k++)
    status = add_house(*scene, k % SIDE - SIDE / 2 + 0.5, k / SIDE - SIDE / 2 + 0.5,
                       0.3 + 0.1 * (k * 7 % 10) / 10);
  return status ? status : hr2d_scene_commit(*scene);
}

/* The work of a row: a test of visibility takes about as long as a link. */
static double work_of(const hr2d_row_counts *row) {
  return (double)(row->links + row->visibility_tests);
}

/* Cuts the patches where equal parts of the work end. */
static void cut(const hr2d_row_counts *row, size_t first[SHARES + 1]) {
  double all = 0, sum = 0;
  for (size_t k = 0; k < PATCHES; k++) all += work_of(&row[k]);
  first[0] = 0;
  for (size_t k = 0, share = 1; k < PATCHES; k++) {
    sum += work_of(&row[k]);
    while (share < SHARES && sum >= all * (double)share / SHARES) first[share++] = k + 1;
  }
  first[SHARES] = PATCHES;
}

/* Refines rows into links, as one process of many would; the counts are those of its rows. */
static hr2d_status make_links(const hr2d_scene *scene, const hr2d_refine_options *options,
                              int stored, hr2d_refine_counts *counts) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_status status = hr2d_hierarchy_create(scene, &hierarchy);
  if (!status) status = hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &links);
  if (!status && stored) status = hr2d_refine(links, options);
  if (!status && stored) *counts = hr2d_linkset_counts(links);
  if (!status && !stored) status = hr2d_refine_count(links, options, counts);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  return status;
}

static hr2d_status share_out(const hr2d_scene *scene) {
  hr2d_row_counts row[PATCHES];
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  hr2d_refine_counts coarse, all, part;
  size_t first[SHARES + 1];
  options.epsilon = 0.2; /* twice as coarse: what takes long there takes long below, too */
  options.row_counts = row;
  hr2d_status status = make_links(scene, &options, 0, &coarse);
  options.epsilon = 0.1;
  options.row_counts = NULL;
  if (!status) status = make_links(scene, &options, 0, &all);
  if (status) return status;
  cut(row, first);
  double most = 0, sum = 0;
  uint64_t links = 0, tests = 0;
  for (int k = 0; k < SHARES && !status; k++) {
    options.row_from = first[k];
    options.row_to = first[k + 1];
    status = make_links(scene, &options, 1, &part);
    const double work = (double)(part.links + part.visibility_tests);
    printf("share %d: patches %3zu to %3zu, %6llu links, %6llu tests\n", k, first[k],
           first[k + 1] - 1, (unsigned long long)part.links,
           (unsigned long long)part.visibility_tests);
    most = fmax(most, work);
    sum += work;
    links += part.links;
    tests += part.visibility_tests;
  }
  printf("most work / mean: %.2f\n", most / (sum / SHARES));
  printf("together the links and tests of one: %s\n",
         links == all.links && tests == all.visibility_tests ? "yes" : "no");
  return status;
}

int main(void) {
  hr2d_scene *scene = NULL;
  hr2d_status status = make_city(&scene);
  if (!status) status = share_out(scene);
  if (status) fprintf(stderr, "%s\n", hr2d_strerror(status));
  hr2d_scene_destroy(scene);
  return status ? 1 : 0;
}
