/* How to save a long solve and to resume it later.  You learn to solve in stages of falling ε,
   to write the state of a stage to a file, and to read it back.

   The state after the second of three stages goes to a file.  New objects resume from it and
   reach the same bits as an uninterrupted run. */
#include <hr2d/hr2d.h>
#include <stdio.h>

static const double epsilon[] = {0.5, 0.1, 0.02};
enum { STAGES = sizeof epsilon / sizeof *epsilon };

/* The objects of a run, without the scene. */
typedef struct work {
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
} work;

static hr2d_status write_file(void *ctx, const void *bytes, size_t size) {
  return fwrite(bytes, 1, size, ctx) == size ? HR2D_OK : HR2D_EIO;
}

static hr2d_status read_file(void *ctx, void *bytes, size_t size) {
  if (fread(bytes, 1, size, ctx) == size) return HR2D_OK;
  return feof(ctx) ? HR2D_ESYNTAX : HR2D_EIO;
}

static hr2d_status begin(const hr2d_scene *scene, work *w) {
  const hr2d_status status = hr2d_hierarchy_create(scene, &w->hierarchy);
  return status ? status : hr2d_linkset_create(w->hierarchy, NULL, NULL, NULL, NULL, &w->links);
}

static void end(work *w) {
  hr2d_solution_destroy(w->solution);
  hr2d_linkset_destroy(w->links);
  hr2d_hierarchy_destroy(w->hierarchy);
}

/* Runs the stages, of the first `stages`, that are finer than the links so far. */
static hr2d_status go_on(work *w, int stages) {
  hr2d_status status = HR2D_OK;
  for (int k = 0; k < stages && !status; k++) {
    if (epsilon[k] >= hr2d_linkset_epsilon(w->links)) continue;
    hr2d_refine_options refine = HR2D_REFINE_OPTIONS_INIT;
    hr2d_solve_options solve = HR2D_SOLVE_OPTIONS_INIT;
    hr2d_solution *next = NULL;
    refine.epsilon = epsilon[k];
    refine.brightness = solve.start = w->solution;
    status = hr2d_refine(w->links, &refine);
    if (!status) status = hr2d_solve(w->links, &solve, &next);
    if (status) break;
    hr2d_solution_destroy(w->solution);
    w->solution = next;
    printf("epsilon %-4g  L = %llu\n", epsilon[k],
           (unsigned long long)hr2d_linkset_size(w->links));
  }
  return status;
}

static hr2d_status run(const hr2d_scene *scene, FILE *file, work *first, work *second) {
  hr2d_status status = begin(scene, first);
  if (!status) status = go_on(first, STAGES - 1);
  if (!status) status = hr2d_state_write(first->solution, write_file, file);
  if (!status) status = go_on(first, STAGES);
  rewind(file);
  puts("from the file:");
  if (!status) status = begin(scene, second);
  if (!status) status = hr2d_state_read(second->links, read_file, file, &second->solution);
  return status ? status : go_on(second, STAGES);
}

int main(void) {
  const double lit = 1, grey = 0.5;
  const hr2d_patch floor = {.b = {1, 0}, .emission = &lit, .emission_bands = 1};
  const hr2d_patch wall = {
      .a = {0, 1}, .b = {0, 0}, .reflectance = &grey, .reflectance_bands = 1};
  hr2d_scene *scene = NULL;
  work first = {NULL, NULL, NULL}, second = {NULL, NULL, NULL};
  FILE *file = tmpfile();
  int ok = file && !hr2d_scene_create(NULL, &scene) && !hr2d_scene_add(scene, &floor, NULL) &&
           !hr2d_scene_add(scene, &wall, NULL) && !hr2d_scene_commit(scene) &&
           !run(scene, file, &first, &second);
  if (ok) {
    const double b = hr2d_solution_average(first.solution, 1, 0);
    printf("wall %.4f, %s\n", b,
           b == hr2d_solution_average(second.solution, 1, 0) ? "the same bits" : "other bits");
  }
  end(&second);
  end(&first);
  hr2d_scene_destroy(scene);
  if (file) fclose(file);
  return !ok;
}
