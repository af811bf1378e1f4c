/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A beam splits at each vertex that it sees. */
#include "mesh/visible-vertices.h"

#include "base/alloc.h"
#include "geometry/vector.h"

static void see_vertex(void *ctx, uint32_t vertex) {
  hr2di_visible_vertices *s = ctx;
  for (uint32_t k = s->first[vertex]; k < s->first[vertex + 1]; k++)
    s->end_seen[s->end[k]] = s->patch;
}

static hr2d_status see_side(void *ctx, const hr2di_line_class *line_class, hr2di_wall_side from,
                            hr2di_wall_side side) {
  (void)line_class;
  (void)from;
  hr2di_visible_vertices *s = ctx;
  const hr2di_side *of = &s->tracer.scene->parts.of_side[side];
  if (s->side_seen[side] == s->patch) return HR2D_OK;
  s->side_seen[side] = s->wall_seen[of->wall] = s->patch;
  const hr2di_side_part *part = s->tracer.scene->parts.part;
  for (uint32_t k = of->parts.first; k < of->parts.last; k++) {
    if (part[k].patch == HR2DI_NOBODY) continue;
    if (k > of->parts.first) s->end_seen[2 * part[k].patch] = s->patch;
    if (k + 1 < of->parts.last) s->end_seen[2 * part[k].patch + 1] = s->patch;
  }
  return hr2di_watch_work(s->tracer.walk.watch, (of->parts.last - of->parts.first) / 8);
}

/* Calls for each end of a patch that is at a vertex; counts them, or enters them. */
static void index_ends(hr2di_visible_vertices *s, int enter) {
  const hr2di_side_parts *p = &s->tracer.scene->parts;
  const hr2di_wall_edge *edge = s->tracer.scene->plane.triangulation.edge;
  for (uint32_t k = 0; k < p->parts; k++) {
    const hr2di_side_part *part = &p->part[k];
    if (part->patch == HR2DI_NOBODY || part->side == HR2DI_HIDDEN) continue;
    const hr2di_parts all = p->of_side[part->side].parts;
    const hr2d_segment patch = s->tracer.scene->patch[part->patch].scaled;
    const hr2di_wall_edge *e = &edge[part->side >> 1];
    const int ends[2] = {k == all.first && hr2di_point_same(part->at.a, patch.a),
                         k + 1 == all.last && hr2di_point_same(part->at.b, patch.b)};
    for (uint32_t last = 0; last < 2; last++) {
      const uint32_t vertex = (part->side & 1) == last ? e->from : e->to;
      if (ends[last] && enter) s->end[--s->first[vertex]] = 2 * part->patch + last;
      if (ends[last] && !enter) s->first[vertex]++;
    }
  }
}

hr2d_status hr2di_visible_vertices_init(hr2di_visible_vertices *s, const hr2d_scene *scene,
                                        hr2di_beam_cache *beam_cache,
                                        const hr2d_allocator *alloc, hr2di_watch *watch) {
  const hr2di_triangulation *t = &scene->plane.triangulation;
  *s = (hr2di_visible_vertices){.tracer =
                                    hr2di_beam_tracer_make(scene, beam_cache, alloc, watch)};
  s->tracer.take = see_side;
  s->tracer.see = see_vertex;
  s->tracer.ctx = s;
  s->first = hr2di_alloc_zero(alloc, t->vertices + 1, sizeof *s->first);
  s->end = hr2di_alloc(alloc, scene->patches, 2 * sizeof *s->end);
  s->end_seen = hr2di_alloc_zero(alloc, scene->patches, 2 * sizeof *s->end_seen);
  s->side_seen = hr2di_alloc_zero(alloc, t->edges, 2 * sizeof *s->side_seen);
  s->wall_seen = hr2di_alloc_zero(alloc, scene->walls.walls, sizeof *s->wall_seen);
  if (!s->first || !s->end || !s->end_seen || !s->side_seen || !s->wall_seen)
    return HR2D_ENOMEM;
  const hr2d_status status = hr2di_watch_work(watch, scene->patches + t->vertices / 8);
  if (status) return status;
  index_ends(s, 0);
  for (size_t v = 0; v < t->vertices; v++) s->first[v + 1] += s->first[v];
  index_ends(s, 1);
  return HR2D_OK;
}

void hr2di_visible_vertices_clear(hr2di_visible_vertices *s) {
  const hr2d_allocator *alloc = &s->tracer.walk.alloc;
  hr2di_beam_tracer_clear(&s->tracer);
  hr2di_alloc_free(alloc, s->first);
  hr2di_alloc_free(alloc, s->end);
  hr2di_alloc_free(alloc, s->end_seen);
  hr2di_alloc_free(alloc, s->side_seen);
  hr2di_alloc_free(alloc, s->wall_seen);
}

hr2d_status hr2di_visible_vertices_look(hr2di_visible_vertices *s, uint32_t patch) {
  s->patch = patch + 1;
  return hr2di_beam_tracer_trace(&s->tracer, patch, 1);
}
