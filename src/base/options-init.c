/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The macros ..._INIT as functions.  A caller's struct may be older or newer than the
   library's: its own size counts. */
#include <hr2d/hr2d.h>
#include <string.h>

static void set_defaults(void *options, size_t size) {
  if (!options) return;
  memset(options, 0, size);
  if (size >= sizeof size) memcpy(options, &size, sizeof size);
}

void hr2d_refine_options_init(hr2d_refine_options *options, size_t size) {
  set_defaults(options, size);
}

void hr2d_solve_options_init(hr2d_solve_options *options, size_t size) {
  set_defaults(options, size);
}

void hr2d_matrix_options_init(hr2d_matrix_options *options, size_t size) {
  set_defaults(options, size);
}

void hr2d_clusters_options_init(hr2d_clusters_options *options, size_t size) {
  set_defaults(options, size);
}

void hr2d_sky_init(hr2d_sky *sky, size_t size) {
  set_defaults(sky, size);
}

void hr2d_lint_options_init(hr2d_lint_options *options, size_t size) {
  set_defaults(options, size);
}

void hr2d_field_options_init(hr2d_field_options *options, size_t size) {
  set_defaults(options, size);
}

void hr2d_enclose_options_init(hr2d_enclose_options *options, size_t size) {
  set_defaults(options, size);
}

void hr2d_target_init(hr2d_target *target, size_t size) {
  set_defaults(target, size);
}

void hr2d_light_init(hr2d_light *light, size_t size) {
  set_defaults(light, size);
}

void hr2d_gradient_init(hr2d_gradient *gradient, size_t size) {
  set_defaults(gradient, size);
}

void hr2d_thermal_init(hr2d_thermal *thermal, size_t size) {
  set_defaults(thermal, size);
}

void hr2d_gas_init(hr2d_gas *gas, size_t size) {
  set_defaults(gas, size);
}

void hr2d_patch_init(hr2d_patch *patch) {
  if (!patch) return;
  *patch = (hr2d_patch)HR2D_PATCH_INIT;
}
