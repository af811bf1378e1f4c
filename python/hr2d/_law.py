# SPDX-License-Identifier: GPL-3.0-or-later
"""The law of the numbers of elements and links, as ε → 0."""
from __future__ import annotations

from typing import Any, NamedTuple, Optional, Tuple

import numpy as np

from ._calls import POLL, Call, ProgressFunction
from ._hr2d import ffi, lib


class Term(NamedTuple):
    """factor·ε^−power."""

    factor: float
    power: float
    error: float
    """Estimated error of the factor: of the quadrature."""


class Law(NamedTuple):
    """Means over the phases of ε, from ε to ε/period.  See hr2d_study_law()."""

    links: Tuple[Term, ...]
    elements: Tuple[Term, ...]
    period: float

    def L(self, epsilon: Any) -> Any:
        """The mean number of links; epsilon may be an array."""
        return _sum(self.links, epsilon)

    def N(self, epsilon: Any) -> Any:
        """The mean number of elements."""
        return _sum(self.elements, epsilon)


def _sum(terms: Tuple[Term, ...], epsilon: Any) -> Any:
    e = np.asarray(epsilon, float)
    return sum((t.factor * e ** -t.power for t in terms), np.zeros(e.shape))[()]


def _terms(raw: Any) -> Tuple[Term, ...]:
    return tuple(Term(t.factor, t.power, t.error) for t in raw if t.factor != 0)


def find_law(links: Any, progress: Optional[ProgressFunction] = None) -> Law:
    """For the scene, the oracle and the policy of a set of links."""
    constants = ffi.new("hr2d_study_constants *")
    options = ffi.new("hr2d_refine_options *", {
        "struct_size": ffi.sizeof("hr2d_refine_options"), "progress": POLL})
    with Call(progress) as call:
        call.check(lib.hr2d_study_law(links, options, constants),
                   lambda: lib.hr2d_linkset_message(links))
    return Law(_terms(constants.links), _terms(constants.elements), constants.period)
