/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of walls: cut, put into a mesh, taken out of it. */
#ifndef HR2D_SRC_TRIANGULATION_PIECES_H
#define HR2D_SRC_TRIANGULATION_PIECES_H

#include "triangulation/mesh.h"

/* Ends a piece that is not in the mesh at v; *rest is a new piece from there on.  HR2D_OK or
   HR2D_ENOMEM. */
hr2d_status hr2di_piece_cut(hr2di_mesh *m, uint32_t piece, uint32_t v, uint32_t *rest);

/* Puts a piece where the edge of h is, which runs along the piece or back; to the list of the
   edge, if there is a wall already. */
void hr2di_piece_put(hr2di_mesh *m, uint32_t piece, int32_t h);

/* Takes a piece out, which the mesh knows, with its list; its edge is free then. */
void hr2di_piece_take(hr2di_mesh *m, uint32_t piece);

/* Ends the list behind a piece that is not in the mesh; returns what was the next. */
uint32_t hr2di_piece_part(hr2di_mesh *m, uint32_t piece);

/* How far v is from the wall of a piece, if the wall reaches it and it is beside the inside of
   the piece; else infinity.  Both parts have fewer vertices beside them if the piece is cut
   there, so that cutting comes to an end. */
double hr2di_piece_distance(const hr2di_mesh *m, uint32_t piece, uint32_t v);

/* Names the walls of two pieces; returns HR2D_ESCENE. */
hr2d_status hr2di_piece_conflict(const hr2di_mesh *m, uint32_t p, uint32_t q, int together,
                                 hr2di_conflict *conflict);

#endif
