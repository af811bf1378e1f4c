/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The functions of glibc 2.36 whose last digits are not those of amd64 on machines that have
   fused multiply-adds, by operations that each machine rounds alike.  Preloaded, for lengths of
   the order of 1: with it all machines print the same digits. */
#include <math.h>

double hypot(double x, double y) {
  return sqrt(x * x + y * y);
}

double cbrt(double x) {
  return copysign(pow(fabs(x), 1.0 / 3), x);
}

double exp2(double x) {
  return pow(2, x);
}
