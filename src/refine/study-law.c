/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The law of N and L as ε → 0: integrals over all patches, as terms of powers of ε. */
#include <hr2d/study.h>
#include <math.h>

#include "base/sized-struct.h"
#include "links/linkset-impl.h"
#include "refine/law-touch.h"
#include "scene/scene-impl.h"

/* Of one interval of a patch; errors are mostly below ten times this. */
#define TOLERANCE 1e-8

enum { BISECTIONS = 1000 };

typedef struct law {
  hr2d_linkset *links;
  hr2di_law_rule rule;
  hr2di_watch watch;
  hr2di_law_view view;
  double sum[HR2DI_LAW_PARTS], error[HR2DI_LAW_PARTS];
  double roots; /* the term of N that does not grow */
  double done;  /* part of the patches */
} law;

static void describe(void *of, hr2d_progress *report) {
  report->fraction = ((const law *)of)->done;
}

static hr2d_status fail(law *l, hr2d_status status) {
  if (!status || hr2di_watch_refused(&l->watch)) return status;
  return hr2di_message_fail(&l->links->message, status, "out of memory for the law");
}

static hr2d_status check_corners(law *l) {
  size_t touching[2];
  if (l->rule.l1) return HR2D_OK;
  const hr2d_status status = hr2di_law_touching(&l->view, touching);
  if (status || touching[0] == touching[1]) return fail(l, status);
  return hr2di_message_fail(
      &l->links->message, HR2D_EUNSUPPORTED,
      "%s and %s touch: with the oracle \"%s\" N and L have no law in the corner",
      hr2di_patch_label(l->view.scene, touching[0]).text,
      hr2di_patch_label(l->view.scene, touching[1]).text, l->links->oracle.name);
}

static double inner_tolerance(const law *l) {
  return l->rule.l1 ? HR2DI_LAW_TOLERANCE_L1 : 0;
}

static hr2d_status integrate(law *l) {
  const size_t patches = l->view.scene->patches;
  const hr2di_law_integral integral = {.at = hr2di_law_view_at,
                                       .ctx = &l->view,
                                       .parts = HR2DI_LAW_PARTS,
                                       .pieces = HR2DI_LAW_PIECES,
                                       .most = BISECTIONS,
                                       .tolerance = inner_tolerance(l) + TOLERANCE};
  hr2d_status status = HR2D_OK;
  for (size_t k = 0; k < patches && !status; k++) {
    double sum[HR2DI_LAW_PARTS] = {0};
    l->view.patch = k;
    l->done = (double)k / (double)patches;
    if (hr2di_scene_lit(l->view.scene, k))
      status = hr2di_law_integrate(&integral, 0, 1, sum, l->error);
    for (size_t part = 0; part < HR2DI_LAW_PARTS; part++) l->sum[part] += sum[part];
    l->roots += sum[HR2DI_LAW_ELEMENTS] + sum[HR2DI_LAW_EDGE_ELEMENTS] > 0 ? -1 : 1;
  }
  return fail(l, status);
}

/* In scene lengths: ε of an oracle that is a length has them, any other has none. */
static hr2d_study_term term(const law *l, int part, double power) {
  const double unit = l->rule.l1 ? pow(hr2d_scene_unit(l->view.scene), power) : 1;
  const double inner = inner_tolerance(l) * fabs(l->sum[part]);
  return (hr2d_study_term){unit * l->sum[part], power, unit * (l->error[part] + inner)};
}

static hr2d_study_term both(hr2d_study_term a, hr2d_study_term b) {
  return (hr2d_study_term){a.factor + b.factor, a.power, a.error + b.error};
}

/* A tree of n leaves has 2n − 1 elements; n grows, or is 1 where a patch sees nothing. */
static hr2d_study_constants constants_of(const law *l) {
  const double clear = l->rule.power, edge = l->rule.edge_power;
  const hr2d_study_term edge_links = term(l, HR2DI_LAW_EDGE_LINKS, edge);
  const hr2d_study_term clear_links = term(l, HR2DI_LAW_CLEAR_LINKS, clear);
  const hr2d_study_term edge_elements = term(l, HR2DI_LAW_EDGE_ELEMENTS, edge);
  const hr2d_study_term elements = term(l, HR2DI_LAW_ELEMENTS, clear);
  const hr2d_study_term roots = {l->roots, 0, 0};
  hr2d_study_constants c = {.period = exp2(1 / clear)};
  c.links[0] = term(l, HR2DI_LAW_LINKS, 2 * clear);
  if (edge == clear) {
    c.links[1] = both(edge_links, clear_links);
    c.elements[0] = both(edge_elements, elements);
    c.elements[1] = roots;
  } else {
    c.links[1] = edge_links;
    c.links[2] = clear_links;
    const int shaded = edge_elements.factor > edge_elements.error; /* not by roundings */
    if (shaded) c.elements[0] = edge_elements;
    c.elements[shaded] = elements;
    c.elements[shaded + 1] = roots;
  }
  return c;
}

static hr2d_status make_law(law *l, const hr2d_refine_options *options,
                            hr2d_study_constants *constants) {
  const hr2d_scene *scene = l->view.scene;
  hr2di_scene_watch(scene, &l->watch, options->progress, options->progress_ctx, "law");
  hr2di_watch_describe(&l->watch, describe, l);
  hr2d_status status =
      hr2di_point_viewer_create(scene, &l->links->alloc, &l->watch, &l->view.viewer);
  status = fail(l, status);
  if (!status) status = check_corners(l);
  if (!status) status = integrate(l);
  if (!status) *constants = constants_of(l);
  hr2di_point_viewer_destroy(l->view.viewer);
  return status;
}

hr2d_status hr2d_study_law(hr2d_linkset *links, const hr2d_refine_options *options,
                           hr2d_study_constants *constants) {
  if (!links || !constants) return HR2D_EINVAL;
  hr2d_refine_options used = HR2D_REFINE_OPTIONS_INIT;
  law l = {.links = links};
  const hr2d_scene *scene = links->hierarchy->scene;
  l.view = (hr2di_law_view){.rule = &l.rule, .scene = scene, .watch = &l.watch};
  if (hr2di_sized_copy(&used, sizeof used, options))
    return hr2di_message_fail(&links->message, HR2D_EINVAL, "struct_size is not set");
  if (hr2di_law_rule_find(&links->oracle, &links->policy, &l.rule))
    return hr2di_message_fail(&links->message, HR2D_EUNSUPPORTED,
                              "there is no law for the oracle \"%s\" and the policy \"%s\"",
                              links->oracle.name, links->policy.name);
  const int panes = scene->effect[HR2D_EFFECT_PANES].called_for;
  if (used.ordered || scene->symmetry.motion || panes)
    return hr2di_message_fail(&links->message, HR2D_EUNSUPPORTED, "there is no law %s",
                              used.ordered ? "of ordered pairs"
                              : panes      ? "with panes, whose sides are divided alike"
                                           : "with mirrors or a period");
  return make_law(&l, &used, constants);
}
