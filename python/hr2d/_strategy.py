# SPDX-License-Identifier: GPL-3.0-or-later
"""Oracles and policies written in Python."""
from __future__ import annotations

from typing import Any, Callable, List, Optional, Tuple, Union

import numpy as np

from ._arrays import ELEMENT, Array, copied
from ._calls import keep_exception
from ._hr2d import ffi, lib

SPLIT_FIRST, SPLIT_SECOND, SPLIT_BOTH = 0, 1, 2


class Batch:
    """Pairs of elements for which links are proposed.

    `first` and `second` are structured arrays with an item per pair: `a`, `b`, `centre` (two
    coordinates each), `length`, `child`, `patch`.  Coordinates and lengths are in units of
    `unit` scene lengths.  All arrays are copies, so that they may be kept.
    """

    def __init__(self, raw: Any):
        pairs = copied(raw.pairs, np.uint32, 2 * raw.count).reshape(-1, 2)
        every = np.frombuffer(
            ffi.buffer(raw.elements, (int(pairs.max()) + 1) * ELEMENT.itemsize), ELEMENT)
        self.epsilon: float = raw.epsilon
        """The ε of this refinement."""
        self.unit: float = raw.unit
        """Scene lengths per unit of the coordinates of elements."""
        self.pairs: Array = pairs
        """Numbers of the elements, (count, 2)."""
        self.first: Array = every[pairs[:, 0]]
        """The first element of each pair: the receiver, if links are directed."""
        self.second: Array = every[pairs[:, 1]]
        """The second element of each pair."""
        self.partial: Array = (copied(raw.partial, np.uint8, raw.count).astype(bool)
                                    if raw.partial else np.zeros(raw.count, bool))
        """Whether something bounds the view between the elements of a pair."""
        self.brightness: Optional[Array] = None
        """Of the second elements, relative to the brightest, if the oracle needs it."""
        if raw.brightness:
            bright = np.frombuffer(ffi.buffer(raw.brightness, (int(pairs.max()) + 1) * 8))
            self.brightness = bright[pairs[:, 1]]

    def __len__(self) -> int:
        return len(self.pairs)

    @property
    def distance(self) -> Array:
        """Distances of the centres."""
        apart = self.first["centre"] - self.second["centre"]
        distances: Array = np.hypot(apart[:, 0], apart[:, 1])
        return distances


class Oracle:
    """Estimates the error of a link.  Subclass it, and write estimate()."""

    name = "python"
    symmetric = True
    """(i, j) and (j, i) get the same estimate; otherwise links carry one direction."""
    needs_brightness = False
    """Reads Batch.brightness."""

    def estimate(self, batch: Batch) -> Any:
        """The estimated error of each pair, from 0 to infinity."""
        raise NotImplementedError


class Policy:
    """Decides about pairs.  Subclass it, and write those of its functions that differ."""

    name = "python"

    def acceptable(self, batch: Batch, error: Array) -> Any:
        """True for each pair that is linked.  Default: error ≤ ε."""
        raise NotImplementedError

    def recursion_limit(self, batch: Batch) -> Any:
        """True for each refused pair that is linked all the same.  Default: none."""
        raise NotImplementedError

    def preferred_subdivision(self, batch: Batch) -> Any:
        """SPLIT_FIRST, SPLIT_SECOND or SPLIT_BOTH for each pair.  Default: the longer one."""
        raise NotImplementedError


class _FunctionOracle(Oracle):
    def __init__(self, function: Callable[[Batch], Any]):
        self.name = getattr(function, "__name__", "python")
        self._function = function

    def estimate(self, batch: Batch) -> Any:
        return self._function(batch)


OracleLike = Union[None, str, Oracle, Callable[[Batch], Any]]
PolicyLike = Union[None, str, Policy]


def _answer(values: Any, count: int, dtype: Any, into: Any) -> int:
    """Writes the answers of a function; there must be one for each pair."""
    array = np.asarray(values)
    if array.shape != (count,):
        raise ValueError(f"{count} pairs need {count} answers, not an array of {array.shape}")
    out = np.frombuffer(ffi.buffer(into, count * np.dtype(dtype).itemsize), dtype)
    out[:] = array
    return lib.HR2D_OK


@ffi.def_extern(error=lib.HR2D_ECALLBACK, onerror=keep_exception)
def hr2dpy_estimate(ctx: Any, raw: Any, error: Any) -> int:
    return _answer(ffi.from_handle(ctx).estimate(Batch(raw)), raw.count, np.float64, error)


@ffi.def_extern(error=lib.HR2D_ECALLBACK, onerror=keep_exception)
def hr2dpy_acceptable(ctx: Any, raw: Any, error: Any, accepted: Any) -> int:
    errors = copied(error, np.float64, raw.count)
    answer = np.asarray(ffi.from_handle(ctx).acceptable(Batch(raw), errors), bool)
    return _answer(answer, raw.count, np.uint8, accepted)


@ffi.def_extern(error=lib.HR2D_ECALLBACK, onerror=keep_exception)
def hr2dpy_recursion_limit(ctx: Any, raw: Any, limited: Any) -> int:
    answer = np.asarray(ffi.from_handle(ctx).recursion_limit(Batch(raw)), bool)
    return _answer(answer, raw.count, np.uint8, limited)


@ffi.def_extern(error=lib.HR2D_ECALLBACK, onerror=keep_exception)
def hr2dpy_preferred_subdivision(ctx: Any, raw: Any, split: Any) -> int:
    answer = np.asarray(ffi.from_handle(ctx).preferred_subdivision(Batch(raw)))
    if not np.isin(answer, (SPLIT_FIRST, SPLIT_SECOND, SPLIT_BOTH)).all():
        raise ValueError("preferred_subdivision() gives SPLIT_FIRST, SPLIT_SECOND or "
                         "SPLIT_BOTH")
    return _answer(answer, raw.count, np.uint8, split)


def oracle_table(oracle: OracleLike) -> Tuple[Any, Any, List[Any]]:
    """Table and context in C, and what must live as long as they do."""
    if oracle is None:
        return ffi.NULL, ffi.NULL, []
    if isinstance(oracle, str):
        table = lib.hr2d_oracle_find(oracle.encode())
        if not table:
            raise ValueError(f"no oracle is called {oracle!r}")
        return table, ffi.NULL, []
    if not isinstance(oracle, Oracle):
        oracle = _FunctionOracle(oracle)
    name, ctx = ffi.new("char[]", oracle.name.encode()), ffi.new_handle(oracle)
    table = ffi.new("hr2d_oracle *", {
        "struct_size": ffi.sizeof("hr2d_oracle"),
        "name": name,
        "flags": (lib.HR2D_ORACLE_SYMMETRIC if oracle.symmetric else 0)
        | (lib.HR2D_ORACLE_NEEDS_BRIGHTNESS if oracle.needs_brightness else 0),
        "estimate": lib.hr2dpy_estimate,
    })
    return table, ctx, [oracle, name, ctx]


def policy_table(policy: PolicyLike) -> Tuple[Any, Any, List[Any]]:
    """As oracle_table().  A function that a class does not write keeps its default."""
    if policy is None:
        return ffi.NULL, ffi.NULL, []
    if isinstance(policy, str):
        table = lib.hr2d_policy_find(policy.encode())
        if not table:
            raise ValueError(f"no policy is called {policy!r}")
        return table, ffi.NULL, []
    name, ctx = ffi.new("char[]", policy.name.encode()), ffi.new_handle(policy)
    table = ffi.new("hr2d_policy *", {"struct_size": ffi.sizeof("hr2d_policy"), "name": name})
    for member in ("acceptable", "recursion_limit", "preferred_subdivision"):
        if getattr(type(policy), member, None) is not getattr(Policy, member):
            setattr(table, member, getattr(lib, "hr2dpy_" + member))
    return table, ctx, [policy, name, ctx]
