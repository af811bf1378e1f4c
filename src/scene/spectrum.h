/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How bands divide what black bodies emit: between wavelengths, or by weights. */
#ifndef HR2D_SRC_SCENE_SPECTRUM_H
#define HR2D_SRC_SCENE_SPECTRUM_H

#include <stddef.h>

/* Of both there is one at most. */
typedef struct hr2di_spectrum {
  double *wavelength; /* in micrometres, rising; NULL: none */
  size_t wavelengths;
  double *weight; /* weights × terms: polynomials of T, of the bands behind the first; NULL */
  size_t weights, terms;
} hr2di_spectrum;

static inline size_t hr2di_spectrum_bands(const hr2di_spectrum *s) {
  return s->wavelengths + s->weights + 1;
}

/* The part of the black body's emission that a band has; 1 if there is one band.  Bands of
   several lights in one scene repeat. */
double hr2di_spectrum_part(const hr2di_spectrum *s, double kelvin, size_t band);

/* Its derivative, with the emission, by σT⁴; see hr2di_black_body_rise(). */
double hr2di_spectrum_rise(const hr2di_spectrum *s, double kelvin, size_t band);

/* Whether all parts at a temperature are in [0,1]: polynomials need not be.  Else *band is one
   that is not. */
int hr2di_spectrum_knows(const hr2di_spectrum *s, double kelvin, size_t *band);

#endif
