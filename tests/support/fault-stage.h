/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stages for calls that fail on demand: a set of objects, made as far as the call needs
   them.  A digest of their contents shows that a failure changed nothing, and that the same
   call gives the same result again. */
#ifndef HR2D_TESTS_SUPPORT_FAULT_STAGE_H
#define HR2D_TESTS_SUPPORT_FAULT_STAGE_H

#include <stdint.h>

#include "support/support.h"

/* How far the objects are made. */
typedef enum fault_depth {
  DEPTH_NOTHING,
  DEPTH_SCENE,     /* empty */
  DEPTH_FILLED,    /* with patches, not committed */
  DEPTH_COMMITTED, /* and from here on with a hierarchy and an empty set of links */
  DEPTH_REFINED,
  DEPTH_SOLVED
} fault_depth;

/* The patches of the scene. */
typedef enum fault_plan {
  PLAN_ROOM,     /* a closed room of two bands with a lamp of two sides in it */
  PLAN_OPEN,     /* two walls and an obstacle under a sky, in part dark */
  PLAN_PAIR,     /* two walls that face each other */
  PLAN_HEAT,     /* a room of three bands with walls of given flux */
  PLAN_GAS,      /* the room, full of gas */
  PLAN_OPEN_GAS, /* the two walls in gas */
  PLAN_CROSSING, /* two bars that cross in a room; cannot be committed */
  PLAN_IMAGES,   /* that under a sky with a mirror, and a period */
  PLAN_PLATES,   /* the two walls between two mirrors: images that are seen are cut off */
  PLAN_BLOCKS,   /* so many patches that beams find the pairs */
  PLAN_ROWS      /* so many that they are clustered, and clusters are linked */
} fault_plan;

typedef struct fault_stage {
  test_memory memory;
  hr2d_scene *scene;
  hr2d_hierarchy *hierarchy;
  hr2d_linkset *links;
  hr2d_solution *solution;
  hr2d_solution *result; /* of the call itself */
} fault_stage;

/* The state of a stage before the call. */
typedef struct fault_setting {
  fault_depth depth;
  fault_plan plan;
  const hr2d_oracle *oracle; /* NULL: size */
  const hr2d_policy *policy; /* NULL: original */
  unsigned order;            /* 0: 1 */
  double epsilon;            /* of the refinement; 0: 0.7 */
} fault_setting;

void fault_stage_make(fault_stage *s, const fault_setting *setting);

/* Destroys everything; nothing may be left. */
void fault_stage_end(fault_stage *s);

/* Digests (FNV): mix bytes, a count, a double into a sum. */
uint64_t fault_mix(uint64_t sum, const void *bytes, size_t size);
uint64_t fault_mix_count(uint64_t sum, uint64_t count);
uint64_t fault_mix_real(uint64_t sum, double value);

/* Digests of the objects of a stage without its result, of a solution, and of counts. */
uint64_t fault_stage_sum(const fault_stage *s);
uint64_t fault_solution_sum(const hr2d_solution *solution);
uint64_t fault_counts_sum(const hr2d_refine_counts *counts);

/* A call: its name, its stage, and the function that makes it.  The function mixes its
   result into *sum. */
typedef struct fault_act {
  const char *name;
  fault_setting setting;
  hr2d_status (*call)(fault_stage *s, uint64_t *sum);
  const char *(*message)(const fault_stage *s); /* NULL: no object keeps one */
  int max; /* allocations that are failed, at equal distances; 0: all */
} fault_act;

/* Each allocation of the call fails once, and for good. */
void fault_play(const fault_act *act);

#endif
