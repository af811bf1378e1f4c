/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Members of a GeoJSON file that are not read, but look as if they should be. */
#ifndef HR2D_SRC_FORMATS_GEOJSON_MEANT_H
#define HR2D_SRC_FORMATS_GEOJSON_MEANT_H

#include "formats/geojson-impl.h"

/* Each makes notes on one object: the collection, its member "hr2d", a feature and its
   properties, those of a back.  HR2D_OK or the status of the watch. */
hr2d_status hr2di_geojson_note_root(hr2di_geojson *reader, const json_t *root);
hr2d_status hr2di_geojson_note_feature(hr2di_geojson *reader, const json_t *feature);
hr2d_status hr2di_geojson_note_back(hr2di_geojson *reader, const json_t *back);

#endif
