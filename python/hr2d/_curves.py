# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves as chords, none farther from its curve than a tolerance.  Ends of chords lie on the curve."""
from __future__ import annotations

import math
from typing import Any, Optional

import numpy as np

from ._arrays import Array
from ._errors import SceneError

MOST_SEGMENTS = 100_000
"""Of one curve; a tolerance that asks for more is a mistake of units."""


def steps(angle: float, radius: float, tolerance: Optional[float]) -> int:
    """Chords of an arc, none farther from it than the tolerance: the sagitta of the angle h is
    r(1 − cos h/2).  Without a tolerance r/200 is one: 32 chords of a circle."""
    part = 1 / 200 if tolerance is None else tolerance / radius if radius > 0 else 2.0
    if not math.isfinite(angle) or not math.isfinite(radius):
        return 1
    # 1 − cos h/2 = 2 sin² h/4, which keeps its digits for small parts.
    most = 4 * math.asin(math.sqrt(part / 2)) if part < .5 else 2 * math.pi / 3
    return _limited(abs(angle) / most, tolerance)


def _limited(number: float, tolerance: Optional[float]) -> int:
    if number > MOST_SEGMENTS:
        raise SceneError(f"a tolerance of {tolerance:g} makes {number:.2g} segments of one curve: "
                         "it is in units of the drawing")
    return max(1, math.ceil(number - 1e-9))


def bulge(a: Array, b: Array, value: float, tolerance: Optional[float]) -> Array:
    """The points after a up to b on the arc of DXF's bulge, tan(θ/4): counterclockwise if > 0."""
    length = float(np.hypot(*(b - a)))
    if value == 0 or length == 0 or not math.isfinite(value):
        return np.array([b])
    left = np.array([a[1] - b[1], b[0] - a[0]])
    centre = (a + b) / 2 + left / 2 * (1 / value - value) / 2
    angle, radius = 4 * math.atan(value), length / 4 * abs(1 / value + value)
    turn = angle * np.arange(1, steps(angle, radius, tolerance) + 1)
    turn = turn / len(turn)
    arm = a - centre
    points = centre + np.stack([arm[0] * np.cos(turn) - arm[1] * np.sin(turn),
                                arm[0] * np.sin(turn) + arm[1] * np.cos(turn)], axis=1)
    points[-1] = b
    return np.asarray(points)


def bezier(corners: Any, tolerance: Optional[float]) -> Array:
    """The points after the first of a Bézier curve of degree 2 or 3.  A chord of the step h is
    within max|B″|h²/8, and B″ is largest at an end."""
    p = np.asarray(corners, dtype=float)
    degree = len(p) - 1
    second = degree * (degree - 1) * np.diff(p, n=2, axis=0)
    bend = float(np.hypot(second[:, 0], second[:, 1]).max())
    if tolerance is None:
        tolerance = float(np.hypot(*np.ptp(p, axis=0))) / 400
    if not math.isfinite(bend) or tolerance == 0:
        return p[-1:]
    n = _limited(math.sqrt(bend / (8 * tolerance)), tolerance)
    t = (np.arange(1, n + 1) / n)[:, None]
    values = sum((math.comb(degree, k) * t ** k * (1 - t) ** (degree - k) * p[k]
                  for k in range(degree + 1)), np.zeros((n, 2)))
    values[-1] = p[-1]
    return values
