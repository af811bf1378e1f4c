/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which patches lie along which side of the wall edges of a triangulation. */
#ifndef HR2D_SRC_SCENE_SIDE_PARTS_H
#define HR2D_SRC_SCENE_SIDE_PARTS_H

#include <hr2d/scene.h>

#include "beams/walk.h"

#define HR2DI_NOBODY UINT32_MAX

/* The side of a part that lies between walls within roundings of each other. */
#define HR2DI_HIDDEN UINT32_MAX

/* Parts of scaled coordinates overlap for certain if they do by more. */
#define HR2DI_PART_ROUNDING 0x1p-49

/* A part of one patch, or of a stretch without patches, on one side of a wall edge. */
typedef struct hr2di_side_part {
  hr2d_segment at;      /* an end that is an end of the patch has its coordinates */
  uint32_t patch;       /* or HR2DI_NOBODY */
  uint32_t place;       /* of the patch in hr2di_runs::patch */
  hr2di_wall_side side; /* or HR2DI_HIDDEN: it sees no more than its contacts */
} hr2di_side_part;

/* Two parts that are face to face with nothing between them. */
typedef struct hr2di_part_contact {
  uint32_t part, other;
  double area; /* their exchange area */
} hr2di_part_contact;

typedef struct hr2di_parts {
  uint32_t first, last; /* items [first, last) of hr2di_side_parts::part */
} hr2di_parts;

/* What lies along a side, and of which wall it is a part. */
typedef struct hr2di_side {
  hr2di_parts parts;
  uint32_t wall;
} hr2di_side;

/* The parts along a run follow each other in its direction, and those of one side make up the
   whole side; a side without patches has none.  Of walls that share an edge, triangles know the
   edge of one, whose sides have the parts of the outermost walls. */
typedef struct hr2di_side_parts {
  hr2d_allocator alloc;
  hr2di_side_part *part;
  size_t parts;
  hr2di_side *of_side;         /* 2·edges */
  hr2di_parts *of_run;         /* one for each run */
  hr2di_parts *of_patch;       /* one for each patch, hidden ones too; may be empty */
  unsigned char *wanted;       /* per side: whether it has patches */
  hr2di_part_contact *contact; /* by part; each is there from both sides */
  size_t contacts;
} hr2di_side_parts;

/* Of a scene with runs and a plane.  HR2D_OK, HR2D_ENOMEM or the status of the watch; to be
   ended by hr2di_side_parts_clear() in any case. */
hr2d_status hr2di_side_parts_init(hr2di_side_parts *parts, const hr2d_scene *scene,
                                  hr2di_watch *watch);
void hr2di_side_parts_clear(hr2di_side_parts *parts);

/* Whether an end of a part is on the left of a border. */
typedef int (*hr2di_side_parts_left_fn)(const void *border, hr2d_point end);

/* The first of parts along a side whose end is on the left of a border; the last one if there
   is none.  The side starts on the right. */
uint32_t hr2di_side_parts_find(const hr2di_side_parts *parts, hr2di_parts among,
                               hr2di_side_parts_left_fn is_on_left, const void *border);

/* What lies along a side. */
enum {
  HR2DI_HAS_FRONT = 1, /* patches */
  HR2DI_HAS_BACK = 2   /* no patch, or not everywhere: the black back of a wall */
};

/* These, of one side. */
unsigned hr2di_side_kind(const hr2di_side_parts *parts, hr2di_wall_side side);

/* Whether a scene with a plane has backs: sides without patches, wholly or in part, or patches
   so close behind others that they see nothing else.  HR2D_OK or the status of the watch. */
hr2d_status hr2di_side_parts_find_backs(const hr2d_scene *scene, int *found,
                                        hr2di_watch *watch);

/* The first contact of a part, or of a later one; the number of contacts if there is none. */
size_t hr2di_side_parts_contact(const hr2di_side_parts *parts, uint32_t part);

#endif
