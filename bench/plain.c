/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plain.h"

#include <math.h>
#include <stdlib.h>

#include "timing.h"

typedef struct node {
  double ax, ay, bx, by, length;
  uint32_t child;
} node;

typedef struct plain_link {
  uint32_t i, j;
  double area;
} plain_link;

typedef struct plain {
  node *node;
  uint32_t nodes, node_capacity;
  plain_link *link;
  uint64_t links, link_capacity;
  double epsilon2;
  int store;
} plain;

static uint32_t children(plain *p, uint32_t at) {
  if (p->node[at].child) return p->node[at].child;
  if (p->nodes + 2 > p->node_capacity)
    p->node = realloc(p->node, (p->node_capacity *= 2) * sizeof *p->node);
  const node n = p->node[at];
  const double mx = 0.5 * (n.ax + n.bx), my = 0.5 * (n.ay + n.by);
  p->node[p->nodes] = (node){n.ax, n.ay, mx, my, n.length / 2, 0};
  p->node[p->nodes + 1] = (node){mx, my, n.bx, n.by, n.length / 2, 0};
  p->node[at].child = p->nodes;
  p->nodes += 2;
  return p->nodes - 2;
}

static double between(double ax, double ay, double bx, double by) {
  return sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by));
}

static void store(plain *p, uint32_t i, uint32_t j) {
  if (p->links == p->link_capacity)
    p->link = realloc(p->link, (size_t)(p->link_capacity *= 2) * sizeof *p->link);
  const node *m = &p->node[i], *n = &p->node[j];
  p->link[p->links] = (plain_link){
      i, j,
      0.5 * (between(m->ax, m->ay, n->ax, n->ay) + between(m->bx, m->by, n->bx, n->by) -
             between(m->ax, m->ay, n->bx, n->by) - between(m->bx, m->by, n->ax, n->ay))};
}

static void project(plain *p, uint32_t i, uint32_t j) {
  const node *m = &p->node[i], *n = &p->node[j];
  const double dx = 0.5 * ((m->ax + m->bx) - (n->ax + n->bx));
  const double dy = 0.5 * ((m->ay + m->by) - (n->ay + n->by));
  const double a = m->length > n->length ? m->length : n->length;
  if (a * a <= p->epsilon2 * (dx * dx + dy * dy)) {
    if (p->store) store(p, i, j);
    p->links++;
  } else if (m->length >= n->length) {
    const uint32_t child = children(p, i);
    project(p, child, j);
    project(p, child + 1, j);
  } else {
    const uint32_t child = children(p, j);
    project(p, i, child);
    project(p, i, child + 1);
  }
}

double plain_run(double distance, double epsilon, int stored, uint64_t *links) {
  const double start = cpu_seconds();
  plain p = {.node_capacity = 1024, .link_capacity = 1024, .epsilon2 = epsilon * epsilon};
  p.store = stored;
  p.node = malloc(p.node_capacity * sizeof *p.node);
  p.link = malloc((size_t)p.link_capacity * sizeof *p.link);
  p.node[0] = (node){0, 0, 1, 0, 1, 0};
  p.node[1] = (node){1, distance, 0, distance, 1, 0};
  p.nodes = 2;
  project(&p, 0, 1);
  const double seconds = cpu_seconds() - start;
  *links = p.links;
  free(p.node);
  free(p.link);
  return seconds;
}

static uint64_t count_in_registers(double xi, double ai, double xj, double aj, double d2,
                                   double epsilon2) {
  const double a = ai > aj ? ai : aj, dx = xi - xj;
  if (a * a <= epsilon2 * (dx * dx + d2)) return 1;
  if (ai >= aj)
    return count_in_registers(xi - ai / 4, ai / 2, xj, aj, d2, epsilon2) +
           count_in_registers(xi + ai / 4, ai / 2, xj, aj, d2, epsilon2);
  return count_in_registers(xi, ai, xj - aj / 4, aj / 2, d2, epsilon2) +
         count_in_registers(xi, ai, xj + aj / 4, aj / 2, d2, epsilon2);
}

double plain_count(double distance, double epsilon, uint64_t *links) {
  const double start = cpu_seconds();
  *links = count_in_registers(0.5, 1, 0.5, 1, distance * distance, epsilon * epsilon);
  return cpu_seconds() - start;
}

double plain_sweeps(const hr2d_link *link, uint64_t links, size_t elements, int sweeps) {
  double *up = malloc(elements * sizeof *up), *down = malloc(elements * sizeof *down);
  for (size_t e = 0; e < elements; e++) up[e] = down[e] = 1;
  const double start = cpu_seconds();
  for (int sweep = 0; sweep < sweeps; sweep++)
    for (uint64_t k = 0; k < links; k++) {
      const hr2d_pair p = link[k].pair;
      down[p.first] += link[k].exchange_area * up[p.second];
      down[p.second] += link[k].exchange_area * up[p.first];
    }
  const double seconds = cpu_seconds() - start;
  free(up);
  free(down);
  return seconds;
}
