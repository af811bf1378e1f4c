/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures time and memory of a solve to 1e-2 among fibres of 16 sides in a closed box.

   Usage: bench-fibres [--row] [--error] [PATCHES...]; 8004 and 64004 patches unless given. Each
   size has a process of its own.  Seconds are of the processor, so that other work on the
   machine matters little; parts of them follow the clock.  With --error the error is measured,
   too.  With --row the scene is an open row of unit squares, one apart.

   Usage: bench-fibres --write FIBRES SIDES; prints such a scene as GeoJSON, for other programs.
 */
#include <hr2d/hr2d.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "alone.h"
#include "many.h"
#include "timing.h"

typedef struct fibres {
  size_t count; /* of patches, about; then exactly */
  int no_error, is_row;
  hr2d_status status;
  hr2d_account account;
  double commit, solve; /* seconds */
  double peak;          /* bytes that the process had at most */
} fibres;

static void solve(void *ctx) {
  fibres *f = ctx;
  struct rusage use;
  hr2d_solution *solution = NULL;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-2;
  target.no_error = f->no_error;
  double start = cpu_seconds();
  hr2d_scene *scene = f->is_row ? many_row(f->count / 4) : many_fibres(f->count / 16);
  if (!scene) exit(EXIT_FAILURE);
  f->commit = cpu_seconds() - start;
  f->count = hr2d_scene_patches(scene);
  start = cpu_seconds();
  f->status = hr2d_solve_to(scene, &target, &solution, &f->account);
  f->solve = cpu_seconds() - start;
  getrusage(RUSAGE_SELF, &use);
  f->peak = 1024. * (double)use.ru_maxrss;
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
}

static void print_row(const fibres *f) {
  const hr2d_account *a = &f->account;
  const double part = 100 / a->seconds;
  printf("%9zu%9.1f%9.1f%8.0f%%%8.0f%%%8.0f%%%8.0f%%%9.2f%7u%7u%10llu%11llu%10.1e  %s\n",
         f->count, f->commit, f->solve, part * a->refine_seconds,
         part * a->coefficients_seconds, part * a->solve_seconds, part * a->error_seconds,
         1e-9 * f->peak, a->order, a->solves, (unsigned long long)a->elements,
         (unsigned long long)a->links, a->average.estimate,
         f->status ? hr2d_strerror(f->status) : "");
  fflush(stdout);
}

/* A fibre is one feature. */
static void write_scene(size_t count, size_t sides) {
  hr2d_point at[MANY_CORNERS];
  many_bed bed = many_bed_of(count, sides);
  puts("{\"type\": \"FeatureCollection\", \"features\": [\n"
       "{\"type\": \"Feature\", \"properties\": {\"reflectance\": 0.5, \"emission\": 1},\n"
       " \"geometry\": {\"type\": \"LineString\", \"coordinates\": [[0, 0], [1, 0]]}},\n"
       "{\"type\": \"Feature\", \"properties\": {\"reflectance\": 0.5},\n"
       " \"geometry\": {\"type\": \"LineString\",\n"
       "  \"coordinates\": [[1, 0], [1, 1], [0, 1], [0, 0]]}}");
  while (many_bed_next(&bed, at)) {
    puts(
        ",{\"type\": \"Feature\", \"properties\": {\"reflectance\": 0.5, \"faces\": \"out\"},\n"
        " \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [[");
    for (size_t c = 0; c <= bed.corners; c++) {
      const hr2d_point p = at[c % bed.corners];
      printf("%s[%.17g, %.17g]", c > 0 ? ", " : "", p.x, p.y);
    }
    puts("]]}}");
  }
  puts("]}");
}

static int write_asked(int argc, char **argv) {
  const size_t count = argc == 4 ? strtoul(argv[2], NULL, 10) : 0;
  const size_t sides = argc == 4 ? strtoul(argv[3], NULL, 10) : 0;
  if (count < 1 || sides < 3 || sides > MANY_CORNERS) {
    fprintf(stderr, "usage: bench-fibres --write FIBRES SIDES, with 3 to %d sides\n",
            MANY_CORNERS);
    return EXIT_FAILURE;
  }
  write_scene(count, sides);
  return EXIT_SUCCESS;
}

int main(int argc, char **argv) {
  if (argc > 1 && strcmp(argv[1], "--write") == 0) return write_asked(argc, argv);
  static char *usual[] = {"8004", "64004"};
  const int is_row = argc > 1 && strcmp(argv[1], "--row") == 0, then = 1 + is_row;
  const int with_error = argc > then && strcmp(argv[then], "--error") == 0;
  const int from = then + with_error;
  char **size = argc > from ? argv + from : usual;
  const int sizes = argc > from ? argc - from : 2;
  printf("%9s%9s%9s%9s%9s%9s%9s%9s%7s%7s%10s%11s%10s\n", "patches", "commit s", "solve s",
         "refine", "blocks", "sweeps", "error", "GB", "order", "solves", "N", "L", "estimate");
  for (int k = 0; k < sizes; k++) {
    fibres f = {
        .count = (size_t)strtoul(size[k], NULL, 10), .no_error = !with_error, .is_row = is_row};
    if (!alone_run(solve, &f, sizeof f)) {
      fprintf(stderr, "bench-fibres: %s patches failed\n", size[k]);
      return EXIT_FAILURE;
    }
    print_row(&f);
  }
  return EXIT_SUCCESS;
}
