/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of exact occlusion: all exchange areas of a scene against crossed strings,
   which ignore occluders, and a link of a refinement for a growing number of occluders.

   Usage: bench_visibility [rows|links|growth|hard|million|views|commit [FAMILY]]; without a
   word, rows and links. Times are medians of rounds in which both sides of a ratio alternate.
   Fails where a bar is missed.  `growth` and `hard` go on to larger scenes, and `million`
   measures a million segments from adding them on; they take as long as commit does.  `views`
   counts the views of single points in a second. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "base/alloc.h"
#include "base/clock.h"
#include "timing.h"
#include "visibility/point-view.h"

enum { MOST_ROUNDS = 15, BLOCKERS = 16 };

#define PI   3.14159265358979323846
#define SIDE 0.1 /* of a blocker */

static int failures;

static void bar(const char *what, double value, double most) {
  if (value <= most) return;
  printf("missed: %s is %.3g, at most %.3g is allowed\n", what, value, most);
  failures++;
}

static void fail(const char *what) {
  fprintf(stderr, "bench_visibility: %s\n", what);
  exit(EXIT_FAILURE);
}

/* Segments to make a scene of. */
typedef struct plan {
  hr2d_segment *segment;
  size_t count, capacity;
} plan;

static void add(plan *p, hr2d_point a, hr2d_point b) {
  if (p->count == p->capacity) {
    p->capacity = 2 * p->capacity + 64;
    p->segment = realloc(p->segment, p->capacity * sizeof *p->segment);
    if (!p->segment) fail("out of memory");
  }
  p->segment[p->count++] = (hr2d_segment){a, b};
}

/* Scene files have nine decimals. */
static double decimal(double x) {
  return nearbyint(x * 1e9) / 1e9;
}

static hr2d_point along(hr2d_point a, hr2d_point b, int k, int pieces) {
  if (k == 0 || k == pieces) return k == 0 ? a : b;
  return (hr2d_point){decimal(a.x + (b.x - a.x) * k / pieces),
                      decimal(a.y + (b.y - a.y) * k / pieces)};
}

/* A closed polygon with its edges in equal pieces. */
static void add_polygon(plan *p, const hr2d_point *corner, int corners, int pieces) {
  for (int k = 0; k < corners; k++)
    for (int m = 0; m < pieces; m++) {
      const hr2d_point a = corner[k], b = corner[(k + 1) % corners];
      add(p, along(a, b, m, pieces), along(a, b, m + 1, pieces));
    }
}

/* The unit square, seen from inside. */
static void add_room(plan *p, int pieces) {
  const hr2d_point corner[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  add_polygon(p, corner, 4, pieces);
}

/* The lower left corners of the blockers in examples/scenes/occ128.vs2. */
static const hr2d_point blocker[BLOCKERS] = {
    {0.075, 0.085},
    {0.0764112, 0.320838532},
    {0.072205845, 0.568463564},
    {0.079121185, 0.834601703},
    {0.331569866, 0.077836622},
    {0.319559789, 0.315100075},
    {0.32920167, 0.580403023},
    {0.322120967, 0.830403023},
    {0.584906074, 0.066609285},
    {0.565386025, 0.323545},
    {0.584129453, 0.584601703},
    {0.566537796, 0.818463564},
    {0.833366556, 0.067403121},
    {0.815944216, 0.334074468},
    {0.834563759, 0.575044257},
    {0.815119684, 0.815888697},
};

/* Half of the patches on the room, half on the blockers: occN. */
static void draw_occ(plan *p, int n) {
  add_room(p, n / 8);
  for (int k = 0; k < BLOCKERS; k++) {
    const hr2d_point c = blocker[k];
    const double x = decimal(c.x + SIDE), y = decimal(c.y + SIDE);
    const hr2d_point corner[] = {c, {c.x, y}, {x, y}, {x, c.y}};
    add_polygon(p, corner, 4, n / (8 * BLOCKERS));
  }
}

/* A regular polygon; counter-clockwise its front is inside, else outside. */
static void add_round(plan *p, hr2d_point centre, double radius, int corners, int hand) {
  hr2d_point last = {centre.x + radius, centre.y};
  for (int k = 1; k <= corners; k++) {
    const double angle = hand * 2 * PI * (k % corners) / corners;
    const hr2d_point next = {centre.x + radius * cos(angle), centre.y + radius * sin(angle)};
    add(p, last, next);
    last = next;
  }
}

/* The same arrangement with everything round, so that no two patches lie on one line. */
static void draw_round(plan *p, int n) {
  add_round(p, (hr2d_point){0.5, 0.5}, 0.75, n / 2, 1);
  for (int k = 0; k < BLOCKERS; k++)
    add_round(p, (hr2d_point){blocker[k].x + SIDE / 2, blocker[k].y + SIDE / 2}, SIDE / 2,
              n / (2 * BLOCKERS), -1);
}

static uint64_t state;

static double uniform(double least, double most) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return least + (most - least) * ((double)(state >> 11) * 0x1p-53);
}

/* `count` discs in the unit square that do not meet. */
static void draw_discs(int count, double least, double most, hr2d_point *centre,
                       double *radius) {
  for (int k = 0; k < count;) {
    const double r = radius[k] = uniform(least, most);
    const hr2d_point c = centre[k] = (hr2d_point){uniform(r, 1 - r), uniform(r, 1 - r)};
    int m = 0;
    while (m < k) {
      const double dx = c.x - centre[m].x, dy = c.y - centre[m].y, apart = r + radius[m];
      if (dx * dx + dy * dy <= 1.01 * apart * apart) break;
      m++;
    }
    k += m == k;
  }
}

/* Calls `put` for each of `count` discs. */
static void scatter(plan *p, int count, double least, double most,
                    void (*put)(plan *, hr2d_point, double)) {
  hr2d_point *centre = malloc(((size_t)count + 1) * sizeof *centre);
  double *radius = malloc(((size_t)count + 1) * sizeof *radius);
  if (!centre || !radius) fail("out of memory");
  state = 20250101;
  draw_discs(count, least / sqrt(count), most / sqrt(count), centre, radius);
  for (int k = 0; k < count; k++) put(p, centre[k], radius[k]);
  free(centre);
  free(radius);
}

static void put_square(plan *p, hr2d_point c, double radius) {
  const double angle = uniform(0, 2 * PI), u = radius * cos(angle), v = radius * sin(angle);
  const hr2d_point corner[] = {
      {c.x + u, c.y + v}, {c.x + v, c.y - u}, {c.x - u, c.y - v}, {c.x - v, c.y + u}};
  add_polygon(p, corner, 4, 1);
}

/* n/8 squares with diagonals of 0.35/√(n/8) to 0.7/√(n/8), any way round. */
static void draw_squares(plan *p, int n) {
  add_room(p, n / 8);
  scatter(p, n / 8, 0.175, 0.35, put_square);
}

static void put_segment(plan *p, hr2d_point c, double radius) {
  const double angle = uniform(0, 2 * PI), u = radius * cos(angle), v = radius * sin(angle);
  add(p, (hr2d_point){c.x - u, c.y - v}, (hr2d_point){c.x + u, c.y + v});
}

static void put_octagon(plan *p, hr2d_point c, double radius) {
  add_round(p, c, radius, 8, -1);
}

/* Sections of n/8 fibres. */
static void draw_fibres(plan *p, int n) {
  add_room(p, 1);
  scatter(p, n / 8, 0.15, 0.3, put_octagon);
}

/* n/4 houses between streets that are not quite straight. */
static void draw_city(plan *p, int n) {
  const int blocks = (int)sqrt(n / 4.), side = blocks > 0 ? blocks : 1;
  add_room(p, 1);
  state = 20250102;
  for (int k = 0; k < side * side; k++) {
    const double x = (k % side + .5) / side, y = (k / side + .5) / side;
    const double w = uniform(.3, .45) / side, e = uniform(.3, .45) / side,
                 south = uniform(.3, .45) / side, north = uniform(.3, .45) / side;
    const hr2d_point corner[] = {
        {x - w, y - south}, {x - w, y + north}, {x + e, y + north}, {x + e, y - south}};
    add_polygon(p, corner, 4, 1);
  }
}

/* Squares that are small beside the space between them. */
static void draw_thin(plan *p, int n) {
  add_room(p, 1);
  scatter(p, n / 4, 0.025, 0.03, put_square);
}

static void draw_tiny(plan *p, int n) {
  add_room(p, 1);
  scatter(p, n / 4, 0.0005, 0.0005, put_square);
}

/* A round room with nothing in it. */
static void draw_open(plan *p, int n) {
  add_round(p, (hr2d_point){0.5, 0.5}, 0.75, n, 1);
}

/* n segments of length 0.3/√n, each with one front and any way round. */
static void draw_segments(plan *p, int n) {
  add_room(p, 1);
  if (n > 0) scatter(p, n, 0.15, 0.15, put_segment);
}

static hr2d_scene *scene_of(void (*draw)(plan *, int), int n, int forced) {
  plan p = {0};
  hr2d_scene *scene = NULL;
  draw(&p, n);
  if (hr2d_scene_create(NULL, &scene)) fail("no scene");
  for (size_t k = 0; k < p.count; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    const double one = 1;
    patch.a = p.segment[k].a;
    patch.b = p.segment[k].b;
    patch.emission = &one;
    patch.emission_bands = 1;
    if (hr2d_scene_add(scene, &patch, NULL)) fail(hr2d_scene_message(scene));
  }
  if (forced && hr2d_scene_force(scene, HR2D_EFFECT_OCCLUSION)) fail("not forced");
  if (hr2d_scene_commit(scene)) fail(hr2d_scene_message(scene));
  free(p.segment);
  return scene;
}

#define DISTANCE(p, q)                                                                         \
  sqrt(((p).x - (q).x) * ((p).x - (q).x) + ((p).y - (q).y) * ((p).y - (q).y))

/* Half of the matrix is enough for a comparison.  As gcc -O3 compiles it without further
   options: roots may set errno then, and come one by one.  Without errno it takes half the
   time. */
#if defined __GNUC__ && !defined __clang__
__attribute__((optimize("O3")))
#endif
static void
fill_strings(const hr2d_segment *s, size_t n, double *area) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      area[i * n + j] = 0.5 * ((DISTANCE(s[i].a, s[j].a) + DISTANCE(s[i].b, s[j].b)) -
                               (DISTANCE(s[i].a, s[j].b) + DISTANCE(s[i].b, s[j].a)));
}

static double worst_row(const hr2d_scene *scene, const hr2d_exchange_rows *rows) {
  const uint64_t *start = hr2d_exchange_rows_start(rows);
  const double *area = hr2d_exchange_rows_area(rows);
  double worst = 0;
  for (size_t i = 0; i < hr2d_scene_patches(scene); i++) {
    const double length = hr2d_scene_length(scene, i);
    long double sum = -length;
    for (uint64_t k = start[i]; k < start[i + 1]; k++) sum += area[k];
    worst = fmax(worst, fabs((double)sum) / length);
  }
  return worst;
}

typedef struct measured {
  size_t patches;
  double seconds, strings, row;
  uint64_t entries;
  hr2d_matrix_counts counts;
} measured;

static double processor_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds of one call; the first one of a scene looks at the rows, too. */
static double make_rows(const hr2d_scene *scene, measured *m) {
  hr2d_exchange_rows *rows = NULL;
  const double start = processor_now();
  if (hr2d_exchange_rows_create(scene, NULL, &rows, &m->counts)) fail("no rows");
  const double seconds = processor_now() - start;
  if (m->entries == 0) m->row = worst_row(scene, rows);
  m->entries = hr2d_exchange_rows_entries(rows);
  hr2d_exchange_rows_destroy(rows);
  return seconds;
}

/* Strings take n² numbers: without them beyond `MOST_STRINGS` patches. */
enum { MOST_STRINGS = 6000 };

static double make_strings(const hr2d_segment *segment, size_t n, double *area) {
  const double start = processor_now();
  if (area) fill_strings(segment, n, area);
  return processor_now() - start;
}

static measured measure_rows(void (*draw)(plan *, int), int n) {
  hr2d_scene *scene = scene_of(draw, n, 0);
  measured m = {.patches = hr2d_scene_patches(scene)};
  const size_t patches = m.patches;
  const int rounds = n > 50000 ? 1 : n > 2048 ? 5 : MOST_ROUNDS;
  double *area = patches <= MOST_STRINGS ? calloc(patches * patches, sizeof *area) : NULL;
  hr2d_segment *segment = malloc(patches * sizeof *segment);
  if ((!area && patches <= MOST_STRINGS) || !segment) fail("out of memory");
  for (size_t k = 0; k < patches; k++) segment[k] = hr2d_scene_segment(scene, k);
  double strings[MOST_ROUNDS], exact[MOST_ROUNDS];
  for (int k = rounds > 1 ? -1 : 0; k < rounds; k++) {
    const double first = make_strings(segment, patches, area);
    const double second = make_rows(scene, &m);
    if (k >= 0) strings[k] = first, exact[k] = second;
  }
  m.seconds = median_of(exact, rounds);
  m.strings = area ? median_of(strings, rounds) : 0;
  free(segment);
  free(area);
  hr2d_scene_destroy(scene);
  return m;
}

typedef struct family {
  const char *name;
  void (*draw)(plan *, int);
  int size;      /* at which strings are the measure */
  double ratio;  /* times their seconds allowed there */
  double growth; /* exponent allowed from 5120 to 102,400; 0 for any */
} family;

/* The family that was asked for; NULL for all. */
static const char *only;

static int is_wanted(const char *name) {
  return !only || strcmp(name, only) == 0;
}

static const family families[] = {{"squares", draw_squares, 5120, .5, 1.15},
                                  {"fibres", draw_fibres, 5120, .5, 1.15},
                                  {"city", draw_city, 3960, .5, 1.15},
                                  {"occ", draw_occ, 5120, 1, 0},
                                  {"round", draw_round, 5120, 3, 0}};
enum { FAMILIES = sizeof families / sizeof *families };

static double exponent(const measured *first, const measured *second) {
  return log(second->seconds / first->seconds) /
         log((double)second->patches / (double)first->patches);
}

static void print_titles(void) {
  printf("%-8s%8s%10s%10s%8s%10s%12s%12s%12s\n", "rows", "N", "ms", "strings", "ratio", "row",
         "pairs", "partial", "triangles");
}

static void print_measured(const char *name, const measured *m) {
  printf("%-8s%8zu%10.2f%10.2f%8.2f%10.1e%12llu%12llu%12llu\n", name, m->patches,
         1e3 * m->seconds, 1e3 * m->strings, m->strings > 0 ? m->seconds / m->strings : 0,
         m->row, (unsigned long long)m->counts.exchange_areas,
         (unsigned long long)m->counts.partial_pairs,
         (unsigned long long)m->counts.visibility_tests);
  bar("worst row", m->row, 1e-13);
}

static measured measure_and_print(const char *name, void (*draw)(plan *, int), int n) {
  const measured m = measure_rows(draw, n);
  print_measured(name, &m);
  fflush(stdout);
  return m;
}

/* Up to the size at which strings are the measure. */
static void measure_families(void) {
  static const int size[] = {128, 512, 1024, 2048};
  print_titles();
  for (size_t k = 0; k < FAMILIES; k++) {
    const family *f = &families[k];
    if (!is_wanted(f->name)) continue;
    for (size_t m = 0; m < sizeof size / sizeof *size; m++)
      measure_and_print(f->name, f->draw, size[m]);
    const measured last = measure_and_print(f->name, f->draw, f->size);
    bar("the ratio to strings", last.seconds / last.strings, f->ratio);
  }
}

static void measure_growth(void) {
  print_titles();
  for (size_t k = 0; k < FAMILIES; k++) {
    const family *f = &families[k];
    if (f->growth == 0 || !is_wanted(f->name)) continue;
    const measured first = measure_and_print(f->name, f->draw, 5120);
    measure_and_print(f->name, f->draw, 20480);
    const measured last = measure_and_print(f->name, f->draw, 102400);
    printf("%-8stime grows like N^%.2f from 5120 to 102,400\n", f->name,
           exponent(&first, &last));
    bar("exponent", exponent(&first, &last), f->growth);
  }
}

/* Where beams pass many triangles, and where everything sees everything. */
static void measure_hard(void) {
  static const struct {
    const char *name;
    void (*draw)(plan *, int);
  } hard[] = {{"thin", draw_thin},
              {"tiny", draw_tiny},
              {"round", draw_round},
              {"backs", draw_segments},
              {"open", draw_open}};
  static const int size[] = {1024, 5120, 10240};
  print_titles();
  for (size_t k = 0; k < sizeof hard / sizeof *hard; k++)
    for (size_t m = 0; m < sizeof size / sizeof *size && is_wanted(hard[k].name); m++)
      measure_and_print(hard[k].name, hard[k].draw, size[m]);
}

typedef struct balance {
  const hr2d_scene *scene;
  double worst; /* row */
  uint64_t entries;
} balance;

static hr2d_status weigh_row(void *ctx, const hr2d_exchange_row *row) {
  balance *b = ctx;
  const double length = hr2d_scene_length(b->scene, row->patch);
  long double sum = -length;
  for (size_t k = 0; k < row->count; k++) sum += row->area[k];
  b->worst = fmax(b->worst, fabs((double)sum) / length);
  b->entries += row->count;
  return HR2D_OK;
}

/* Seconds on the clock. */
static double visit_rows(const hr2d_scene *scene, unsigned threads, balance *b) {
  hr2d_matrix_options options = HR2D_MATRIX_OPTIONS_INIT;
  options.threads = threads;
  *b = (balance){.scene = scene};
  const double start = hr2di_clock_now();
  if (hr2d_exchange_rows_visit(scene, &options, weigh_row, b, NULL)) fail("no rows");
  return hr2di_clock_now() - start;
}

static double gigabytes(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return (double)usage.ru_maxrss * 1024e-9;
}

/* From the first patch to the last row, with one thread and with two; then the rows are held.
 */
static void measure_million(const family *f) {
  balance b;
  measured m = {.entries = 1};
  const double start = hr2di_clock_now();
  hr2d_scene *scene = scene_of(f->draw, 1000000, 0);
  const double committed = hr2di_clock_now() - start;
  const double one = visit_rows(scene, 1, &b), space = gigabytes();
  const double two = visit_rows(scene, 2, &b);
  printf("%s: %zu patches, %.2f s to commit, %.2f s for rows of %llu entries, %.2f s with two "
         "threads, %.2f GB, worst row %.1e\n",
         f->name, hr2d_scene_patches(scene), committed, one, (unsigned long long)b.entries, two,
         space, b.worst);
  const double held = make_rows(scene, &m);
  printf("%s: %.2f s and %.2f GB to hold them\n", f->name, held, gigabytes());
  bar("seconds", committed + one, 60);
  bar("GB", space, 2);
  bar("worst row", b.worst, 1e-13);
  if (sysconf(_SC_NPROCESSORS_ONLN) > 1) bar("1.7 times two threads", 1.7 * two / one, 1);
  hr2d_scene_destroy(scene);
}

/* Root links first, then small elements. */
typedef struct refined {
  double roots, links;       /* seconds */
  double pairs;              /* of patches */
  uint64_t root_links, made; /* by the first step, by the second */
  uint64_t partial, blocked;
} refined;

static void refine(hr2d_scene *scene, double epsilon, refined *r) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *set = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  const double n = (double)hr2d_scene_patches(scene);
  if (hr2d_hierarchy_create(scene, &hierarchy) ||
      hr2d_linkset_create(hierarchy, NULL, NULL, NULL, NULL, &set))
    fail("no link set");
  double start = hr2di_clock_now();
  options.epsilon = 1e9;
  options.max_level = 12;
  if (hr2d_refine(set, &options)) fail(hr2d_linkset_message(set));
  r->roots = hr2di_clock_now() - start;
  r->pairs = n * (n - 1) / 2;
  const hr2d_refine_counts roots = hr2d_linkset_counts(set);
  start = hr2di_clock_now();
  options.epsilon = epsilon;
  if (hr2d_refine(set, &options)) fail(hr2d_linkset_message(set));
  r->links = hr2di_clock_now() - start;
  const hr2d_refine_counts all = hr2d_linkset_counts(set);
  r->root_links = roots.links;
  r->made = all.exchange_areas - roots.exchange_areas;
  r->partial = all.partial_links;
  r->blocked = all.blocked_pairs - roots.blocked_pairs;
  hr2d_linkset_destroy(set);
  hr2d_hierarchy_destroy(hierarchy);
}

static double per_link(const refined *r) {
  return 1e9 * r->links / (double)r->made;
}

/* The extra cost over the links of a convex room, per pair with an occluder in its shaft: a
   partial link or a blocked pair. */
static double per_shaded(const refined *r, double cost, double convex) {
  const double shaded = (double)(r->partial + r->blocked);
  return shaded > 0 ? (cost - convex) * (double)r->made / shaded : 0;
}

typedef struct link_cost {
  double link, shaded; /* ns */
} link_cost;

static link_cost measure_links(int n, double epsilon, double convex) {
  hr2d_scene *scene = scene_of(draw_segments, n, 0);
  const int rounds = n < 100 ? 5 : n < 1000 ? 3 : 1;
  double roots[MOST_ROUNDS], links[MOST_ROUNDS];
  refined r = {0};
  for (int k = 0; k < rounds; k++) {
    refine(scene, epsilon, &r);
    roots[k] = 1e9 * r.roots / r.pairs;
    links[k] = per_link(&r);
  }
  hr2d_scene_destroy(scene);
  link_cost cost = {.link = median_of(links, rounds)};
  cost.shaded = per_shaded(&r, cost.link, convex);
  printf("%-8s%6d%10.0f%12llu%12llu%10llu%12llu%10.1f%8.2f%10.0f\n", "links", n,
         median_of(roots, rounds), (unsigned long long)r.root_links, (unsigned long long)r.made,
         (unsigned long long)r.partial, (unsigned long long)r.blocked, cost.link,
         convex > 0 ? cost.link / convex : 1, cost.shaded);
  return cost;
}

/* The convex room, with occlusion forced and not. */
static void measure_forced(double epsilon) {
  hr2d_scene *scene[2];
  double cost[2][MOST_ROUNDS];
  refined r = {0};
  for (int k = 0; k < 2; k++) scene[k] = scene_of(draw_segments, 0, k);
  for (int k = 0; k < MOST_ROUNDS; k++)
    for (int m = 0; m < 2; m++) {
      refine(scene[m], epsilon, &r);
      cost[m][k] = per_link(&r);
    }
  for (int k = 0; k < 2; k++) hr2d_scene_destroy(scene[k]);
  const double without = median_of(cost[0], MOST_ROUNDS),
               with = median_of(cost[1], MOST_ROUNDS);
  printf("convex room, 1/epsilon %g: %.1f ns a link, %.1f with occlusion forced: %.3f times\n",
         1 / epsilon, without, with, with / without);
  bar("forced occlusion", with / without, 1.1);
}

static void measure_refinements(int most, double epsilon) {
  printf("1/epsilon = %g\n%-8s%6s%10s%12s%12s%10s%12s%10s%8s%10s\n", 1 / epsilon, "", "n",
         "ns/root", "root links", "made", "partial", "blocked", "ns/link", "ratio",
         "ns/shaded");
  const double convex = measure_links(0, epsilon, 0).link;
  double last = 0;
  for (int n = 10; n <= most; n *= 10) {
    const link_cost cost = measure_links(n, epsilon, convex);
    if (last > 0)
      bar("growth of the cost of a shaded pair", cost.shaded / last, log(n) / log(n / 10.));
    last = cost.shaded;
  }
}

/* Views of points anywhere, and what one sees. */
static void measure_views(const family *f) {
  enum { VIEWS = 2000 };
  hr2d_scene *scene = scene_of(f->draw, f->size, 0);
  const hr2d_allocator alloc = hr2di_alloc_default();
  hr2di_viewer *viewer;
  double seconds[MOST_ROUNDS];
  size_t glimpses = 0;
  for (int round = 0; round < 5; round++) {
    glimpses = 0;
    state = 20250103;
    const double start = processor_now();
    if (hr2di_viewer_create(scene, &alloc, NULL, &viewer)) fail("no viewer");
    for (int k = 0; k < VIEWS; k++) {
      hr2di_view_from seen;
      const size_t patch = (size_t)uniform(0, (double)hr2d_scene_patches(scene));
      if (hr2di_view_at(viewer, patch, uniform(0, 1), &seen)) fail("no view");
      glimpses += seen.count;
    }
    hr2di_viewer_destroy(viewer);
    seconds[round] = processor_now() - start;
  }
  printf("%-8s%8zu%12.0f%12.1f\n", f->name, hr2d_scene_patches(scene),
         VIEWS / median_of(seconds, 5), (double)glimpses / VIEWS);
  hr2d_scene_destroy(scene);
}

/* Seconds of commit alone. */
static double commit_seconds(void (*draw)(plan *, int), int n, int lamps) {
  plan p = {0};
  hr2d_scene *scene = NULL;
  draw(&p, n);
  if (hr2d_scene_create(NULL, &scene)) fail("no scene");
  for (size_t k = 0; k < p.count; k++) {
    const double one = 1;
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = p.segment[k].a;
    patch.b = p.segment[k].b;
    patch.emission = &one;
    patch.emission_bands = !lamps || k < (size_t)lamps;
    if (hr2d_scene_add(scene, &patch, NULL)) fail(hr2d_scene_message(scene));
  }
  const double start = processor_now();
  if (hr2d_scene_commit(scene)) fail(hr2d_scene_message(scene));
  const double seconds = processor_now() - start;
  hr2d_scene_destroy(scene);
  free(p.segment);
  return seconds;
}

/* Where all patches emit, and where one does: then dark patches are searched for. */
static void measure_commits(void) {
  static const family committed[] = {{"open", draw_open, 0, 0, 1.3},
                                     {"squares", draw_squares, 0, 0, 1.3},
                                     {"fibres", draw_fibres, 0, 0, 1.3}};
  static const int size[] = {10240, 102400, 1024000};
  printf("%-8s%10s%12s%12s\n", "commit", "N", "s", "one lamp, s");
  for (size_t f = 0; f < sizeof committed / sizeof *committed; f++) {
    double first = 0;
    for (int k = 0; k < 3 && is_wanted(committed[f].name); k++) {
      const double lit = commit_seconds(committed[f].draw, size[k], 0);
      printf("%-8s%10d%12.3f%12.3f\n", committed[f].name, size[k], lit,
             commit_seconds(committed[f].draw, size[k], 1));
      if (k == 0) first = lit;
      if (k == 2) bar("exponent of commit", log(lit / first) / log(100), committed[f].growth);
    }
  }
}

int main(int argc, char **argv) {
  static const char *const words[] = {"rows",    "links", "growth", "hard",
                                      "million", "views", "commit"};
  enum { WORDS = sizeof words / sizeof *words, DEFAULT = 2 };
  const char *what = argc > 1 ? argv[1] : "";
  int asked[WORDS], any = 0;
  only = argc > 2 ? argv[2] : NULL;
  for (int k = 0; k < WORDS; k++)
    any |= asked[k] = *what ? strcmp(what, words[k]) == 0 : k < DEFAULT;
  if (!any) {
    fprintf(stderr, "usage: %s [rows|links|growth|hard|million|views|commit [FAMILY]]\n",
            argv[0]);
    return 2;
  }
  if (asked[0]) measure_families();
  if (asked[1]) {
    measure_refinements(1000, 1. / 256);
    measure_forced(1. / 256);
  }
  if (asked[2]) measure_growth();
  if (asked[3]) measure_hard();
  if (asked[6]) measure_commits();
  for (int k = 0; k < 2 && asked[4]; k++)
    if (is_wanted(families[k].name)) measure_million(&families[k]);
  if (asked[5]) printf("%-8s%8s%12s%12s\n", "views", "N", "a second", "glimpses");
  for (int k = 0; k < FAMILIES && asked[5]; k++)
    if (is_wanted(families[k].name)) measure_views(&families[k]);
  return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
