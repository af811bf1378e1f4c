/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The readers of scene files: each adds the patches that a text describes.  If one fails,
   hr2d_scene_read() and hr2d_scene_parse() remove the patches that it has added. */
#ifndef HR2D_SRC_FORMATS_SCENE_FILE_H
#define HR2D_SRC_FORMATS_SCENE_FILE_H

#include <hr2d/scene.h>
#include <stddef.h>

#include "base/watch.h"

/* GeoJSON: sets the background last, once nothing else can fail. */
hr2d_status hr2di_geojson_read(hr2d_scene *scene, const char *text, size_t size,
                               hr2di_watch *watch);

/* View2D's .vs2; and whether a text seems to be in this format. */
hr2d_status hr2di_vs2_read(hr2d_scene *scene, const char *text, size_t size,
                           hr2di_watch *watch);
int hr2di_vs2_recognise(const char *text, size_t size);

#endif
