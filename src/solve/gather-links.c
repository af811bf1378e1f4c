/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In one band of a low order a call for each link would take longer than its products: the
   order is a constant to the compiler there.  Neighbours in the store mostly share their first
   element, whose sums stay in registers.  Sums are added in the order of hr2di_gather_both().
   Vectors are written down: compilers make some of the columns of small blocks. */
#include "solve/gather-links.h"

#include "base/ordered-dot.h"
#include "base/wide.h"
#include "solve/gather-blocks.h"

/* Blocks in two parts mostly have MORE coefficients than their leading part, which is a
   constant then, too. */
enum { LOW = 8, FOURS = LOW / 4, MORE = 2 };

/* A row of a block, see block-numbers.h: `split` numbers at `head`, and the others at `tail`.
 */
typedef struct row {
  const void *head, *tail;
  size_t split;
  double area;
  int single;
} row;

HR2DI_PART double number_of(const row *r, size_t m) {
  return m < r->split ? hr2di_number_at(r->head, m, r->single, r->area)
                      : hr2di_number_at(r->tail, m - r->split, r->single, r->area);
}

HR2DI_PART void load_four(const row *r, size_t m, hr2di_four *to) {
  if (m + 4 <= r->split)
    hr2di_four_numbers(r->head, m, r->single, r->area, to);
  else if (m >= r->split)
    hr2di_four_numbers(r->tail, m - r->split, r->single, r->area, to);
  else
    *to = (hr2di_four){number_of(r, m), number_of(r, m + 1), number_of(r, m + 2),
                       number_of(r, m + 3)};
}

/* Coefficients of an element, or sums for them. */
typedef struct coefficients {
  hr2di_four at[FOURS];
  double rest[3];
} coefficients;

HR2DI_PART void load_field(const double *from, size_t order, coefficients *to) {
  const size_t fours = order / 4, rest = order % 4;
  for (size_t q = 0; q < fours; q++) to->at[q] = *(const hr2di_four *)(from + 4 * q);
  for (size_t m = 0; m < rest; m++) to->rest[m] = from[4 * fours + m];
}

HR2DI_PART void store_field(const coefficients *from, size_t order, double *to) {
  const size_t fours = order / 4, rest = order % 4;
  for (size_t q = 0; q < fours; q++) *(hr2di_four *)(to + 4 * q) = from->at[q];
  for (size_t m = 0; m < rest; m++) to[4 * fours + m] = from->rest[m];
}

/* The product of a row with `from`; adds the row times `up` to `sum` if that is asked for. */
HR2DI_PART double add_row(const row *r, size_t order, const coefficients *from, double up,
                          coefficients *sum, int both) {
  const size_t fours = order / 4, rest = order % 4;
  hr2di_four s = {0};
  double t = 0;
  for (size_t q = 0; q < fours; q++) {
    hr2di_four entry;
    load_four(r, 4 * q, &entry);
    s += entry * from->at[q];
    if (both) sum->at[q] += entry * up;
  }
  for (size_t m = 0; m < rest; m++) {
    const double entry = number_of(r, 4 * fours + m);
    t += entry * from->rest[m];
    if (both) sum->rest[m] += entry * up;
  }
  return hr2di_dot_four(s[0], s[1], s[2], s[3]) + t;
}

/* One link: `to_i` receives from up_j, and `to_j` from `up_i` unless that is not asked for. */
HR2DI_PART void add_link(const hr2di_stored_block *c, double area, const double *up_i,
                         const double *up_j, double *to_i, double *to_j, int both) {
  const size_t order = c->order, lead = c->lead, others = order - lead;
  const size_t number = hr2di_number_size(c->single);
  const char *value = c->value, *rest = others > 0 ? c->rest : value;
  const char *below = rest + lead * others * number;
  coefficients from, sum;
  load_field(up_j, order, &from);
  if (both) load_field(to_j, order, &sum);
  for (size_t l = 0; l < lead; l++) {
    const row r = {value + l * lead * number, rest + l * others * number, lead, area,
                   c->single};
    to_i[l] += add_row(&r, order, &from, up_i[l], &sum, both);
  }
  for (size_t l = lead; l < order; l++) {
    const row r = {below + (l - lead) * order * number, NULL, order, area, c->single};
    to_i[l] += add_row(&r, order, &from, up_i[l], &sum, both);
  }
  if (both) store_field(&sum, order, to_j);
}

/* Runs of links with the same first element. */
HR2DI_PART void add_run(const hr2di_link_run *run, int single, size_t order, size_t lead,
                        const double *restrict up, double *restrict down, int both) {
  const hr2di_stored_block all = {run->block.value, run->block.rest, order, lead, single};
  for (size_t k = 0; k < run->count;) {
    const uint32_t first = run->link[k].pair.first;
    double up_i[LOW], to_i[LOW];
    for (size_t l = 0; l < order; l++) up_i[l] = up[first * order + l];
    for (size_t l = 0; l < order; l++) to_i[l] = down[first * order + l];
    for (; k < run->count && run->link[k].pair.first == first; k++) {
      const size_t second = run->link[k].pair.second;
      const hr2di_stored_block c = hr2di_block_behind(&all, k);
      add_link(&c, run->link[k].exchange_area, up_i, up + second * order, to_i,
               down + second * order, both);
    }
    for (size_t l = 0; l < order; l++) down[first * order + l] = to_i[l];
  }
}

HR2DI_PART void add_parts(const hr2di_link_run *run, int single, size_t order, const double *up,
                          double *down, int both) {
  if (run->block.lead == order)
    add_run(run, single, order, order, up, down, both);
  else
    add_run(run, single, order, order - MORE, up, down, both);
}

HR2DI_PART void add_order(const hr2di_link_run *run, int single, size_t order, const double *up,
                          double *down, int both) {
  switch (order) {
  case 2:
    add_parts(run, single, 2, up, down, both);
    return;
  case 3:
    add_parts(run, single, 3, up, down, both);
    return;
  case 4:
    add_parts(run, single, 4, up, down, both);
    return;
  case 5:
    add_parts(run, single, 5, up, down, both);
    return;
  case 6:
    add_parts(run, single, 6, up, down, both);
    return;
  case 7:
    add_parts(run, single, 7, up, down, both);
    return;
  default:
    add_parts(run, single, LOW, up, down, both);
  }
}

HR2DI_PART void low_loop(const hr2di_link_run *run, size_t order, const double *up,
                         double *down, int both) {
  if (run->block.single)
    add_order(run, 1, order, up, down, both);
  else
    add_order(run, 0, order, up, down, both);
}

HR2DI_PART void both_ways_loop(const hr2di_link_run *run, size_t order, const double *up,
                               double *down) {
  low_loop(run, order, up, down, 1);
}
HR2DI_WIDE(both_ways, (const hr2di_link_run *run, size_t order, const double *up, double *down),
           (run, order, up, down))

HR2DI_PART void one_way_loop(const hr2di_link_run *run, size_t order, const double *up,
                             double *down) {
  low_loop(run, order, up, down, 0);
}
HR2DI_WIDE(one_way, (const hr2di_link_run *run, size_t order, const double *up, double *down),
           (run, order, up, down))

HR2DI_PART void join_loop(const hr2di_stored_block *block, double area, double *to) {
  hr2di_join_block(block, area, to);
}
HR2DI_WIDE(join, (const hr2di_stored_block *block, double area, double *to), (block, area, to))

/* Any order and number of bands. */
static void add_each(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                     double *down) {
  const size_t width = order * bands;
  const int whole = !run->block.single && !run->block.rest;
  double room[HR2D_MAX_ORDER * HR2D_MAX_ORDER];
  for (size_t k = 0; k < run->count; k++) {
    const hr2d_pair pair = run->link[k].pair;
    const size_t i = pair.first * width, j = pair.second * width;
    const hr2di_stored_block block = hr2di_block_behind(&run->block, k);
    const double *c = whole ? block.value : room;
    if (!whole) join(&block, run->link[k].exchange_area, room);
    if (run->directed)
      hr2di_gather_block(c, order, bands, up + j, down + i);
    else
      hr2di_gather_both(c, order, bands, up + i, up + j, down + i, down + j);
  }
}

void hr2di_gather_links(const hr2di_link_run *run, size_t order, size_t bands, const double *up,
                        double *down) {
  const size_t lead = run->block.lead;
  if (bands > 1 || order < 2 || order > LOW || (lead != order && lead + MORE != order))
    add_each(run, order, bands, up, down);
  else if (run->directed)
    one_way(run, order, up, down);
  else
    both_ways(run, order, up, down);
}
