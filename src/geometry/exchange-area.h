/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchange areas of many element pairs at once, bit for bit as from hr2d_exchange_area(). */
#ifndef HR2D_SRC_GEOMETRY_EXCHANGE_AREA_H
#define HR2D_SRC_GEOMETRY_EXCHANGE_AREA_H

#include <hr2d/oracle.h>
#include <stddef.h>

void hr2di_exchange_areas(const hr2d_element *elements, const hr2d_pair *pairs, size_t count,
                          double *area);

#endif
