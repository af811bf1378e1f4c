/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Components: patches that exchange light with each other, directly or over other patches. */
#ifndef HR2D_SRC_LINKS_COMPONENTS_H
#define HR2D_SRC_LINKS_COMPONENTS_H

#include "links/linkset-impl.h"

typedef struct hr2di_components {
  hr2d_allocator alloc;
  uint32_t *parent; /* union-find over the patches, followed by the clusters */
  size_t count;     /* of both */
} hr2di_components;

/* Joins what light passes between through panes, in a band, or in any for SIZE_MAX. */
void hr2di_components_join_panes(hr2di_components *c, const hr2d_scene *scene, size_t band);

/* Finds the components of a link set, without panes.  Returns HR2D_OK, HR2D_ENOMEM or the
   status of the watch. Call hr2di_components_clear() in any case. */
hr2d_status hr2di_components_init(hr2di_components *c, const hr2d_linkset *links,
                                  hr2di_watch *watch);
void hr2di_components_clear(hr2di_components *c);

/* The component that holds a patch: the number of the first patch in it. */
size_t hr2di_component(hr2di_components *c, size_t patch);

#endif
