/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hr2d_solve(): from links, and perhaps a former solution, to a solution and its powers. */
#include <hr2d/solve.h>
#include <hr2d/transport.h>
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/neumaier-sum.h"
#include "base/sized-struct.h"
#include "base/team.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/frozen-temperatures.h"
#include "solution/band-solution.h"
#include "solution/solution-impl.h"
#include "solve/closure.h"
#include "solve/equation.h"
#include "solve/existence.h"
#include "solve/first-guess.h"
#include "solve/gas-light.h"
#include "solve/heat-scene.h"
#include "solve/power-cut-off.h"
#include "solve/solve-how.h"

static hr2d_status check_options(hr2d_linkset *links, const hr2d_solve_options *o, int adopts) {
  hr2di_message *message = &links->message;
  if (links->hierarchy->refining || links->solving)
    return hr2di_message_fail(message, HR2D_ESTATE, "the links are being %s already",
                              links->solving ? "solved on" : "refined");
  if (o->tolerance != 0 && (!(o->tolerance >= 1e-15) || !isfinite(o->tolerance)))
    return hr2di_message_fail(message, HR2D_EINVAL, "tolerance %g is not a number ≥ 1e-15",
                              o->tolerance);
  if ((unsigned)o->closure > HR2D_CLOSURE_OFF)
    return hr2di_message_fail(message, HR2D_EINVAL, "closure %d is no hr2d_closure",
                              (int)o->closure);
  if (o->start && o->start->hierarchy != links->hierarchy)
    return hr2di_message_fail(message, HR2D_EINVAL, "the warm start is from another hierarchy");
  if (adopts && hr2di_scene_is_unsettled(links->hierarchy->scene))
    return hr2di_message_fail(message, HR2D_EUNSUPPORTED,
                              "values from outside do not tell the temperatures of patches of "
                              "given flux in several bands");
  if (links->share &&
      hr2di_gas_refuses(links->hierarchy->scene, "shares do not solve", &links->message))
    return HR2D_EUNSUPPORTED;
  if (links->counts.elements == 0)
    return hr2di_message_fail(message, HR2D_ESTATE, "the link set was never refined");
  return HR2D_OK;
}

/* Adds the escaped power of a leaf.  In balanced components, and in gas, it is ∫mB; gas of
   given heat gives it back.  Elsewhere it is the power that the leaf sends less the power that
   it gets from patches: summed over all leaves, the power that is sent and does not arrive. */
static void add_escape(const hr2di_equation *s, size_t leaf, size_t band, hr2di_sum *escaped) {
  const hr2di_transport *t = &s->transport;
  const size_t at = leaf * t->width + band;
  const double area = s->weight[leaf * t->order];
  const double *missing = t->gas ? hr2di_gas_light_lost(t) : s->balance.missing;
  if (t->gas && !missing) return;
  if (!t->gas && !hr2di_balance_holds(&s->balance, leaf)) {
    hr2di_sum_add(escaped, area * s->radiosity[at]);
    hr2di_sum_add(escaped, -area * s->irradiance[at]);
    if (s->outside) hr2di_sum_add(escaped, area * s->outside[at]);
    return;
  }
  for (size_t l = 0; l < t->order; l++)
    hr2di_sum_add(escaped,
                  area * (missing[leaf * t->order + l] * s->radiosity[at + l * t->bands]));
}

/* Powers in scene lengths. */
static hr2d_power sum_power(const hr2di_equation *s, size_t band) {
  const hr2di_transport *t = &s->transport;
  const hr2d_scene *scene = t->scene;
  hr2di_sum emitted = {0, 0}, received = {0, 0}, absorbed = {0, 0}, escaped = {0, 0};
  for (size_t k = 0; k < t->leaves; k++) {
    const size_t at = k * t->width + band, patch = t->hierarchy->element[t->leaf[k]].patch;
    const double absorbance = hr2di_scene_absorptance(scene, patch, band);
    const double area = s->weight[k * t->order];
    if (patch >= hr2di_scene_cell(scene)) continue;
    hr2di_sum_add(&emitted, area * s->source[at]);
    hr2di_sum_add(&absorbed, area * (absorbance * s->irradiance[at]));
    if (s->outside) hr2di_sum_add(&received, area * s->outside[at]);
    add_escape(s, k, band, &escaped);
  }
  const double unit = hr2d_scene_unit(scene);
  const int e = s->exponent[band];
  return (hr2d_power){
      ldexp(unit * hr2di_sum_total(&emitted), e), ldexp(unit * hr2di_sum_total(&received), e),
      ldexp(unit * hr2di_sum_total(&absorbed), e), ldexp(unit * hr2di_sum_total(&escaped), e)};
}

/* Pulls a leaf field up to every element, in the unit of E.  Returns 1 if all values are
   finite, else 0. */
static int take_raised(hr2di_equation *s, const double *leaf_field, double *field) {
  hr2di_transport *t = &s->transport;
  int finite = 1;
  hr2di_transport_pull(t, leaf_field);
  for (size_t k = 0; k < t->elements * t->width && !t->failed; k++) {
    if (k % 1024 == 0) t->failed = hr2di_watch_work(t->watch, 100);
    field[k] = ldexp(t->up[k], s->exponent[k % t->bands]);
    finite &= isfinite(field[k]) != 0;
  }
  return finite;
}

/* Sets E_g and the heat of all gases in all bands. */
static hr2d_status set_gas(const hr2di_equation *s, hr2d_solution *made) {
  const hr2di_transport *t = &s->transport;
  const double unit = hr2d_scene_unit(t->scene);
  made->gas =
      hr2di_alloc(&made->alloc, t->scene->gases.count * t->bands, 2 * sizeof *made->gas);
  for (size_t k = 0; k < t->scene->gases.count && made->gas; k++)
    for (size_t b = 0; b < t->bands; b++) {
      const int e = s->exponent[b];
      double *of = hr2di_solution_gas(made, k, b);
      of[0] = ldexp(hr2di_gas_light_emission(t, k, b, e, s->radiosity), e);
      of[1] = ldexp(unit * hr2di_gas_light_heat(t, k, b, e, s->radiosity), e);
    }
  return made->gas ? HR2D_OK : HR2D_ENOMEM;
}

/* Sets the powers of all bands, and what they are off. */
static hr2d_status set_powers(hr2di_equation *s, hr2d_solution *made) {
  hr2di_transport *t = &s->transport;
  for (size_t band = 0; band < t->bands && !t->failed; band++) {
    t->failed = hr2di_watch_work(t->watch, t->leaves / 4);
    made->power[band] = sum_power(s, band);
  }
  if (t->gas && !t->failed) t->failed = set_gas(s, made);
  if (t->failed || !hr2di_symmetry_cuts(&t->scene->symmetry)) return t->failed;
  made->power_cut_off = hr2di_alloc(&made->alloc, t->bands, sizeof *made->power_cut_off);
  return made->power_cut_off ? hr2di_power_cut_off(s, made->power_cut_off) : HR2D_ENOMEM;
}

/* The part of the largest value by which B and H of one equation differ from solve to solve,
   with room: B by some 1e-13, as solve.h states, and H = (B − E)/ρ by ten times that where ρ is
   a tenth; 1.3e-13 and 1.2e-12 were seen. */
#define SAME 1e-11

/* Whether two fields differ by roundings alone. */
static int is_same(const double *one, const double *other, size_t count, size_t bands,
                   size_t band) {
  double largest = 0, difference = 0;
  for (size_t k = band; k < count; k += bands) {
    largest = fmax(largest, fabs(one[k]));
    difference = fmax(difference, fabs(one[k] - other[k]));
  }
  return difference <= SAME * largest;
}

/* A warm start that solves this equation already keeps its bits: so a state that is gone on
   from without finer links is the same as before. */
static void keep_start(const hr2di_equation *s, hr2d_solution *made) {
  const hr2d_solution *start = s->options.start;
  if (!start || made->work.iterations > 0 || start->elements != made->elements ||
      start->order != made->order)
    return;
  const size_t count = made->elements * made->order * made->bands;
  for (size_t b = 0; b < made->bands; b++)
    if (!is_same(made->value, start->value, count, made->bands, b) ||
        !is_same(made->irradiance, start->irradiance, count, made->bands, b))
      return;
  memcpy(made->value, start->value, count * sizeof *made->value);
  memcpy(made->irradiance, start->irradiance, count * sizeof *made->irradiance);
  memcpy(made->power, start->power, made->bands * sizeof *made->power);
  made->residual = start->residual;
}

static hr2d_status make_solution(hr2di_equation *s, hr2d_solution **solution) {
  hr2di_transport *t = &s->transport;
  hr2d_solution *made = hr2di_alloc_zero(&s->links->alloc, 1, sizeof *made);
  if (!made) return HR2D_ENOMEM;
  *made = (hr2d_solution){.alloc = s->links->alloc,
                          .links = s->links,
                          .hierarchy = t->hierarchy,
                          .elements = t->elements,
                          .order = t->order,
                          .bands = t->bands,
                          .work = {.gathers = t->sweeps,
                                   .iterations = s->residuals ? s->residuals - 1 : 0,
                                   .row_sums = s->row_sums,
                                   .background_rows = t->sky ? s->row_sums : 0,
                                   .kernels = s->kernels,
                                   .coefficients_seconds = s->coefficients_seconds},
                          .residual = hr2di_equation_residual(s)};
  made->power = hr2di_alloc(&made->alloc, t->bands, sizeof *made->power);
  made->value = hr2di_alloc(&made->alloc, t->elements * t->width, sizeof *made->value);
  made->irradiance =
      hr2di_alloc(&made->alloc, t->elements * t->width, sizeof *made->irradiance);
  if (!made->power || !made->value || !made->irradiance) {
    hr2d_solution_destroy(made);
    return HR2D_ENOMEM;
  }
  const hr2d_status status = set_powers(s, made);
  if (status) {
    hr2d_solution_destroy(made);
    return status;
  }
  int finite = take_raised(s, s->radiosity, made->value);
  hr2di_closure_move_mean(t, s->radiosity, s->irradiance);
  finite &= take_raised(s, s->irradiance, made->irradiance);
  hr2di_image_map_spread(&t->image_map, t->order, t->bands, made->value);
  hr2di_image_map_spread(&t->image_map, t->order, t->bands, made->irradiance);
  if (finite && !t->failed) {
    keep_start(s, made);
    *solution = made;
    return HR2D_OK;
  }
  hr2d_solution_destroy(made);
  return t->failed ? t->failed
                   : hr2di_message_fail(&s->links->message, HR2D_ERANGE,
                                        "a radiosity is beyond what a double can represent");
}

/* Takes B on leaves as it is, and its irradiance. */
static hr2d_status adopt(hr2di_equation *s, const double *field) {
  const hr2di_transport *t = &s->transport;
  int finite = 1;
  for (size_t k = 0; k < s->field; k++) {
    const double given = field[t->leaf[k / t->width] * t->width + k % t->width];
    s->radiosity[k] = ldexp(given, -s->exponent[k % t->bands]);
    finite &= isfinite(given) != 0;
  }
  if (!finite)
    return hr2di_message_fail(&s->links->message, HR2D_EINVAL,
                              "a value that is given is not finite");
  hr2di_equation_gather(s, s->radiosity);
  return t->failed;
}

/* B of an equation that has its source. */
static hr2d_status find(hr2di_equation *eq) {
  if (!eq->transport.hierarchy->scene->effect[HR2D_EFFECT_INTERREFLECTION].on)
    return hr2di_equation_take(eq);
  hr2d_status status = hr2di_first_guess(eq);
  if (!status) status = hr2di_equation_solve(eq);
  if (!status) status = hr2di_equation_settle_power(eq);
  return status ? status : hr2di_equation_check_sign(eq);
}

static void tell_refusal(const hr2di_equation *eq, hr2d_status status) {
  if (status && eq->watch.refused && status == eq->watch.status)
    hr2di_message_fail(&eq->links->message, status, "%s: %s", eq->watch.report.phase,
                       hr2d_strerror(status));
}

/* With a `field` it is adopted. */
static hr2d_status solve(hr2d_linkset *links, const hr2di_equation_how *how,
                         const hr2d_solve_options *options, const double *field,
                         hr2d_solution **solution) {
  hr2di_equation eq;
  hr2d_status status = hr2di_equation_init(&eq, links, links->hierarchy->scene, how, options);
  if (!eq.options.start) eq.options.start = how->start;
  if (!status) status = field ? adopt(&eq, field) : find(&eq);
  if (!status) status = make_solution(&eq, solution);
  tell_refusal(&eq, status);
  hr2di_equation_clear(&eq);
  return status;
}

/* Finds temperatures first; on success the solution owns the scene of frozen temperatures. */
static hr2d_status solve_heat(hr2d_linkset *links, const hr2d_solve_options *options,
                              hr2d_scene *frozen, hr2d_solution **solution) {
  hr2di_heat_balance h;
  hr2d_status status = hr2di_heat_balance_init(&h, frozen, links, options);
  if (!status) status = hr2di_heat_balance_settle(&h);
  if (!status) status = hr2di_heat_scene_check(&h);
  if (!status) status = hr2di_heat_balance_source(&h, options);
  if (!status) status = find(&h.eq);
  if (!status) status = make_solution(&h.eq, solution);
  tell_refusal(&h.eq, status);
  if (!status) (*solution)->own_scene = frozen;
  hr2di_heat_balance_clear(&h);
  return status;
}

static hr2d_status guess(hr2d_linkset *links, const hr2d_solve_options *options,
                         hr2d_scene **frozen) {
  const hr2d_status status =
      hr2di_heat_scene_create(links->hierarchy->scene, options->start, options->progress,
                              options->progress_ctx, frozen);
  if (status)
    hr2di_message_fail(&links->message, status, "%s", hr2di_heat_scene_failure(status));
  return status;
}

/* During the solve callbacks may change neither the links nor the hierarchy. */
static void begin(hr2d_linkset *links) {
  links->solving = 1;
  atomic_fetch_add(&links->hierarchy->readers, 1);
}

static void end(hr2d_linkset *links) {
  atomic_fetch_sub(&links->hierarchy->readers, 1);
  links->solving = 0;
}

hr2d_status hr2di_solve_again(hr2di_equation *eq, const hr2d_solution *start,
                              hr2d_solution **solution) {
  hr2d_status status = hr2di_existence_check(eq->links, eq->transport.scene, &eq->watch);
  eq->options.start = start;
  eq->residuals = eq->transport.sweeps = 0;
  begin(eq->links);
  if (!status) status = find(eq);
  if (!status) status = make_solution(eq, solution);
  end(eq->links);
  tell_refusal(eq, status);
  eq->row_sums = eq->kernels = 0;
  eq->coefficients_seconds = 0;
  eq->options.start = NULL;
  return status;
}

/* A solution that another share does not have is none. */
static hr2d_status agree(hr2d_linkset *links, hr2d_status own, hr2d_solution **solution) {
  const hr2d_status status = hr2di_share_agree(links->share, own);
  if (status && !own) {
    hr2d_solution_destroy(*solution);
    *solution = NULL;
    hr2di_message_fail(&links->message, status, "another share: %s", hr2d_strerror(status));
  }
  return status;
}

static hr2d_status run(hr2d_linkset *links, const hr2di_equation_how *how,
                       const hr2d_solve_options *given, const double *field,
                       hr2d_solution **solution);

/* The bands of a group alone. */
static hr2d_status run_group(hr2d_linkset *links, size_t group, const hr2di_equation_how *how,
                             const hr2d_solve_options *options, const double *field,
                             hr2d_solution **solution) {
  const hr2d_hierarchy *h = links->hierarchy;
  const size_t items = h->elements * h->order;
  hr2di_linkset_part part;
  hr2di_equation_how part_how = *how;
  hr2d_solve_options part_options = *options;
  hr2d_solution *start = NULL, *how_start = NULL;
  double *part_field = NULL;
  hr2di_linkset_part_begin(&part, links, group);
  hr2d_status status = hr2di_band_solution_take(options->start, &part.links, group, &start);
  if (!status) status = hr2di_band_solution_take(how->start, &part.links, group, &how_start);
  if (!status && field) {
    part_field =
        hr2di_alloc(&links->alloc, items, part.hierarchy.scene->bands * sizeof *part_field);
    status = part_field ? HR2D_OK : HR2D_ENOMEM;
  }
  if (part_field) hr2di_band_field_take(h->scene, group, items, field, part_field);
  part_options.start = start;
  part_how.start = how_start;
  if (!status) status = run(&part.links, &part_how, &part_options, part_field, solution);
  hr2di_alloc_free(&links->alloc, part_field);
  hr2d_solution_destroy(start);
  hr2d_solution_destroy(how_start);
  hr2di_linkset_part_end(&part);
  return status;
}

/* Bands that gas absorbs differently have an equation of their own. */
static hr2d_status run_groups(hr2d_linkset *links, const hr2di_equation_how *how,
                              const hr2d_solve_options *options, const double *field,
                              hr2d_solution **solution) {
  hr2d_solution **made = hr2di_alloc_zero(&links->alloc, links->groups, sizeof *made);
  hr2d_status status = made ? HR2D_OK : HR2D_ENOMEM;
  begin(links);
  for (size_t g = 0; g < links->groups && !status; g++)
    status = run_group(links, g, how, options, field, &made[g]);
  if (!status) status = hr2di_band_solution_join(links, made, solution);
  end(links);
  for (size_t g = 0; g < links->groups && made; g++) hr2d_solution_destroy(made[g]);
  hr2di_alloc_free(&links->alloc, made);
  if (status == HR2D_ENOMEM)
    hr2di_message_fail(&links->message, status, "out of memory for the solve");
  return status;
}

static hr2d_status run(hr2d_linkset *links, const hr2di_equation_how *how,
                       const hr2d_solve_options *given, const double *field,
                       hr2d_solution **solution) {
  hr2d_solve_options options = HR2D_SOLVE_OPTIONS_INIT;
  if (hr2di_sized_copy(&options, sizeof options, given))
    return hr2di_message_fail(&links->message, HR2D_EINVAL, "struct_size is not set");
  hr2d_status status = check_options(links, &options, field != NULL);
  if (status) return status;
  options.threads = (unsigned)hr2di_team_threads(options.threads);
  if (links->groups > 1) return run_groups(links, how, &options, field, solution);
  const hr2d_scene *scene = links->hierarchy->scene;
  hr2d_scene *frozen = NULL;
  hr2di_watch watch;
  hr2di_share_begin(links->share);
  hr2di_scene_watch(scene, &watch, options.progress, options.progress_ctx, "rows");
  if (hr2di_scene_is_unsettled(scene)) status = guess(links, &options, &frozen);
  if (!status && !field) status = hr2di_existence_check(links, frozen ? frozen : scene, &watch);
  begin(links);
  hr2d_solution *made = NULL;
  if (!status)
    status = frozen ? solve_heat(links, &options, frozen, &made)
                    : solve(links, how, &options, field, &made);
  end(links);
  if (status) hr2di_relit_destroy(frozen);
  if (status == HR2D_ENOMEM)
    hr2di_message_fail(&links->message, status, "out of memory for the solve");
  if (links->share) status = agree(links, status, &made);
  if (!status) *solution = made;
  return status;
}

hr2d_status hr2di_solve(hr2d_linkset *links, const hr2di_equation_how *how,
                        const hr2d_solve_options *options, hr2d_solution **solution) {
  return run(links, how, options, NULL, solution);
}

hr2d_status hr2d_solve(hr2d_linkset *links, const hr2d_solve_options *options,
                       hr2d_solution **solution) {
  if (!links || !solution) return HR2D_EINVAL;
  const hr2di_equation_how how = hr2di_equation_how_of(links);
  return run(links, &how, options, NULL, solution);
}

hr2d_status hr2d_solution_adopt(hr2d_linkset *links, const hr2d_solve_options *given,
                                const double *field, hr2d_solution **solution) {
  if (!links || !field || !solution) return HR2D_EINVAL;
  const hr2di_equation_how how = hr2di_equation_how_of(links);
  return run(links, &how, given, field, solution);
}
