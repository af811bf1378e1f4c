/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How to couple a finite element program with radiation.  You learn to take view factors
   between the facets of a mesh, to turn them into a matrix from T⁴ to net fluxes, and to use
   this matrix in Newton's method, which then converges in a few steps.

   A square brick has a square cavity.  It is 900 K hot below and 300 K above; its sides lose
   nothing.  Heat is conducted in the brick, and radiated from wall to wall of the cavity:

       K T + P'A q = 0,   q = B − F B,   B = εσ T⁴ + (1 − ε) F B,

   with the stiffness matrix K of bilinear elements, the areas A of the facets, P the mean of
   the two nodes of each facet, and F the view factors.  They do not depend on T: so q = G σT⁴
   with a matrix G that is made once. */
#include <hr2d/hr2d.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 12, FROM = 3, TO = 9, SIDE = TO - FROM };
enum { NODES = (CELLS + 1) * (CELLS + 1), FACETS = 4 * SIDE };

static const double sigma = 5.670374419e-8; /* W/(m² K⁴) */
static const double width = 0.24;           /* m */
static const double conductivity = 0.7;     /* W/(m K) */
static const double hot = 900, cold = 300;  /* K */

typedef struct brick {
  double stiffness[NODES][NODES];  /* W/K for each metre of depth */
  double transfer[FACETS][FACETS]; /* G */
  double tangent[NODES][NODES];
  double temperature[NODES];
  double residual[NODES]; /* the heat that comes in at each node */
  int facet[FACETS][2];   /* its nodes; the cavity is on the left */
} brick;

static int node(int column, int row) {
  return row * (CELLS + 1) + column;
}

/* Bilinear elements on squares; cells of the cavity conduct nothing. */
static void make_stiffness(brick *b, int has_cavity) {
  static const double square[] = {4. / 6, -1. / 6, -2. / 6, -1. / 6};
  for (int row = 0; row < CELLS; row++)
    for (int column = 0; column < CELLS; column++) {
      const int inside = column >= FROM && column < TO && row >= FROM && row < TO;
      const int corner[] = {node(column, row), node(column + 1, row), node(column + 1, row + 1),
                            node(column, row + 1)};
      if (inside && has_cavity) continue;
      for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
          b->stiffness[corner[i]][corner[j]] += conductivity * square[(i - j) & 3];
    }
}

/* Counter-clockwise around the cavity, so that it is on the left. */
static void make_facets(brick *b) {
  for (int k = 0; k < SIDE; k++) {
    const int corner[][4] = {{FROM + k, FROM, FROM + k + 1, FROM},
                             {TO, FROM + k, TO, FROM + k + 1},
                             {TO - k, TO, TO - k - 1, TO},
                             {FROM, TO - k, FROM, TO - k - 1}};
    for (int side = 0; side < 4; side++) {
      b->facet[side * SIDE + k][0] = node(corner[side][0], corner[side][1]);
      b->facet[side * SIDE + k][1] = node(corner[side][2], corner[side][3]);
    }
  }
}

static hr2d_point place(int n) {
  const double cell = width / CELLS;
  return (hr2d_point){n % (CELLS + 1) * cell, n / (CELLS + 1) * cell};
}

/* The facets are the patches of a scene, in the same order. */
static hr2d_status find_factors(const brick *b, double *factor) {
  hr2d_scene *scene = NULL;
  hr2d_status status = hr2d_scene_create(NULL, &scene);
  for (int k = 0; k < FACETS && !status; k++) {
    hr2d_patch patch = HR2D_PATCH_INIT;
    patch.a = place(b->facet[k][0]);
    patch.b = place(b->facet[k][1]);
    status = hr2d_scene_add(scene, &patch, NULL);
  }
  if (!status) status = hr2d_scene_commit(scene);
  if (!status) status = hr2d_exchange_matrix(scene, NULL, factor, NULL);
  for (int i = 0; i < FACETS && !status; i++)
    for (int j = 0; j < FACETS; j++) factor[i * FACETS + j] /= hr2d_scene_length(scene, i);
  if (status && scene) fprintf(stderr, "conduction: %s\n", hr2d_scene_message(scene));
  hr2d_scene_destroy(scene);
  return status;
}

/* Solves m y = x by Gauss's elimination and writes y over x; these matrices need no pivots. */
static void eliminate(int n, double *m, double *x) {
  for (int k = 0; k < n; k++)
    for (int i = k + 1; i < n; i++) {
      const double part = m[i * n + k] / m[k * n + k];
      if (part == 0) continue;
      for (int j = k; j < n; j++) m[i * n + j] -= part * m[k * n + j];
      x[i] -= part * x[k];
    }
  for (int i = n - 1; i >= 0; i--) {
    for (int j = i + 1; j < n; j++) x[i] -= m[i * n + j] * x[j];
    x[i] /= m[i * n + i];
  }
}

/* Column c of G: the net fluxes if facet c alone emits, with σT⁴ = 1. */
static void make_transfer(brick *b, double emissivity, const double *factor) {
  for (int c = 0; c < FACETS; c++) {
    double equation[FACETS * FACETS], radiosity[FACETS] = {0};
    radiosity[c] = emissivity;
    for (int i = 0; i < FACETS; i++)
      for (int j = 0; j < FACETS; j++)
        equation[i * FACETS + j] = (i == j) - (1 - emissivity) * factor[i * FACETS + j];
    eliminate(FACETS, equation, radiosity);
    for (int i = 0; i < FACETS; i++) {
      b->transfer[i][c] = radiosity[i];
      for (int j = 0; j < FACETS; j++)
        b->transfer[i][c] -= factor[i * FACETS + j] * radiosity[j];
    }
  }
}

/* Adds to the node of each end of facet i half of A q, and its derivative to the tangent. */
static void add_radiation(brick *b) {
  const double half = width / CELLS / 2;
  for (int i = 0; i < FACETS; i++)
    for (int j = 0; j < FACETS; j++) {
      const int *from = b->facet[j], *to = b->facet[i];
      const double mean = (b->temperature[from[0]] + b->temperature[from[1]]) / 2;
      const double flux = half * b->transfer[i][j] * sigma * pow(mean, 4);
      for (int end = 0; end < 2; end++) {
        b->residual[to[end]] += flux;
        b->tangent[to[end]][from[0]] += 2 * flux / mean;
        b->tangent[to[end]][from[1]] += 2 * flux / mean;
      }
    }
}

static void linearise(brick *b) {
  for (int i = 0; i < NODES; i++) {
    b->residual[i] = 0;
    for (int j = 0; j < NODES; j++) {
      b->tangent[i][j] = b->stiffness[i][j];
      b->residual[i] += b->stiffness[i][j] * b->temperature[j];
    }
  }
  add_radiation(b);
}

/* A step of Newton's method; returns the largest change of a temperature. */
static double step(brick *b) {
  double change[NODES], largest = 0;
  linearise(b);
  for (int i = 0; i < NODES; i++) {
    const int row = i / (CELLS + 1), empty = b->tangent[i][i] == 0;
    change[i] = -b->residual[i];
    if (row > 0 && row < CELLS && !empty) continue;
    for (int j = 0; j < NODES; j++) b->tangent[i][j] = i == j;
    change[i] = 0;
  }
  eliminate(NODES, b->tangent[0], change);
  for (int i = 0; i < NODES; i++) {
    b->temperature[i] += change[i];
    largest = fmax(largest, fabs(change[i]));
  }
  return largest;
}

/* The heat that comes in at the nodes of a row, in W for each metre of depth. */
static double heat(const brick *b, int row) {
  double sum = 0;
  for (int column = 0; column <= CELLS; column++) sum += b->residual[node(column, row)];
  return sum;
}

static void solve(brick *b, const char *name, int has_cavity, double emissivity,
                  const double *factor) {
  memset(b, 0, sizeof *b);
  make_stiffness(b, has_cavity);
  make_facets(b);
  if (emissivity > 0) make_transfer(b, emissivity, factor);
  for (int i = 0; i < NODES; i++)
    b->temperature[i] = hot + (cold - hot) * (i / (CELLS + 1)) / CELLS;
  printf("%-24s", name);
  for (int k = 0; k < 5; k++) printf(" %8.3f", step(b));
  linearise(b);
  printf("  %8.3f W/m in, %8.3f W/m out\n", heat(b, 0), -heat(b, CELLS));
}

int main(void) {
  brick *b = calloc(1, sizeof *b);
  double *factor = malloc(sizeof *factor * FACETS * FACETS);
  if (b) make_facets(b);
  hr2d_status status = b && factor ? find_factors(b, factor) : HR2D_ENOMEM;
  if (!status) {
    puts("                         largest change of T in each step, in K        heat");
    solve(b, "no cavity", 0, 0, factor);
    solve(b, "nothing is radiated", 1, 0, factor);
    solve(b, "emissivity 0.3", 1, 0.3, factor);
    solve(b, "emissivity 0.9", 1, 0.9, factor);
  }
  free(factor);
  free(b);
  return status != HR2D_OK;
}
