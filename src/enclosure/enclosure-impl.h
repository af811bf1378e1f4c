/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The enclosure object: ranges of the means over patches. */
#ifndef HR2D_SRC_ENCLOSURE_ENCLOSURE_IMPL_H
#define HR2D_SRC_ENCLOSURE_ENCLOSURE_IMPL_H

#include <hr2d/enclosure.h>

#include "enclosure/enclosure-factors.h"

struct hr2d_enclosure {
  hr2d_allocator alloc;
  const hr2d_scene *scene;
  size_t patches, bands; /* without images */
  hr2di_range *b, *h;    /* patches × bands */
};

#endif
