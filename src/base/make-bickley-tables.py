#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes bickley-tables.h: python3 make-bickley-tables.py > bickley-tables.h (needs mpmath).

Beyond 1, sqrt(x+1) e^x Ki_n(x) is a polynomial in s = 1/(x+1) on each of six pieces, mapped to
[-1,1].  Up to 1, Ki_n is a polynomial and (-1)^n x^n (d(x^2) - ln x c(x^2)): the series of K_0,
integrated n times.  Values come from the trapezoidal rule on the integral over exp(-x cosh t),
which knows nothing of either."""
import mpmath as mp

mp.mp.dps = 45
EDGES = [1, 2, 4, 8, 16, 64, 1000]
DEGREE = 14
SERIES = 8


def scaled(n, x):
    """e^x Ki_n(x) = the integral of exp(-x (cosh t - 1)) / cosh(t)^n over t > 0."""
    h = min(mp.mpf(1) / 14, mp.mpf("0.4") / mp.sqrt(x))
    total, k = mp.mpf(1) / 2, 1
    while True:
        c = mp.cosh(k * h)
        term = mp.exp(-x * (c - 1)) / c**n
        total += term
        if term < total * mp.mpf(10) ** -44:
            return total * h
        k += 1


def chebyshev(f, a, b, count):
    at = [mp.cos(mp.pi * (k + mp.mpf(1) / 2) / count) for k in range(count)]
    value = [f((a + b) / 2 + (b - a) / 2 * x) for x in at]
    return [
        (2 - (j == 0))
        * mp.fsum(value[k] * mp.cos(mp.pi * j * (k + mp.mpf(1) / 2) / count) for k in range(count))
        / count
        for j in range(count)
    ]


def powers(c):
    """The coefficients of powers from those of Chebyshev polynomials."""
    before, here, out = [mp.mpf(1)], [mp.mpf(0), mp.mpf(1)], [mp.mpf(0)] * len(c)
    for j, factor in enumerate(c):
        if j == 0:
            polynomial = before
        else:
            polynomial = here
            after = [mp.mpf(0)] + [2 * t for t in here]
            for k, t in enumerate(before):
                after[k] -= t
            before, here = here, after
        for k, t in enumerate(polynomial):
            out[k] += factor * t
    return out


def ends(lo, hi):
    return mp.mpf(1) / (hi + 1), mp.mpf(1) / (lo + 1)


def rows(values, indent="    "):
    """Numbers with 20 digits, in lines of at most 96 columns."""
    line, out = indent, []
    for v in values:
        text = mp.nstr(v, 20) + ", "
        if len(line) + len(text) > 97:
            out.append(line.rstrip())
            line = indent
        line += text
    out.append(line.rstrip().rstrip(","))
    return "\n".join(out)


def far(n):
    print("static const double far_%d[PIECES][DEGREE + 1] = {" % n)
    for lo, hi in zip(EDGES, EDGES[1:]):
        a, b = ends(lo, hi)
        c = chebyshev(lambda s: mp.sqrt(1 / s) * scaled(n, 1 / s - 1), a, b, 24)
        print("  {\n%s\n  }," % rows(powers(c[: DEGREE + 1])))
    print("};")


def near(n):
    logs, rest = [], []
    for k in range(SERIES):
        c = mp.mpf(4) ** -k / mp.factorial(k) ** 2
        for j in range(1, n + 1):
            c /= 2 * k + j
        sums = mp.fsum(mp.mpf(1) / (2 * k + j) for j in range(1, n + 1))
        logs.append(c)
        rest.append(c * (mp.harmonic(k) - mp.euler + mp.log(2) + sums))
    print("static const double log_%d[SERIES] = {\n%s\n};" % (n, rows(logs)))
    print("static const double rest_%d[SERIES] = {\n%s\n};" % (n, rows(rest)))


print("/* SPDX-License-Identifier: GPL-3.0-or-later */")
print("/* Made by make-bickley-tables.py, which explains them; for bickley.c alone. */")
print("/* clang-format off */")
print("enum { PIECES = %d, DEGREE = %d, SERIES = %d };" % (len(EDGES) - 1, DEGREE, SERIES))
pairs = [ends(lo, hi) for lo, hi in zip(EDGES, EDGES[1:])]
print("static const double middle[PIECES] = {\n%s\n};" % rows([(a + b) / 2 for a, b in pairs]))
print("static const double scale[PIECES] = {\n%s\n};" % rows([2 / (b - a) for a, b in pairs]))
for number in (2, 3, 4):
    far(number)
    near(number)
print("/* clang-format on */")
