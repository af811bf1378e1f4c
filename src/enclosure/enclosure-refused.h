/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What hr2d_enclose() does not enclose. */
#ifndef HR2D_SRC_ENCLOSURE_ENCLOSURE_REFUSED_H
#define HR2D_SRC_ENCLOSURE_ENCLOSURE_REFUSED_H

#include <hr2d/scene.h>

/* HR2D_OK, or HR2D_EUNSUPPORTED with the reason in `room` bytes. */
hr2d_status hr2di_enclosure_refused(const hr2d_scene *scene, char *reason, size_t room);

#endif
