/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The name of the scene, and how it was solved. */
#include "draw/picture.h"

#if HAVE_CAIRO
#include <math.h>
#include <stdio.h>

#include "cli/scene.h"

#define SIDE 24.0

/* The target or budget, and the bound of the error that was reached. */
static void describe_target(const run *r, char *text, size_t size) {
  const options *o = r->options;
  const int sup = o->norm == HR2D_NORM_SUP;
  char wanted[48];
  if (o->target_error > 0)
    snprintf(wanted, sizeof wanted, "target error %g", o->target_error);
  else
    snprintf(wanted, sizeof wanted, "%g seconds", o->time_budget);
  const double bound = sup ? r->account.sup.bound : r->account.average.bound;
  if (isfinite(bound))
    snprintf(text, size, "%s, at most %.1e reached", wanted, bound);
  else
    snprintf(text, size, "%s, error unknown", wanted);
}

/* The line below the title. */
static void describe(const picture *p, char *text, size_t size) {
  const run *r = p->run;
  const options *o = r->options;
  const hr2d_refine_counts n = hr2d_linkset_counts(r->links);
  char first[32] = "", order[32] = "", last[128];
  if (options_targeted(o)) {
    describe_target(r, last, sizeof last);
  } else {
    snprintf(first, sizeof first, "ε = %g    ", o->epsilon);
    snprintf(last, sizeof last, "oracle %s, variant %s", o->oracle->name, o->policy->name);
  }
  if (r->account.order > 1) snprintf(order, sizeof order, "p = %u    ", r->account.order);
  snprintf(text, size, "%s%sN = %llu    L = %llu    %s", first, order,
           (unsigned long long)n.elements, (unsigned long long)r->account.links, last);
}

double title_width(const picture *p) {
  char text[256];
  describe(p, text, sizeof text);
  pen_font(p->cr, 10.5, 0);
  const double below = pen_text_width(p->cr, text);
  pen_font(p->cr, 15, 1);
  return fmax(below, pen_text_width(p->cr, scene_file_name(p->run->options))) + 2 * SIDE;
}

void title_draw(const picture *p) {
  char text[256];
  pen_grey(p->cr, 0.1);
  pen_font(p->cr, 15, 1);
  pen_write(p->cr, SIDE, 28, scene_file_name(p->run->options));
  describe(p, text, sizeof text);
  pen_grey(p->cr, 0.3);
  pen_font(p->cr, 10.5, 0);
  pen_write(p->cr, SIDE, 46, text);
}
#endif
