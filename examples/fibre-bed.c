/* The conductivity that radiation gives to a bed of parallel fibres.  You learn how two mirrors
   make a bed without end from the half of a cell.

   Fibres of diameter d stand in a hexagonal grid of pitch p, rows s = p √3/2 apart.  They
   conduct so well that each has one temperature, which falls from row to row by the same step.
   For small steps heat flows as through a solid of conductivity

     k = 4 F σ T³ d,

   where F, the exchange factor, depends on p/d and on the emissivity ε of the fibres.  With
   σT⁴ = m on row m, F = q s/d for the flux q of heat from row to row.

   Fibres that touch (p = d) leave pores between three of them.  If they are black, each side of
   a pore exchanges all of its length with the two others, and with a circumference c

     F = (s/(p d)) c/3,   which is √3 π/6 = 0.9069 for circles.

   Here fibres are polygons of 12 sides, with a circumference of 12 d sin 15°.  Rows of which
   one sees past the next need a period: up to p/d = 1.15 nothing is seen beyond some fibres,
   and F is exact; then the last images stand for those that are cut off. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>

/* Of a fibre; and rows on each side of the place where the flux is measured. */
enum { SIDES = 12, ROWS = 3 };

typedef struct bed {
  double pitch, emissivity; /* with d = 1 */
  hr2d_scene *scene;
  hr2d_solution *solution;
} bed;

static double row_step(const bed *b) {
  return b->pitch * sqrt(0.75);
}

static hr2d_status add(bed *b, hr2d_point from, hr2d_point to, double m, double emissivity) {
  hr2d_patch patch = HR2D_PATCH_INIT;
  const double emission = emissivity * m, reflectance = 1 - emissivity;
  patch.a = from;
  patch.b = to;
  patch.emission = &emission;
  patch.reflectance = &reflectance;
  patch.emission_bands = patch.reflectance_bands = 1;
  return hr2d_scene_add(b->scene, &patch, NULL);
}

/* The half of a fibre on the right of the mirror x = 0, or on the left of x = p/2. */
static hr2d_status add_half_fibre(bed *b, int row, double m) {
  const double pi = acos(-1), side = row % 2 ? -1 : 1;
  const double x = row % 2 ? 0.5 * b->pitch : 0, y = row * row_step(b);
  hr2d_point last = {x, y - 0.5};
  hr2d_status status = HR2D_OK;
  for (int k = 1; k <= SIDES / 2 && !status; k++) {
    const double angle = 2 * pi * k / SIDES;
    const hr2d_point next = {k < SIDES / 2 ? x + side * 0.5 * sin(angle) : x,
                             y - 0.5 * cos(angle)};
    status =
        side > 0 ? add(b, next, last, m, b->emissivity) : add(b, last, next, m, b->emissivity);
    last = next;
  }
  return status;
}

/* Rows between black plates that touch the last ones, all as warm as their places say. */
static hr2d_status make_bed(bed *b) {
  const double width = 0.5 * b->pitch, top = ROWS * row_step(b) + 0.5;
  hr2d_status status = hr2d_scene_create(NULL, &b->scene);
  if (!status) status = add(b, (hr2d_point){0, -top}, (hr2d_point){width, -top}, 1, 1);
  for (int row = -ROWS; row <= ROWS && !status; row++)
    status = add_half_fibre(b, row, row + ROWS + 2);
  if (!status) status = add(b, (hr2d_point){width, top}, (hr2d_point){0, top}, 2 * ROWS + 3, 1);
  for (int k = 0; k < 2 && !status; k++)
    status = hr2d_scene_add_mirror(b->scene, (hr2d_segment){{k * width, 0}, {k * width, 1}});
  return status ? status : hr2d_scene_commit(b->scene);
}

/* All heat of what is above the middle row flows down past it, half of it to the row itself:
   the mean of that above the row and of that above and in it. */
static double flux_of(const bed *b) {
  const size_t patches = hr2d_scene_patches(b->scene), fibre = SIDES / 2;
  const size_t middle = 1 + ROWS * fibre;
  double heat[2] = {0, 0};
  for (size_t k = middle; k < patches; k++) {
    const double flow =
        hr2d_scene_length(b->scene, k) * hr2d_solution_net_flux(b->solution, k, 0);
    heat[0] += k >= middle + fibre ? flow : 0;
    heat[1] += flow;
  }
  return 0.5 * (heat[0] + heat[1]) / (0.5 * b->pitch);
}

static hr2d_status exchange_factor(double pitch, double emissivity, double *factor) {
  bed b = {.pitch = pitch, .emissivity = emissivity};
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = 1e-4;
  hr2d_status status = make_bed(&b);
  if (!status) status = hr2d_solve_to(b.scene, &target, &b.solution, NULL);
  if (!status) *factor = flux_of(&b) * row_step(&b);
  if (status)
    fprintf(stderr, "fibre-bed: %s: %s\n", hr2d_strerror(status),
            b.scene ? hr2d_scene_message(b.scene) : "");
  hr2d_solution_destroy(b.solution);
  hr2d_scene_destroy(b.scene);
  return status;
}

int main(void) {
  static const double emissivity[] = {1, 0.8, 0.5, 0.3}, pitch[] = {1, 1.05, 1.1, 1.25};
  const double step = sqrt(0.75), around = SIDES * sin(acos(-1) / SIDES);
  hr2d_status status = HR2D_OK;
  printf("F of k = 4 F sigma T^3 d for fibres in a hexagonal grid\n%6s", "p/d");
  for (size_t k = 0; k < 4; k++) printf("  eps=%-5g", emissivity[k]);
  printf("\n");
  for (size_t p = 0; p < 4 && !status; p++) {
    printf("%6.2f", pitch[p]);
    for (size_t k = 0; k < 4 && !status; k++) {
      double factor = 0;
      status = exchange_factor(pitch[p], emissivity[k], &factor);
      printf("  %.4f   ", factor);
    }
    printf("\n");
  }
  printf("black fibres that touch, by crossed strings: %.4f\n", step * around / 3);
  return status != HR2D_OK;
}
