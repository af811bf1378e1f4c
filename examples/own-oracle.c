/* How to write an oracle of your own.  You learn to fill in the table hr2d_oracle, to answer
   for a batch of pairs, and to keep data of your own in a context.

   This oracle bounds the error, after Lischinski, Smits and Greenberg (1994), by an interval
   that contains the kernel over both elements.  G = h_x h_y / (2r³), where h_x and h_y are the
   distance of one point from the line of the other.  Distances from a line are largest and
   smallest at the ends, and r is at least the distance of the segments.  So Gmin ≤ G ≤ Gmax
   and ∫∫ |G(x_c,y_c) − G| ≤ A_x A_y (Gmax − Gmin). */
#include <float.h>
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

/* The context: data that the oracle keeps between calls. */
typedef struct tally {
  unsigned long long asked;
} tally;

static double minimum(double p, double q) {
  return p < q ? p : q;
}

static double maximum(double p, double q) {
  return p > q ? p : q;
}

static double line_distance(const hr2d_element *e, hr2d_point p) {
  const double ux = e->b.x - e->a.x, uy = e->b.y - e->a.y;
  return maximum(0, (ux * (p.y - e->a.y) - uy * (p.x - e->a.x)) / hypot(ux, uy));
}

static double point_distance(hr2d_point p, hr2d_point q) {
  return hypot(p.x - q.x, p.y - q.y);
}

static double segment_distance(const hr2d_element *e, hr2d_point p) {
  const double ux = e->b.x - e->a.x, uy = e->b.y - e->a.y;
  double t = ((p.x - e->a.x) * ux + (p.y - e->a.y) * uy) / (ux * ux + uy * uy);
  t = minimum(maximum(t, 0), 1);
  return point_distance(p, (hr2d_point){e->a.x + t * ux, e->a.y + t * uy});
}

static double bound(const hr2d_element *i, const hr2d_element *j) {
  const double hi[] = {line_distance(i, j->a), line_distance(i, j->b)};
  const double hj[] = {line_distance(j, i->a), line_distance(j, i->b)};
  const double near = minimum(minimum(segment_distance(i, j->a), segment_distance(i, j->b)),
                              minimum(segment_distance(j, i->a), segment_distance(j, i->b)));
  const double far = maximum(maximum(point_distance(i->a, j->a), point_distance(i->a, j->b)),
                             maximum(point_distance(i->b, j->a), point_distance(i->b, j->b)));
  if (near < DBL_MIN) return HUGE_VAL; /* they touch: the kernel has no bound */
  const double most = maximum(hi[0], hi[1]) * maximum(hj[0], hj[1]) / (2 * near * near * near);
  const double least = minimum(hi[0], hi[1]) * minimum(hj[0], hj[1]) / (2 * far * far * far);
  return i->length * j->length * (most - least);
}

static hr2d_status estimate(void *ctx, const hr2d_batch *batch, double *error) {
  tally *t = ctx;
  t->asked += batch->count;
  for (size_t k = 0; k < batch->count; k++) {
    const hr2d_pair pair = batch->pairs[k];
    /* the L¹ error is a length, so it is given in scene lengths */
    error[k] = batch->unit * bound(&batch->elements[pair.first], &batch->elements[pair.second]);
  }
  return HR2D_OK;
}

static const hr2d_oracle bounds = {.struct_size = sizeof bounds,
                                   .name = "kernel bounds",
                                   .flags = HR2D_ORACLE_SYMMETRIC,
                                   .estimate = estimate};

static hr2d_status make_scene(hr2d_scene **scene) {
  const double one = 1, grey = 0.5;
  const hr2d_patch floor = {.a = {0, 0},
                            .b = {1, 0},
                            .emission = &one,
                            .emission_bands = 1,
                            .reflectance = &grey,
                            .reflectance_bands = 1};
  const hr2d_patch ceiling = {
      .a = {1, .1}, .b = {0, .1}, .reflectance = &grey, .reflectance_bands = 1};
  hr2d_status status = hr2d_scene_create(NULL, scene);
  if (!status) status = hr2d_scene_add(*scene, &floor, NULL);
  if (!status) status = hr2d_scene_add(*scene, &ceiling, NULL);
  return status ? status : hr2d_scene_commit(*scene);
}

static hr2d_status run(const hr2d_scene *scene, const hr2d_oracle *oracle, void *ctx,
                       double epsilon) {
  hr2d_hierarchy *hierarchy = NULL;
  hr2d_linkset *links = NULL;
  hr2d_solution *solution = NULL;
  hr2d_refine_options options = HR2D_REFINE_OPTIONS_INIT;
  options.epsilon = epsilon;
  hr2d_status status = hr2d_hierarchy_create(scene, &hierarchy);
  if (!status) status = hr2d_linkset_create(hierarchy, oracle, ctx, NULL, NULL, &links);
  if (!status) status = hr2d_refine(links, &options);
  if (!status) status = hr2d_solve(links, NULL, &solution);
  if (!status)
    printf("%-14s %8g %6llu %8llu  %.6f\n", oracle->name, epsilon,
           (unsigned long long)hr2d_linkset_counts(links).elements,
           (unsigned long long)hr2d_linkset_size(links), hr2d_solution_average(solution, 1, 0));
  hr2d_solution_destroy(solution);
  hr2d_linkset_destroy(links);
  hr2d_hierarchy_destroy(hierarchy);
  return status;
}

int main(void) {
  hr2d_scene *scene = NULL;
  tally t = {0};
  hr2d_status status = make_scene(&scene);
  printf("%-14s %8s %6s %8s  %s\n", "oracle", "epsilon", "N", "L", "ceiling");
  for (double epsilon = 1e-2; epsilon > 1e-6 && !status; epsilon /= 10)
    status = run(scene, &bounds, &t, epsilon);
  for (double epsilon = 1. / 8; epsilon > 1. / 100 && !status; epsilon /= 2)
    status = run(scene, hr2d_oracle_size(), NULL, epsilon);
  for (double epsilon = 1. / 16; epsilon > 1. / 100 && !status; epsilon /= 2)
    status = run(scene, hr2d_oracle_bf(), NULL, epsilon);
  printf("asked about %llu pairs\n", t.asked);
  if (status) fprintf(stderr, "own-oracle: %s\n", hr2d_strerror(status));
  hr2d_scene_destroy(scene);
  return status != HR2D_OK;
}
