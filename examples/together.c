/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How several processes solve one scene together.  You learn to write the callback that adds up
   their values; here the processes talk through sockets, on a cluster it would be a message
   passing library.

   Each process makes the links of its share of the pairs of patches.  All of them get the same
   solution, and the same as one process. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PROCESSES = 3, PATCHES = 48 };

/* The parent, number 0, has a socket to each child; a child has one to the parent. */
typedef struct line {
  unsigned number;
  int socket[PROCESSES];
} line;

/* What a process has found. */
typedef struct found {
  hr2d_status status;
  double average; /* of B on the patch across from the lamp */
  uint64_t links; /* of its own */
} found;

/* What goes before the values. */
typedef struct head {
  hr2d_status status;
  size_t count;
} head;

static void put(int socket, const void *bytes, size_t size) {
  for (const char *at = bytes; size > 0;) {
    const ssize_t some = write(socket, at, size);
    if (some <= 0) exit(1); /* the other end is gone */
    at += some;
    size -= (size_t)some;
  }
}

static void get(int socket, void *bytes, size_t size) {
  for (char *at = bytes; size > 0;) {
    const ssize_t some = read(socket, at, size);
    if (some <= 0) exit(1);
    at += some;
    size -= (size_t)some;
  }
}

/* The parent takes the values of each child.  One that has failed sends none that count. */
static hr2d_status take_all(const line *l, hr2d_status status, hr2d_combine how, double *value,
                            size_t count) {
  for (int k = 1; k < PROCESSES; k++) {
    head h;
    get(l->socket[k], &h, sizeof h);
    double *other = malloc((h.count + 1) * sizeof *other);
    if (!other) exit(1);
    get(l->socket[k], other, h.count * sizeof *other);
    if (!status) status = h.status;
    for (size_t m = 0; m < count && !status; m++)
      value[m] = how == HR2D_COMBINE_SUM ? value[m] + other[m] : fmax(value[m], other[m]);
    free(other);
  }
  return status;
}

static hr2d_status combine(void *ctx, hr2d_status status, hr2d_combine how, double *value,
                           size_t count) {
  const line *l = ctx;
  head h = {status, status ? 0 : count};
  if (l->number == 0) {
    h.status = take_all(l, status, how, value, h.count);
    for (int k = 1; k < PROCESSES; k++) {
      put(l->socket[k], &h, sizeof h);
      if (!h.status) put(l->socket[k], value, count * sizeof *value);
    }
    return h.status;
  }
  put(l->socket[0], &h, sizeof h);
  put(l->socket[0], value, h.count * sizeof *value);
  get(l->socket[0], &h, sizeof h);
  if (!h.status) get(l->socket[0], value, count * sizeof *value);
  return h.status;
}

/* A round room with a lamp. */
static hr2d_status make_room(hr2d_scene **scene) {
  static const double lit = 1, grey = 0.5;
  hr2d_status status = hr2d_scene_create(NULL, scene);
  for (int k = 0; k < PATCHES && !status; k++) {
    const double from = 2 * 3.14159265358979323846 * k / PATCHES;
    const double to = 2 * 3.14159265358979323846 * ((k + 1) % PATCHES) / PATCHES;
    hr2d_patch wall = HR2D_PATCH_INIT;
    wall.a = (hr2d_point){cos(from), sin(from)};
    wall.b = (hr2d_point){cos(to), sin(to)};
    wall.emission = &lit;
    wall.emission_bands = k == 0;
    wall.reflectance = &grey;
    wall.reflectance_bands = 1;
    status = hr2d_scene_add(*scene, &wall, NULL);
  }
  return status ? status : hr2d_scene_commit(*scene);
}

/* Solves with a share, or alone. */
static hr2d_status solve(hr2d_share *share, double *average, uint64_t *links) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_scene *scene = NULL;
  hr2d_solution *solution = NULL;
  target.error = 1e-9;
  target.share = share;
  hr2d_status status = make_room(&scene);
  if (!status) status = hr2d_solve_to(scene, &target, &solution, NULL);
  if (!status) {
    *average = hr2d_solution_average(solution, PATCHES / 2, 0);
    *links = hr2d_linkset_size(hr2d_solution_links(solution));
  }
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return status;
}

/* The work of each process.  A child tells the parent what it has found. */
static int work(line *l) {
  hr2d_share share = {sizeof share, l->number, PROCESSES, combine, l, HR2D_OK};
  found f = {0};
  f.status = solve(&share, &f.average, &f.links);
  if (l->number > 0) put(l->socket[0], &f, sizeof f);
  if (l->number > 0) return 0;
  found alone = {0};
  alone.status = solve(NULL, &alone.average, &alone.links);
  for (int k = 0; k < PROCESSES; k++) {
    if (k > 0) get(l->socket[k], &f, sizeof f);
    if (f.status || alone.status) return 1;
    printf("process %d has %3llu of %llu links and B = %.12f\n", k, (unsigned long long)f.links,
           (unsigned long long)alone.links, f.average);
  }
  printf("alone it is %s\n", fabs(f.average - alone.average) < 1e-14 ? "the same" : "not");
  return 0;
}

int main(void) {
  line parent = {.number = 0};
  for (unsigned k = 1; k < PROCESSES; k++) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends)) return 1;
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) {
      line l = {.number = k, .socket = {ends[1]}};
      return work(&l);
    }
    close(ends[1]);
    parent.socket[k] = ends[0];
  }
  int failed = work(&parent);
  for (int k = 1, status; k < PROCESSES; k++) failed |= wait(&status) < 0 || status;
  return failed;
}
