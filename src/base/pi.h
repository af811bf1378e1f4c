/* SPDX-License-Identifier: GPL-3.0-or-later */
/* C11 has no π. */
#ifndef HR2D_SRC_BASE_PI_H
#define HR2D_SRC_BASE_PI_H

#define HR2DI_PI 3.14159265358979323846

#endif
