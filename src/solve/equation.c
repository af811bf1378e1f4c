/* SPDX-License-Identifier: GPL-3.0-or-later */
/* B = Q + ρ K B on the leaves, for a source Q.

   With B = Q + √ρ y the equation becomes (I − √ρ K √ρ) y = √ρ K Q.  Its operator is
   self-adjoint in Σ A x y, because A_i K_ij = AF_ij = A_j K_ji, and positive definite
   where light is lost; patches with ρ = 0 drop out by themselves.  In balanced components
   Q' = Q − (1−ρ)c and z stand for Q and B, see energy-balance.h.  On panes matrices stand for ρ
   and √ρ, see scattering.h. */
#include "solve/equation.h"

#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "base/clock.h"
#include "hierarchy/hierarchy-impl.h"
#include "scene/scene-impl.h"
#include "solve/background.h"
#include "solve/closure.h"
#include "solve/external-irradiance.h"
#include "solve/gas-light.h"
#include "solve/gas-rows.h"
#include "solve/row-sums.h"

/* Where nothing reflects, closure has nothing to correct. */
static int reflects(const hr2d_scene *scene) {
  return scene->effect[HR2D_EFFECT_INTERREFLECTION].called_for;
}

/* At an order above 1.  The background needs closed rows: what K lacks elsewhere would
   come from the background. */
static hr2d_status integrate_rows_order_p(hr2di_equation *s, int closure, int background) {
  hr2di_transport *t = &s->transport;
  if (background) s->row_sums = t->leaves;
  hr2d_status status = hr2di_closure_set_order_p(t);
  if (!status && background) status = hr2di_background_set_order_p(t, &s->links->sees_backs);
  if (!closure) {
    hr2di_alloc_free(&t->alloc, t->closure);
    hr2di_alloc_free(&t->alloc, t->closed);
    t->closure = NULL;
    t->closed = NULL;
    t->all_closed = 0;
  }
  return status;
}

/* Sets closure and the form factor of the background, which need the rows of all leaves. */
static hr2d_status integrate_rows(hr2di_equation *s) {
  const int closure = s->options.closure != HR2D_CLOSURE_OFF && reflects(s->transport.scene);
  const int background = hr2di_external_wants_sky(s->links->hierarchy->scene);
  if (hr2di_scene_has_gas(s->links->hierarchy->scene))
    return hr2di_gas_rows_set(&s->transport, s->options.closure != HR2D_CLOSURE_OFF,
                              &s->row_sums, &s->links->message);
  if (!closure && !background) return HR2D_OK;
  if (s->transport.order > 1) return integrate_rows_order_p(s, closure, background);
  hr2di_row_sums rows;
  hr2d_status status = hr2di_row_sums_init(&rows, &s->transport, background);
  if (!status && background) status = hr2di_background_set(&s->transport, &rows);
  if (!status && closure) status = hr2di_closure_set(&s->transport, &rows, NULL);
  s->row_sums = rows.leaves;
  hr2di_row_sums_clear(&rows);
  return status;
}

/* Makes the blocks that an order above 1 needs, unless a former solve has made them. */
static hr2d_status integrate_blocks(hr2di_equation *s, const hr2di_equation_how *how) {
  hr2d_linkset *links = s->links;
  const size_t own = how->order ? how->order : links->hierarchy->order;
  const hr2di_blocks_wanted wanted = {
      .order = own > 1 && how->block_order > own ? how->block_order : own,
      .single = how->single,
      .beam_cache = how->beam_cache,
      .threads = s->options.threads};
  if ((wanted.order == 1 && !hr2di_scene_has_gas(links->hierarchy->scene)) ||
      hr2di_link_blocks_made(links, &wanted))
    return HR2D_OK;
  const double start = hr2di_clock_now();
  const hr2d_status status = hr2di_link_blocks_init(links, &wanted, &s->watch);
  s->kernels = links->blocks.kernels;
  s->coefficients_seconds = hr2di_clock_now() - start;
  return status;
}

/* Sets powers of two that bring the light of each band near 1.  Then neither squares nor B
   after many reflections leave the range of a double, and denormals have all digits. */
static void set_exponents(hr2di_equation *s) {
  const hr2d_scene *scene = s->transport.scene;
  for (size_t b = 0; b < scene->bands; b++) {
    double max = fmax(hr2di_sky_max(scene, b), hr2d_scene_sun(scene, b).irradiance);
    for (size_t k = 0; k < scene->gases.count && s->transport.gas; k++)
      max = fmax(max, fabs(hr2di_gas_light_emission(&s->transport, k, b, 0, s->y)));
    for (size_t k = 0; k < scene->patches; k++)
      max = fmax(max, fabs(hr2d_scene_emission(scene, k, b)));
    s->exponent[b] = max > 0 ? ilogb(max) : 0;
    s->light[b] = ldexp(hr2d_scene_background(scene, b), -s->exponent[b]);
  }
}

/* Item k of the system is coefficient k % order of leaf k / order. */
static hr2d_status set_surfaces(hr2di_equation *s) {
  hr2d_status status = HR2D_OK;
  const hr2di_transport *t = &s->transport;
  for (size_t k = 0; k < s->items && !status; k++) {
    if (k % 1024 == 0) status = hr2di_watch_work(t->watch, 1024 * (1 + t->bands) / 2);
    const hr2d_element *e = &t->hierarchy->element[t->leaf[k / t->order]];
    s->weight[k] = e->length;
    const int pane = t->other_leaf && t->other_leaf[k / t->order] != k / t->order;
    for (size_t b = 0; b < t->bands; b++)
      s->root_rho[k * t->bands + b] =
          pane ? 1 : sqrt(hr2d_scene_reflectance(t->scene, e->patch, b));
  }
  return status ? status : hr2di_scattering_set(&s->panes, t);
}

hr2d_status hr2di_equation_set_surfaces(hr2di_equation *s) {
  if (s->balance.count > 0) hr2di_balance_set_losses(&s->balance, &s->transport);
  return set_surfaces(s);
}

hr2d_status hr2di_equation_reserve(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  s->items = t->leaves * t->order;
  s->field = t->leaves * t->width;
  s->space = hr2di_alloc_zero(&s->links->alloc, s->items + 7 * s->field + 3 * t->bands,
                              sizeof *s->space);
  if (!s->space) return HR2D_ENOMEM;
  double **const field[] = {&s->source, &s->root_rho, &s->radiosity, &s->irradiance,
                            &s->y,      &s->b,        &s->work};
  s->weight = s->space;
  for (size_t k = 0; k < 7; k++) *field[k] = s->space + s->items + k * s->field;
  s->norm[0] = s->space + s->items + 7 * s->field;
  s->norm[1] = s->norm[0] + t->bands;
  s->light = s->norm[1] + t->bands;
  return hr2di_scattering_init(&s->panes, t);
}

/* E is constant on leaves. */
static hr2d_status set_source(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  for (size_t k = 0; k < s->field; k++) s->source[k] = 0;
  for (size_t k = 0; k < t->leaves; k++)
    for (size_t b = 0; b < t->bands; b++)
      s->source[k * t->width + b] =
          ldexp(hr2d_scene_emission(t->scene, t->hierarchy->element[t->leaf[k]].patch, b),
                -s->exponent[b]);
  return hr2di_watch_work(t->watch, t->leaves * t->bands / 4);
}

static hr2d_status set_outside(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  const hr2d_scene *scene = t->hierarchy->scene;
  const int has_gas = t->gas && hr2di_scene_gas_emits(scene);
  if (!t->sky && !has_gas && !hr2di_scene_has_sun(scene) && !hr2di_external_has_pieces(scene)) {
    hr2di_alloc_free(&s->links->alloc, s->outside);
    s->outside = NULL;
    return HR2D_OK;
  }
  if (!s->outside) s->outside = hr2di_alloc(&s->links->alloc, s->field, sizeof *s->outside);
  if (!s->outside) return HR2D_ENOMEM;
  const hr2d_status status = hr2di_external_set(t, s->light, s->exponent, s->outside);
  if (has_gas) hr2di_gas_light_add(t, s->exponent, s->outside);
  return status;
}

hr2d_status hr2di_equation_set_light(hr2di_equation *s) {
  hr2d_status status = hr2di_equation_set_surfaces(s);
  set_exponents(s);
  if (!status) status = set_outside(s);
  for (size_t k = 0; k < s->field; k++) s->y[k] = 0;
  s->background = 1;
  return status ? status : set_source(s);
}

hr2di_equation_how hr2di_equation_how_of(const hr2d_linkset *links) {
  return (hr2di_equation_how){.single = links->blocks.single};
}

hr2d_status hr2di_equation_init(hr2di_equation *s, hr2d_linkset *links, const hr2d_scene *scene,
                                const hr2di_equation_how *how,
                                const hr2d_solve_options *options) {
  *s = (hr2di_equation){
      .links = links, .options = *options, .background = 1, .enough = how->enough};
  if (!(s->options.tolerance > 0)) s->options.tolerance = HR2D_DEFAULT_TOLERANCE;
  if (!s->options.max_iterations) s->options.max_iterations = HR2D_DEFAULT_MAX_ITERATIONS;
  s->transport.alloc = links->alloc;
  hr2di_transport *t = &s->transport;
  hr2di_scene_watch(links->hierarchy->scene, &s->watch, options->progress,
                    options->progress_ctx, "rows");
  s->watch.report.elements = links->hierarchy->elements;
  s->watch.report.links = links->store.count;
  hr2d_status status = integrate_blocks(s, how);
  if (status) return status;
  hr2di_watch_phase(&s->watch, "rows");
  status = hr2di_transport_init(t, s->links, how->order, s->options.threads, &s->watch);
  if (status == HR2D_ESTATE)
    return hr2di_message_fail(&links->message, status,
                              "the elements of both sides of a pane are not the same: divide "
                              "both alike, or refine the links once more");
  t->scene = scene;
  if (how->roots) t->roots = how->roots;
  hr2di_transport_set_bands(t, 1);
  if (!status) status = integrate_rows(s);
  if (!status && t->closure) status = hr2di_closure_set_mean(t);
  hr2di_transport_set_bands(t, links->hierarchy->scene->bands);
  if (!status && t->closure && reflects(scene) && !links->directed)
    status = hr2di_balance_init(&s->balance, t);
  hr2di_alloc_free(&t->alloc, t->rows);
  t->rows = NULL;
  if (!status) status = hr2di_watch_work(&s->watch, t->leaves * t->width / 4);
  if (status) return status;
  hr2di_watch_phase(&s->watch, "solve");
  s->exponent = hr2di_alloc(&s->links->alloc, t->bands, sizeof *s->exponent);
  if (!s->exponent) return HR2D_ENOMEM;
  status = hr2di_equation_reserve(s);
  return status ? status : hr2di_equation_set_light(s);
}

static void apply_panes(const hr2di_equation *s, hr2di_scattering_part part, double *field) {
  hr2di_scattering_apply(&s->panes, part, s->transport.order, s->transport.bands, field);
}

void hr2di_equation_scatter(const hr2di_equation *s, double *field) {
  for (size_t k = 0; k < s->field; k++) field[k] = s->root_rho[k] * s->root_rho[k] * field[k];
  apply_panes(s, HR2DI_SCATTERING, field);
}

/* field = √ρ field, the second factor √ρ of the equation. */
static void reflect(const hr2di_equation *s, double *field) {
  for (size_t k = 0; k < s->field; k++) field[k] *= s->root_rho[k];
  apply_panes(s, HR2DI_SCATTERING_SIGNED_ROOT, field);
}

/* out = √ρ K √ρ in */
static void apply(void *ctx, const double *in, double *out) {
  hr2di_equation *s = ctx;
  for (size_t k = 0; k < s->field; k++) s->work[k] = s->root_rho[k] * in[k];
  apply_panes(s, HR2DI_SCATTERING_ROOT, s->work);
  hr2di_transport_apply(&s->transport, s->work, out);
  reflect(s, out);
}

/* field += √ρ y; what is added on panes waits in `work`. */
static void add_root(hr2di_equation *s, const double *y, double *field) {
  if (s->panes.pairs > 0) {
    memcpy(s->work, y, s->field * sizeof *y);
    apply_panes(s, HR2DI_SCATTERING_ROOT, s->work);
    y = s->work;
  }
  for (size_t k = 0; k < s->field; k++) field[k] += s->root_rho[k] * y[k];
}

/* out = z = Q' + √ρ y, with Q' = Q outside balanced components. */
static void set_fluctuation(hr2di_equation *s, const double *y, double *out) {
  for (size_t k = 0; k < s->field; k++) out[k] = s->source[k];
  hr2di_balance_absorb(&s->balance, &s->transport, out);
  if (y) add_root(s, y, out);
}

/* B = c + z */
static void set_radiosity(hr2di_equation *s, const double *y) {
  set_fluctuation(s, y, s->radiosity);
  hr2di_balance_add(&s->balance, &s->transport, s->radiosity);
}

static hr2di_krylov_system make_system(hr2di_equation *s);

static void scale(void *ctx, const double *y, double *norm) {
  hr2di_equation *s = ctx;
  const hr2di_krylov_system system = make_system(s);
  set_radiosity(s, y);
  hr2di_krylov_dot(&system, s->radiosity, s->radiosity, norm);
  for (size_t b = 0; b < system.bands; b++) norm[b] = sqrt(norm[b]);
}

/* scale() has set the radiosity. */
static int is_enough(void *ctx, const double *r) {
  return hr2di_equation_is_enough(ctx, r);
}

static hr2d_status report(void *ctx, double residual) {
  hr2di_equation *s = ctx;
  s->residuals++;
  if (s->transport.failed) return s->transport.failed;
  const double digits = residual > 0 ? log(residual) / log(s->options.tolerance) : 1;
  hr2di_watch *watch = s->transport.watch;
  watch->report.fraction = fmin(fmax(digits, 0), 1);
  watch->report.residual = residual;
  return hr2di_watch_ask(watch);
}

static hr2di_krylov_system make_system(hr2di_equation *s) {
  return (hr2di_krylov_system){.alloc = &s->links->alloc,
                               .size = s->items,
                               .bands = s->transport.bands,
                               .weight = s->square ? s->square : s->weight,
                               .symmetric =
                                   !s->links->directed && !s->square && !s->panes.indefinite,
                               .apply = apply,
                               .scale = scale,
                               .enough = is_enough,
                               .report = report,
                               .ctx = s,
                               .watch = s->transport.watch,
                               .tolerance = s->options.tolerance,
                               .max_iterations = s->options.max_iterations};
}

static void add_outside(const hr2di_equation *s, double *irradiance) {
  if (!s->background || !s->outside) return;
  for (size_t k = 0; k < s->field; k++) irradiance[k] += s->outside[k];
}

/* H = KB + S */
void hr2di_equation_gather(hr2di_equation *s, const double *radiosity) {
  hr2di_transport_apply(&s->transport, radiosity, s->irradiance);
  add_outside(s, s->irradiance);
}

/* h = Kz + S − mc */
static void gather_rest(hr2di_equation *s, const double *z, double *out) {
  hr2di_transport_apply(&s->transport, z, out);
  add_outside(s, out);
  hr2di_balance_release(&s->balance, &s->transport, out);
}

void hr2di_equation_balance(hr2di_equation *s) {
  if (s->balance.count > 0)
    hr2di_balance_set(&s->balance, &s->transport, s->source, s->background ? s->outside : NULL);
}

hr2d_status hr2di_equation_solve(hr2di_equation *s) {
  hr2di_equation_balance(s);
  set_fluctuation(s, NULL, s->radiosity);
  gather_rest(s, s->radiosity, s->irradiance);
  memcpy(s->b, s->irradiance, s->field * sizeof *s->b);
  reflect(s, s->b);
  const hr2di_krylov_system system = make_system(s);
  double residual = 0;
  hr2d_status status = hr2di_krylov(&system, s->b, s->y, &residual);
  if (s->transport.failed) status = s->transport.failed;
  if (status == HR2D_ENOT_CONVERGED && s->residuals <= s->options.max_iterations)
    return hr2di_message_fail(
        &s->links->message, status,
        "after %llu iterations I − ρK is found not to be positive definite: rows "
        "of the links exceed 1, and closure or finer links are needed",
        (unsigned long long)s->residuals);
  if (status == HR2D_ENOT_CONVERGED)
    return hr2di_message_fail(
        &s->links->message, status,
        "the relative residual is %.1e where %.1e was asked for, after %llu "
        "gathers",
        residual, s->options.tolerance, (unsigned long long)s->transport.sweeps);
  if (status)
    return hr2di_message_fail(&s->links->message, status, "solve: %s", hr2d_strerror(status));
  return hr2di_equation_take(s);
}

/* H = c + h with c corrected, and B = Q + ρH. */
static void balance(hr2di_equation *s) {
  const hr2di_transport *t = &s->transport;
  hr2di_balance_correct(&s->balance, t, s->source, s->irradiance);
  hr2di_balance_add(&s->balance, t, s->irradiance);
  memcpy(s->work, s->irradiance, s->field * sizeof *s->work);
  hr2di_equation_scatter(s, s->work);
  for (size_t k = 0; k < s->field; k++)
    if (hr2di_balance_holds(&s->balance, k / t->width))
      s->radiosity[k] = s->source[k] + s->work[k];
}

hr2d_status hr2di_equation_take(hr2di_equation *s) {
  set_fluctuation(s, s->y, s->radiosity);
  gather_rest(s, s->radiosity, s->irradiance);
  if (s->balance.count > 0) balance(s);
  return s->transport.failed;
}

/* c if entry k of a field is the constant coefficient of a leaf, else 0. */
static double constant_of(const hr2di_equation *s, size_t k) {
  const hr2di_transport *t = &s->transport;
  const size_t m = k % t->width;
  return m < t->bands ? hr2di_balance_at(&s->balance, t, k / t->width, m) : 0;
}

/* With B = c + z the defect is Q − (1−ρ)c + ρ(Kz + S − mc) − z. */
void hr2di_equation_defect(hr2di_equation *s, const double *radiosity, double *out) {
  for (size_t k = 0; k < s->field; k++) s->work[k] = radiosity[k] - constant_of(s, k);
  gather_rest(s, s->work, out);
  hr2di_equation_scatter(s, out);
  for (size_t k = 0; k < s->field; k++) out[k] -= s->work[k];
  set_fluctuation(s, NULL, s->work);
  for (size_t k = 0; k < s->field; k++) out[k] += s->work[k];
}

/* `b` is the work space: a solve sets it before it is read. */
void hr2di_equation_set_panes_unknown(hr2di_equation *s, const double *radiosity) {
  if (s->panes.pairs == 0) return;
  for (size_t k = 0; k < s->field; k++) s->b[k] = constant_of(s, k);
  apply_panes(s, HR2DI_SCATTERING, s->b);
  for (size_t k = 0; k < s->field; k++) s->b[k] = radiosity[k] - s->source[k] - s->b[k];
  apply_panes(s, HR2DI_SCATTERING_INVERSE_ROOT, s->b);
  for (size_t m = 0; m < s->panes.pairs; m++) {
    const size_t width = s->transport.width, front = s->panes.pair[m].front * width,
                 back = s->panes.pair[m].back * width;
    memcpy(s->y + front, s->b + front, width * sizeof *s->y);
    memcpy(s->y + back, s->b + back, width * sizeof *s->y);
  }
}

double hr2di_equation_residual(hr2di_equation *s) {
  const hr2di_krylov_system system = make_system(s);
  if (s->balance.count > 0) {
    hr2di_equation_defect(s, s->radiosity, s->y);
  } else {
    memcpy(s->y, s->irradiance, s->field * sizeof *s->y);
    hr2di_equation_scatter(s, s->y);
    for (size_t k = 0; k < s->field; k++) s->y[k] = s->source[k] + s->y[k] - s->radiosity[k];
  }
  hr2di_krylov_dot(&system, s->y, s->y, s->norm[0]);
  hr2di_krylov_dot(&system, s->radiosity, s->radiosity, s->norm[1]);
  double max = 0;
  for (size_t b = 0; b < system.bands; b++)
    if (s->norm[0][b] > 0) max = fmax(max, sqrt(s->norm[0][b] / s->norm[1][b]));
  return max;
}

void hr2di_equation_clear(hr2di_equation *s) {
  hr2di_balance_clear(&s->balance);
  hr2di_transport_clear(&s->transport);
  hr2di_scattering_clear(&s->panes, &s->links->alloc);
  hr2di_alloc_free(&s->links->alloc, s->space);
  hr2di_alloc_free(&s->links->alloc, s->outside);
  hr2di_alloc_free(&s->links->alloc, s->exponent);
}
