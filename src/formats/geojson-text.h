/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses the text of a GeoJSON file into jansson's tree. */
#ifndef HR2D_SRC_FORMATS_GEOJSON_TEXT_H
#define HR2D_SRC_FORMATS_GEOJSON_TEXT_H

#include <jansson.h>
#include <stddef.h>

#include "base/message.h"
#include "base/watch.h"

/* *root becomes an object or an array, a reference that the caller owns; NULL on failure.
   Returns HR2D_OK, HR2D_ENOMEM, the status of the watch, or HR2D_ESYNTAX with a message that
   names line and column. */
hr2d_status hr2di_geojson_load(const char *text, size_t size, json_t **root,
                               hr2di_message *message, hr2di_watch *watch);

#endif
