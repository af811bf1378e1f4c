/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The transport operator: irradiance from radiosity, over the links of all levels.

   Fields on leaves are arrays of leaves × order × bands.  The operator pulls them up the
   trees, gathers over the links, and pushes the result down to the leaves. */
#ifndef HR2D_SRC_SOLVE_TRANSPORT_H
#define HR2D_SRC_SOLVE_TRANSPORT_H

#include "hierarchy/push-pull.h"
#include "links/linkset-impl.h"
#include "solve/image-map.h"

typedef struct hr2di_transport {
  const hr2d_linkset *links;
  const hr2di_roots *roots; /* with the clusters that exchange light: of the links, or finer */
  hr2di_link_blocks blocks; /* of the links, above order 1; */
  void *leading; /* their values, where the operator has fewer than their leading part */
  const hr2d_hierarchy *hierarchy;
  const hr2d_scene
      *scene; /* whose E and ρ count: that of the hierarchy, or one of frozen temperatures */
  hr2d_allocator alloc;
  hr2di_push_pull trees;
  hr2di_image_map image_map;
  size_t order, bands, width; /* width is order × bands */
  int by_blocks; /* links exchange by blocks, not by areas: above order 1, and through gas */
  size_t elements, leaves;
  uint32_t *leaf;       /* the element of each leaf */
  uint32_t *other_leaf; /* the leaf on the other side of a pane, elsewhere the leaf itself; NULL
                           without panes */
  double *up;           /* elements × width: radiosity */
  struct hr2di_shared *shared; /* sums over shares; NULL: there is but one */
  double *down;     /* per slice the same: power received; then in the first one irradiance */
  double *receive;  /* order 1: factors per element for the push; NULL: light spreads evenly */
  double *send;     /* the same for the pull; equal to `receive` unless links are directed */
  double *closure;  /* leaves × order × order, added to the diagonal; NULL for none */
  double *sky;      /* leaves × order: form factor of the background; NULL: none */
  double *gas;      /* leaves × order: the part m of the light of a leaf that gas absorbs, or
                       that escapes into it; so much of E_g arrives from it.  NULL: no gas */
  size_t gas_order; /* coefficients on each leaf of `gas`; the first `order` of them count */
  double *gas_of;   /* with borders, per gas the part of m that is its own, as `gas` is; NULL:
                       there is one gas */
  double
      *gas_exchange;  /* with borders, gases × gases: their exchange areas of E_g; else NULL */
  double *gas_return; /* gases × gases: E_g of those of given heat, from what they get; and room
                         for as many numbers as there are gases.  NULL: no heat is given */
  double *gas_kept;   /* the part of m that gases of given heat do not give back, as `gas` is;
                         NULL: they give back all */
  size_t slices;      /* parts into which the links are cut, whatever the number of threads */
  unsigned threads;   /* as in options */
  hr2di_cluster_room room;
  uint64_t sweeps; /* gathers so far */
  hr2di_watch *watch;
  hr2d_status failed; /* HR2D_ENOMEM if a gather lacked memory, or the status of the watch: its
                         result must not be used */
  double *mean;       /* per element: of the diagonal of `closure`; NULL for none */
  unsigned char *closed; /* per patch: closure makes row sums 1; NULL at order 1, or without */
  int all_closed;        /* that is so for all patches */
  double *rows; /* leaves × order: K 1 without closure; NULL: nobody has gathered it */
  int check; /* links count with what this check of the extrapolation leaves, less 1; 0: as they
                are */
} hr2di_transport;

/* The copies of `down` that the operator of an order has. */
size_t hr2di_transport_slices(const hr2d_linkset *links, size_t order);

/* Sets up the operator at an order, with 0 at that of the hierarchy; above 1 the links must
   have blocks.
   Returns HR2D_OK, HR2D_ENOMEM or the status of the watch.  Call hr2di_transport_clear() in any
   case. */
hr2d_status hr2di_transport_init(hr2di_transport *t, const hr2d_linkset *links, size_t order,
                                 unsigned threads, hr2di_watch *watch);

void hr2di_transport_clear(hr2di_transport *t);

/* Sets the blocks to the first coefficients of `blocks`, as many as the operator has: all,
   those of their leading part, or fewer, which are copied to memory of its own.  HR2D_OK,
   HR2D_ENOMEM or the status of the watch. */
hr2d_status hr2di_transport_lead(hr2di_transport *t, const hr2di_link_blocks *blocks);

/* Fields have so many bands from now on, no more than those of the scene: rows are the same in
   all, and are gathered in one. */
static inline void hr2di_transport_set_bands(hr2di_transport *t, size_t bands) {
  t->bands = t->trees.bands = bands;
  t->width = t->order * bands;
}

/* Why its results must not be used, or HR2D_OK. */
static inline hr2d_status hr2di_transport_status(const hr2di_transport *t) {
  return t->failed ? t->failed : hr2di_watch_status(t->watch);
}

/* Pulls a leaf field up to every element, into t->up. */
void hr2di_transport_pull(hr2di_transport *t, const double *leaf_field);

/* Pushes irradiance of elements, in t->down, down to the leaves. */
void hr2di_transport_lower(hr2di_transport *t, double *irradiance);

/* irradiance = K radiosity: H_i = Σ_j AF_ij B_j / A_i on leaves. */
void hr2di_transport_apply(hr2di_transport *t, const double *radiosity, double *irradiance);

/* The same over a part of the links, without closure: links of distant pairs, or all links. */
typedef enum hr2di_transport_part { HR2DI_ALL_LINKS, HR2DI_DISTANT_LINKS } hr2di_transport_part;
void hr2di_transport_apply_part(hr2di_transport *t, hr2di_transport_part part,
                                const double *radiosity, double *irradiance);

/* Adds what closure receives; with all links that is K radiosity. */
void hr2di_transport_close(const hr2di_transport *t, const double *radiosity,
                           double *irradiance);

/* irradiance = what a check of the extrapolation of a period leaves of K radiosity. */
void hr2di_transport_check(hr2di_transport *t, int check, const double *radiosity,
                           double *irradiance);

/* The sum of the form factors over the links of each element itself, without those above and
   below it, at order 1: of links over which it receives, or over which it sends. */
void hr2di_transport_link_rows(hr2di_transport *t, int sends, double *factor);

#endif
