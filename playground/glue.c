/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the page asks of the library, as calls that take and give numbers and arrays alone.  The
   JavaScript side is page/library.js.  Every call that can fail returns an hr2d_status. */
#include "glue.h"

#include <stdlib.h>

enum {
  FITTED = 6,      /* rows of a study that show how L grows */
  MOST_ROUNDS = 20 /* of links by the light of the last round */
};

/* A scene with what was made from it last. */
typedef struct play {
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy; /* of a solve with ε; that of a target belongs to its solution */
  hr2d_linkset *links;       /* likewise */
  hr2d_solution *solution;
  hr2d_account account;
  const char *message;
} play;

static hr2d_status ask_page(void *ctx, const hr2d_progress *progress) {
  (void)ctx;
  return go_on(progress->phase, progress->fraction) ? HR2D_OK : HR2D_STOPPED;
}

static void drop_solution(play *p) {
  hr2d_solution_destroy(p->solution);
  hr2d_linkset_destroy(p->links);
  hr2d_hierarchy_destroy(p->hierarchy);
  p->solution = NULL;
  p->links = NULL;
  p->hierarchy = NULL;
  p->account = (hr2d_account){0};
}

static void drop_scene(play *p) {
  drop_solution(p);
  hr2d_scene_destroy(p->scene);
  p->scene = NULL;
}

/* Keeps the reason of a failure: the sentence of an object, or else that of the status. */
static hr2d_status fail(play *p, hr2d_status status, const char *message) {
  p->message = !status ? "" : message && *message ? message : hr2d_strerror(status);
  return status;
}

/* Memory. */

play *PAGE(play_create)(void) {
  return calloc(1, sizeof(play));
}

void *PAGE(play_allocate)(size_t bytes) {
  return malloc(bytes ? bytes : 1);
}

void PAGE(play_release)(void *block) {
  free(block);
}

/* The scene. */

static hr2d_status read_scene(play *p, const char *text, size_t size, int cut, size_t *cuts) {
  hr2d_status status;
  drop_scene(p);
  status = hr2d_scene_create(NULL, &p->scene);
  if (status) return status;
  hr2d_scene_set_progress(p->scene, ask_page, p);
  status = hr2d_scene_parse(p->scene, text, size);
  if (!status && cut) status = hr2d_scene_split_crossings(p->scene, cuts);
  return status ? status : hr2d_scene_commit(p->scene);
}

/* Takes the text of a scene file.  With `cut`, patches that cross are cut; *cuts receives at
   how many places. */
hr2d_status PAGE(play_open)(play *p, const char *text, size_t size, int cut, size_t *cuts) {
  *cuts = 0;
  const hr2d_status status = read_scene(p, text, size, cut, cuts);
  return fail(p, status, p->scene ? hr2d_scene_message(p->scene) : NULL);
}

const char *PAGE(play_message)(const play *p) {
  return p->message;
}

size_t PAGE(play_patches)(const play *p) {
  return hr2d_scene_patches(p->scene);
}

size_t PAGE(play_bands)(const play *p) {
  return hr2d_scene_bands(p->scene);
}

double PAGE(play_background)(const play *p, size_t band) {
  return hr2d_scene_background(p->scene, band);
}

const char *PAGE(play_name)(const play *p, size_t patch) {
  return hr2d_scene_name(p->scene, patch);
}

/* For each patch its ends, then E, ρ and τ of each band: 4 + 3·bands numbers. */
void PAGE(play_walls)(const play *p, double *out) {
  const size_t patches = hr2d_scene_patches(p->scene), bands = hr2d_scene_bands(p->scene);
  for (size_t k = 0; k < patches; k++) {
    const hr2d_segment s = hr2d_scene_segment(p->scene, k);
    *out++ = s.a.x, *out++ = s.a.y, *out++ = s.b.x, *out++ = s.b.y;
    for (size_t band = 0; band < bands; band++) *out++ = hr2d_scene_emission(p->scene, k, band);
    for (size_t band = 0; band < bands; band++)
      *out++ = hr2d_scene_reflectance(p->scene, k, band);
    for (size_t band = 0; band < bands; band++)
      *out++ = hr2d_scene_transmittance(p->scene, k, band);
  }
}

/* The images of patches between mirrors and in a period, without the patches themselves: how
   many there are, and the four coordinates of each of the first `count`. */
size_t PAGE(play_images_count)(const play *p) {
  return (hr2d_scene_images(p->scene) - 1) * hr2d_scene_patches(p->scene);
}

void PAGE(play_images)(const play *p, double *out, size_t count) {
  const size_t patches = hr2d_scene_patches(p->scene);
  for (size_t k = 0; k < count; k++) {
    const hr2d_segment s = hr2d_scene_image(p->scene, k % patches, 1 + k / patches);
    *out++ = s.a.x, *out++ = s.a.y, *out++ = s.b.x, *out++ = s.b.y;
  }
}

/* Solutions. */

/* Takes what package_solve() has made.  A solution that misses its target is one, too: the
   account says so. */
void PAGE(play_take)(play *p) {
  drop_scene(p);
  const glue_solve made = glue_take();
  p->scene = made.scene;
  p->hierarchy = made.hierarchy;
  p->links = made.links;
  p->solution = made.solution;
  p->account = made.account;
  p->message = p->account.reason;
}

/* By the light of the last round, if there is one. */
static hr2d_status refine_round(play *p, hr2d_refine_options *how, hr2d_solve_options *solve) {
  hr2d_solution *next = NULL;
  how->brightness = solve->start = p->solution;
  hr2d_status status = hr2d_refine(p->links, how);
  if (!status) status = hr2d_solve(p->links, solve, &next);
  if (status) return status;
  hr2d_solution_destroy(p->solution);
  p->solution = next;
  return HR2D_OK;
}

/* Once; by an oracle that weighs by brightness, until its light adds no link. */
static hr2d_status refine_and_solve(play *p, const hr2d_oracle *oracle, double epsilon,
                                    unsigned levels, double max_links, double tolerance) {
  hr2d_refine_options how = HR2D_REFINE_OPTIONS_INIT;
  hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
  how.epsilon = epsilon;
  how.max_level = levels;
  how.max_links = (uint64_t)max_links;
  how.progress = solve.progress = ask_page;
  solve.tolerance = tolerance;
  hr2d_status status = hr2d_hierarchy_create(p->scene, &p->hierarchy);
  if (!status) status = hr2d_linkset_create(p->hierarchy, oracle, NULL, NULL, NULL, &p->links);
  for (int round = 0; !status && round < MOST_ROUNDS; round++) {
    const hr2d_refine_counts last = hr2d_linkset_counts(p->links);
    status = refine_round(p, &how, &solve);
    const hr2d_refine_counts now = hr2d_linkset_counts(p->links);
    if (!(hr2d_linkset_oracle(p->links)->flags & HR2D_ORACLE_NEEDS_BRIGHTNESS) ||
        (now.elements == last.elements && now.links == last.links))
      break;
  }
  return status;
}

/* The paper's algorithm: an oracle by its name, and ε.  For `levels`, `max_links` and
   `tolerance` 0 is the default. */
hr2d_status PAGE(play_solve_epsilon)(play *p, const char *oracle, double epsilon,
                                     unsigned levels, double max_links, double tolerance) {
  drop_solution(p);
  const hr2d_status status =
      refine_and_solve(p, hr2d_oracle_find(oracle), epsilon, levels, max_links, tolerance);
  return fail(p, status, p->links ? hr2d_linkset_message(p->links) : NULL);
}

/* Measures the error of the last solution, for the account. */
hr2d_status PAGE(play_measure_error)(play *p, double least, double seconds) {
  hr2d_target how = HR2D_TARGET_INIT;
  how.error = least;
  how.seconds = seconds;
  how.progress = ask_page;
  const hr2d_status status =
      hr2d_solution_error(p->solution, &how, &p->account.average, &p->account.sup);
  return fail(p, status, hr2d_scene_message(p->scene));
}

static const hr2d_linkset *links_of(const play *p) {
  return hr2d_solution_links(p->solution);
}

/* N, leaves, stored L, p, gathers; then estimate and bound of the averages of B, of B at
   points, and of the averages of H; and whether the target was missed.  Links between clusters,
   which are not stored, come from the account. */
void PAGE(play_account)(const play *p, double *out) {
  const hr2d_account *a = &p->account;
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(links_of(p));
  const hr2d_hierarchy_counts n = hr2d_hierarchy_count(h);
  const uint64_t stored = hr2d_linkset_size(links_of(p));
  *out++ = (double)n.elements;
  *out++ = (double)n.leaves;
  *out++ = (double)(a->links > stored ? a->links : stored);
  *out++ = hr2d_hierarchy_order(h);
  *out++ = (double)hr2d_solution_work(p->solution).gathers;
  *out++ = a->average.estimate, *out++ = a->average.bound;
  *out++ = a->sup.estimate, *out++ = a->sup.bound;
  *out++ = a->irradiance.estimate, *out++ = a->irradiance.bound;
  *out = *a->reason != 0;
}

/* For each patch and band the averages of B and of H. */
void PAGE(play_averages)(const play *p, double *out) {
  const size_t patches = hr2d_scene_patches(p->scene), bands = hr2d_scene_bands(p->scene);
  for (size_t k = 0; k < patches; k++)
    for (size_t band = 0; band < bands; band++) {
      *out++ = hr2d_solution_average(p->solution, k, band);
      *out++ = hr2d_solution_irradiance(p->solution, k, band);
    }
}

size_t PAGE(play_elements_count)(const play *p) {
  return (size_t)hr2d_hierarchy_count(hr2d_linkset_hierarchy(links_of(p))).elements;
}

/* For each element its ends in scene lengths, its patch, its first child or 0, and B of each
   band: 6 + bands numbers. */
void PAGE(play_elements)(const play *p, double *out) {
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(links_of(p));
  const hr2d_element *e = hr2d_hierarchy_elements(h);
  const size_t count = play_elements_count(p), bands = hr2d_scene_bands(p->scene);
  const double unit = hr2d_scene_unit(p->scene);
  for (size_t k = 0; k < count; k++) {
    *out++ = e[k].a.x * unit, *out++ = e[k].a.y * unit;
    *out++ = e[k].b.x * unit, *out++ = e[k].b.y * unit;
    *out++ = e[k].patch, *out++ = e[k].child;
    for (size_t band = 0; band < bands; band++)
      *out++ = hr2d_solution_element(p->solution, (uint32_t)k, band);
  }
}

size_t PAGE(play_links_count)(const play *p) {
  return (size_t)hr2d_linkset_size(links_of(p));
}

/* The two elements of each of the first `count` links. */
void PAGE(play_links)(const play *p, uint32_t *out, size_t count) {
  for (size_t k = 0; k < count; k++) {
    const hr2d_pair pair = hr2d_linkset_get(links_of(p), k).pair;
    *out++ = pair.first, *out++ = pair.second;
  }
}

/* The exchange area of each of the first `count` links. */
void PAGE(play_exchange_areas)(const play *p, double *out, size_t count) {
  for (size_t k = 0; k < count; k++) *out++ = hr2d_linkset_get(links_of(p), k).exchange_area;
}

hr2d_status glue_field(const hr2d_solution *solution, hr2d_point low, hr2d_point high,
                       size_t columns, size_t rows, double tolerance, double *mean,
                       unsigned char *place) {
  hr2d_field_options how = HR2D_FIELD_OPTIONS_INIT;
  hr2d_field_values values = HR2D_FIELD_VALUES_INIT;
  hr2d_field_grid grid = HR2D_FIELD_GRID_INIT;
  grid.low = low;
  grid.high = high;
  grid.columns = columns;
  grid.rows = rows;
  grid.tolerance = tolerance;
  how.progress = ask_page;
  values.mean = mean;
  values.place = place;
  return hr2d_field_on_grid(solution, &grid, &how, &values, NULL);
}

hr2d_status PAGE(play_field)(play *p, double x0, double y0, double x1, double y1,
                             size_t columns, size_t rows, double tolerance, double *mean,
                             unsigned char *place) {
  return fail(p,
              glue_field(p->solution, (hr2d_point){x0, y0}, (hr2d_point){x1, y1}, columns, rows,
                         tolerance, mean, place),
              NULL);
}

/* The study of L against N. */

static size_t study_rows(play *p, hr2d_linkset *links, const double *epsilon, size_t count,
                         double max_links, hr2d_study_row *rows) {
  hr2d_refine_options how = HR2D_REFINE_OPTIONS_INIT;
  size_t done = 0;
  how.max_links = (uint64_t)max_links;
  how.progress = ask_page;
  fail(p, hr2d_study_run(links, &how, epsilon, count, rows, &done), NULL);
  return done;
}

/* Counts N and L for each ε, until L would exceed a budget: two numbers for each.  Then the
   slope of log L on log N over the last of them, or 0.  Returns how many were counted. */
size_t PAGE(play_study)(play *p, const char *oracle, const double *epsilon, size_t count,
                        double max_links, double *out) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_study_row *rows = calloc(count, sizeof *rows);
  hr2d_study_fit fit = {0};
  size_t done = 0;
  if (rows && !hr2d_hierarchy_create(p->scene, &hierarchy) &&
      !hr2d_linkset_create(hierarchy, hr2d_oracle_find(oracle), NULL, NULL, NULL, &links))
    done = study_rows(p, links, epsilon, count, max_links, rows);
  for (size_t k = 0; k < done; k++) {
    out[2 * k] = (double)rows[k].counts.elements;
    out[2 * k + 1] = (double)rows[k].counts.links;
  }
  if (done >= FITTED) (void)hr2d_study_fit_rows(rows + done - FITTED, FITTED, &fit);
  out[2 * count] = fit.slope;
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  free(rows);
  return done;
}
